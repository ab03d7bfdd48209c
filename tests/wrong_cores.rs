//! Wrong renderers, made by wrapping a right one: the bench has to see them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::case::{self, Case};
use furnace::contract::{
    Acceleration, BuildStats, BuiltScene, Core, CoreInfo, Film, Hit, IntegratorSettings,
    LightSample, Randomness, Ray, RenderSettings, Result, TraversalStats,
};
use furnace::cores::CoreSpec;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::run::{Bench, Outcome, Plan, Request, Status, attempt};
use furnace::scene::{Camera, SceneDescription};
use glam::DVec3;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// What is wrong with a core.
#[derive(Clone, Copy)]
enum Wrong {
    /// Every radiance is a hundredth too large.
    OnePercentBright,
    /// One pixel of each picture is NaN.
    NanPixel,
    /// One pixel of each picture is left as it came.
    UntouchedPixel,
    /// The pdf of light samples falls with the distance, not with its square.
    LightPdfByDistance,
    /// Two of five estimates of radiance are 0.
    LosesSamples,
}

/// A core that is right but for one thing.
struct WrongCore {
    core: Box<dyn Core>,
    wrong: Wrong,
}

struct WrongScene<'a> {
    scene: Box<dyn BuiltScene + 'a>,
    wrong: Wrong,
}

impl Core for WrongCore {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        let scene = self.core.build_scene(scene, acceleration)?;
        Ok(Box::new(WrongScene { scene, wrong: self.wrong }))
    }
}

impl BuiltScene for WrongScene<'_> {
    fn stats(&self) -> BuildStats {
        self.scene.stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        self.scene.intersect(rays, hits)
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        self.scene.sample_light(light, from, random, samples)?;
        if let Wrong::LightPdfByDistance = self.wrong {
            samples.iter_mut().for_each(|sample| sample.pdf /= sample.distance);
        }
        Ok(())
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        self.scene.radiance(rays, settings, radiance)?;
        match self.wrong {
            Wrong::OnePercentBright => {
                radiance.iter_mut().flatten().for_each(|value| *value *= 1.01);
            }
            Wrong::LosesSamples => {
                let lost = radiance.iter_mut().enumerate().filter(|(number, _)| number % 5 < 2);
                lost.for_each(|(_, radiance)| *radiance = [0.0; 3]);
            }
            _ => {}
        }
        Ok(())
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let before = film.pixels.clone();
        self.scene.render(camera, settings, film)?;
        let middle = film.pixels.len() / 2;
        match self.wrong {
            Wrong::OnePercentBright => {
                film.pixels.iter_mut().flatten().for_each(|value| *value *= 1.01);
            }
            Wrong::NanPixel => film.pixels[middle] = [f32::NAN; 3],
            Wrong::UntouchedPixel => film.pixels[middle] = before[middle],
            Wrong::LightPdfByDistance | Wrong::LosesSamples => {}
        }
        Ok(())
    }
}

fn cases(filters: &[&str]) -> (Bench, Vec<Arc<Case>>) {
    cases_of(Seed::SUITE, filters)
}

fn cases_of(seed: Seed, filters: &[&str]) -> (Bench, Vec<Arc<Case>>) {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let all = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec![core("builtin")],
        filters: filters.iter().map(ToString::to_string).collect(),
        seed,
        ..Request::default()
    };
    let plan = Plan::new(project, request, &all).unwrap();
    let cases = plan.trials.iter().map(|trial| Arc::clone(&trial.case)).collect();
    (plan.bench(), cases)
}

fn core(name: &str) -> CoreSpec {
    name.parse().unwrap()
}

fn outcomes(wrong: Wrong, name: &str, filters: &[&str]) -> Vec<(String, Outcome)> {
    let (bench, cases) = cases(filters);
    assert!(!cases.is_empty(), "no case is selected by {filters:?}");
    let mut core = WrongCore { core: core(name).make().unwrap(), wrong };
    cases.iter().map(|case| (case.id.clone(), attempt(&bench, case, &mut core).outcome)).collect()
}

/// Cases whose estimates have little noise, so that one in a hundred shows at the default budget.
const LOW_NOISE: &[&str] =
    &["light/point-light-follows", "light/directional-light-follows", "integrator/furnace"];

#[test]
fn one_per_cent_of_energy_is_seen_in_either_core() {
    for name in ["builtin", "textbook"] {
        let outcomes = outcomes(Wrong::OnePercentBright, name, LOW_NOISE);
        let red: Vec<_> =
            outcomes.iter().filter(|(_, o)| o.status() == Status::Fail).map(|(id, _)| id).collect();
        assert!(red.len() >= 3, "{name}: only {red:?} of {} cases fail", outcomes.len());
    }
}

/// Every selected case fails, and says these words.
fn assert_named(wrong: Wrong, name: &str, filters: &[&str], words: &[&str]) {
    for (id, outcome) in outcomes(wrong, name, filters) {
        assert_eq!(outcome.status(), Status::Fail, "{id}");
        let statement = outcome.statement();
        words.iter().for_each(|words| assert!(statement.contains(words), "{id}: {statement}"));
    }
}

#[test]
fn a_nan_pixel_fails_and_is_named() {
    let filters = ["image/point-light-plane"];
    assert_named(Wrong::NanPixel, "builtin", &filters, &["is NaN", "pixel ("]);
}

#[test]
fn an_untouched_pixel_is_told_from_a_nan() {
    let filters = ["image/point-light-plane"];
    assert_named(Wrong::UntouchedPixel, "builtin", &filters, &["left untouched"]);
}

#[test]
fn a_light_pdf_without_the_square_is_seen_in_the_solid_angle() {
    let area_lights = ["sphere", "rectangle", "triangle"]
        .map(|l| format!("light/{l}-light-samples-reach-the-light"));
    let area_lights = area_lights.each_ref().map(String::as_str);
    assert_named(Wrong::LightPdfByDistance, "textbook", &area_lights, &["1/pdf"]);
}

#[test]
fn samples_that_are_lost_are_told_from_light_that_is_weighted() {
    let filters = ["light/sphere-light-matches", "light/rectangle-light-tilted-matches"];
    let words = ["40 % of the samples contribute nothing, and the others what all should"];
    assert_named(Wrong::LosesSamples, "textbook", &filters, &words);
}

/// Mean radiances by the scene and the ray that they were asked for: a sum, and of how many.
type Table = BTreeMap<Key, ([f64; 3], f64)>;

/// A digest of all that is known of the scene, a ray's origin and direction, and the bounces.
type Key = (u64, [[u64; 3]; 2], [u32; 2]);

/// A core that writes down what a right one answers, or answers what is written down, and nothing else.
struct TableCore {
    core: Box<dyn Core>,
    table: Table,
    learns: bool,
}

struct TableScene<'a> {
    scene: Box<dyn BuiltScene + 'a>,
    table: &'a mut Table,
    learns: bool,
    digest: u64,
}

impl Core for TableCore {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(TableScene {
            scene: self.core.build_scene(scene, acceleration)?,
            table: &mut self.table,
            learns: self.learns,
            digest: digest_of(&format!("{scene:?}")),
        }))
    }
}

impl BuiltScene for TableScene<'_> {
    fn stats(&self) -> BuildStats {
        self.scene.stats()
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let (digest, bounces) = (self.digest, &settings.bounces);
        let bits = |vector: DVec3| vector.to_array().map(f64::to_bits);
        let key = |ray: &Ray| {
            (digest, [ray.origin, ray.direction].map(bits), [*bounces.start(), *bounces.end()])
        };
        if self.learns {
            self.scene.radiance(rays, settings, radiance)?;
            for (ray, radiance) in rays.iter().zip(radiance) {
                let (sum, count) = self.table.entry(key(ray)).or_default();
                (0..3).for_each(|c| sum[c] += radiance[c]);
                *count += 1.0;
            }
        } else {
            for (ray, radiance) in rays.iter().zip(radiance) {
                let known = self.table.get(&key(ray));
                *radiance = known.map_or([0.0; 3], |(sum, count)| sum.map(|sum| sum / count));
            }
        }
        Ok(())
    }
}

fn digest_of(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

#[test]
fn a_table_of_answers_is_of_no_use_at_another_seed() {
    let filters =
        ["light/rectangle-light-overhead-matches-closed-form", "light/point-light-follows"];
    let mut core =
        TableCore { core: core("builtin").make().unwrap(), table: Table::new(), learns: true };
    let mut statuses = |seed: Seed, learns: bool| {
        let (bench, cases) = cases_of(seed, &filters);
        core.learns = learns;
        let status = |case: &Arc<Case>| attempt(&bench, case, &mut core).outcome.status();
        cases.iter().map(status).collect::<Vec<_>>()
    };
    let learnt = statuses(Seed(1), true);
    assert!(learnt.iter().all(|status| *status == Status::Pass), "{learnt:?}");
    assert_eq!(statuses(Seed(1), false), learnt, "it has seen these");
    let elsewhere = statuses(Seed(2), false);
    assert!(elsewhere.iter().all(|status| *status == Status::Fail), "{elsewhere:?}");
}
