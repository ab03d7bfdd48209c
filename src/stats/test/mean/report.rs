//! What a test of means found out about one claim.

use super::state::PLANNED_SIGMAS;
use crate::stats::plan::{Doubt, Escalation, Judgement, Scored};
use crate::stats::{Hypothesis, Report, Stage, TestKind, Verdict};

/// One stage, seen by one claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StageScore {
    pub(crate) stage: Stage,
    /// Samples over all its runs.
    pub(crate) samples: u64,
    pub(crate) mean: f64,
    /// Standard error of that mean, from the spread of this stage's own runs.
    pub(crate) standard_error: f64,
    /// How far outside the band the mean is, in standard errors of this stage (the first key).
    pub(crate) t: f64,
    /// The same in standard errors known from theory or from the other stages (the second key).
    pub(crate) u: f64,
    /// Whether both keys turned, on the side the first stage chose.
    pub(crate) rejects: bool,
}

impl Scored for StageScore {
    fn rejects(&self) -> bool {
        self.rejects
    }

    fn samples(&self) -> u64 {
        self.samples
    }

    fn excess(&self) -> f64 {
        (self.t.abs().min(self.u.abs()) / PLANNED_SIGMAS).powi(2)
    }
}

/// The judgement of one claim. `mean`, `standard_error` and the intervals are those of the largest
/// stage, the last of equals.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeanReport {
    pub(crate) verdict: Verdict,
    /// What keeps stages that all reject from being a failure.
    pub(crate) doubt: Option<Doubt>,
    /// The true mean, as claimed.
    pub(crate) expected: f64,
    /// Half width of the null hypothesis, in the unit of the mean.
    pub(crate) band: f64,
    pub(crate) mean: f64,
    /// Of `mean`, from the spread of independent runs.
    pub(crate) standard_error: f64,
    /// Holds the mean of the core with 99.9 % confidence.
    pub(crate) interval: [f64; 2],
    /// `interval` divided by what was expected; none for the mean of a difference.
    pub(crate) ratio: Option<[f64; 2]>,
    pub(crate) stages: Escalation<StageScore>,
    pub(crate) resolution: f64,
    /// The relative error that had to be caught; `resolution` is the smallest that would have been.
    pub(crate) detects: f64,
    /// Samples drawn in all, pilot and repeated stages included.
    pub(crate) samples: u64,
    /// Probability that a correct core fails this claim, as entered in the ledger.
    pub(crate) false_alarm: f64,
    /// Of the first stage, two-sided, against `expected` alone; none where nothing varies.
    pub(crate) p_value: Option<f64>,
}

impl MeanReport {
    /// The same after a test for gross errors and one for errors of `detects`, or after the first alone,
    /// which passes nothing.
    pub(super) fn of_two_tests(self, detects: f64) -> Self {
        let passes = self.verdict == Verdict::Pass && self.detects > detects;
        let verdict = if passes { Verdict::Inconclusive } else { self.verdict };
        Self { verdict, detects, false_alarm: 2.0 * self.false_alarm, ..self }
    }
}

impl Report for MeanReport {
    fn judgement(&self) -> Judgement {
        Judgement {
            allowed: self.band,
            interval: Some(self.interval),
            smallest_detectable_error: Some(self.resolution).filter(|error| error.is_finite()),
            hypothesis: Some(Hypothesis {
                false_alarm: self.false_alarm,
                ..self.stages.hypothesis(TestKind::Mean)
            }),
            doubt: self.doubt,
            p_value: self.p_value,
            ..Judgement::new(self.verdict, self.mean, self.expected)
        }
    }
}
