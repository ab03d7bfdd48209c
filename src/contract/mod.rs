//! What a renderer core promises, and the plain data that crosses the boundary.
//!
//! A core implements [`Core`], and the scenes it has taken in implement [`BuiltScene`]. Every method has a
//! default that answers [`CoreError::Unsupported`]: implement what you have, declare it in [`Core::info`],
//! and the harness asks for nothing else.
//!
//! # Rules, once for all
//!
//! - Lengths are scene units; angles are radians; radiance is W·sr⁻¹·m⁻² per linear RGB channel.
//! - Directions are unit length unless a field says otherwise.
//! - BSDF directions are in the local shading frame (normal = +z) and both point *away* from the surface.
//!   `f` never includes the cosine; every `pdf` is per steradian.
//! - Film coordinates run over [0, 1]²: (0, 0) bottom left, (0.5, 0.5) centre. Pictures have row 0 on top.
//! - The caller allocates; `out[i]` answers `in[i]`; out slices are as long as the first in slice.
//! - The boundary is f64 whatever the core computes in: f32 → f64 is exact, so a double-precision core is
//!   never judged through single-precision rounding.
//!
//! **Invariant:** one caller at a time. A core may use threads inside a call.

pub mod abi;
mod batch;
mod capability;
mod error;
mod settings;
pub mod validate;

pub use batch::{
    AdaptiveMean, BoxHit, BsdfQuery, BsdfSample, BsdfValue, CodedFilm, DirectionSample, Film, Hit,
    LightSample, Primitive, Randomness, Ray, Sampler, TraversalStats, read_flags,
};
pub use capability::{
    Capabilities, Conventions, CoreInfo, EmissionSides, Falloff, GlassFresnel, GlassRadiance,
    SmithTerm,
};
pub use error::{CoreError, Result};
pub use settings::{
    Acceleration, AdaptiveSettings, BuildStats, DirectSampling, IntegratorSettings, RenderSettings,
    Roulette, Split,
};

pub use crate::math::Precision;

use crate::scene::{Aabb, Camera, Material, SceneDescription};
use glam::{DVec2, DVec3};

/// A renderer under test.
pub trait Core: Send {
    /// Who the core is, what it can do, and which conventions it follows.
    fn info(&self) -> CoreInfo;

    /// World-space rays through `film` points: unit directions, origin at the camera,
    /// `t_min` and `t_max` at its clip distances.
    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        let _ = (camera, film, rays);
        Err(CoreError::Unsupported(Capabilities::GENERATE_RAYS))
    }

    /// Nearest hit of each ray with one primitive, no acceleration structure involved.
    /// `shape` and `primitive` of a hit are 0.
    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        let _ = (primitive, rays, hits);
        Err(CoreError::Unsupported(Capabilities::INTERSECT_PRIMITIVE))
    }

    /// Whether each ray segment meets the closed box.
    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        let _ = (bounds, rays, hits);
        Err(CoreError::Unsupported(Capabilities::INTERSECT_BOX))
    }

    /// One direction of the hemisphere around +z for each element of `random`, with its density.
    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        let _ = (sampler, random, samples);
        Err(CoreError::Unsupported(Capabilities::SAMPLE_DIRECTION))
    }

    /// The density (per steradian) with which `sampler` draws each direction; 0 where it never goes.
    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        let _ = (sampler, directions, pdf);
        Err(CoreError::Unsupported(Capabilities::SAMPLE_DIRECTION))
    }

    /// `f` and `pdf` for given pairs of directions. Delta lobes answer zero.
    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        let _ = (material, queries, values);
        Err(CoreError::Unsupported(Capabilities::EVAL_BSDF))
    }

    /// One incident direction for each outgoing direction.
    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        let _ = (material, wo, random, samples);
        Err(CoreError::Unsupported(Capabilities::SAMPLE_BSDF))
    }

    /// Runs the adaptive stopping rule over given streams of sample luminances, and answers the mean it
    /// would have written and how many samples it took. A stream is as long as the sample cap.
    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        let _ = (settings, streams, means);
        Err(CoreError::Unsupported(Capabilities::ADAPTIVE_MEAN))
    }

    /// Take the scene in, and build whatever structure speeds it up.
    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        let _ = (scene, acceleration);
        Err(CoreError::Unsupported(Capabilities::BUILD_SCENE))
    }
}

/// A scene the core has taken in: the only way to reach a traversal or a render, so that "intersect before
/// build" cannot be written.
pub trait BuiltScene {
    /// What the build made. Zero for what the core does not know.
    fn stats(&self) -> BuildStats;

    /// Nearest hits in the scene.
    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let _ = (rays, hits);
        Err(CoreError::Unsupported(Capabilities::INTERSECT))
    }

    /// Whether anything lies on each segment: the any-hit query of shadow rays.
    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let _ = (rays, occluded);
        Err(CoreError::Unsupported(Capabilities::OCCLUDED))
    }

    /// One direction from each point towards light `light` of [`SceneDescription::lights`].
    /// Visibility is not tested.
    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let _ = (light, from, random, samples);
        Err(CoreError::Unsupported(Capabilities::SAMPLE_LIGHT))
    }

    /// One radiance estimate per ray: the integrator without camera or film. Ray `i` of a call draws its
    /// own random numbers, so that equal rays give independent estimates.
    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let _ = (rays, settings, radiance);
        Err(CoreError::Unsupported(Capabilities::RADIANCE))
    }

    /// A picture: `film` arrives with the size asked for and every pixel set to NaN.
    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let _ = (camera, settings, film);
        Err(CoreError::Unsupported(Capabilities::RENDER))
    }

    /// A picture of 8 bits, from a core that writes nothing else.
    fn render_codes(&mut self, camera: &Camera, settings: &RenderSettings) -> Result<CodedFilm> {
        let _ = (camera, settings);
        Err(CoreError::Unsupported(Capabilities::RENDER_CODES))
    }
}
