//! Every answer is checked before a check sees it.
//!
//! [`Validated`] stands between checks and a core: it fills every out slice with a marked NaN, so that "left
//! untouched" is seen; it stops panics; and it refuses answers that are not of the contract's form: numbers that
//! are not finite, directions that are not unit, pdfs below zero, shapes that do not exist. Checks need not
//! defend themselves. Not here: whether an answer is *right*, which is what checks are for.

use super::answer::{Answer, Asked, Unformed};
use super::argument::{Argument, needed_by, size_of_answer};
use super::crossing::Request;
use super::question::*;
use super::work::{self, Work};
use super::{
    Acceleration, BuildStats, Built, BuiltScene, Circumstances, Components, Core, CoreInfo,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A core whose answers have the contract's form, or else are errors.
pub struct Validated<'a> {
    core: &'a mut dyn Core,
    capabilities: Capabilities,
    primitives_of_shape: Vec<usize>,
    unformed: Unformed,
    work: Work,
    /// Of each element that it is asked.
    work_of_one: u64,
}

/// A built scene whose answers have the contract's form, or else are errors.
struct ValidatedScene<'a> {
    scene: Built<'a>,
    capabilities: Capabilities,
    primitives_of_shape: Vec<usize>,
    unformed: Unformed,
    work: Work,
    /// Of each element that it is asked.
    work_of_one: u64,
}

impl<'a> Validated<'a> {
    /// Stands in front of `core`.
    pub fn new(core: &'a mut dyn Core) -> Self {
        Self::before(core, Unformed::Refused)
    }

    /// The same where the breaches of the core are known: what was meant takes the place of what has not the form, where
    /// that is clear.
    pub(crate) fn mending(core: &'a mut dyn Core) -> Self {
        Self::before(core, Unformed::Mended)
    }

    /// In a worker, whose answers are looked at by whoever asked.
    pub(crate) fn in_worker(core: &'a mut dyn Core) -> Self {
        Self::before(core, Unformed::Left)
    }

    /// The same, where what is asked is counted.
    pub(crate) fn counted(self, work: &Work) -> Self {
        Self { work: work.clone(), ..self }
    }

    fn before(core: &'a mut dyn Core, unformed: Unformed) -> Self {
        let capabilities = core.info().capabilities;
        let work = Work::default();
        Self { core, capabilities, primitives_of_shape: vec![1], unformed, work, work_of_one: 1 }
    }
}

/// Asks a question of whoever stands behind, and looks at the answer.
macro_rules! validated {
    (($behind:ident) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            $(knows(self.capabilities, Argument::needs($arg))?;)*
            let asked = Asked {
                size: size_of_answer([$(Argument::size($arg)),*]),
                capabilities: self.capabilities,
                primitives_of_shape: &self.primitives_of_shape,
                unformed: self.unformed,
            };
            // An empty batch has its answer; libraries of arrays may have none that is empty.
            if asked.size.contains(&0) {
                return Ok(Default::default());
            }
            self.work.look_at_the_time(stringify!($method))?;
            let work = self.work_of_one $(* Argument::work($arg))*;
            self.work.add(work * (asked.size[0] * asked.size[1]) as u64);
            $(self.work.see(Argument::circumstances($arg));)*
            $out.untouch(&asked);
            let told =
                guarded(stringify!($method), || self.$behind.$method($($arg,)* &mut *$out))?;
            $out.accept(&asked).map_err(|error| {
                let request =
                    Request::new(stringify!($method))$(.with_argument(stringify!($arg), $arg))*;
                with_its_question(error, &request)
            })?;
            Ok(told)
        }
    };
}

impl Core for Validated<'_> {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        if !self.core.info().components.contains(components) {
            return Err(CoreError::Unsupported(Capabilities::empty()));
        }
        guarded("take_components", || self.core.take_components(components))
    }

    each_question! { Core validated (core) }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        let capabilities = self.capabilities;
        let needed = scene.materials.iter().map(needed_by).collect();
        knows(capabilities, needed)?;
        let of_meshes = scene.meshes.iter().map(|mesh| mesh.indices.len());
        let primitives_of_shape = of_meshes.chain(scene.spheres.iter().map(|_| 1)).collect();
        self.work.look_at_the_time("build_scene")?;
        self.work.add(scene.primitive_count() as u64);
        self.work.see(Circumstances::of_scene(scene));
        let work_of_one = work::of_ray(scene, how);
        let (unformed, work) = (self.unformed, self.work.clone());
        let scene = guarded("build_scene", || self.core.build_scene(scene, how))?;
        Ok(Box::new(ValidatedScene {
            scene,
            capabilities,
            primitives_of_shape,
            unformed,
            work,
            work_of_one,
        }))
    }
}

impl BuiltScene for ValidatedScene<'_> {
    fn stats(&self) -> BuildStats {
        self.scene.stats()
    }

    each_question! { Scene validated (scene) }
}

/// What is younger than the contract is not shown to cores that do not say that they know it.
fn knows(capabilities: Capabilities, needed: Capabilities) -> Result<()> {
    let missing = needed - capabilities;
    if missing.is_empty() { Ok(()) } else { Err(CoreError::Unsupported(missing)) }
}

/// The same error, where it is of one element with what was asked for that.
fn with_its_question(error: CoreError, request: &Request<'_>) -> CoreError {
    match error {
        CoreError::BrokeContract(breach) => breach.with_question(request).into(),
        other => other,
    }
}

/// Runs one request; a panic inside it is the core's crash.
fn guarded<T>(during: &str, request: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(request)).unwrap_or_else(|panic| {
        let message = panic
            .downcast_ref::<&str>()
            .map(ToString::to_string)
            .or_else(|| panic.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "a panic without a message".to_owned());
        let how = format!("panicked: {message}");
        Err(CoreError::Crashed { how, during: during.to_owned(), element: None })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Surface;

    #[test]
    fn an_empty_batch_is_not_asked() {
        let mut core = Answers(|_| panic!("asked of nothing"));
        let sphere = Primitive::Sphere { centre: DVec3::ZERO, radius: 1.0 };
        Validated::new(&mut core).intersect_primitive(&sphere, &[], &mut []).unwrap();
    }

    /// A core that answers by calling a closure on the hits it is to fill.
    struct Answers(fn(&mut [Hit]));

    impl Core for Answers {
        fn info(&self) -> CoreInfo {
            CoreInfo { capabilities: Capabilities::INTERSECT_PRIMITIVE, ..Default::default() }
        }

        fn intersect_primitive(
            &mut self,
            _: &Primitive,
            _: &[Ray],
            hits: &mut [Hit],
        ) -> Result<()> {
            (self.0)(hits);
            Ok(())
        }
    }

    fn complaint_about(answer: fn(&mut [Hit])) -> String {
        let sphere = Primitive::Sphere { centre: DVec3::ZERO, radius: 1.0 };
        let rays = [Ray::new(DVec3::Z * 3.0, -DVec3::Z); 2];
        let mut core = Answers(answer);
        Validated::new(&mut core)
            .intersect_primitive(&sphere, &rays, &mut [Hit::MISS; 2])
            .unwrap_err()
            .to_string()
    }

    const GOOD: Hit = Hit {
        t: 2.0,
        shape: 0,
        primitive: 0,
        geometric_normal: DVec3::Z,
        shading_normal: DVec3::Z,
        uv: DVec2::ZERO,
    };

    #[test]
    fn an_untouched_answer_is_told_from_a_computed_one() {
        let untouched = complaint_about(|hits| hits[0] = GOOD);
        assert!(untouched.contains("hit 1 of 2: primitive was left untouched"), "{untouched}");
    }

    #[test]
    fn a_nan_distance_is_told_with_what_was_asked_and_what_is_right() {
        let nan = complaint_about(|hits| hits.fill(Hit { t: f64::NAN, ..GOOD }));
        assert!(nan.contains("broke the contract: hit 0 of 2: t is NaN"), "{nan}");
        assert_eq!(
            nan,
            "the core broke the contract: hit 0 of 2: t is NaN; a finite number is right, or a miss \
             (`primitive` is NONE) where the ray meets nothing; asked was \
             intersect-sphere with origin [0, 0, 3], direction [-0, -0, -1], t from 0 to inf"
        );
    }

    #[test]
    fn a_normal_that_is_not_unit_is_refused() {
        let long = complaint_about(|hits| {
            hits.fill(Hit { shading_normal: DVec3::Z * 2.0, ..GOOD });
        });
        assert!(long.contains("shading_normal has length 2, not 1"), "{long}");
    }

    #[test]
    fn a_core_that_does_not_know_rough_glass_is_not_shown_any() {
        let (reflectance, transmittance) = ([1.0; 3], [1.0; 3]);
        let surface =
            Surface::RoughGlass { index: 1.5, roughness: 0.3, reflectance, transmittance };
        let material = Material { name: "frosted".into(), surface, emission: None };
        let mut core = Answers(|_| panic!("shown"));
        let mut core = Validated::new(&mut core);
        let refusal = CoreError::Unsupported(Capabilities::ROUGH_GLASS);
        assert_eq!(core.eval_bsdf(&material, &[], &mut []), Err(refusal.clone()));
        let scene = SceneDescription { materials: vec![material], ..Default::default() };
        let built = core.build_scene(&scene, Acceleration::BruteForce).map(|_| ());
        assert_eq!(built, Err(refusal));
    }

    #[test]
    fn a_core_takes_nothing_from_the_bench_unless_it_says_so() {
        let mut core = Answers(|_| ());
        assert_eq!(core.info().components, Components::empty());
        let refusal = Validated::new(&mut core).take_components(Components::BOX_TEST);
        assert_eq!(refusal, Err(CoreError::Unsupported(Capabilities::empty())));
    }

    #[test]
    fn a_panic_is_a_crash_of_the_core() {
        let crash = complaint_about(|_| panic!("index out of bounds"));
        assert!(crash.contains("crashed (panicked: index out of bounds)"), "{crash}");
        assert!(crash.contains("during intersect_primitive"), "{crash}");
    }

    /// A core that makes pictures of one pixel with these variances.
    struct Reports(Vec<[f32; 3]>);

    impl Core for Reports {
        fn info(&self) -> CoreInfo {
            CoreInfo { capabilities: Capabilities::REPORTED_VARIANCE, ..Default::default() }
        }

        fn build_scene(&mut self, _: &SceneDescription, _: Acceleration) -> Result<Built<'_>> {
            Ok(Box::new(Reports(self.0.clone())))
        }
    }

    impl BuiltScene for Reports {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn render(&mut self, _: &Camera, _: &RenderSettings, film: &mut Film) -> Result<()> {
            (film.pixels, film.sample_counts) = (vec![[1.0; 3]], vec![4]);
            if !self.0.is_empty() {
                film.variances = self.0.clone();
            }
            Ok(())
        }
    }

    fn picture_with(variances: &[[f32; 3]]) -> Result<Film> {
        let settings =
            RenderSettings { width: 1, height: 1, samples_per_pixel: 4, ..Default::default() };
        let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0, [1, 1]);
        let (mut core, mut film) = (Reports(variances.to_vec()), Film::default());
        Validated::new(&mut core)
            .build_scene(&SceneDescription::default(), Acceleration::DEFAULT)?
            .render(&camera, &settings, &mut film)?;
        Ok(film)
    }

    #[test]
    fn variances_are_there_finite_and_not_negative() {
        assert_eq!(picture_with(&[[0.5, 0.0, 1.0]]).unwrap().variances, [[0.5, 0.0, 1.0]]);
        let complaint = |variances: &[[f32; 3]]| picture_with(variances).unwrap_err().to_string();
        let untouched = complaint(&[]);
        assert!(
            untouched.contains("variance of pixel (0, 0) from the top left: it was left untouched")
        );
        assert!(complaint(&[[-1.0, 0.0, 0.0]]).contains("it = -1 is negative (red)"));
        assert!(complaint(&[[0.0, f32::NAN, 0.0]]).contains("it is NaN (green)"));
        assert!(complaint(&[[0.0; 3]; 2]).contains("2 variances of 1 pixels"));
    }

    #[test]
    fn a_shape_that_does_not_exist_is_refused() {
        let ghost = complaint_about(|hits| hits.fill(Hit { shape: 7, ..GOOD }));
        assert!(ghost.contains("shape 7 has no primitive 0"), "{ghost}");
    }
}
