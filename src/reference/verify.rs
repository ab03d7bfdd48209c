//! Whether Mitsuba still says what a reference says.

use super::make::remove;
use super::{Listener, MakeError, References, environment, recipe};
use crate::scene::reference::load;
use crate::stats::{self, ImageDraw, ImageEffort, ImageReport, Stage, judge_image};

/// How to verify a reference.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VerifyOptions {
    /// Install Mitsuba into `references/.venv` if it is not there.
    pub create_environment: bool,
    /// Mitsuba's back end, instead of the fastest that works.
    pub variant: Option<String>,
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// The same judgement a core's picture gets.
    pub report: ImageReport,
    /// Samples a pixel in each of its runs.
    pub samples_per_run: u32,
}

/// The relative error of the whole picture that must be seen.
const DETECTS: f64 = 0.01;

/// Far from the seeds that references are made of, and below 2²⁰, from where on Mitsuba's scalar
/// back end repeats itself on films of 128 × 96 pixels.
const FIRST_SEED: u32 = 500_000;

impl References {
    /// Renders passes with seeds the reference has not seen, and judges them as a core's picture is
    /// judged: screened, and confirmed if suspected.
    pub fn verify(
        &self,
        name: &str,
        options: &VerifyOptions,
        progress: Listener<'_>,
    ) -> Result<Verification, MakeError> {
        let mut recipe = recipe::read(&self.folder, name)?;
        let scene = self.scenes.load(&recipe.scene, &recipe.parameters)?;
        let stored = load(&self.folder, name, &scene)?;
        recipe.bounces = stored.provenance.bounces[1];
        let plan = self.plan(name, recipe, "verify")?;
        let python = environment::python(&self.folder, options.create_environment, progress)?;
        let asked = options.variant.as_deref();
        let mitsuba = environment::mitsuba(python, asked, &plan.job, progress)?;
        let effort = ImageEffort::new(DETECTS, plan.job.samples);
        let mut draw = |request: ImageDraw| {
            let seeds = seeds_of(request.stage, &effort);
            let seed = seeds[request.run as usize];
            if plan.job.pass(seed).is_none() {
                mitsuba.render(&plan.job, &seeds, progress)?;
            }
            plan.pass(seed)
        };
        let reference =
            stats::Reference { mean: &stored.mean, standard_error: &stored.standard_error };
        let report = judge_image(reference, &effort, &mut draw)?;
        remove(&plan.job.folder)?;
        Ok(Verification { report, samples_per_run: plan.job.samples })
    }
}

/// The seeds of all runs of a stage: rendered together, for starting Mitsuba takes longer than a
/// pass.
fn seeds_of(stage: Stage, effort: &ImageEffort) -> Vec<u32> {
    let (block, runs) = match stage {
        Stage::Second => (1, effort.confirm_runs),
        Stage::Third => (2, effort.confirm_runs),
        _ => (0, effort.screen_runs),
    };
    let first = FIRST_SEED + 1_000 * block;
    (first..first + runs).collect()
}
