//! Whether two series have nothing to do with each other.

use crate::stats::plan::{Hypothesis, Judgement, Report, TestKind, Verdict};

/// Standard errors that chance is given.
const SIGMAS: f64 = 7.0;
/// Of fewer pairs chance explains even a coefficient of 1.
const FEWEST_PAIRS: usize = 50;

/// What came of comparing two series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CorrelationReport {
    /// Fail if they are related.
    pub(crate) verdict: Verdict,
    /// Pearson's coefficient, in [-1, 1].
    pub(crate) coefficient: f64,
    /// The largest that chance explains.
    pub(crate) limit: f64,
    pub(crate) pairs: usize,
}

impl CorrelationReport {
    /// Why nothing can be said, if that is so.
    pub(crate) fn doubt(&self) -> Option<String> {
        let doubt = || match self.limit < 1.0 {
            true => "there is no noise to compare".to_owned(),
            false => format!("{} pairs prove nothing, {FEWEST_PAIRS} might", self.pairs),
        };
        (self.verdict == Verdict::Inconclusive).then(doubt)
    }
}

impl Report for CorrelationReport {
    fn judgement(&self) -> Judgement {
        Judgement {
            allowed: self.limit,
            hypothesis: Some(Hypothesis::new(TestKind::Correlation, false)),
            ..Judgement::new(self.verdict, self.coefficient, 0.0)
        }
    }
}

/// Judges pairs of numbers: Pearson's coefficient of n unrelated pairs has standard error 1/√n.
/// Series without any variance are inconclusive, and so are those that could not fail, because chance
/// explains even equal ones.
pub(crate) fn judge_uncorrelated(pairs: &[[f64; 2]]) -> CorrelationReport {
    let n = pairs.len() as f64;
    let mean = |side: usize| pairs.iter().map(|pair| pair[side]).sum::<f64>() / n;
    let means = [mean(0), mean(1)];
    let product = |a: usize, b: usize| {
        pairs.iter().map(|pair| (pair[a] - means[a]) * (pair[b] - means[b])).sum::<f64>()
    };
    let spread = (product(0, 0) * product(1, 1)).sqrt();
    let coefficient = product(0, 1) / spread;
    let limit = SIGMAS / n.sqrt();
    let verdict = match spread > 0.0 && pairs.len() >= FEWEST_PAIRS {
        false => Verdict::Inconclusive,
        true => Verdict::pass_if(coefficient.abs() <= limit),
    };
    CorrelationReport { verdict, coefficient, limit, pairs: pairs.len() }
}

/// Standard errors that chance is given in the most related of up to ten thousand pairs of series: signs are within t of
/// them but with probability 2 exp(-t²/2) (Hoeffding 1963), so that all together cost no more than one pair.
const SIGMAS_OF_MANY: f64 = 8.2;

/// Of many pairs of series the most related one, judged as that. Pairs that prove nothing are left out; none if all are.
pub(crate) fn judge_most_related<T>(
    reports: impl IntoIterator<Item = (T, CorrelationReport)>,
) -> Option<(T, CorrelationReport)> {
    let judged = reports.into_iter().filter(|(_, one)| one.verdict != Verdict::Inconclusive);
    let judged = judged.map(|(name, one)| {
        let limit = one.limit * SIGMAS_OF_MANY / SIGMAS;
        let verdict = Verdict::pass_if(one.coefficient.abs() <= limit);
        (name, CorrelationReport { verdict, limit, ..one })
    });
    let excess = |report: &CorrelationReport| report.coefficient.abs() / report.limit;
    let could_fail = judged.filter(|(_, one)| one.limit < 1.0);
    could_fail.max_by(|(_, a), (_, b)| excess(a).total_cmp(&excess(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    fn pairs(shared: f64) -> Vec<[f64; 2]> {
        let mut stream = Seed(5).stream();
        let mut pair = || {
            let (a, b) = (uniform(&mut stream), uniform(&mut stream));
            [a, shared * a + (1.0 - shared) * b]
        };
        (0..4000).map(|_| pair()).collect()
    }

    #[test]
    fn unrelated_series_pass_and_related_ones_fail() {
        assert_eq!(judge_uncorrelated(&pairs(0.0)).verdict, Verdict::Pass);
        assert_eq!(judge_uncorrelated(&pairs(0.2)).verdict, Verdict::Fail);
        assert_eq!(judge_uncorrelated(&pairs(1.0)).verdict, Verdict::Fail);
    }

    #[test]
    fn the_same_series_twice_fail_or_are_too_short_but_never_pass() {
        let twice = |n: usize| judge_uncorrelated(&pairs(1.0)[..n]);
        for n in 0..FEWEST_PAIRS {
            assert_eq!(twice(n).verdict, Verdict::Inconclusive, "{n}");
            assert!(twice(n).doubt().is_some_and(|doubt| doubt.contains("50")));
        }
        assert_eq!(twice(FEWEST_PAIRS).verdict, Verdict::Fail);
        assert_eq!(twice(FEWEST_PAIRS).doubt(), None);
    }

    #[test]
    fn constant_series_say_nothing() {
        assert_eq!(judge_uncorrelated(&[[1.0, 2.0]; 9]).verdict, Verdict::Inconclusive);
    }
}
