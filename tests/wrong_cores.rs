//! Wrong renderers, made by wrapping a right one: the bench has to see them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::case::{self, Case};
use furnace::contract::{
    Acceleration, BuildStats, BuiltScene, Core, CoreInfo, Film, Hit, IntegratorSettings,
    LightSample, Randomness, Ray, RenderSettings, Result, TraversalStats,
};
use furnace::cores::CoreSpec;
use furnace::project::Project;
use furnace::run::{Bench, Outcome, Plan, Request, Status, attempt};
use furnace::scene::{Camera, SceneDescription};
use glam::DVec3;
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
        if let Wrong::OnePercentBright = self.wrong {
            radiance.iter_mut().flatten().for_each(|value| *value *= 1.01);
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
            Wrong::LightPdfByDistance => {}
        }
        Ok(())
    }
}

fn cases(filters: &[&str]) -> (Bench, Vec<Arc<Case>>) {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let all = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec![core("builtin")],
        filters: filters.iter().map(ToString::to_string).collect(),
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
