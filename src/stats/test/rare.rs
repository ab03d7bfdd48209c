//! What must hardly ever happen: counted, and judged at once by the exact tail of the rate that is
//! allowed.

use crate::math::Precision;
use crate::stats::law::{binomial_at_least, share_interval};
use crate::stats::plan::level::{MISS_LEVEL, RARE_FALSE_ALARM};
use crate::stats::plan::{Hypothesis, Judgement, Report, TestKind, Verdict};

/// How often something may happen to a correct core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rarity {
    double: f64,
    single: f64,
}

impl Rarity {
    /// Rays that slip through a closed surface. Single precision: the rate at which Embree's own
    /// verification accepts leaks.
    pub(crate) const LEAKS: Self = Self { double: 0.0, single: 2e-5 };

    /// Points in a shadow that is none. Rays keep clear of the surface they leave, by 10⁻⁶ to 10⁻⁴ of the scene, and
    /// where surfaces touch or cross they may start behind the other one: about that share of an area is so near.
    pub(crate) const OWN_SHADOWS: Self = Self { double: 1e-4, single: 1e-4 };

    /// The share of trials in this precision.
    pub(crate) const fn of(self, precision: Precision) -> f64 {
        match precision {
            Precision::Double => self.double,
            Precision::Single => self.single,
        }
    }
}

/// The judgement of a count of rare events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RareReport {
    /// Pass or fail; inconclusive without trials.
    pub(crate) verdict: Verdict,
    pub(crate) hits: u64,
    pub(crate) trials: u64,
    /// The share that is allowed.
    pub(crate) allowed: f64,
    /// Holds the share of the core with 99.9 % confidence.
    pub(crate) interval: [f64; 2],
    /// The smallest share that would have been caught with probability 0.999.
    pub(crate) resolution: f64,
}

impl Report for RareReport {
    fn judgement(&self) -> Judgement {
        Judgement {
            allowed: self.allowed,
            interval: Some(self.interval),
            hypothesis: Some(Hypothesis::new(TestKind::Rare, false)),
            ..Judgement::new(self.verdict, self.hits as f64 / self.trials as f64, 0.0)
        }
    }
}

/// Judges whether something that happened `hits` times in `trials` may happen with probability
/// `allowed`.
pub(crate) fn judge_rare(hits: u64, trials: u64, allowed: f64) -> RareReport {
    let is_too_many =
        |hits| hits > 0 && binomial_at_least(hits, trials, allowed) < RARE_FALSE_ALARM;
    let verdict = match trials {
        0 => Verdict::Inconclusive,
        _ => Verdict::pass_if(!is_too_many(hits)),
    };
    // The most hits that still pass, by bisection: tails fall with the number of hits.
    let (mut passes, mut fails) = (0, trials + 1);
    while fails - passes > 1 {
        let middle = passes + (fails - passes) / 2;
        if is_too_many(middle) { fails = middle } else { passes = middle }
    }
    RareReport {
        verdict,
        hits,
        trials,
        allowed,
        interval: share_interval(hits, trials.max(1), MISS_LEVEL / 2.0),
        resolution: share_interval(passes, trials.max(1), MISS_LEVEL)[1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_nothing_is_allowed_one_is_too_many() {
        let clean = judge_rare(0, 1_000_000, 0.0);
        assert_eq!(clean.verdict, Verdict::Pass);
        // ln 1000 = 6.9
        assert!((clean.resolution * 1e6 - 6.9).abs() < 0.01, "{clean:?}");
        assert_eq!(judge_rare(1, 1_000_000, 0.0).verdict, Verdict::Fail);
    }

    #[test]
    fn an_allowed_rate_fails_only_beyond_chance() {
        // 20 are expected; P(51 or more) is 4.8e-9, P(50 or more) 1.2e-8.
        for (hits, verdict) in [(20, Verdict::Pass), (50, Verdict::Pass), (51, Verdict::Fail)] {
            assert_eq!(judge_rare(hits, 1_000_000, 2e-5).verdict, verdict, "{hits}");
        }
        let resolution = judge_rare(20, 1_000_000, 2e-5).resolution;
        assert!((7e-5..9e-5).contains(&resolution), "{resolution}");
    }

    #[test]
    fn nothing_tried_is_no_pass() {
        assert_eq!(judge_rare(0, 0, 2e-5).verdict, Verdict::Inconclusive);
    }
}
