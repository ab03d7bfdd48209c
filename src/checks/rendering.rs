//! A small picture of a scene, as the checks of film, pixels and seeds render it.

use super::{CheckError, camera_of};
use crate::contract::{
    AdaptiveSettings, BuiltScene, DirectSampling, Film, IntegratorSettings, RenderSettings,
    Roulette,
};
use crate::image::encoding::Encoding;
use crate::image::png::Picture;
use crate::scene::{Camera, SceneDescription};

/// Columns and rows of a film, in the order of its pixels.
pub(crate) fn places([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Everything about a picture but its seed.
pub(crate) struct Rendering {
    camera: Camera,
    settings: RenderSettings,
}

impl Rendering {
    /// A picture of `scene` from its camera.
    ///
    /// # Errors
    /// If it has none.
    pub(crate) fn of(
        scene: &SceneDescription,
        size: [u32; 2],
        bounces: [u32; 2],
        samples_per_pixel: u32,
    ) -> Result<Self, CheckError> {
        Ok(Self::through(camera_of(scene)?, size, bounces, samples_per_pixel))
    }

    pub(crate) fn through(
        camera: Camera,
        size: [u32; 2],
        bounces: [u32; 2],
        samples_per_pixel: u32,
    ) -> Self {
        let settings = RenderSettings {
            width: size[0],
            height: size[1],
            samples_per_pixel,
            integrator: IntegratorSettings {
                bounces: bounces[0]..=bounces[1],
                ..Default::default()
            },
            ..Default::default()
        };
        Self { camera, settings }
    }

    /// The same with another way to sample direct light.
    pub(crate) fn by(mut self, direct: DirectSampling) -> Self {
        self.settings.integrator.direct = direct;
        self
    }

    /// The same with paths that end by chance.
    pub(crate) fn with_roulette(mut self, roulette: Option<Roulette>) -> Self {
        self.settings.integrator.roulette = roulette;
        self
    }

    /// The same where each pixel stops by itself, at the samples asked for at the latest.
    pub(crate) fn adaptive(mut self, settings: AdaptiveSettings) -> Self {
        self.settings.adaptive = Some(settings);
        self
    }

    /// The same with one sample in each cell of a grid over the pixel.
    pub(crate) fn stratified(mut self) -> Self {
        self.settings.stratified = true;
        self
    }

    /// The picture of a seed; `threads` as in [`IntegratorSettings::threads`].
    pub(crate) fn film(
        &self,
        scene: &mut dyn BuiltScene,
        seed: u64,
        threads: u32,
    ) -> Result<Film, CheckError> {
        let mut film = Film::default();
        scene.render(&self.camera, &self.settings_of(seed, threads), &mut film)?;
        Ok(film)
    }

    /// The same of a core that writes 8 bits.
    pub(crate) fn codes(
        &self,
        scene: &mut dyn BuiltScene,
        seed: u64,
    ) -> Result<(Encoding, Picture), CheckError> {
        let mut codes = Picture::default();
        let encoding = scene.render_codes(&self.camera, &self.settings_of(seed, 0), &mut codes)?;
        Ok((encoding, codes))
    }

    fn settings_of(&self, seed: u64, threads: u32) -> RenderSettings {
        let mut settings = self.settings.clone();
        settings.integrator.seed = seed;
        settings.integrator.threads = threads;
        settings
    }
}
