//! The three-stage ladder: the way a mean fails, unless a run is in a hurry.
//!
//! A first stage tests every claim on both sides at 2·[`STAGE_LEVEL`]. Claims it suspects are
//! tested again on fresh runs with 4 times and then 16 times the samples, on the side the first
//! stage chose. Only a claim that is rejected three times fails. A single test at the same overall
//! level would rest on tails of 10⁻⁹, where the central limit theorem is wrong by factors of
//! thousands for the skewed sums that renderers make; a product of three moderate tails stays
//! right, and a correct core pays for the first stage only.
//!
//! A stage rejects with two keys. `t` divides by the spread of the stage's own runs, and on
//! right-skewed data errs towards "too low"; `u` divides by a spread from elsewhere (theory, or the
//! other stages) and errs towards "too high". Both must turn.
//!
//! The unit of replication is one seeded run of the core, never a sample inside it, so that
//! stratified and quasi-random samplers need no special case.
//!
//! A run that stops at its first failure does not want to know by how much: there, runs are first
//! fed to bets ([`betting`](super::betting)), which end the matter if the error is gross.
//!
//! Not here: what the samples are, and how many hypotheses the suite has (`ledger`).

use super::trail::Trail;
use super::{Claim, Effort, MeanReport, Moments};
use crate::math::rng::Seed;
use serde::{Deserialize, Serialize};

/// Level of one stage on one side.
pub const STAGE_LEVEL: f64 = 5e-4;

/// Probability that a correct core fails one claim: two sides, three stages, and twice that because
/// the ladder may repeat one stage whose variance came out wrong.
pub const MEAN_FALSE_ALARM: f64 = 2.0 * 2.0 * STAGE_LEVEL * STAGE_LEVEL * STAGE_LEVEL;

/// Effect sizes, in standard errors, that the first stage is planned for: 3.45 to reject (Student,
/// 63 degrees of freedom), 3.09 so that it does with probability 0.999, and the rest for bugs that
/// also add variance.
pub(super) const PLANNED_SIGMAS: f64 = 7.0;
/// The deviation comes from a pilot that knows it to 9 %, and is judged by a stage that knows it to
/// 9 %.
pub(super) const PLAN_MARGIN: f64 = 1.2;
/// Probability of missing an error as large as the printed resolution.
pub(super) const MISS_LEVEL: f64 = 1e-3;
/// Runs whose variance is below this share of the expected one have not seen the tail.
pub(super) const VARIANCE_GUARD: f64 = 0.25;
/// A mean that rests on fewer samples is not normal enough for any key.
pub(super) const FEWEST_EFFECTIVE: f64 = 200.0;
/// Samples of the pilot, before it is found to be too small.
const PILOT_SAMPLES: u64 = 4096;
/// Samples of the largest pilot.
const LARGEST_PILOT: u64 = 65_536;
/// Events that a pilot must have seen to size the first stage by it.
pub(super) const PILOT_EFFECTIVE: f64 = 50.0;
/// Runs of the opening. An estimator whose largest sample is 50 times its mean shows in as many that
/// half of the light is missing.
const OPENING_RUNS: u32 = 4096;
/// Fewest samples of the second and third stage. A pilot and a first stage that are both constant
/// may have missed an event that happens once in 10⁴ samples; this many miss it with probability
/// 1e-3 and 4e-12.
const FEWEST_CONFIRMING: [u64; 2] = [65_536, 262_144];

/// The same where the first stage was grossly below the claim: together with its own they miss an
/// event that happens once in 5000 samples with probability 1e-9.
const FEWEST_STEADY: [u64; 2] = [16_384, 65_536];

/// How a suspicion is confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pace {
    /// Grossly too much: no event that has not happened can lower a mean of radiances.
    Brisk,
    /// Grossly too little, unless rare events have not happened yet.
    Steady,
    /// On 4 and 16 times the samples.
    Thorough,
}

/// A step of the ladder. Each has its own random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Bets on the smallest of runs, where early decisions are wanted.
    Opening,
    /// Measures the noise, decides nothing unless bets are on.
    Pilot,
    /// Suspects.
    First,
    /// Confirms on 4 times the samples.
    Second,
    /// Confirms on 16 times the samples.
    Third,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Stage::Opening => "opening",
            Stage::Pilot => "pilot",
            Stage::First => "stage 1",
            Stage::Second => "stage 2",
            Stage::Third => "stage 3",
        })
    }
}

/// A request for one run of the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    /// The stage it belongs to.
    pub stage: Stage,
    /// How often the stage has been drawn before: pilots grow, and one stage may be repeated.
    pub attempt: u32,
    /// Number of the run in its stage.
    pub run: u32,
    /// Samples that its mean is over.
    pub samples: u64,
}

impl Draw {
    /// The seed of this run below the seed of its check.
    pub fn seed(&self, check: Seed) -> Seed {
        check.child(self.stage).child(self.attempt).child(self.run)
    }
}

/// Runs the core once and answers the mean of every claim over that run.
pub type DrawMeans<'a, E> = dyn FnMut(Draw) -> Result<Vec<f64>, E> + 'a;

/// Judges all claims on the same runs. `draw` runs the core once, with its own seed, and answers
/// for each claim the mean over that run.
///
/// # Panics
///
/// If `draw` answers another number of means than there are claims.
pub fn judge_means<E>(
    claims: &[Claim],
    effort: &Effort,
    draw: &mut DrawMeans<'_, E>,
) -> Result<Vec<MeanReport>, E> {
    judge_means_at(STAGE_LEVEL, claims, effort, draw)
}

/// The same with another level of each stage, so that calibration can be simulated.
pub(super) fn judge_means_at<E>(
    level: f64,
    claims: &[Claim],
    effort: &Effort,
    draw: &mut DrawMeans<'_, E>,
) -> Result<Vec<MeanReport>, E> {
    let mut ladder = Ladder {
        effort: *effort,
        trails: claims.iter().map(|claim| Trail::new(*claim, level, effort)).collect(),
        draw,
        drawn: 0,
        repeated: false,
    };
    ladder.climb()?;
    Ok(ladder.trails.iter().map(|trail| trail.report(effort, ladder.drawn)).collect())
}

/// The state of [`judge_means`].
struct Ladder<'a, E> {
    effort: Effort,
    trails: Vec<Trail>,
    draw: &'a mut DrawMeans<'a, E>,
    drawn: u64,
    repeated: bool,
}

impl<E> Ladder<'_, E> {
    fn climb(&mut self) -> Result<(), E> {
        self.opening()?;
        if self.is_over() {
            return Ok(());
        }
        self.pilot()?;
        if self.is_over() {
            return Ok(());
        }
        let first = self.planned_samples();
        self.stage(Stage::First, first)?;
        self.stage(Stage::Second, self.confirming_samples(first, 0))?;
        self.stage(Stage::Third, self.confirming_samples(first, 1))
    }

    /// Whether bets have decided: one claim is false, or all are true.
    fn is_over(&self) -> bool {
        self.trails.iter().any(Trail::is_lost) || self.trails.iter().all(Trail::is_won)
    }

    /// Bets on runs as small as they come, until one claim is lost or all are won. Only bounded
    /// samples say more in this form than in the larger runs of the pilot.
    fn opening(&mut self) -> Result<(), E> {
        if !self.trails.iter().any(Trail::gains_by_opening) {
            return Ok(());
        }
        let samples = self.effort.grain;
        for run in 0..OPENING_RUNS {
            self.run(Draw { stage: Stage::Opening, attempt: 0, run, samples })?;
            self.drawn += samples;
            if self.is_over() {
                break;
            }
        }
        Ok(())
    }

    /// Grows the pilot until every claim has seen enough events to know its own deviation.
    fn pilot(&mut self) -> Result<(), E> {
        let largest = self.whole_runs((self.effort.most_samples / 4).min(LARGEST_PILOT));
        let mut samples = self.whole_runs(PILOT_SAMPLES).min(largest);
        for attempt in 0.. {
            let moments = self.sample(Stage::Pilot, attempt, samples)?;
            if self.is_over() {
                break;
            }
            let informed = self.trails.iter().zip(&moments).all(|(t, m)| t.learns_from(m, samples));
            if informed || samples >= largest {
                for (trail, moments) in self.trails.iter_mut().zip(&moments) {
                    trail.take_pilot(moments, samples);
                }
                break;
            }
            samples = self.whole_runs(4 * samples).min(largest);
        }
        Ok(())
    }

    /// Samples of the first stage: what the hungriest claim needs, up to the cap.
    fn planned_samples(&self) -> u64 {
        let open = self.trails.iter().filter(|trail| trail.takes_part_in(Stage::First));
        let needed = open.map(|trail| trail.needed_samples(self.effort.detects));
        let most = self.effort.most_samples as f64;
        self.whole_runs(needed.fold(FEWEST_EFFECTIVE, f64::max).min(most).ceil() as u64)
    }

    /// Samples of the second and third stage (0 and 1). They may follow from what earlier stages
    /// saw, for each stage is judged on fresh samples: what is grossly wrong needs no more of them.
    fn confirming_samples(&self, first: u64, stage: usize) -> u64 {
        let pace = self.trails.iter().filter_map(Trail::pace).max().unwrap_or(Pace::Thorough);
        let (factors, fewest) = match pace {
            Pace::Brisk => ([1, 1], [0, 0]),
            Pace::Steady => ([2, 4], FEWEST_STEADY),
            Pace::Thorough => ([4, 16], FEWEST_CONFIRMING),
        };
        let cap = self.effort.most_samples.saturating_mul(factors[stage]);
        (factors[stage] * first).max(self.whole_runs(fewest[stage].min(cap)))
    }

    /// Draws and scores a stage, unless nobody is suspected any more.
    fn stage(&mut self, stage: Stage, samples: u64) -> Result<(), E> {
        if !self.trails.iter().any(|trail| trail.takes_part_in(stage)) {
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
    /// it said. Once a ladder; the level in [`MEAN_FALSE_ALARM`] has been paid for it.
    fn repeat_with(&self, stage: Stage, moments: &[Moments], samples: u64) -> Option<u64> {
        let most = self.effort.most_samples.saturating_mul(match stage {
            Stage::Third => 64,
            Stage::Second => 16,
            _ => 1,
        });
        let wanted = self.trails.iter().zip(moments).filter(|(t, _)| t.takes_part_in(stage));
        let wanted = wanted.filter_map(|(t, m)| t.wants_repeat(stage, m, samples, &self.effort));
        let larger = self.whole_runs(wanted.max()?.min(most));
        (!self.repeated && larger > samples).then_some(larger)
    }

    fn score(&mut self, stage: Stage, moments: &[Moments], samples: u64) {
        for (trail, moments) in self.trails.iter_mut().zip(moments) {
            if trail.takes_part_in(stage) {
                trail.score(stage, moments, samples);
            }
        }
        self.take_noise(moments, samples);
    }

    fn take_noise(&mut self, moments: &[Moments], samples: u64) {
        for (trail, moments) in self.trails.iter_mut().zip(moments) {
            trail.take_noise(moments, samples);
        }
    }

    /// One attempt at a stage: the moments of each claim's mean over the runs.
    fn sample(&mut self, stage: Stage, attempt: u32, samples: u64) -> Result<Vec<Moments>, E> {
        let mut moments = vec![Moments::default(); self.trails.len()];
        let per_run = samples / u64::from(self.effort.runs);
        for run in 0..self.effort.runs {
            let means = self.run(Draw { stage, attempt, run, samples: per_run })?;
            for (moments, mean) in moments.iter_mut().zip(means) {
                moments.push(mean);
            }
        }
        self.drawn += samples;
        Ok(moments)
    }

    /// One run: the mean of each claim, on which bets are settled while they are on.
    fn run(&mut self, draw: Draw) -> Result<Vec<f64>, E> {
        let means = (self.draw)(draw)?;
        assert_eq!(means.len(), self.trails.len(), "a run answers one mean for each claim");
        if matches!(draw.stage, Stage::Opening | Stage::Pilot) {
            for (trail, mean) in self.trails.iter_mut().zip(&means) {
                trail.settle(*mean, draw.samples);
            }
        }
        Ok(means)
    }

    /// `samples`, rounded up to whole grains in each run.
    fn whole_runs(&self, samples: u64) -> u64 {
        let runs = u64::from(self.effort.runs);
        let per_run = samples.div_ceil(runs).max(1);
        per_run.next_multiple_of(self.effort.grain) * runs
    }
}

#[cfg(test)]
mod tests;
