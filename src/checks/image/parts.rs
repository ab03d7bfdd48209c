//! What a picture is made of, for the report: each bounce alone, and direct light sampled in both ways. Grades nothing.

use super::shot::Shot;
use crate::checks::{CheckError, Layer};
use crate::contract::{BuiltScene, Capabilities, DirectSampling};
use crate::image::Image;
use crate::math::rng::Seed;
use crate::scene::SceneDescription;
use crate::scene::reference::bounce_layer;

/// Of a bounce alone, a pixel: a picture for the eye, at a few percent of what its verdict took.
const BOUNCE_SAMPLES: u32 = 4;

/// What a core is asked for beside its picture.
pub(super) struct Parts<'a> {
    pub(super) shot: &'a Shot,
    pub(super) scene: &'a SceneDescription,
    pub(super) can: Capabilities,
}

impl Parts<'_> {
    /// What the core can show of itself. `first` is one run that was judged: one way of sampling costs nothing more.
    pub(super) fn of_core(
        &self,
        first: Image,
        built: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<Vec<Layer>, CheckError> {
        let mut layers = self.bounces(built, seed.child("bounce"))?;
        if self.samples_both_ways() {
            let other = match self.shot.direct {
                DirectSampling::Lights => DirectSampling::Hemisphere,
                DirectSampling::Hemisphere => DirectSampling::Lights,
            };
            let shot = Shot { direct: other, ..*self.shot };
            layers.push(sampled(self.shot.direct, first));
            layers.push(sampled(other, shot.render(built, seed.child("other"))?));
        }
        Ok(layers)
    }

    fn bounces(&self, built: &mut dyn BuiltScene, seed: Seed) -> Result<Vec<Layer>, CheckError> {
        let [first, last] = self.shot.bounces;
        if !self.shot.isolates || first == last {
            return Ok(Vec::new());
        }
        let alone = |bounce: u32| {
            let shot = Shot { bounces: [bounce; 2], samples: BOUNCE_SAMPLES, ..*self.shot };
            let image = shot.render(built, seed.child(bounce))?;
            Ok(Layer { name: bounce_layer(bounce as usize), image })
        };
        (first..=last).map(alone).collect()
    }

    /// A direction meets no delta light: without its light the pictures are not of one scene.
    fn samples_both_ways(&self) -> bool {
        self.can.contains(Capabilities::HEMISPHERE_SAMPLING)
            && !self.scene.lights.iter().any(|light| light.is_delta())
    }
}

fn sampled(direct: DirectSampling, image: Image) -> Layer {
    let name = match direct {
        DirectSampling::Lights => "light-sampling",
        DirectSampling::Hemisphere => "hemisphere-sampling",
    };
    Layer { name: name.to_owned(), image }
}

/// Those bounces of a reference that the core has shown.
pub(super) fn of_reference(bounces: Vec<Image>, of_core: &[Layer]) -> Vec<Layer> {
    let layer = |(bounce, image)| Layer { name: bounce_layer(bounce), image };
    let layers = bounces.into_iter().enumerate().map(layer);
    layers.filter(|layer| of_core.iter().any(|other| other.name == layer.name)).collect()
}

/// By how many samples they were rendered: `; alone, a bounce by 4 and a way of sampling by 12`.
pub(super) fn caption(parts: &[Layer], samples: u32) -> String {
    match parts {
        [] => String::new(),
        _ => format!("; alone, a bounce by {BOUNCE_SAMPLES} and a way of sampling by {samples}"),
    }
}
