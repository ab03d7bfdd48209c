//! Whether Mitsuba still says what a reference says.

use super::make::remove;
use super::{Listener, MakeError, MitsubaOptions, References, environment};
use crate::stats::{self, ImageDraw, ImageEffort, ImageReport, Stage, judge_image};

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Verification {
    /// The same judgement a core's picture gets.
    pub(crate) report: ImageReport,
    /// Samples a pixel in each of its runs.
    pub(crate) samples_per_run: u32,
}

/// The relative error of the whole picture that must be seen.
const DETECTS: f64 = 0.01;

/// Far from the seeds that references are made of, and below 2²⁰, from where on Mitsuba's scalar
/// back end repeats itself on films of 128 × 96 pixels.
const FIRST_SEED: u32 = 500_000;

impl References {
    /// Renders passes with seeds the reference has not seen, and judges them as a core's picture is
    /// judged: screened, and confirmed if suspected.
    pub(crate) fn verify(
        &self,
        name: &str,
        options: &MitsubaOptions,
        progress: Listener<'_>,
    ) -> Result<Verification, MakeError> {
        let (stored, plan) = self.stored(name, "verify")?;
        let mitsuba = environment::mitsuba(&self.folder, options, &plan.job, progress)?;
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

/// The seeds of all runs of a stage: rendered together, for starting Mitsuba takes longer than a pass.
fn seeds_of(stage: Stage, effort: &ImageEffort) -> Vec<u32> {
    let (block, runs) = match stage {
        Stage::Second => (1, effort.confirm_runs()),
        Stage::Third => (2, effort.confirm_runs()),
        _ => (0, effort.screen_runs),
    };
    let first = FIRST_SEED + 1_000 * block;
    (first..first + runs).collect()
}
