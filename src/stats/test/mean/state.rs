//! What the test of a mean knows of one claim between its stages.

use super::noise::{Noise, Tail, sample_variance};
use super::{MeanReport, StageScore};
use crate::stats::law::student_tail;
use crate::stats::plan::level::{INTERVAL_LEVEL, MEAN_FALSE_ALARM, MISS_LEVEL};
use crate::stats::plan::{Doubt, Escalation, Scored};
use crate::stats::{Claim, Effort, Moments, Stage, Verdict, normal_upper, student_upper};

/// Standard errors that the first stage is planned for: 3.45 to reject (Student, 63 degrees of
/// freedom), 3.09 so that it does with probability 0.999, and the rest for bugs that also add
/// variance.
pub(super) const PLANNED_SIGMAS: f64 = 7.0;
/// The deviation comes from a pilot that knows it to 9 %, and is judged by a stage that knows it to
/// 9 %.
const PLAN_MARGIN: f64 = 1.2;
/// Runs whose variance is below this share of the expected one have not seen the tail.
const VARIANCE_GUARD: f64 = 0.25;
/// A mean that rests on fewer samples is not normal enough for any key.
pub(super) const FEWEST_EFFECTIVE: f64 = 200.0;
/// Events that a pilot must have seen to size the first stage by it.
const PILOT_EFFECTIVE: f64 = 50.0;
/// Standard errors outside the band that make a pilot suspicious.
const PILOT_SIGMAS: f64 = 3.0;
/// Fewest samples of a first stage after a suspicious pilot. What looks like a wrong constant may
/// be a rare event that has not happened; the stages that follow look for it on more.
const FEWEST_TO_SUSPECT: f64 = 16_384.0;

/// Samples that tell well enough by how much a mean is off that the pilot has seen to be: of a
/// relative deviation of 2, an interval of 2 %.
const FEWEST_TO_TELL: f64 = 131_072.0;
/// How many times fewer samples than the first stage had show a gross error: one that is 14 standard errors out.
const GROSS_EXCESS: f64 = 4.0;
/// The rarest event that carries light and that a failure cannot have missed: one sample in so many.
const RAREST_EVENT: u64 = 30_000;
/// Fewest samples of a last stage that is too low: they miss such an event with a probability of 3e-10.
const FEWEST_TO_MISS_NOTHING: u64 = 22 * RAREST_EVENT;
/// The same in a hurry: an event that happens once in 5000 samples is missed by all stages with a probability of 1e-9.
const FEWEST_IN_A_HURRY: u64 = 65_536;
/// How many times as pointed as normal runs those may be that call a mean too low, by their kurtosis. Beyond it few of
/// them carry their spread: the next one may as well carry the light that is missing.
const MOST_POINTED: f64 = 5.0 / 3.0;

/// A claim and what its stages have said.
pub(super) struct MeanTest {
    claim: Claim,
    /// Of one stage, on one side.
    level: f64,
    /// How far outside the band the mean is at least, by the pilot.
    departs_by: f64,
    /// What errors are told relative to: the scale of the claim, or the mean where the pilot saw more.
    scale: f64,
    noise: Noise,
    /// Of the stages that decide.
    tail: Tail,
    stages: Escalation<StageScore>,
    /// Whether no run has answered NaN or infinity.
    is_finite: bool,
}

impl MeanTest {
    pub(super) fn new(claim: Claim, level: f64) -> Self {
        Self {
            claim,
            level,
            departs_by: 0.0,
            scale: claim.scale,
            noise: Noise::default(),
            tail: Tail::default(),
            stages: Escalation::default(),
            is_finite: true,
        }
    }

    pub(super) fn takes_part_in(&self, stage: Stage) -> bool {
        self.is_finite && self.stages.next() == Some(stage)
    }

    /// Whether a pilot has seen enough to size the first stage. A constant that disagrees with the
    /// claim may be a rare event that has not happened yet.
    pub(super) fn learns_from(&self, pilot: &Moments, samples: u64) -> bool {
        let variance = sample_variance(pilot, samples);
        if !variance.is_finite() {
            return true;
        }
        if variance == 0.0 {
            return self.claim.departure(pilot.mean()) == 0.0;
        }
        self.effective(variance, samples) >= PILOT_EFFECTIVE
    }

    pub(super) fn take_pilot(&mut self, pilot: &Moments, samples: u64) {
        let departure = self.claim.departure(pilot.mean()).abs();
        let chance = PILOT_SIGMAS * pilot.standard_error();
        self.departs_by = (departure - chance).max(0.0);
        self.scale = self.claim.scale.max(pilot.mean().abs() - chance);
        self.take_noise(pilot, samples);
    }

    /// Learns the noise of one more stage, for the second key of the stages that follow.
    pub(super) fn take_noise(&mut self, moments: &Moments, samples: u64) {
        if moments.variance().is_finite() {
            self.noise.take(moments, samples);
        } else {
            self.is_finite = false;
        }
    }

    /// Samples of a first stage that would see an error of `detects`, relative to what is measured where that is too
    /// much: light three times as bright need not be known nine times as well. Where the pilot has seen an error,
    /// as many as show that one, and tell by how much.
    pub(super) fn needed_samples(&self, detects: f64) -> f64 {
        let room = detects * self.scale - self.claim.band_width();
        let to_see = |error: f64| match error > 0.0 {
            true => (PLANNED_SIGMAS * PLAN_MARGIN / error).powi(2) * self.variance(),
            false => f64::INFINITY,
        };
        let to_be_gross = (GROSS_EXCESS * to_see(self.departs_by)).max(FEWEST_TO_TELL);
        let to_be_sure = if self.departs_by > 0.0 { FEWEST_TO_SUSPECT } else { 0.0 };
        to_see(room).min(to_be_gross).max(self.fewest_normal()).max(to_be_sure)
    }

    /// Fewer samples do not have a normal mean.
    fn fewest_normal(&self) -> f64 {
        FEWEST_EFFECTIVE * PLAN_MARGIN.powi(2) * (1.0 + self.variance() / self.scale.powi(2))
    }

    /// The size a stage should have had, if its spread is not what was expected: too small to have
    /// seen the tail, or too large to see the error promised.
    pub(super) fn wants_repeat(
        &self,
        stage: Stage,
        moments: &Moments,
        samples: u64,
        effort: &Effort,
    ) -> Option<u64> {
        let seen = sample_variance(moments, samples);
        if seen < VARIANCE_GUARD * self.null_variance() {
            return Some(4 * samples);
        }
        let score = self.scored(stage, moments, samples);
        let mut wiser = Self { noise: self.noise, ..Self::new(self.claim, self.level) };
        wiser.stages.push(score);
        wiser.noise.take(moments, samples);
        let resolution = wiser.resolution();
        let blind = stage == Stage::First && !score.rejects && resolution > effort.detects;
        // The spread of the stage itself may be what is large, which the plan does not know.
        let band = self.claim.band_width() / self.claim.scale;
        let short = PLAN_MARGIN * (resolution - band) / (effort.detects - band);
        let needed = wiser.needed_samples(effort.detects).max(short.powi(2) * samples as f64);
        // Past 2⁵³ the cast saturates, and the cap is far below.
        blind.then_some(needed as u64)
    }

    /// Samples on which `stage` confirms what the first has seen; none where nothing is suspected.
    pub(super) fn confirming_samples(&self, stage: Stage, in_a_hurry: bool) -> Option<f64> {
        let is_open = self.takes_part_in(stage);
        let fewest = self.fewest_confirming(stage, in_a_hurry)? as f64;
        is_open.then(|| self.stages.confirming(stage).max(self.fewest_normal()).max(fewest))
    }

    /// How many samples protect against an event that has not happened. Too much radiance is no such event; where a
    /// mean of differences is judged, both signs may be.
    fn fewest_confirming(&self, stage: Stage, in_a_hurry: bool) -> Option<u64> {
        let (first, last) = (self.stages.first()?, self.stages.last()?);
        let is_gross = first.excess() >= GROSS_EXCESS;
        let is_high = last.t > 0.0 && self.claim.expected > 0.0;
        Some(match (is_gross, is_high, stage) {
            (true, true, _) => 0,
            (true, false, Stage::Third) if in_a_hurry => FEWEST_IN_A_HURRY.max(first.samples),
            (_, _, Stage::Third) => FEWEST_TO_MISS_NOTHING.max(first.samples),
            (true, false, _) if in_a_hurry => 16_384,
            _ => 65_536,
        })
    }

    /// Learns how pointed the runs of a stage are that decides.
    pub(super) fn take_runs(&mut self, means: &[f64], per_run: u64) {
        self.tail.take(means, per_run);
    }

    pub(super) fn score(&mut self, stage: Stage, moments: &Moments, samples: u64) {
        let score = self.scored(stage, moments, samples);
        self.is_finite &= score.mean.is_finite();
        self.stages.push(score);
    }

    fn scored(&self, stage: Stage, moments: &Moments, samples: u64) -> StageScore {
        let departure = self.claim.departure(moments.mean());
        let standard_error = moments.standard_error();
        let t = in_units(departure, standard_error);
        let u = in_units(departure, (self.null_variance() / samples as f64).sqrt());
        let same_side = self.stages.last().is_none_or(|last| t * last.t > 0.0);
        let first_key = t.abs() > student_upper(self.level, (moments.count() - 1) as f64);
        let second_key = u.abs() > self.second_critical();
        let rejects = first_key && second_key && same_side;
        StageScore { stage, samples, mean: moments.mean(), standard_error, t, u, rejects }
    }

    fn second_critical(&self) -> f64 {
        match self.claim.null_deviation {
            Some(_) => normal_upper(self.level),
            None => student_upper(self.level, self.noise.freedom),
        }
    }

    /// The variance of one sample known from elsewhere: from theory, or from the stages before.
    fn null_variance(&self) -> f64 {
        self.claim
            .null_deviation
            .map_or_else(|| self.noise.variance(), |deviation| deviation.powi(2))
    }

    /// The larger of what was measured and what theory says.
    fn variance(&self) -> f64 {
        self.noise.variance().max(self.null_variance())
    }

    fn effective(&self, variance: f64, samples: u64) -> f64 {
        samples as f64 / (1.0 + variance / self.claim.scale.powi(2))
    }

    /// The smallest relative error that the first stage, which every error has to get past, would
    /// have rejected with probability 1 − [`MISS_LEVEL`].
    fn resolution(&self) -> f64 {
        let Some(first) = self.stages.first() else {
            return f64::INFINITY;
        };
        let elsewhere = (self.variance() / first.samples as f64).sqrt();
        let error = first.standard_error.max(elsewhere);
        let sigmas = self.second_critical() + normal_upper(MISS_LEVEL);
        (self.claim.band_width() + sigmas * error) / self.claim.scale
    }

    pub(super) fn report(&self, effort: &Effort, drawn: u64) -> MeanReport {
        let largest = self.stages.largest();
        let first_samples = self.stages.first().map_or(0, |score| score.samples);
        let mean = largest.map_or(f64::NAN, |score| score.mean);
        let standard_error = largest.map_or(f64::NAN, |score| score.standard_error);
        let half_width = student_upper(INTERVAL_LEVEL, f64::from(effort.runs - 1)) * standard_error;
        let interval = [mean - half_width, mean + half_width];
        let resolution = self.resolution();
        let effective_samples = self.effective(self.variance(), first_samples);
        let sees = resolution <= effort.detects && effective_samples >= FEWEST_EFFECTIVE;
        let doubt = self.may_lack_its_tail().then_some(Doubt::HeavyTail);
        let rejects = self.stages.rejects() && doubt.is_none();
        MeanReport {
            verdict: Verdict::of_test(rejects || !self.is_finite, sees && doubt.is_none()),
            doubt,
            expected: self.claim.expected,
            band: self.claim.band_width(),
            mean,
            standard_error,
            interval,
            ratio: self.ratio(interval),
            stages: self.stages.clone(),
            resolution,
            detects: effort.detects,
            samples: drawn,
            false_alarm: MEAN_FALSE_ALARM,
            p_value: self.p_value(f64::from(effort.runs - 1)),
        }
    }

    /// Whether it is suspected of being too low by runs of which few carry the spread. A mean of radiances that is too
    /// high no event can lower, and one of differences may lack an event of either sign.
    fn may_lack_its_tail(&self) -> bool {
        let is_low = self.stages.last().is_some_and(|last| last.t < 0.0);
        let may_grow = is_low || self.claim.expected <= 0.0;
        self.stages.rejects() && may_grow && self.tail.pointedness() > MOST_POINTED
    }

    fn p_value(&self, freedom: f64) -> Option<f64> {
        let first = self.stages.first().filter(|first| first.standard_error > 0.0)?;
        let t = (first.mean - self.claim.expected).abs() / first.standard_error;
        Some(2.0 * student_tail(t, freedom))
    }

    fn ratio(&self, interval: [f64; 2]) -> Option<[f64; 2]> {
        let expected = self.claim.expected;
        let mut ratio = interval.map(|end| end / expected);
        if expected < 0.0 {
            ratio.reverse();
        }
        (expected != 0.0).then_some(ratio)
    }
}

/// A departure in standard errors. Nothing is never significant, however small the error; anything
/// is, where there is no error at all. Capped, because infinity does not survive JSON.
fn in_units(departure: f64, standard_error: f64) -> f64 {
    const LARGEST: f64 = 1e9;
    if departure == 0.0 { 0.0 } else { (departure / standard_error).clamp(-LARGEST, LARGEST) }
}
