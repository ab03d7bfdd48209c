//! The fast core, and the one to trust: single precision inside, eight boxes at a time, all processors.
//!
//! | file | subject |
//! |---|---|
//! | `camera` | film points to rays |
//! | `trace` | from a ray to the surface that it meets |
//! | `slab` | a ray and a box, as the contract asks |
//! | `world`, `vertex` | of which material it is; seen from where |
//! | `scatter`, `light` | directions from surfaces, and towards lights |
//! | `integrator`, `direct` | paths |
//! | `render`, `adaptive`, `random` | images, when a pixel is done, and numbers |
//!
//! Which precision where: traversal, BSDFs and throughput are single; points on surfaces, light geometry and
//! sums over samples are double. Traversal decides in single precision what is hit, and the hit is then worked
//! out in double on the primitive itself.

mod adaptive;
mod camera;
mod direct;
mod integrator;
mod light;
mod mis;
mod random;
mod reach;
mod render;
mod scatter;
mod scene;
mod slab;
mod trace;
mod vertex;
mod world;

#[cfg(test)]
mod tests;

use crate::contract::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue, Built,
    BuiltScene, Capabilities, Components, Conventions, Core, CoreInfo, DirectionSample, Hit,
    Precision, Primitive, Randomness, Ray, Result, Sampler,
};
use crate::scene::{self as description, Aabb, Camera, Material, SceneDescription};
use camera::Pinhole;
use glam::{DVec2, DVec3};
use scatter::{Bsdf, warp};
use scene::BuiltinScene;

/// Listed one by one: a capability that the contract gains is not ours before it is written.
const CAPABILITIES: Capabilities = Capabilities::GENERATE_RAYS
    .union(Capabilities::INTERSECT_PRIMITIVE)
    .union(Capabilities::BUILD_SCENE)
    .union(Capabilities::INTERSECT)
    .union(Capabilities::OCCLUDED)
    .union(Capabilities::BRUTE_FORCE)
    .union(Capabilities::TRAVERSAL_STATS)
    .union(Capabilities::EVAL_BSDF)
    .union(Capabilities::SAMPLE_BSDF)
    .union(Capabilities::SAMPLE_LIGHT)
    .union(Capabilities::RADIANCE)
    .union(Capabilities::RENDER)
    .union(Capabilities::ADAPTIVE_SAMPLING)
    .union(Capabilities::INTERSECT_BOX)
    .union(Capabilities::SAMPLE_DIRECTION)
    .union(Capabilities::ADAPTIVE_MEAN)
    .union(Capabilities::SPLIT_RULES)
    .union(Capabilities::HEMISPHERE_SAMPLING)
    .union(Capabilities::ISOLATED_BOUNCES)
    .union(Capabilities::DEPTH_LIMIT)
    .union(Capabilities::ROULETTE)
    .union(Capabilities::ROUGH_GLASS)
    .union(Capabilities::REPORTED_VARIANCE)
    .union(Capabilities::STRATIFIED_PIXELS)
    .union(Capabilities::CALLERS_RANDOMNESS)
    .union(Capabilities::DETERMINISTIC)
    .union(Capabilities::PROMISES);

/// The fast core. It keeps nothing between calls.
#[derive(Clone, Copy, Debug, Default)]
pub struct Builtin;

impl Builtin {
    /// Ready at once.
    pub const fn new() -> Self {
        Self
    }
}

impl Core for Builtin {
    fn info(&self) -> CoreInfo {
        CoreInfo {
            name: "builtin".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            capabilities: CAPABILITIES,
            // Its components are inlined into one another, down to the SIMD kernel.
            components: Components::empty(),
            precision: Precision::Single,
            conventions: Conventions::default(),
        }
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        let pinhole = Pinhole::new(camera);
        for (ray, &point) in rays.iter_mut().zip(film) {
            *ray = pinhole.ray(point);
        }
        Ok(())
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        let scene = scene_of_one(primitive);
        BuiltinScene::new(&scene, Acceleration::BruteForce)?.intersect(rays, hits)?;
        Ok(())
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = slab::intersect_box(bounds, ray);
        }
        Ok(())
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        for (sample, &point) in samples.iter_mut().zip(random.points) {
            let direction = warp::direction(sampler, warp::narrow_point(point));
            let pdf = f64::from(warp::pdf(sampler, direction));
            *sample = DirectionSample { direction: direction.as_dvec3(), pdf };
        }
        Ok(())
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        for (pdf, direction) in pdf.iter_mut().zip(directions) {
            *pdf = f64::from(warp::pdf(sampler, direction.as_vec3()));
        }
        Ok(())
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        let bsdf = Bsdf::new(&material.surface);
        for (value, query) in values.iter_mut().zip(queries) {
            let (f, pdf) = bsdf.evaluate(query.wo.as_vec3(), query.wi.as_vec3());
            *value = BsdfValue { f: f.as_dvec3().to_array(), pdf: f64::from(pdf) };
        }
        Ok(())
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        let bsdf = Bsdf::new(&material.surface);
        let numbers = random.points.iter().zip(random.lobes);
        for ((sample, wo), (&point, &lobe)) in samples.iter_mut().zip(wo).zip(numbers) {
            *sample = sample_bsdf(&bsdf, *wo, point, lobe);
        }
        Ok(())
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        for (mean, stream) in means.iter_mut().zip(streams) {
            *mean = adaptive::mean_of_stream(settings, stream);
        }
        Ok(())
    }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        Ok(Box::new(BuiltinScene::new(scene, how)?))
    }
}

fn sample_bsdf(bsdf: &Bsdf, wo: DVec3, point: DVec2, lobe: f64) -> BsdfSample {
    let wo = wo.as_vec3();
    let is_delta = u32::from(bsdf.is_delta());
    let invalid = BsdfSample { is_delta, ..BsdfSample::NONE };
    let Some(found) = bsdf.sample(wo, warp::narrow_point(point), warp::narrow(lobe)) else {
        return invalid;
    };
    // A delta lobe has no f; the contract wants the one that gives its weight.
    let weight_to_f = f64::from(found.pdf) / f64::from(found.wi.z.abs());
    let f = if bsdf.is_delta() {
        found.weight.as_dvec3() * weight_to_f
    } else {
        bsdf.evaluate(wo, found.wi).0.as_dvec3()
    };
    let (wi, f) = (found.wi.as_dvec3(), f.to_array());
    if f.iter().all(|channel| channel.is_finite()) {
        BsdfSample { wi, f, pdf: f64::from(found.pdf), is_delta, is_valid: 1 }
    } else {
        invalid
    }
}

/// A black scene of one triangle or sphere.
fn scene_of_one(primitive: &Primitive) -> SceneDescription {
    let black = description::Surface::Diffuse { reflectance: [0.0; 3] };
    let material = Material { name: "black".to_owned(), surface: black, emission: None };
    let name = "primitive".to_owned();
    let mut scene = SceneDescription { materials: vec![material], ..Default::default() };
    match *primitive {
        Primitive::Triangle { positions, normals } => scene.meshes.push(description::Mesh {
            name,
            positions: positions.to_vec(),
            normals: normals.to_vec(),
            indices: vec![[0, 1, 2]],
            material: 0,
        }),
        Primitive::Sphere { centre, radius } => scene.spheres.push(description::Sphere {
            name,
            centre,
            radius,
            inward: false,
            material: 0,
        }),
    }
    scene
}
