//! Adds to a reference what it can hold beside its picture: each bounce alone by Mitsuba, and what
//! stands at the centre of each pixel by brute force in double precision.

use super::make::{Plan, remove};
use super::sums::Sums;
use super::{Listener, MakeError, MitsubaOptions, References, environment};
use crate::checks::shape::first_hits;
use crate::image::pair::Plane;
use crate::image::{Image, luminance};
use crate::scene::SceneDescription;
use crate::scene::reference::{FirstHits, Layers, Reference, load};

/// Passes of each bounce, with the first seeds of the reference: enough to say which is missing.
const PASSES: u32 = 16;
/// How far the light of all bounces may be from that of the picture, which has more passes.
const ADDS_UP: f64 = 0.01;
/// Precision of a stored bounce: 1 in 64, where a share of it is known to a tenth at best.
const BOUNCE_BITS: u32 = 6;

impl References {
    /// Adds layers to the reference `name`, whose picture stays what it is. Without a back end that
    /// renders the same paths at every depth, which LLVM's does, only what is seen first.
    pub(crate) fn add_layers(
        &self,
        name: &str,
        options: &MitsubaOptions,
        progress: Listener<'_>,
    ) -> Result<Reference, MakeError> {
        let (mut stored, plan) = self.stored(name, "layers")?;
        let bounces = self.bounces(&plan, options, progress)?;
        remove(&plan.job.folder)?;
        check_sum(name, &bounces, &stored.mean)?;
        stored.provenance.bounce_passes = if bounces.is_empty() { 0 } else { PASSES };
        stored.layers = Layers { bounces, first_hits: first_hits_of(&plan.scene) };
        self.write(&mut stored)?;
        Ok(load(&self.folder, name, &plan.scene)?)
    }

    /// The mean of each bounce alone: paths of one seed are the same whatever the last bounce is, so
    /// that the difference of two pictures is one bounce.
    fn bounces(
        &self,
        plan: &Plan,
        options: &MitsubaOptions,
        progress: Listener<'_>,
    ) -> Result<Vec<Image>, MakeError> {
        let mitsuba = environment::mitsuba(&self.folder, options, &plan.job, progress)?;
        if !mitsuba.variant.name.starts_with("llvm") {
            return Ok(Vec::new());
        }
        let job = plan.job.apart(plan.recipe.bounces);
        let seeds: Vec<u32> = (0..PASSES).collect();
        mitsuba.render(&job, &seeds, progress)?;
        let [width, height] = job.film.map(|pixels| pixels as usize);
        let mut sums = Sums::new(width, height);
        for seed in seeds {
            sums.push(&plan.whole(job.pass(seed), seed)?);
        }
        let below_each_other = sums.mean_rounded(BOUNCE_BITS);
        let height = plan.job.film[1] as usize;
        let bounces = below_each_other.pixels.chunks(width * height);
        Ok(bounces.map(|pixels| Image { width, height, pixels: pixels.to_vec() }).collect())
    }
}

fn check_sum(name: &str, bounces: &[Image], mean: &Image) -> Result<(), MakeError> {
    let light = |image: &Image| image.pixels.iter().map(|pixel| luminance(*pixel)).sum::<f64>();
    let ratio = bounces.iter().map(light).sum::<f64>() / light(mean);
    if bounces.is_empty() || (ratio - 1.0).abs() <= ADDS_UP {
        Ok(())
    } else {
        Err(MakeError::BouncesDoNotAddUp { name: name.to_owned(), ratio })
    }
}

fn first_hits_of(scene: &SceneDescription) -> Option<FirstHits> {
    let camera = scene.camera.as_ref()?;
    let [width, height] = camera.film.map(|pixels| pixels as usize);
    let (depth, normals) = first_hits(scene, camera).into_iter().map(single_precision).unzip();
    let depth = Plane { width, height, values: depth };
    Some(FirstHits { depth, normal: Image { width, height, pixels: normals } })
}

#[expect(clippy::cast_possible_truncation, reason = "as precise as the file")]
fn single_precision((depth, normal): (f64, glam::DVec3)) -> (f32, [f32; 3]) {
    (depth as f32, normal.as_vec3().to_array())
}
