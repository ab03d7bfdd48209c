//! A scene that a core in a worker has taken in.

use super::{Remote, Step, done, numbers, out_of_place};
use crate::contract::{
    Acceleration, BuildStats, BuiltScene, Capabilities, CodedFilm, Film, Hit, IntegratorSettings,
    LightSample, Randomness, Ray, RenderSettings, Result, TraversalStats, read_flags,
};
use crate::image::png::Picture;
use crate::scene::{Camera, SceneDescription};
use crate::worker::message::{Answer, Request, Sent, Wanted};
use crate::worker::{SceneArrays, scene_header};
use glam::DVec3;

/// A scene that a core in a worker has taken in.
pub struct RemoteScene<'a> {
    remote: &'a mut Remote,
    /// What built it, for workers that have to build it again.
    build: Request,
    arrays: SceneArrays,
    stats: BuildStats,
}

impl<'a> RemoteScene<'a> {
    /// Lets the core build `scene`.
    pub fn build(
        remote: &'a mut Remote,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Self> {
        let arrays = SceneArrays::new(scene);
        let build = Request::Build { scene: scene_header(scene), acceleration };
        match remote.worker.ask(&build, &arrays.sent(), &mut [])? {
            Answer::Built { stats } => Ok(Self { remote, build, arrays, stats }),
            other => Err(out_of_place(&other)),
        }
    }

    fn ask(
        &mut self,
        request: &Request,
        sent: &[Sent<'_>],
        wanted: &mut [Wanted<'_>],
    ) -> Result<Answer> {
        let build = Step { request: &self.build, sent: &self.arrays.sent() };
        self.remote.ask(Some(build), request, sent, wanted)
    }

    fn traced(
        &mut self,
        request: &Request,
        rays: &[Ray],
        wanted: Wanted<'_>,
    ) -> Result<TraversalStats> {
        match self.ask(request, &[Sent::new("rays", rays)], &mut [wanted])? {
            Answer::Traced { stats } => Ok(stats),
            other => Err(out_of_place(&other)),
        }
    }
}

impl Drop for RemoteScene<'_> {
    fn drop(&mut self) {
        // If it cannot be released, the core has died, and the next request will say so.
        let _ = self.remote.worker.ask(&Request::Release, &[], &mut []);
    }
}

impl BuiltScene for RemoteScene<'_> {
    fn stats(&self) -> BuildStats {
        self.stats
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        self.traced(&Request::Intersect, rays, Wanted::new("hits", hits))
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let mut flags = vec![u8::MAX; occluded.len()];
        let wanted = Wanted::new("occluded", &mut flags);
        let stats = self.traced(&Request::Occluded, rays, wanted)?;
        read_flags(&flags, occluded)?;
        Ok(stats)
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let [points, lobes] = numbers(random);
        let sent = [Sent::new("from", from), points, lobes];
        let request = Request::SampleLight { light, seed: random.seed };
        done(self.ask(&request, &sent, &mut [Wanted::new("samples", samples)]))
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let request = Request::Radiance { settings: settings.clone() };
        let wanted = Wanted::new("radiance", radiance);
        done(self.ask(&request, &[Sent::new("rays", rays)], &mut [wanted]))
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let request = Request::Render { camera: *camera, settings: settings.clone() };
        let pixels = Wanted::new("pixels", &mut film.pixels);
        let counts = Wanted::new("sample-counts", &mut film.sample_counts);
        let variances = Wanted::new("variances", &mut film.variances);
        let has = self.remote.worker.info().capabilities;
        let mut wanted = vec![pixels, counts];
        wanted.extend(has.contains(Capabilities::REPORTED_VARIANCE).then_some(variances));
        done(self.ask(&request, &[], &mut wanted))
    }

    fn render_codes(&mut self, camera: &Camera, settings: &RenderSettings) -> Result<CodedFilm> {
        let [width, height] = [settings.width, settings.height].map(|pixels| pixels as usize);
        let mut codes = Picture { width, height, pixels: vec![[0; 3]; width * height] };
        let request = Request::RenderCodes { camera: *camera, settings: settings.clone() };
        match self.ask(&request, &[], &mut [Wanted::new("codes", &mut codes.pixels)])? {
            Answer::Coded { encoding } => Ok(CodedFilm { encoding, codes }),
            other => Err(out_of_place(&other)),
        }
    }
}
