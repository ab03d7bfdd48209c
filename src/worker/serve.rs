//! The side of the core: reads requests, asks the core, answers. Any [`Core`] can stand behind it.

mod built;

use super::frame::{self, Body, FrameError};
use super::message::{
    Answer, ArrayHeader, CoreHeader, Element, Header, Request, Sent, encode, parse,
};
use super::{Channel, scene};
use crate::contract::{
    AdaptiveMean, BoxHit, BsdfSample, BsdfValue, Core, CoreError, DirectionSample, Hit, Primitive,
    Randomness, Ray, Result as CoreResult,
};
use crate::scene::Aabb;
use bytemuck::Zeroable;
use glam::{DVec2, DVec3};
use std::io::{Read, Write};

/// Answers every request that comes, until the channel is closed.
///
/// # Errors
/// If the channel fails, or what comes is no request.
pub fn serve(core: &mut dyn Core, channel: Channel) -> Result<(), FrameError> {
    let mut inbox = Inbox { input: channel.input, body: Body::default() };
    let mut outbox = Outbox { output: channel.output, buffer: Vec::new() };
    while let Some(Incoming { number, request, arrays }) = inbox.next()? {
        match request {
            Request::Build { scene, acceleration } => {
                let scene = scene::decode(scene, &mut { arrays })?;
                built::serve_built(core, number, &scene, acceleration, &mut inbox, &mut outbox)?;
            }
            request => answer(core, number, request, arrays, &mut outbox)?,
        }
    }
    Ok(())
}

/// Answers every request that comes with the reason why there is no core.
///
/// # Errors
/// As [`serve`].
pub fn refuse(why: String, channel: Channel) -> Result<(), FrameError> {
    let mut inbox = Inbox { input: channel.input, body: Body::default() };
    let mut outbox = Outbox { output: channel.output, buffer: Vec::new() };
    while let Some(Incoming { number, .. }) = inbox.next()? {
        outbox.fail(number, CoreError::Refused(why.clone()))?;
    }
    Ok(())
}

/// Answers a request that needs no scene.
fn answer(
    core: &mut dyn Core,
    number: u64,
    request: Request,
    mut arrays: Arrays<'_>,
    outbox: &mut Outbox,
) -> Result<(), FrameError> {
    match request {
        Request::Hello => {
            let core = CoreHeader::new(&core.info());
            outbox.send(number, Answer::Core { core }, &[])
        }
        Request::GenerateRays { camera } => {
            let film = arrays.take::<DVec2>("film")?;
            outbox.batch(number, "rays", film.len(), |out: &mut [Ray]| {
                core.generate_rays(&camera, film, out)
            })
        }
        Request::IntersectTriangle => {
            let positions = arrays.take_exactly("positions")?;
            let normals = arrays.take_exactly("normals")?;
            hit(core, number, &Primitive::Triangle { positions, normals }, arrays, outbox)
        }
        Request::IntersectSphere => {
            let [[x, y, z, radius]] = arrays.take_exactly("spheres")?;
            let centre = DVec3::new(x, y, z);
            hit(core, number, &Primitive::Sphere { centre, radius }, arrays, outbox)
        }
        Request::IntersectBox => {
            let [min, max] = arrays.take_exactly("bounds")?;
            let rays = arrays.take::<Ray>("rays")?;
            outbox.batch(number, "box-hits", rays.len(), |out: &mut [BoxHit]| {
                core.intersect_box(&Aabb { min, max }, rays, out)
            })
        }
        Request::SampleDirection { sampler, seed } => {
            let random = arrays.randomness(seed)?;
            let count = random.points.len();
            outbox.batch(number, "samples", count, |out: &mut [DirectionSample]| {
                core.sample_direction(sampler, random, out)
            })
        }
        Request::DirectionPdf { sampler } => {
            let directions = arrays.take::<DVec3>("directions")?;
            outbox.batch(number, "pdf", directions.len(), |out: &mut [f64]| {
                core.direction_pdf(sampler, directions, out)
            })
        }
        Request::EvalBsdf { material } => {
            let queries = arrays.take("queries")?;
            outbox.batch(number, "values", queries.len(), |out: &mut [BsdfValue]| {
                core.eval_bsdf(&material, queries, out)
            })
        }
        Request::SampleBsdf { material, seed } => {
            let wo = arrays.take::<DVec3>("wo")?;
            let random = arrays.randomness(seed)?;
            outbox.batch(number, "samples", wo.len(), |out: &mut [BsdfSample]| {
                core.sample_bsdf(&material, wo, random, out)
            })
        }
        Request::AdaptiveMean { settings } => {
            let streams = arrays.streams()?;
            outbox.batch(number, "means", streams.len(), |out: &mut [AdaptiveMean]| {
                core.adaptive_mean(settings, &streams, out)
            })
        }
        other => Err(FrameError::Malformed(format!("`{}` without a scene", other.name()))),
    }
}

fn hit(
    core: &mut dyn Core,
    number: u64,
    primitive: &Primitive,
    mut arrays: Arrays<'_>,
    outbox: &mut Outbox,
) -> Result<(), FrameError> {
    let rays = arrays.take::<Ray>("rays")?;
    outbox.batch(number, "hits", rays.len(), |out: &mut [Hit]| {
        core.intersect_primitive(primitive, rays, out)
    })
}

/// Where requests come from.
struct Inbox {
    input: Box<dyn Read + Send>,
    body: Body,
}

/// A request that has come.
struct Incoming<'a> {
    number: u64,
    request: Request,
    arrays: Arrays<'a>,
}

impl Inbox {
    /// The next request; none when the channel is closed.
    fn next(&mut self) -> Result<Option<Incoming<'_>>, FrameError> {
        let opening = match frame::open(&mut self.input) {
            Err(FrameError::Closed) => return Ok(None),
            opening => opening?,
        };
        self.body.read(&mut self.input, opening.body)?;
        let header: Header<Request> = parse(&opening.header)?;
        let arrays = Arrays { headers: header.arrays, taken: 0, bytes: self.body.bytes() };
        Ok(Some(Incoming { number: opening.number, request: header.message, arrays }))
    }
}

/// The arrays of a request, taken one after another.
pub struct Arrays<'a> {
    headers: Vec<ArrayHeader>,
    taken: usize,
    bytes: &'a [u8],
}

impl<'a> Arrays<'a> {
    /// The next array, which has this name.
    ///
    /// # Errors
    /// If it is another, or longer than what was sent.
    pub fn take<T: Element>(&mut self, name: &str) -> Result<&'a [T], FrameError> {
        let wrong = |what: String| FrameError::Malformed(format!("array `{name}` {what}"));
        let header = self.headers.get(self.taken).ok_or_else(|| wrong("is missing".to_owned()))?;
        self.taken += 1;
        if header.0 != name || header.1 != T::NAME {
            return Err(wrong(format!("is `{}` of {}, not of {}", header.0, header.1, T::NAME)));
        }
        let size = usize::try_from(header.2).ok().and_then(|n| n.checked_mul(size_of::<T>()));
        let end = size.filter(|size| *size <= self.bytes.len());
        let end =
            end.ok_or_else(|| wrong(format!("has {} elements, and not so many came", header.2)))?;
        let (array, _) = self.bytes.split_at(end);
        self.bytes = &self.bytes[frame::padded(end).min(self.bytes.len())..];
        bytemuck::try_cast_slice(array).map_err(|error| wrong(error.to_string()))
    }

    /// The next array, which has this name and just so many elements.
    fn take_exactly<T: Element, const N: usize>(
        &mut self,
        name: &str,
    ) -> Result<[T; N], FrameError> {
        let array = self.take(name)?;
        let other =
            || FrameError::Malformed(format!("array `{name}` has {} elements", array.len()));
        <[T; N]>::try_from(array).map_err(|_| other())
    }

    fn randomness(&mut self, seed: u64) -> Result<Randomness<'a>, FrameError> {
        Ok(Randomness { points: self.take("points")?, lobes: self.take("lobes")?, seed })
    }

    fn streams(&mut self) -> Result<Vec<&'a [f64]>, FrameError> {
        let mut values = self.take::<f64>("values")?;
        let lengths = self.take::<u64>("lengths")?;
        let too_few = || FrameError::Malformed("streams longer than their values".to_owned());
        let mut streams = Vec::with_capacity(lengths.len());
        for length in lengths {
            let length = usize::try_from(*length).unwrap_or(usize::MAX);
            let (stream, rest) = values.split_at_checked(length).ok_or_else(too_few)?;
            streams.push(stream);
            values = rest;
        }
        Ok(streams)
    }
}

/// Where answers go.
struct Outbox {
    output: Box<dyn Write + Send>,
    buffer: Vec<u8>,
}

impl Outbox {
    fn send(
        &mut self,
        number: u64,
        message: Answer,
        arrays: &[Sent<'_>],
    ) -> Result<(), FrameError> {
        encode(&mut self.buffer, number, message, arrays)?;
        frame::send(&mut self.output, &self.buffer)
    }

    /// Lets the core fill an array, and sends it, or else why there is none.
    fn batch<T: Element + Zeroable>(
        &mut self,
        number: u64,
        name: &'static str,
        count: usize,
        fill: impl FnOnce(&mut [T]) -> CoreResult<()>,
    ) -> Result<(), FrameError> {
        let mut out = vec![T::zeroed(); count];
        match fill(&mut out) {
            Ok(()) => self.send(number, Answer::Done, &[Sent::new(name, &out)]),
            Err(error) => self.fail(number, error),
        }
    }

    fn fail(&mut self, number: u64, error: CoreError) -> Result<(), FrameError> {
        self.send(number, Answer::of_error(error), &[])
    }
}
