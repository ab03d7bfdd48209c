//! What a core is asked to render, and what it should show.

use crate::checks::CheckError;
use crate::checks::rendering::Rendering;
use crate::contract::{BuiltScene, DirectSampling};
use crate::image::Image;
use crate::image::encoding::Encoding;
use crate::image::png::Picture;
use crate::math::rng::Seed;
use crate::scene::reference::Reference;
use crate::scene::{Camera, SceneDescription};
use crate::stats::ImageEffort;
use std::sync::Arc;

/// What a core is asked for, and what it should show.
pub(super) struct Setup {
    pub(super) scene: Arc<SceneDescription>,
    pub(super) reference: Reference,
    pub(super) shot: Shot,
    pub(super) effort: ImageEffort,
    /// What the core has declared and the reference has otherwise.
    pub(super) differing: Vec<&'static str>,
}

/// How each run is rendered.
#[derive(Clone, Copy)]
pub(super) struct Shot {
    pub(super) camera: Camera,
    pub(super) direct: DirectSampling,
    /// First and last.
    pub(super) bounces: [u32; 2],
    /// Of a pixel.
    pub(super) samples: u32,
    /// Whether the core renders a bounce alone.
    pub(super) isolates: bool,
}

impl Shot {
    fn rendering(&self) -> Rendering {
        let Self { camera, direct, bounces, samples, .. } = *self;
        Rendering::through(camera, camera.film, bounces, samples).by(direct)
    }

    pub(super) fn render(
        &self,
        scene: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<Image, CheckError> {
        let film = self.rendering().film(scene, seed.0, 0)?;
        let [width, height] = self.camera.film.map(|side| side as usize);
        Ok(Image { width, height, pixels: film.pixels })
    }

    /// The same of a core that writes 8 bits.
    pub(super) fn codes(
        &self,
        scene: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<(Encoding, Picture), CheckError> {
        self.rendering().codes(scene, seed.0)
    }
}
