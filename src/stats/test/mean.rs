//! Whether means are what is claimed, in three stages ([`Escalation`](crate::stats::plan::Escalation)).
//!
//! A pilot measures the noise. The first stage tests every claim on both sides, the second and third
//! on the side that the first has chosen.
//!
//! A stage rejects with two keys. `t` divides by the spread of the stage's own runs, and on
//! right-skewed data errs towards "too low"; `u` divides by a spread from elsewhere (theory, or the
//! other stages) and errs towards "too high". Both must turn.
//!
//! The unit of replication is one seeded run of the core, never a sample inside it, so that
//! stratified and quasi-random samplers need no special case.
//!
//! Not here: what the samples are (`checks`).

#[cfg(test)]
mod calibration;
mod noise;
mod report;
mod state;
#[cfg(test)]
mod tests;

pub(crate) use report::{MeanReport, StageScore};

use crate::math::rng::Seed;
use crate::stats::plan::level::STAGE_LEVEL;
use crate::stats::{Claim, Effort, Moments, Stage, Verdict};
use state::{FEWEST_EFFECTIVE, MeanTest};

/// Samples of the pilot, before it is found to be too small.
const PILOT_SAMPLES: u64 = 4096;
/// Samples of the largest pilot.
const LARGEST_PILOT: u64 = 65_536;

/// A request for one run of the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Draw {
    pub(crate) stage: Stage,
    /// How often the stage has been drawn before: pilots grow, and one stage may be repeated.
    pub(crate) attempt: u32,
    /// Number of the run in its stage.
    pub(crate) run: u32,
    /// Samples that its mean is over.
    pub(crate) samples: u64,
}

impl Draw {
    /// The seed of this run below the seed of its check.
    pub(crate) fn seed(&self, check: Seed) -> Seed {
        self.stage.seed(check).child(self.attempt).child(self.run)
    }
}

/// Runs the core once and answers the mean of every claim over that run.
pub(crate) type DrawMeans<'a, E> = dyn FnMut(Draw) -> Result<Vec<f64>, E> + 'a;

/// Judges all claims on the same runs. `draw` runs the core once, with its own seed, and answers
/// for each claim the mean over that run.
///
/// Where gross errors are looked for first ([`Effort::coarse_first`]), one that is found ends the test
/// of all claims; otherwise they are judged as if nobody had looked. The two tests share random
/// numbers, which the sum of their error probabilities allows.
pub(crate) fn judge_means<E>(
    claims: &[Claim],
    effort: &Effort,
    draw: &mut DrawMeans<'_, E>,
) -> Result<Vec<MeanReport>, E> {
    let Some(coarse) = effort.coarse() else {
        return judge_means_at(STAGE_LEVEL, claims, effort, draw);
    };
    let mut reports = judge_means_at(STAGE_LEVEL, claims, &coarse, draw)?;
    if reports.iter().all(|report| report.verdict != Verdict::Fail) {
        let drawn = reports.first().map_or(0, |report| report.samples);
        reports = judge_means_at(STAGE_LEVEL, claims, effort, draw)?;
        reports.iter_mut().for_each(|report| report.samples += drawn);
    }
    Ok(reports.into_iter().map(|report| report.of_two_tests(effort.detects)).collect())
}

/// The same with another level of each stage, so that calibration can be simulated.
pub(super) fn judge_means_at<E>(
    level: f64,
    claims: &[Claim],
    effort: &Effort,
    draw: &mut DrawMeans<'_, E>,
) -> Result<Vec<MeanReport>, E> {
    let tests = claims.iter().map(|claim| MeanTest::new(*claim, level)).collect();
    let mut judging = Judging { effort: *effort, tests, draw, drawn: 0, repeated: false };
    judging.run()?;
    Ok(judging.tests.iter().map(|test| test.report(effort, judging.drawn)).collect())
}

/// The state of [`judge_means`]: all tests on the same runs.
struct Judging<'a, E> {
    effort: Effort,
    tests: Vec<MeanTest>,
    draw: &'a mut DrawMeans<'a, E>,
    drawn: u64,
    repeated: bool,
}

impl<E> Judging<'_, E> {
    fn run(&mut self) -> Result<(), E> {
        if self.tests.is_empty() {
            return Ok(());
        }
        self.pilot()?;
        let first = self.planned_samples();
        self.stage(Stage::First, first)?;
        self.stage(Stage::Second, self.confirming_samples(Stage::Second))?;
        self.stage(Stage::Third, self.confirming_samples(Stage::Third))
    }

    /// Grows the pilot until every claim has seen enough events to know its own deviation.
    fn pilot(&mut self) -> Result<(), E> {
        let largest = self.whole_runs((self.effort.most_samples / 4).min(LARGEST_PILOT));
        let mut samples = self.whole_runs(PILOT_SAMPLES).min(largest);
        for attempt in 0.. {
            let moments = self.sample(Stage::Pilot, attempt, samples)?;
            let informed = self.tests.iter().zip(&moments).all(|(t, m)| t.learns_from(m, samples));
            if informed || samples >= largest {
                for (test, moments) in self.tests.iter_mut().zip(&moments) {
                    test.take_pilot(moments, samples);
                }
                break;
            }
            samples = self.whole_runs(4 * samples).min(largest);
        }
        Ok(())
    }

    /// Samples of the first stage: what the hungriest claim needs, up to the cap.
    fn planned_samples(&self) -> u64 {
        let open = self.tests.iter().filter(|test| test.takes_part_in(Stage::First));
        let needed = open.map(|test| test.needed_samples(self.effort.detects));
        let most = self.effort.most_samples as f64;
        self.whole_runs(needed.fold(FEWEST_EFFECTIVE, f64::max).min(most).ceil() as u64)
    }

    /// Samples of the second or third stage. They may follow from what earlier stages saw, for each
    /// stage is judged on fresh samples: what is grossly wrong needs few of them.
    fn confirming_samples(&self, stage: Stage) -> u64 {
        let in_a_hurry = self.effort.in_a_hurry;
        let needed =
            self.tests.iter().filter_map(|test| test.confirming_samples(stage, in_a_hurry));
        let cap = self.effort.most_samples.saturating_mul(stage.factor());
        self.whole_runs(needed.fold(0.0, f64::max).min(cap as f64).ceil() as u64)
    }

    /// Draws and scores a stage, unless nobody is suspected any more.
    fn stage(&mut self, stage: Stage, samples: u64) -> Result<(), E> {
        if !self.tests.iter().any(|test| test.takes_part_in(stage)) {
            return Ok(());
        }
        let moments = self.sample(stage, 0, samples)?;
        let Some(larger) = self.repeat_with(stage, &moments, samples) else {
            self.score(stage, &moments, samples);
            return Ok(());
        };
        self.repeated = true;
        self.take_noise(&moments, samples);
        let moments = self.sample(stage, 1, larger)?;
        self.score(stage, &moments, larger);
        Ok(())
    }

    /// The size at which a stage is drawn again because its variance is not what the stages before
    /// it said. Once a test; the level in [`MEAN_FALSE_ALARM`](crate::stats::plan::level::MEAN_FALSE_ALARM) has been paid for it.
    fn repeat_with(&self, stage: Stage, moments: &[Moments], samples: u64) -> Option<u64> {
        let room = if stage == Stage::First { 1 } else { 4 * stage.factor() };
        let most = self.effort.most_samples.saturating_mul(room);
        let wanted = self.tests.iter().zip(moments).filter(|(t, _)| t.takes_part_in(stage));
        let wanted = wanted.filter_map(|(t, m)| t.wants_repeat(stage, m, samples, &self.effort));
        let larger = self.whole_runs(wanted.max()?.min(most));
        (!self.repeated && larger > samples).then_some(larger)
    }

    fn score(&mut self, stage: Stage, moments: &[Moments], samples: u64) {
        for (test, moments) in self.tests.iter_mut().zip(moments) {
            if test.takes_part_in(stage) {
                test.score(stage, moments, samples);
            }
        }
        self.take_noise(moments, samples);
    }

    fn take_noise(&mut self, moments: &[Moments], samples: u64) {
        for (test, moments) in self.tests.iter_mut().zip(moments) {
            test.take_noise(moments, samples);
        }
    }

    /// One attempt at a stage: the moments of each claim's mean over the runs.
    fn sample(&mut self, stage: Stage, attempt: u32, samples: u64) -> Result<Vec<Moments>, E> {
        let mut runs = vec![Vec::new(); self.tests.len()];
        let per_run = samples / u64::from(self.effort.runs);
        for run in 0..self.effort.runs {
            let means = (self.draw)(Draw { stage, attempt, run, samples: per_run })?;
            assert_eq!(means.len(), self.tests.len(), "a run answers one mean for each claim");
            runs.iter_mut().zip(means).for_each(|(of_claim, mean)| of_claim.push(mean));
        }
        self.drawn += samples;
        if stage != Stage::Pilot {
            self.tests.iter_mut().zip(&runs).for_each(|(test, runs)| test.take_runs(runs, per_run));
        }
        Ok(runs.into_iter().map(|means| means.into_iter().collect()).collect())
    }

    /// `samples`, rounded up to whole grains in each run.
    fn whole_runs(&self, samples: u64) -> u64 {
        let runs = u64::from(self.effort.runs);
        let per_run = samples.div_ceil(runs).max(1);
        per_run.next_multiple_of(self.effort.grain) * runs
    }
}
