//! Every answer is checked before a check sees it.
//!
//! [`Validated`] stands between checks and a core: it fills every out slice with a marked NaN, so that "left
//! untouched" is seen; it stops panics; and it refuses answers that are not of the contract's form: numbers that
//! are not finite, directions that are not unit, densities below zero, shapes that do not exist. Checks need not
//! defend themselves. Not here: whether an answer is *right*, which is what checks are for.

use super::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue,
    BuildStats, BuiltScene, Capabilities, CodedFilm, Core, CoreError, CoreInfo, DirectionSample,
    Film, Hit, IntegratorSettings, LightSample, Primitive, Randomness, Ray, RenderSettings, Result,
    Sampler, TraversalStats,
};
use crate::image::CHANNELS;
use crate::scene::{Aabb, Camera, Material, SceneDescription, Surface};
use glam::{DVec2, DVec3};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How far from 1 the length of a unit vector may be: f32 cores normalise to about 1e-7.
const UNIT_LENGTH_ERROR: f64 = 1e-5;

/// A NaN that no computation makes: it marks what the core has not written.
const UNTOUCHED: f64 = f64::from_bits(0x7ff8_f00d_f00d_f00d);
const UNTOUCHED_SINGLE: f32 = f32::from_bits(0x7fd0_f00d);
const UNTOUCHED_COUNT: u32 = u32::MAX - 1;
const UNTOUCHED_VECTOR: DVec3 = DVec3::splat(UNTOUCHED);

/// A core whose answers have the contract's form, or else are errors.
pub struct Validated<'a> {
    core: &'a mut dyn Core,
}

impl<'a> Validated<'a> {
    /// Stands in front of `core`.
    pub fn new(core: &'a mut dyn Core) -> Self {
        Self { core }
    }

    /// Materials that are younger than the contract are not shown to cores that do not say that they know them.
    ///
    /// # Errors
    /// If there is one that the core does not know.
    fn knows<'m>(&self, materials: impl IntoIterator<Item = &'m Material>) -> Result<()> {
        let is_rough_glass = |m: &Material| matches!(m.surface, Surface::RoughGlass { .. });
        let needed = Capabilities::ROUGH_GLASS;
        let is_young = materials.into_iter().any(is_rough_glass);
        match is_young && !self.core.info().capabilities.contains(needed) {
            true => Err(CoreError::Unsupported(needed)),
            false => Ok(()),
        }
    }
}

/// A built scene whose answers have the contract's form, or else are errors.
struct ValidatedScene<'a> {
    scene: Box<dyn BuiltScene + 'a>,
    /// Whether pictures come with the variance of their pixels.
    reports_variance: bool,
    /// Primitives of each shape, to tell hits that cannot be.
    primitives_of_shape: Vec<usize>,
}

impl Core for Validated<'_> {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        rays.fill(Ray {
            origin: UNTOUCHED_VECTOR,
            t_min: UNTOUCHED,
            direction: UNTOUCHED_VECTOR,
            t_max: UNTOUCHED,
        });
        guarded("generate_rays", || self.core.generate_rays(camera, film, rays))?;
        each(rays, "ray", |ray| {
            finite_vector("origin", ray.origin)?;
            unit("direction", ray.direction)?;
            not_nan("t_min", ray.t_min)?;
            not_nan("t_max", ray.t_max)
        })
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        hits.fill(UNTOUCHED_HIT);
        guarded("intersect_primitive", || self.core.intersect_primitive(primitive, rays, hits))?;
        each(hits, "hit", |hit| valid_hit(hit, &[1]))
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        hits.fill(BoxHit {
            t_enter: UNTOUCHED,
            t_exit: UNTOUCHED,
            hit: UNTOUCHED_COUNT,
            reserved: 0,
        });
        guarded("intersect_box", || self.core.intersect_box(bounds, rays, hits))?;
        each(hits, "box hit", |hit| flag("hit", hit.hit))
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        samples.fill(DirectionSample { direction: UNTOUCHED_VECTOR, pdf: UNTOUCHED });
        guarded("sample_direction", || self.core.sample_direction(sampler, random, samples))?;
        each(samples, "sample", |sample| {
            unit("direction", sample.direction)?;
            not_negative("pdf", sample.pdf)
        })
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        pdf.fill(UNTOUCHED);
        guarded("direction_pdf", || self.core.direction_pdf(sampler, directions, pdf))?;
        each(pdf, "density", |pdf| not_negative("pdf", *pdf))
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        self.knows([material])?;
        values.fill(BsdfValue { f: [UNTOUCHED; 3], pdf: UNTOUCHED });
        guarded("eval_bsdf", || self.core.eval_bsdf(material, queries, values))?;
        each(values, "value", |value| {
            colour("f", value.f)?;
            not_negative("pdf", value.pdf)
        })
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        self.knows([material])?;
        samples.fill(BsdfSample {
            wi: UNTOUCHED_VECTOR,
            f: [UNTOUCHED; 3],
            pdf: UNTOUCHED,
            is_delta: UNTOUCHED_COUNT,
            is_valid: UNTOUCHED_COUNT,
        });
        guarded("sample_bsdf", || self.core.sample_bsdf(material, wo, random, samples))?;
        each(samples, "sample", |sample| {
            flag("is_valid", sample.is_valid)?;
            if sample.is_valid == 0 {
                return Ok(());
            }
            flag("is_delta", sample.is_delta)?;
            unit("wi", sample.wi)?;
            colour("f", sample.f)?;
            not_negative("pdf", sample.pdf)
        })
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        means.fill(AdaptiveMean { mean: UNTOUCHED, used: UNTOUCHED_COUNT, reserved: 0 });
        guarded("adaptive_mean", || self.core.adaptive_mean(settings, streams, means))?;
        each(means, "mean", |mean| {
            finite("mean", mean.mean)?;
            touched("used", mean.used)
        })
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        self.knows(&scene.materials)?;
        let primitives_of_shape = scene
            .meshes
            .iter()
            .map(|mesh| mesh.indices.len())
            .chain(scene.spheres.iter().map(|_| 1))
            .collect();
        let reports_variance =
            self.core.info().capabilities.contains(Capabilities::REPORTED_VARIANCE);
        let scene = guarded("build_scene", || self.core.build_scene(scene, acceleration))?;
        Ok(Box::new(ValidatedScene { scene, reports_variance, primitives_of_shape }))
    }
}

impl BuiltScene for ValidatedScene<'_> {
    fn stats(&self) -> BuildStats {
        self.scene.stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        hits.fill(UNTOUCHED_HIT);
        let stats = guarded("intersect", || self.scene.intersect(rays, hits))?;
        each(hits, "hit", |hit| valid_hit(hit, &self.primitives_of_shape))?;
        Ok(stats)
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        guarded("occluded", || self.scene.occluded(rays, occluded))
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        samples.fill(LightSample {
            wi: UNTOUCHED_VECTOR,
            distance: UNTOUCHED,
            radiance: [UNTOUCHED; 3],
            pdf: UNTOUCHED,
            is_delta: UNTOUCHED_COUNT,
            is_valid: UNTOUCHED_COUNT,
        });
        guarded("sample_light", || self.scene.sample_light(light, from, random, samples))?;
        each(samples, "sample", |sample| {
            flag("is_valid", sample.is_valid)?;
            if sample.is_valid == 0 {
                return Ok(());
            }
            flag("is_delta", sample.is_delta)?;
            unit("wi", sample.wi)?;
            not_nan("distance", sample.distance)?;
            colour("radiance", sample.radiance)?;
            not_negative("pdf", sample.pdf)
        })
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        radiance.fill([UNTOUCHED; 3]);
        guarded("radiance", || self.scene.radiance(rays, settings, radiance))?;
        each(radiance, "radiance", |radiance| colour("radiance", *radiance))
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let (width, height) = (settings.width, settings.height);
        let count = width as usize * height as usize;
        *film = Film {
            width,
            height,
            pixels: vec![[UNTOUCHED_SINGLE; 3]; count],
            sample_counts: vec![UNTOUCHED_COUNT; count],
            variances: vec![[UNTOUCHED_SINGLE; 3]; if self.reports_variance { count } else { 0 }],
        };
        guarded("render", || self.scene.render(camera, settings, film))?;
        if !self.reports_variance {
            film.variances.clear();
        }
        valid_film(film, width, height)?;
        valid_variances(film, width, if self.reports_variance { count } else { 0 })
    }

    fn render_codes(&mut self, camera: &Camera, settings: &RenderSettings) -> Result<CodedFilm> {
        let film = guarded("render_codes", || self.scene.render_codes(camera, settings))?;
        let (asked, codes) = ([settings.width, settings.height].map(|n| n as usize), &film.codes);
        let is_whole = codes.pixels.len() == codes.width * codes.height;
        if asked == [codes.width, codes.height] && is_whole {
            return Ok(film);
        }
        Err(CoreError::BrokeContract(format!(
            "the picture has {} × {} pixels, not {} × {}",
            codes.width, codes.height, asked[0], asked[1]
        )))
    }
}

const UNTOUCHED_HIT: Hit = Hit {
    t: UNTOUCHED,
    shape: UNTOUCHED_COUNT,
    primitive: UNTOUCHED_COUNT,
    geometric_normal: UNTOUCHED_VECTOR,
    shading_normal: UNTOUCHED_VECTOR,
    uv: DVec2::splat(UNTOUCHED),
};

/// Runs one request; a panic inside it is the core's crash.
fn guarded<T>(during: &str, request: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(request)).unwrap_or_else(|panic| {
        let message = panic
            .downcast_ref::<&str>()
            .map(ToString::to_string)
            .or_else(|| panic.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "a panic without a message".to_owned());
        Err(CoreError::Crashed { how: format!("panicked: {message}"), during: during.to_owned() })
    })
}

/// What is wrong with one element, before its number is known.
type Complaint = std::result::Result<(), String>;

fn each<T>(elements: &[T], what: &str, check: impl Fn(&T) -> Complaint) -> Result<()> {
    for (index, element) in elements.iter().enumerate() {
        check(element).map_err(|complaint| {
            CoreError::BrokeContract(format!("{what} {index} of {}: {complaint}", elements.len()))
        })?;
    }
    Ok(())
}

fn valid_hit(hit: &Hit, primitives_of_shape: &[usize]) -> Complaint {
    if !hit.is_hit() {
        return Ok(());
    }
    touched("primitive", hit.primitive)?;
    let primitives = primitives_of_shape.get(hit.shape as usize).copied().unwrap_or(0);
    if hit.primitive as usize >= primitives {
        return Err(format!("shape {} has no primitive {}", hit.shape, hit.primitive));
    }
    finite("t", hit.t)
        .map_err(|complaint| format!("{complaint}; did the ray miss? set primitive to NONE"))?;
    unit("geometric_normal", hit.geometric_normal)?;
    unit("shading_normal", hit.shading_normal)
}

fn valid_film(film: &Film, width: u32, height: u32) -> Result<()> {
    let count = width as usize * height as usize;
    if film.pixels.len() != count || film.sample_counts.len() != count {
        return Err(CoreError::BrokeContract(format!(
            "the picture has {} pixels and {} sample counts; {width} x {height} is {count}",
            film.pixels.len(),
            film.sample_counts.len(),
        )));
    }
    each_pixel(&film.pixels, width, "pixel", "radiance")?;
    each(&film.sample_counts, "sample count", |count| touched("it", *count))
}

/// Whether the variances of a film are `count` of the contract's form.
fn valid_variances(film: &Film, width: u32, count: usize) -> Result<()> {
    if film.variances.len() != count {
        let found = film.variances.len();
        let what = format!("the picture has {found} variances of {count} pixels");
        return Err(CoreError::BrokeContract(what));
    }
    each_pixel(&film.variances, width, "variance of pixel", "it")
}

/// Whether every value of the pixels of a film is written, finite and not negative.
fn each_pixel(values: &[[f32; 3]], width: u32, what: &str, name: &str) -> Result<()> {
    for (index, value) in values.iter().enumerate() {
        valid_pixel(name, *value).map_err(|complaint| {
            let (x, y) = (index % width as usize, index / width as usize);
            CoreError::BrokeContract(format!("{what} ({x}, {y}) from the top left: {complaint}"))
        })?;
    }
    Ok(())
}

fn valid_pixel(name: &str, value: [f32; 3]) -> Complaint {
    if value.iter().any(|value| value.to_bits() == UNTOUCHED_SINGLE.to_bits()) {
        return Err("left untouched".to_owned());
    }
    colour(name, value.map(f64::from))
}

fn colour(name: &str, value: [f64; 3]) -> Complaint {
    value.iter().zip(CHANNELS).try_for_each(|(value, channel)| {
        not_negative(name, *value).map_err(|complaint| format!("{complaint} ({channel})"))
    })
}

fn not_negative(name: &str, value: f64) -> Complaint {
    finite(name, value)?;
    if value >= 0.0 { Ok(()) } else { Err(format!("{name} = {value} is negative")) }
}

fn finite(name: &str, value: f64) -> Complaint {
    not_nan(name, value)?;
    if value.is_finite() { Ok(()) } else { Err(format!("{name} is infinite")) }
}

fn not_nan(name: &str, value: f64) -> Complaint {
    if value.to_bits() == UNTOUCHED.to_bits() {
        Err(format!("{name} was left untouched"))
    } else if value.is_nan() {
        Err(format!("{name} is NaN"))
    } else {
        Ok(())
    }
}

fn finite_vector(name: &str, value: DVec3) -> Complaint {
    value.to_array().iter().try_for_each(|component| finite(name, *component))
}

fn unit(name: &str, value: DVec3) -> Complaint {
    finite_vector(name, value)?;
    let length = value.length();
    if (length - 1.0).abs() <= UNIT_LENGTH_ERROR {
        Ok(())
    } else {
        Err(format!("{name} has length {length}, not 1"))
    }
}

fn flag(name: &str, value: u32) -> Complaint {
    touched(name, value)?;
    if value <= 1 { Ok(()) } else { Err(format!("{name} is {value}, neither 0 nor 1")) }
}

fn touched(name: &str, value: u32) -> Complaint {
    if value == UNTOUCHED_COUNT { Err(format!("{name} was left untouched")) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{Capabilities, Conventions, Precision};

    /// A core that answers by calling a closure on the hits it is to fill.
    struct Answers(fn(&mut [Hit]));

    impl Core for Answers {
        fn info(&self) -> CoreInfo {
            CoreInfo {
                name: "answers".into(),
                version: "0".into(),
                capabilities: Capabilities::INTERSECT_PRIMITIVE,
                precision: Precision::Double,
                conventions: Conventions::default(),
            }
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
    fn a_nan_distance_is_the_cores_fault_and_says_what_to_do() {
        let nan = complaint_about(|hits| hits.fill(Hit { t: f64::NAN, ..GOOD }));
        assert!(nan.contains("broke the contract: hit 0 of 2: t is NaN"), "{nan}");
        assert!(nan.contains("set primitive to NONE"), "{nan}");
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
    fn a_panic_is_a_crash_of_the_core() {
        let crash = complaint_about(|_| panic!("index out of bounds"));
        assert!(crash.contains("crashed (panicked: index out of bounds)"), "{crash}");
        assert!(crash.contains("during intersect_primitive"), "{crash}");
    }

    /// A core that makes pictures of one pixel with these variances.
    struct Reports(Vec<[f32; 3]>);

    impl Core for Reports {
        fn info(&self) -> CoreInfo {
            let capabilities = Capabilities::REPORTED_VARIANCE;
            CoreInfo { capabilities, ..Answers(|_| {}).info() }
        }

        fn build_scene(
            &mut self,
            _: &SceneDescription,
            _: Acceleration,
        ) -> Result<Box<dyn BuiltScene + '_>> {
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
        let integrator = IntegratorSettings::default();
        let (width, height, samples_per_pixel, adaptive) = (1, 1, 4, None);
        let settings = RenderSettings {
            width,
            height,
            samples_per_pixel,
            integrator,
            adaptive,
            stratified: false,
        };
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
        assert!(untouched.contains("variance of pixel (0, 0) from the top left: left untouched"));
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
