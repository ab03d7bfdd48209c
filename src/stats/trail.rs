//! What the ladder remembers of one claim while it climbs.

use super::betting::{EARLY_FALSE_ALARM, Wager};
use super::ladder::{
    FEWEST_EFFECTIVE, MEAN_FALSE_ALARM, MISS_LEVEL, PILOT_EFFECTIVE, PLAN_MARGIN, PLANNED_SIGMAS,
    Pace, VARIANCE_GUARD,
};
use super::noise::{Noise, sample_variance};
use super::{
    Claim, Effort, MeanReport, Moments, Stage, StageScore, Verdict, normal_upper, student_upper,
};

/// Standard errors outside the band that make a pilot suspicious.
const PILOT_SIGMAS: f64 = 3.0;
/// Fewest samples of a first stage after a suspicious pilot. What looks like a wrong constant may
/// be a rare event that has not happened; 4 and 16 times as many samples confirm.
const FEWEST_TO_SUSPECT: f64 = 16_384.0;
/// Level of one side of the printed intervals.
const INTERVAL_LEVEL: f64 = 5e-4;

/// Where a claim stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Standing {
    Open,
    /// Rejected by every stage so far; the sign is that of the departure.
    Suspected(f64),
    Cleared,
    Rejected,
    /// Some run answered NaN or infinity.
    NotFinite,
}

/// A claim and its history.
pub(super) struct Trail {
    claim: Claim,
    /// Of one stage, on one side.
    level: f64,
    /// Whether the pilot was outside the band by more than its noise.
    is_expected_to_depart: bool,
    noise: Noise,
    scores: Vec<StageScore>,
    standing: Standing,
    /// Where early decisions are wanted.
    wager: Option<Wager>,
    /// What the bets have decided.
    early: Option<Verdict>,
}

impl Trail {
    pub(super) fn new(claim: Claim, level: f64, effort: &Effort) -> Self {
        let wager = effort.decides_early.then(|| Wager::on(&claim, effort.detects));
        Self { wager, ..Self::without_bets(claim, level) }
    }

    fn without_bets(claim: Claim, level: f64) -> Self {
        Self {
            claim,
            level,
            is_expected_to_depart: false,
            noise: Noise::default(),
            scores: Vec::new(),
            standing: Standing::Open,
            wager: None,
            early: None,
        }
    }

    /// Settles the bets on the mean of one more run.
    pub(super) fn settle(&mut self, mean: f64, samples: u64) {
        if let (Some(wager), None) = (&mut self.wager, self.early) {
            wager.take(mean, samples);
            self.early = wager.verdict();
        }
    }

    /// Whether the bets have shown that the claim is false.
    pub(super) fn is_lost(&self) -> bool {
        self.early == Some(Verdict::Fail)
    }

    /// Whether the bets have shown that the claim holds as well as promised.
    pub(super) fn is_won(&self) -> bool {
        self.early == Some(Verdict::Pass)
    }

    pub(super) fn gains_by_opening(&self) -> bool {
        self.wager.as_ref().is_some_and(Wager::wants_small_runs)
    }

    pub(super) fn takes_part_in(&self, stage: Stage) -> bool {
        match stage {
            Stage::Opening | Stage::Pilot | Stage::First => {
                self.standing == Standing::Open && self.early.is_none()
            }
            Stage::Second | Stage::Third => matches!(self.standing, Standing::Suspected(_)),
        }
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

    /// Learns from the last pilot.
    pub(super) fn take_pilot(&mut self, pilot: &Moments, samples: u64) {
        let departure = self.claim.departure(pilot.mean()).abs();
        self.is_expected_to_depart = departure > PILOT_SIGMAS * pilot.standard_error();
        self.take_noise(pilot, samples);
    }

    /// Learns the noise of one more stage, for the second key of the stages that follow.
    pub(super) fn take_noise(&mut self, moments: &Moments, samples: u64) {
        if moments.variance().is_finite() {
            self.noise.take(moments, samples);
        } else {
            self.standing = Standing::NotFinite;
        }
    }

    /// Samples of a first stage that would see an error of `detects`.
    pub(super) fn needed_samples(&self, detects: f64) -> f64 {
        let variance = self.variance();
        let room = detects * self.claim.scale - self.claim.band_width();
        let for_noise = if room > 0.0 {
            (PLANNED_SIGMAS * PLAN_MARGIN / room).powi(2) * variance
        } else {
            f64::INFINITY
        };
        let for_normality =
            FEWEST_EFFECTIVE * PLAN_MARGIN.powi(2) * (1.0 + variance / self.claim.scale.powi(2));
        let to_be_sure = if self.is_expected_to_depart { FEWEST_TO_SUSPECT } else { 0.0 };
        for_noise.max(for_normality).max(to_be_sure)
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
        let mut wiser = Self { scores: vec![score], ..Self::without_bets(self.claim, self.level) };
        wiser.noise = self.noise;
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

    /// How this claim's suspicion wants to be confirmed, if it is suspected. Where a mean of
    /// differences is judged, both signs may be an event that has not happened.
    pub(super) fn pace(&self) -> Option<Pace> {
        let Standing::Suspected(sign) = self.standing else { return None };
        let first = self.scores.first()?;
        let is_gross = first.t.abs().min(first.u.abs()) >= 2.0 * PLANNED_SIGMAS;
        Some(match (is_gross, sign > 0.0 && self.claim.expected > 0.0) {
            (true, true) => Pace::Brisk,
            (true, false) => Pace::Steady,
            (false, _) => Pace::Thorough,
        })
    }

    /// Takes the decision of a stage.
    pub(super) fn score(&mut self, stage: Stage, moments: &Moments, samples: u64) {
        let score = self.scored(stage, moments, samples);
        self.scores.push(score);
        self.standing = if !score.mean.is_finite() {
            Standing::NotFinite
        } else if !score.rejects {
            Standing::Cleared
        } else if stage == Stage::Third {
            Standing::Rejected
        } else {
            Standing::Suspected(score.t.signum())
        };
    }

    fn scored(&self, stage: Stage, moments: &Moments, samples: u64) -> StageScore {
        let departure = self.claim.departure(moments.mean());
        let standard_error = moments.standard_error();
        let t = in_units(departure, standard_error);
        let u = in_units(departure, (self.null_variance() / samples as f64).sqrt());
        let same_side = match self.standing {
            Standing::Suspected(sign) => t * sign > 0.0,
            _ => true,
        };
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
        let Some(first) = self.scores.iter().find(|score| score.stage == Stage::First) else {
            return f64::INFINITY;
        };
        let elsewhere = (self.variance() / first.samples as f64).sqrt();
        let error = first.standard_error.max(elsewhere);
        let sigmas = self.second_critical() + normal_upper(MISS_LEVEL);
        (self.claim.band_width() + sigmas * error) / self.claim.scale
    }

    /// What came out.
    pub(super) fn report(&self, effort: &Effort, drawn: u64) -> MeanReport {
        let report = self.ladder_report(effort, drawn);
        match &self.wager {
            None => report,
            Some(wager) => self.with_bets(report, wager),
        }
    }

    /// The same where bets were on. They have cost their share of the error budget whether or not
    /// they decided; where no stage was climbed they are all that is known.
    fn with_bets(&self, report: MeanReport, wager: &Wager) -> MeanReport {
        let false_alarm = report.false_alarm + EARLY_FALSE_ALARM;
        if !self.scores.is_empty() || self.standing == Standing::NotFinite {
            return MeanReport { false_alarm, ..report };
        }
        let (mean, standard_error) = wager.mean();
        let interval = wager.interval(2.0 * INTERVAL_LEVEL);
        MeanReport {
            verdict: self.early.unwrap_or(Verdict::Inconclusive),
            mean,
            standard_error,
            interval,
            ratio: self.ratio(interval),
            resolution: if self.is_won() { report.detects } else { f64::INFINITY },
            samples_missing: None,
            decided_early: self.early.is_some(),
            false_alarm,
            ..report
        }
    }

    fn ladder_report(&self, effort: &Effort, drawn: u64) -> MeanReport {
        let last = self.scores.last();
        let first_samples = self.scores.first().map_or(0, |score| score.samples);
        let mean = last.map_or(f64::NAN, |score| score.mean);
        let standard_error = last.map_or(f64::NAN, |score| score.standard_error);
        let half_width = student_upper(INTERVAL_LEVEL, f64::from(effort.runs - 1)) * standard_error;
        let interval = [mean - half_width, mean + half_width];
        let resolution = self.resolution();
        let effective_samples = self.effective(self.variance(), first_samples);
        let verdict = match self.standing {
            Standing::Rejected | Standing::NotFinite => Verdict::Fail,
            _ if resolution <= effort.detects && effective_samples >= FEWEST_EFFECTIVE => {
                Verdict::Pass
            }
            _ => Verdict::Inconclusive,
        };
        MeanReport {
            verdict,
            expected: self.claim.expected,
            scale: self.claim.scale,
            band: self.claim.band_width(),
            mean,
            standard_error,
            interval,
            ratio: self.ratio(interval),
            stages: self.scores.clone(),
            resolution,
            detects: effort.detects,
            samples: drawn,
            effective_samples,
            samples_missing: self.missing(verdict, effort, first_samples),
            decided_early: false,
            false_alarm: MEAN_FALSE_ALARM,
        }
    }

    fn ratio(&self, interval: [f64; 2]) -> Option<[f64; 2]> {
        let expected = self.claim.expected;
        let mut ratio = interval.map(|end| end / expected);
        if expected < 0.0 {
            ratio.reverse();
        }
        (expected != 0.0).then_some(ratio)
    }

    fn missing(&self, verdict: Verdict, effort: &Effort, first_samples: u64) -> Option<u64> {
        let needed = self.needed_samples(effort.detects);
        let worth_asking = verdict == Verdict::Inconclusive && needed.is_finite();
        worth_asking.then(|| (needed as u64).saturating_sub(first_samples).max(1))
    }
}

/// A departure in standard errors. Nothing is never significant, however small the error; anything
/// is, where there is no error at all. Capped, because infinity does not survive JSON.
fn in_units(departure: f64, standard_error: f64) -> f64 {
    const LARGEST: f64 = 1e9;
    if departure == 0.0 { 0.0 } else { (departure / standard_error).clamp(-LARGEST, LARGEST) }
}
