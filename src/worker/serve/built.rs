//! Requests to a scene that was built, until it is released.

use super::{Arrays, Inbox, Incoming, Outbox};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, CodedFilm, Core, Film, Hit, LightSample, Ray,
    Result as CoreResult, TraversalStats,
};
use crate::scene::SceneDescription;
use crate::worker::frame::FrameError;
use crate::worker::message::{Answer, Element, Request, Sent};
use bytemuck::Zeroable;
use glam::DVec3;

/// Builds `scene`, and answers what is asked of it until it is released or the channel is closed.
pub fn serve_built(
    core: &mut dyn Core,
    number: u64,
    scene: &SceneDescription,
    acceleration: Acceleration,
    inbox: &mut Inbox,
    outbox: &mut Outbox,
) -> Result<(), FrameError> {
    let capabilities = core.info().capabilities;
    let mut built = match core.build_scene(scene, acceleration) {
        Ok(built) => built,
        Err(error) => return outbox.fail(number, error),
    };
    outbox.send(number, Answer::Built { stats: built.stats() }, &[])?;
    while let Some(Incoming { number, request, arrays }) = inbox.next()? {
        if request == Request::Release {
            drop(built);
            return outbox.send(number, Answer::Done, &[]);
        }
        answer(built.as_mut(), capabilities, number, request, arrays, outbox)?;
    }
    Ok(())
}

fn answer(
    built: &mut dyn BuiltScene,
    capabilities: Capabilities,
    number: u64,
    request: Request,
    mut arrays: Arrays<'_>,
    outbox: &mut Outbox,
) -> Result<(), FrameError> {
    match request {
        Request::Intersect => {
            let rays = arrays.take::<Ray>("rays")?;
            traced(outbox, number, "hits", rays.len(), |out: &mut [Hit]| built.intersect(rays, out))
        }
        Request::Occluded => {
            let rays = arrays.take::<Ray>("rays")?;
            traced(outbox, number, "occluded", rays.len(), |out: &mut [u8]| {
                let mut occluded = vec![false; out.len()];
                let stats = built.occluded(rays, &mut occluded)?;
                for (out, occluded) in out.iter_mut().zip(occluded) {
                    *out = u8::from(occluded);
                }
                Ok(stats)
            })
        }
        Request::SampleLight { light, seed } => {
            let from = arrays.take::<DVec3>("from")?;
            let random = arrays.randomness(seed)?;
            outbox.batch(number, "samples", from.len(), |out: &mut [LightSample]| {
                built.sample_light(light, from, random, out)
            })
        }
        Request::Radiance { settings } => {
            let rays = arrays.take::<Ray>("rays")?;
            outbox.batch(number, "radiance", rays.len(), |out: &mut [[f64; 3]]| {
                built.radiance(rays, &settings, out)
            })
        }
        Request::Render { camera, settings } => {
            let (width, height) = (settings.width, settings.height);
            let mut film = Film::blank(width, height, capabilities);
            match built.render(&camera, &settings, &mut film) {
                Ok(()) => {
                    let pixels = Sent::new("pixels", &film.pixels);
                    let counts = Sent::new("sample-counts", &film.sample_counts);
                    let variances = Sent::new("variances", &film.variances);
                    let mut arrays = vec![pixels, counts];
                    let reports = capabilities.contains(Capabilities::REPORTED_VARIANCE);
                    arrays.extend(reports.then_some(variances));
                    outbox.send(number, Answer::Done, &arrays)
                }
                Err(error) => outbox.fail(number, error),
            }
        }
        Request::RenderCodes { camera, settings } => match built.render_codes(&camera, &settings) {
            Ok(CodedFilm { encoding, codes }) => {
                let codes = Sent::new("codes", &codes.pixels);
                outbox.send(number, Answer::Coded { encoding }, &[codes])
            }
            Err(error) => outbox.fail(number, error),
        },
        other => Err(FrameError::Malformed(format!("`{}` within a scene", other.name()))),
    }
}

/// As [`Outbox::batch`], with what the traversal did.
fn traced<T: Element + Zeroable>(
    outbox: &mut Outbox,
    number: u64,
    name: &'static str,
    count: usize,
    fill: impl FnOnce(&mut [T]) -> CoreResult<TraversalStats>,
) -> Result<(), FrameError> {
    let mut out = vec![T::zeroed(); count];
    match fill(&mut out) {
        Ok(stats) => outbox.send(number, Answer::Traced { stats }, &[Sent::new(name, &out)]),
        Err(error) => outbox.fail(number, error),
    }
}
