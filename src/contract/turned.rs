//! A core that is shown every scene elsewhere: turned and relabelled by the seed of the run.
//!
//! [`Turned`] stands between validation and a core. What goes in, scenes and the rays, points and cameras of their
//! questions, is moved; what comes out is moved back. No check knows of it, and what a core remembers of a scene of
//! another run is of no use to it. What is asked without a scene crosses as it is. People are told of the scene as its
//! file has it: errors, too, are moved back.

use super::breach::BreachKind;
use super::crossing::{Element, Sent};
use super::question::*;
use super::{Acceleration, BuildStats, Built, BuiltScene, Components, Core, CoreInfo};
use crate::scene::motion::{Labels, Motion};

/// A core behind a motion.
pub(crate) struct Turned<'a> {
    core: &'a mut dyn Core,
    motion: Motion,
}

/// A scene that a core has taken in elsewhere.
struct TurnedScene<'a> {
    scene: Built<'a>,
    motion: Motion,
    labels: Labels,
}

impl<'a> Turned<'a> {
    pub(crate) fn new(core: &'a mut dyn Core, motion: Motion) -> Self {
        Self { core, motion }
    }
}

/// What needs no scene.
macro_rules! passed {
    (() {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            self.core.$method($($arg,)* $out)
        }
    };
}

impl Core for Turned<'_> {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        self.core.take_components(components)
    }

    each_question! { Core passed () }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        let (moved, labels) = self.motion.scene(scene);
        let scene = self.core.build_scene(&moved, how)?;
        Ok(Box::new(TurnedScene { scene, motion: self.motion, labels }))
    }
}

impl BuiltScene for TurnedScene<'_> {
    fn stats(&self) -> BuildStats {
        self.scene.stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let told = self.scene.intersect(&self.rays(rays), hits);
        let told = told.map_err(|error| self.error_back(error, "rays", rays))?;
        hits.iter_mut().for_each(|hit| *hit = self.hit_back(hit));
        Ok(told)
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let told = self.scene.occluded(&self.rays(rays), occluded);
        told.map_err(|error| self.error_back(error, "rays", rays))
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let there: Vec<_> = from.iter().map(|point| self.motion.there(*point)).collect();
        let told = self.scene.sample_light(self.labels.light(light), &there, random, samples);
        told.map_err(|error| self.error_back(error, "from", from))?;
        for sample in samples {
            sample.wi = self.motion.back(sample.wi);
        }
        Ok(())
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let told = self.scene.radiance(&self.rays(rays), settings, radiance);
        told.map_err(|error| self.error_back(error, "rays", rays))
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        self.scene.render(&self.motion.camera(camera), settings, film)
    }

    fn render_codes(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        codes: &mut Picture,
    ) -> Result<Encoding> {
        self.scene.render_codes(&self.motion.camera(camera), settings, codes)
    }
}

impl TurnedScene<'_> {
    fn rays(&self, rays: &[Ray]) -> Vec<Ray> {
        let there = |ray: &Ray| Ray {
            origin: self.motion.there(ray.origin),
            direction: self.motion.there(ray.direction),
            ..*ray
        };
        rays.iter().map(there).collect()
    }

    fn hit_back(&self, hit: &Hit) -> Hit {
        let (shape, primitive) = self.labels.primitive_back(hit.shape, hit.primitive);
        Hit {
            shape,
            primitive,
            geometric_normal: self.motion.back(hit.geometric_normal),
            shading_normal: self.motion.back(hit.shading_normal),
            ..*hit
        }
    }

    /// Names what was asked, and what was answered, as the scene's file does.
    fn error_back<T: Element>(
        &self,
        mut error: CoreError,
        name: &'static str,
        asked: &[T],
    ) -> CoreError {
        match &mut error {
            CoreError::Crashed { element: Some(culprit), .. } => {
                culprit.numbers = Sent::new(name, asked).describe(culprit.index);
            }
            CoreError::BrokeContract(breach) => {
                if let BreachKind::NoSuchPrimitive { shape, primitive } = &mut breach.kind {
                    (*shape, *primitive) = self.labels.primitive_back(*shape, *primitive);
                }
            }
            _ => {}
        }
        error
    }
}

#[cfg(test)]
mod tests {
    use super::super::breach::Breach;
    use super::super::validate::Validated;
    use super::*;
    use crate::math::rng::Seed;
    use crate::scene::{Light, Mesh, Sphere};

    /// A core that hits the first shape's first primitive where its rays begin, and samples lights straight on.
    #[derive(Default)]
    struct Echo {
        seen: SceneDescription,
    }

    impl Core for Echo {
        fn info(&self) -> CoreInfo {
            CoreInfo { capabilities: Capabilities::all(), ..CoreInfo::default() }
        }

        fn build_scene(&mut self, scene: &SceneDescription, _: Acceleration) -> Result<Built<'_>> {
            self.seen = scene.clone();
            Ok(Box::new(Self { seen: scene.clone() }))
        }
    }

    impl BuiltScene for Echo {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        /// The nearest sphere, met head on.
        fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
            for (ray, hit) in rays.iter().zip(hits) {
                let met = (0..).zip(&self.seen.spheres).filter_map(|(number, sphere)| {
                    let along = (sphere.centre - ray.origin).dot(ray.direction);
                    let t = along - sphere.radius;
                    let is_met = ray.at(along).abs_diff_eq(sphere.centre, 1e-12);
                    let normal = -ray.direction;
                    let shape = self.seen.meshes.len() as u32 + number;
                    let hit = Hit { t, shape, primitive: 0, ..Hit::MISS };
                    let hit = Hit { geometric_normal: normal, shading_normal: normal, ..hit };
                    (is_met && ray.t_min < t && t < ray.t_max).then_some(hit)
                });
                *hit = met.min_by(|a, b| a.t.total_cmp(&b.t)).unwrap_or(Hit::MISS);
            }
            Ok(TraversalStats::default())
        }

        fn sample_light(
            &mut self,
            light: u32,
            from: &[DVec3],
            _: Randomness<'_>,
            samples: &mut [LightSample],
        ) -> Result<()> {
            let Light::Point { position, intensity } = self.seen.lights[light as usize] else {
                panic!("another light");
            };
            for (from, sample) in from.iter().zip(samples) {
                let distance = position.distance(*from);
                let radiance = intensity.map(|i| i / (distance * distance));
                let wi = (position - *from) / distance;
                *sample =
                    LightSample { wi, distance, radiance, pdf: 1.0, is_delta: 1, is_valid: 1 };
            }
            Ok(())
        }
    }

    fn scene() -> SceneDescription {
        let sphere = |x: f64| Sphere {
            name: String::new(),
            centre: DVec3::X * x,
            radius: 0.5,
            inward: false,
            material: 0,
        };
        let light = |x: f64| Light::Point { position: DVec3::X * x, intensity: [x; 3] };
        SceneDescription {
            meshes: vec![Mesh::default()],
            spheres: vec![sphere(3.0), sphere(-7.0), sphere(11.0)],
            lights: vec![light(2.0), light(4.0), light(8.0)],
            ..SceneDescription::default()
        }
    }

    /// What a check sees of a core under many motions is what it sees of the core itself.
    #[test]
    fn a_check_sees_nothing_of_a_motion() {
        let rays = [DVec3::X, DVec3::NEG_X, DVec3::Y].map(|d| Ray::new(DVec3::ZERO, d));
        let near = Ray { t_max: 2.0, ..rays[0] };
        let rays = [rays[0], rays[1], rays[2], near];
        for seed in 0..50 {
            let mut core = Echo::default();
            let mut turned = Turned::new(&mut core, Motion::drawn(Seed(seed)));
            let mut turned = Validated::new(&mut turned);
            let mut built = turned.build_scene(&scene(), Acceleration::DEFAULT).unwrap();
            let mut hits = [Hit::MISS; 4];
            built.intersect(&rays, &mut hits).unwrap();
            assert_eq!(hits.map(|hit| hit.t), [2.5, 6.5, f64::INFINITY, f64::INFINITY]);
            assert_eq!([hits[0].shape, hits[1].shape], [1, 2]);
            assert_eq!(hits[1].geometric_normal, DVec3::X);
        }
    }

    #[test]
    fn a_light_is_found_again_where_its_file_has_it() {
        for seed in 0..50 {
            let mut core = Echo::default();
            let mut turned = Turned::new(&mut core, Motion::drawn(Seed(seed)));
            let mut built = turned.build_scene(&scene(), Acceleration::DEFAULT).unwrap();
            let mut samples = [LightSample::NONE];
            let random = Randomness { points: &[DVec2::ZERO], lobes: &[0.0], seed: 0 };
            built.sample_light(1, &[DVec3::ZERO], random, &mut samples).unwrap();
            let [sample] = samples;
            assert_eq!((sample.wi, sample.distance), (DVec3::X, 4.0));
            assert_eq!(sample.radiance, [0.25; 3]);
        }
    }

    /// A core at its end, which says so in the numbers that it was handed.
    struct Ending(CoreError);

    impl BuiltScene for Ending {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn occluded(&mut self, _: &[Ray], _: &mut [bool]) -> Result<TraversalStats> {
            Err(self.0.clone())
        }
    }

    #[test]
    fn errors_name_rays_and_primitives_as_the_scene_s_file_does() {
        let motion = Motion::drawn(Seed(5));
        let (_, labels) = motion.scene(&scene());
        let (shape, _) = labels.primitive_back(2, 0);
        let rays =
            [DVec3::X, DVec3::Y].map(|direction| Ray::new(DVec3::new(1.0, 2.0, 3.0), direction));
        let told = |error: CoreError| {
            let (scene, labels) = (Box::new(Ending(error)), labels.clone());
            let mut ending = TurnedScene { scene, motion, labels };
            ending.occluded(&rays, &mut [false; 2]).unwrap_err().to_string()
        };
        let numbers = "origin [-2, 1, 3]".to_owned();
        let element = Some(Box::new(Culprit { index: 1, numbers }));
        let [how, during] = ["SIGSEGV", "occluded, element 1 of 2"].map(str::to_owned);
        let crash = told(CoreError::Crashed { how, during, element });
        assert!(crash.contains("element 1 of 2: origin [1, 2, 3], direction [0, 1, 0]"), "{crash}");
        let none = BreachKind::NoSuchPrimitive { shape: 2, primitive: 7 };
        let breach = told(Breach::of("primitive", none).into());
        assert!(breach.ends_with(&format!("shape {shape} has no primitive 7")), "{breach}");
    }
}
