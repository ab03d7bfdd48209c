//! The plain core: a path tracer in f64, written the way a course teaches it, one function per task.
//!
//! It is the second witness for the fast core, the model to read before writing an adapter, and the ground on which
//! students' mistakes are planted. So it prefers the formula of the lecture to the faster one, and each place where a
//! student goes wrong is a function of its own, a *step*. Nothing here is shared with other cores.
//!
//! Read it in the order of the course, each file from the top:
//!
//! | part | task | file |
//! |---|---|---|
//! | 1 | camera rays; triangle, sphere; samples of a pixel | `camera`, `intersect`, `render` |
//! | 2 | box; dividing, building, walking the BVH | `slab`, `split`, `build`, `bvh` |
//! | 3 | surfaces, hemisphere and light sampling | `bsdf`, `sampling`, `light`, `area_light`, `direct` |
//! | 4 | paths of many bounces, roulette | `integrator` |
//! | 5 | adaptive sampling, how noisy a pixel is | `adaptive`, `spread` |
//!
//! Beyond the course: `glass`, `ggx` and `rough_glass` scatter as their names say; `world` is the scene as rays
//! see it, and `vertex` a point of a path in it; `random` gives every path its own stream, so that
//! answers do not depend on threads.
//!
//! Where the lesson says `steps.half_size(angle)` it means the function `half_size` below; `steps` is the table of them
//! all. A copy of this core has other functions in some places: mistakes that students make (`fault`), or choices that
//! are as right (`different`); `variant` makes the copies. Of those three the lesson knows nothing. An argument that a
//! step does not look at, `_number`, is what somebody else's version of it needs.

mod adaptive;
mod area_light;
mod bsdf;
mod build;
mod bvh;
mod camera;
pub(crate) mod different;
mod direct;
pub(crate) mod fault;
mod frame;
mod ggx;
mod glass;
mod integrator;
mod intersect;
mod light;
mod random;
mod render;
mod rough_glass;
mod sampling;
mod single;
mod slab;
mod split;
mod spread;
mod steps;
pub(crate) mod variant;
mod vertex;
mod world;

use crate::contract::question::*;
use crate::contract::{
    Acceleration, BuildStats, Built, BuiltScene, Components, Conventions, Core, CoreInfo, Precision,
};
use integrator::Integrator;
use random::Random;
use steps::{LESSON, Steps};
pub(crate) use world::World;

/// The plain core, or a copy of it.
#[derive(Clone, Debug)]
pub(crate) struct Textbook {
    /// As it is asked.
    steps: Steps,
    /// As it is where it takes nothing from the bench.
    own: Steps,
    /// Without its faults: what the bench puts in their place.
    right: Steps,
    info: CoreInfo,
}

impl Textbook {
    pub(crate) fn new() -> Self {
        let info = CoreInfo {
            name: "textbook".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            capabilities: Capabilities::all(),
            components: Components::all(),
            precision: Precision::Double,
            conventions: Conventions::default(),
        };
        Self { steps: LESSON, own: LESSON, right: LESSON, info }
    }

    /// `scene`, taken in.
    pub(crate) fn built(&self, scene: &SceneDescription, acceleration: Acceleration) -> World<'_> {
        World::new(scene, acceleration, &self.steps)
    }
}

/// Lets a shared one answer.
macro_rules! shared {
    (() {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            (&*self).$method($($arg,)* $out)
        }
    };
}

impl Core for Textbook {
    fn info(&self) -> CoreInfo {
        self.info.clone()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        self.steps = self.own.taking(components, &self.right);
        Ok(())
    }

    each_question! { Core shared () }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        Ok(Box::new(self.built(scene, how)))
    }
}

/// Nothing changes by being asked: many threads may ask one.
impl Core for &Textbook {
    fn info(&self) -> CoreInfo {
        self.info.clone()
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        answer(film, rays, |point| camera::generate_ray(camera, *point, &self.steps));
        Ok(())
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        answer(rays, hits, |ray| {
            world::hit_alone(primitive, ray, &self.steps).unwrap_or(Hit::MISS)
        });
        Ok(())
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        answer(rays, hits, |ray| box_hit(slab::intersect_box(bounds, ray, &self.steps)));
        Ok(())
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        for (index, sample) in samples.iter_mut().enumerate() {
            let (point, _) = self.steps.callers_numbers(&random, index);
            *sample = sampling::sample(sampler, point, &self.steps);
        }
        Ok(())
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        answer(directions, pdf, |direction| sampling::pdf(sampler, *direction, &self.steps));
        Ok(())
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        answer(queries, values, |query| {
            bsdf::evaluate(&material.surface, query.wo, query.wi, &self.steps)
        });
        Ok(())
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        for (index, (wo, sample)) in wo.iter().zip(samples).enumerate() {
            let (point, lobe) = self.steps.callers_numbers(&random, index);
            let drawn = bsdf::sample(&material.surface, *wo, point, lobe, &self.steps);
            *sample = drawn.unwrap_or(BsdfSample::NONE);
        }
        Ok(())
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        answer(streams, means, |stream| adaptive::mean_of_stream(settings, stream, &self.steps));
        Ok(())
    }
}

impl BuiltScene for World<'_> {
    fn stats(&self) -> BuildStats {
        self.build_stats()
    }

    each_question! { Scene shared () }
}

impl BuiltScene for &World<'_> {
    fn stats(&self) -> BuildStats {
        self.build_stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let mut stats = TraversalStats::default();
        answer(rays, hits, |ray| self.closest_hit(ray, &mut stats).unwrap_or(Hit::MISS));
        Ok(stats)
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let mut stats = TraversalStats::default();
        answer(rays, occluded, |ray| self.any_hit(ray, &mut stats));
        Ok(stats)
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let lights = World::lights(self);
        let light = lights.get(light as usize).ok_or_else(|| {
            CoreError::Refused(format!("there is no light {light}, the scene has {}", lights.len()))
        })?;
        let steps = World::steps(self);
        for (index, (from, sample)) in from.iter().zip(samples).enumerate() {
            let (point, lobe) = steps.callers_numbers(&random, index);
            *sample = light.sample(*from, point, lobe, steps).unwrap_or(LightSample::NONE);
        }
        Ok(())
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let integrator = Integrator::new(self, settings);
        let steps = World::steps(self);
        let seed = steps.seed(settings.seed);
        render::fill(settings.threads, radiance, |index| {
            let mut random = Random::for_ray(seed, index).drawn_by(steps);
            integrator.radiance(&rays[index], &mut random).to_array()
        })
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        render::render(self, camera, settings, film)
    }
}

/// Fills `answers[i]` from `questions[i]`.
fn answer<Q, A>(questions: &[Q], answers: &mut [A], mut one: impl FnMut(&Q) -> A) {
    for (question, slot) in questions.iter().zip(answers) {
        *slot = one(question);
    }
}

fn box_hit(span: Option<(f64, f64)>) -> BoxHit {
    let (t_enter, t_exit) = span.unwrap_or_default();
    BoxHit { t_enter, t_exit, hit: u32::from(span.is_some()), reserved: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::validate::Validated;
    use crate::contract::{DirectSampling, Split};
    use crate::cores::stage::{Stage, clear_glass, diffuse, grey, looks};
    use crate::scene::{Light, Surface};
    use random::Random;

    const COUNT: usize = 500;

    fn numbers() -> (Vec<DVec2>, Vec<f64>) {
        let mut random = Random::for_ray(0, 0);
        (0..COUNT).map(|_| (random.point(), random.number())).unzip()
    }

    /// Something of everything.
    fn scene() -> SceneDescription {
        let metal = looks(Surface::Conductor { reflectance: grey(0.8), roughness: 0.2 });
        let mirror = looks(Surface::Mirror { reflectance: grey(0.9) });
        let sky = Light::GradientSky { up: DVec3::Z, horizon: grey(0.1), zenith: grey(0.6) };
        Stage::empty()
            .floor()
            .sphere(DVec3::new(0.0, 0.0, 1.0), 0.5, clear_glass())
            .sphere(DVec3::new(1.5, 0.0, 1.0), 0.5, mirror)
            .sphere(DVec3::new(-1.5, 0.0, 1.0), 0.5, metal)
            .sphere(DVec3::new(0.0, 1.5, 2.0), 0.3, diffuse(0.4).emitting(3.0))
            .room(20.0, diffuse(0.5).emitting_cap(1.0, 0.5))
            .light(Light::Point { position: DVec3::new(1.0, 1.0, 3.0), intensity: grey(2.0) })
            .light(Light::Directional { direction: DVec3::NEG_Z, irradiance: grey(0.5) })
            .light(Light::ConstantSky { radiance: grey(0.2) })
            .light(sky)
            .scene()
    }

    #[test]
    fn sampling_answers_have_the_form_of_the_contract() {
        let (points, lobes) = numbers();
        let random = || Randomness { points: &points, lobes: &lobes, seed: 0 };
        let mut textbook = Textbook::new();
        let mut core = Validated::new(&mut textbook);
        let mut directions = [DirectionSample { direction: DVec3::Z, pdf: 0.0 }; COUNT];
        for sampler in [Sampler::UniformHemisphere, Sampler::CosineHemisphere] {
            core.sample_direction(sampler, random(), &mut directions).expect("valid");
        }
        let wo = directions.map(|sample| sample.direction);
        for material in &scene().materials {
            core.sample_bsdf(material, &wo, random(), &mut [BsdfSample::NONE; COUNT])
                .expect("valid");
        }
        let scene = scene();
        let mut built = core.build_scene(&scene, Acceleration::DEFAULT).expect("valid");
        for light in 0..scene.lights.len() as u32 {
            let samples = &mut [LightSample::NONE; COUNT];
            built.sample_light(light, &wo, random(), samples).expect("valid");
        }
        let beyond = scene.lights.len() as u32;
        let refused = built.sample_light(beyond, &wo, random(), &mut [LightSample::NONE; COUNT]);
        assert!(refused.unwrap_err().to_string().contains("there is no light 6"));
    }

    #[test]
    fn radiance_has_the_form_of_the_contract_and_does_not_depend_on_threads() {
        let scene = scene();
        let camera = Camera::look_at(DVec3::new(0.0, -5.0, 2.0), DVec3::Z, DVec3::Z, 1.2, [16, 16]);
        let mut textbook = Textbook::new();
        let mut core = Validated::new(&mut textbook);
        let mut rays = [Ray::new(DVec3::ZERO, DVec3::Z); COUNT];
        core.generate_rays(&camera, &numbers().0, &mut rays).expect("valid");
        let mut built = core.build_scene(&scene, Acceleration::DEFAULT).expect("valid");
        for direct in [DirectSampling::Lights, DirectSampling::Hemisphere] {
            let answers = [0, 1, 2].map(|threads| {
                let settings =
                    IntegratorSettings { bounces: 0..=6, direct, threads, ..Default::default() };
                let mut radiance = [[0.0; 3]; COUNT];
                built.radiance(&rays, &settings, &mut radiance).expect("valid");
                radiance
            });
            assert!(answers[0] == answers[1] && answers[1] == answers[2]);
            assert!(answers[0].iter().any(|radiance| radiance[0] > 0.0));
        }
    }

    #[test]
    fn hits_do_not_depend_on_the_structure() {
        let scene = scene();
        let mut core = Textbook::new();
        let mut hits_with = |acceleration| {
            let mut rays = [Ray::new(DVec3::ZERO, DVec3::Z); COUNT];
            for (ray, point) in rays.iter_mut().zip(numbers().0) {
                *ray = Ray::new(DVec3::new(3.0, -4.0, 3.0), point.extend(0.1) - DVec3::ONE / 2.0);
            }
            let mut hits = [Hit::MISS; COUNT];
            let mut built = core.build_scene(&scene, acceleration).expect("it builds");
            built.intersect(&rays, &mut hits).expect("it intersects");
            let mut occluded = [false; COUNT];
            built.occluded(&rays, &mut occluded).expect("it intersects");
            assert_eq!(hits.map(|hit| hit.is_hit()), occluded);
            hits
        };
        let brute = hits_with(Acceleration::BruteForce);
        for split in [Split::Median, Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea] {
            assert_eq!(
                hits_with(Acceleration::Bvh { split, max_leaf_size: 1, counted: false }),
                brute
            );
        }
    }
}
