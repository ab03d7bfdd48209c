//! Bets against a claim: a gambler who gets rich has shown that it is false.
//!
//! Before each run the gambler stakes a share of the capital on the mean being above what is
//! claimed, or below it, at odds that are fair or worse if the claim is true. Capital can then
//! grow beyond 1/α with probability α at most, whenever one looks and however the runs are
//! distributed (Ville 1939; Waudby-Smith and Ramdas 2024, "Estimating means of bounded random
//! variables by betting"). No central limit theorem is used and nothing is planned beforehand, so
//! that a gross error ends a test after a few thousand samples.
//!
//! A bet on "above" can lose all only on samples far below the claim: it needs to know that samples
//! are not negative. A bet on "below" needs the largest sample there can be ([`Support`]); without
//! it nobody can tell darkness from light that has not come yet.
//!
//! The same bets against both ends of the tolerated interval make a confidence sequence: once both
//! are lost, the mean lies between them, and the claim passes.

use super::{Claim, Sides, Verdict};
use serde::{Deserialize, Serialize};

/// Probability that a correct core fails one claim by these bets, both sides together.
pub const EARLY_FALSE_ALARM: f64 = 1e-10;
/// Probability that an error as large as promised is passed early.
const EARLY_MISS: f64 = 1e-3;
/// Stakes kept side by side, as shares of the largest that cannot ruin. Each is best against an
/// error of one size; the mean of all has, up to a factor 25, the capital of the best.
const STAKES: usize = 25;
/// The smallest and the largest of them. The largest leaves something to go on with after the worst
/// sample.
const STAKE_ENDS: [f64; 2] = [1e-4, 0.9];

/// What a single sample of a correct core can be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Support {
    /// Anything: no bet is safe.
    #[default]
    Unbounded,
    /// Nothing below 0, as radiance is. Too much of it can be shown, too little cannot.
    NotNegative,
    /// Between 0 and this.
    UpTo(f64),
}

impl Support {
    fn contains(self, value: f64) -> bool {
        match self {
            Self::Unbounded => true,
            Self::NotNegative => value >= 0.0,
            Self::UpTo(most) => (0.0..=most).contains(&value),
        }
    }

    /// The largest stake on a mean above `boundary`, per unit: nothing below 0 can come.
    fn most_on_above(self, boundary: f64) -> Option<f64> {
        (self != Self::Unbounded && boundary > 0.0).then(|| boundary.recip())
    }

    /// The largest stake on a mean below `boundary`, per unit.
    fn most_on_below(self, boundary: f64) -> Option<f64> {
        match self {
            Self::UpTo(most) if boundary < most => Some((most - boundary).recip()),
            _ => None,
        }
    }
}

/// A gambler against "the mean is at most this" (positive stakes) or "at least this" (negative).
#[derive(Clone, Debug)]
struct Capital {
    boundary: f64,
    stakes: Vec<f64>,
    /// Logarithm of what each stake has become of 1.
    logs: Vec<f64>,
}

impl Capital {
    /// Grows if the mean is above `boundary`.
    fn on_above(boundary: f64, support: Support) -> Option<Self> {
        Some(Self::new(boundary, support.most_on_above(boundary)?))
    }

    /// Grows if the mean is below `boundary`.
    fn on_below(boundary: f64, support: Support) -> Option<Self> {
        Some(Self::new(boundary, -support.most_on_below(boundary)?))
    }

    fn new(boundary: f64, most: f64) -> Self {
        let [smallest, largest] = STAKE_ENDS;
        let step = (largest / smallest).ln() / (STAKES - 1) as f64;
        let stakes = (0..STAKES).map(|i| most * smallest * (step * i as f64).exp()).collect();
        Self { boundary, stakes, logs: vec![0.0; STAKES] }
    }

    fn take(&mut self, value: f64) {
        for (log, stake) in self.logs.iter_mut().zip(&self.stakes) {
            *log += (stake * (value - self.boundary)).ln_1p();
        }
    }

    /// Logarithm of the mean capital.
    fn log(&self) -> f64 {
        let largest = self.logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = self.logs.iter().map(|log| (log - largest).exp()).sum();
        largest + (sum / STAKES as f64).ln()
    }
}

/// The bets on one claim.
#[derive(Clone, Debug)]
pub(super) struct Wager {
    support: Support,
    /// Against the claim: the mean is above its band, or below it.
    against: [Option<Capital>; 2],
    /// For the claim: the mean is not as high as the promised error would make it, not as low.
    /// Empty where that side cannot be shown.
    for_it: [Option<Capital>; 2],
    sides: Sides,
    /// Mean and samples of each run.
    runs: Vec<(f64, u64)>,
}

impl Wager {
    /// Bets on `claim`, where an error of `detects` has to be seen.
    pub(super) fn on(claim: &Claim, detects: f64) -> Self {
        let (expected, support) = (claim.expected, claim.support);
        let (band, error) = (claim.band_width(), detects * claim.scale);
        Self {
            support,
            against: [
                Capital::on_above(expected + band, support).filter(|_| claim.fails_above()),
                Capital::on_below(expected - band, support).filter(|_| claim.fails_below()),
            ],
            for_it: [
                Capital::on_below(expected + error, support),
                Capital::on_above(expected - error, support),
            ],
            sides: claim.sides,
            runs: Vec::new(),
        }
    }

    /// Whether many small runs say more than a few large ones: where bets on "below" are limited by
    /// the largest sample, each run can win but little.
    pub(super) fn wants_small_runs(&self) -> bool {
        matches!(self.support, Support::UpTo(_))
    }

    /// Takes in the mean of one more run over `samples`. A value that no correct core answers says that the claim's
    /// support is not what the check believes: all bets are off.
    pub(super) fn take(&mut self, value: f64, samples: u64) {
        if !self.support.contains(value) {
            (self.against, self.for_it) = ([None, None], [None, None]);
        }
        for capital in self.against.iter_mut().chain(&mut self.for_it).flatten() {
            capital.take(value);
        }
        self.runs.push((value, samples));
    }

    /// What can be said already.
    pub(super) fn verdict(&self) -> Option<Verdict> {
        if self.log_evidence() >= -EARLY_FALSE_ALARM.ln() {
            return Some(Verdict::Fail);
        }
        let refuted = |capital: &Option<Capital>| {
            capital.as_ref().is_some_and(|capital| capital.log() >= -EARLY_MISS.ln())
        };
        let [not_too_high, not_too_low] = self.for_it.each_ref().map(refuted);
        let holds = match self.sides {
            Sides::Both => not_too_high && not_too_low,
            Sides::AtLeast => not_too_low,
            Sides::AtMost => not_too_high,
        };
        holds.then_some(Verdict::Pass)
    }

    /// Logarithm of the capital against the claim: half of it was put on either side.
    fn log_evidence(&self) -> f64 {
        let logs = self.against.iter().flatten().map(|capital| capital.log() - 2f64.ln());
        let logs: Vec<f64> = logs.collect();
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return largest;
        }
        largest + logs.iter().map(|log| (log - largest).exp()).sum::<f64>().ln()
    }

    /// Mean over all samples, and its standard error.
    pub(super) fn mean(&self) -> (f64, f64) {
        let total: u64 = self.runs.iter().map(|(_, samples)| samples).sum();
        let sum: f64 = self.runs.iter().map(|(value, samples)| value * *samples as f64).sum();
        let mean = sum / total as f64;
        let squares = self.runs.iter().map(|(v, n)| *n as f64 * (v - mean).powi(2)).sum::<f64>();
        let variance = squares / (self.runs.len() - 1) as f64;
        (mean, (variance / total as f64).sqrt())
    }

    /// Holds the mean with probability 1 − `level` at all times at once. An end that cannot be shown
    /// is 0 or infinite.
    pub(super) fn interval(&self, level: f64) -> [f64; 2] {
        let refutes = |capital: Option<Capital>| {
            capital.is_some_and(|mut capital| {
                self.runs.iter().for_each(|(value, _)| capital.take(*value));
                capital.log() >= (2.0 / level).ln()
            })
        };
        // No stake wins against the mean of what it was settled on: ln(1 + x) ≤ x.
        let mean = self.runs.iter().map(|(v, _)| v).sum::<f64>() / self.runs.len() as f64;
        let low = edge(mean, 0.0, |m| refutes(Capital::on_above(m, self.support)));
        let high = match self.support {
            Support::UpTo(most) => {
                edge(mean, most, |m| refutes(Capital::on_below(m, self.support)))
            }
            _ => f64::INFINITY,
        };
        [low, high]
    }
}

/// How far from `inside` towards `outside` means are not refuted.
fn edge(mut inside: f64, mut outside: f64, refuted: impl Fn(f64) -> bool) -> f64 {
    const HALVINGS: u32 = 40;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if refuted(middle) { outside = middle } else { inside = middle }
    }
    outside
}

#[cfg(test)]
mod tests;
