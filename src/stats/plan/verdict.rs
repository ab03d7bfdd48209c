//! The three things a check can say. A noisy agreement is not a pass.

use crate::text::spoken;
use serde::{Deserialize, Serialize};

spoken! {
    /// What a check says of the claim it judged. Ordered from good to bad, so that `max` is the worst.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Verdict {
        /// Not rejected, and an error of the promised size would have been seen.
        Pass = "pass",
        /// Not rejected, but the promised error could have hidden in the noise. Never counts as passed.
        Inconclusive = "inconclusive",
        /// Rejected.
        Fail = "fail",
    }
}

impl Verdict {
    /// The worst of several; nothing judged is [`Verdict::Inconclusive`], since absence of evidence
    /// is not success.
    pub(crate) fn worst_of(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        verdicts.into_iter().max().unwrap_or(Verdict::Inconclusive)
    }

    /// Of a test with noise: `sees` whether it would have seen an error of the promised size. Write both so that NaN
    /// makes them false.
    pub(crate) fn of_test(rejects: bool, sees: bool) -> Verdict {
        match (rejects, sees) {
            (true, _) => Verdict::Fail,
            (false, true) => Verdict::Pass,
            (false, false) => Verdict::Inconclusive,
        }
    }

    /// Of a comparison with what the core never had to give: a rejection leaves open whether it is right.
    pub(crate) fn unexpected(self) -> Verdict {
        self.min(Verdict::Inconclusive)
    }

    /// Pass if the condition holds, else fail: for comparisons without noise. Write the condition
    /// so that NaN makes it false.
    pub(crate) fn pass_if(holds: bool) -> Verdict {
        if holds { Verdict::Pass } else { Verdict::Fail }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_failure_outweighs_everything_and_nothing_is_not_a_pass() {
        use Verdict::{Fail, Inconclusive, Pass};
        assert_eq!(Verdict::worst_of([Pass, Fail, Inconclusive]), Fail);
        assert_eq!(Verdict::worst_of([Pass, Inconclusive, Pass]), Inconclusive);
        assert_eq!(Verdict::worst_of([]), Inconclusive);
    }

    #[test]
    fn what_was_never_promised_fails_nothing_and_passes_nothing_more() {
        use Verdict::{Fail, Inconclusive, Pass};
        assert_eq!(
            [Pass, Inconclusive, Fail].map(Verdict::unexpected),
            [Pass, Inconclusive, Inconclusive]
        );
    }

    #[test]
    fn nan_passes_nothing() {
        let error = f64::NAN;
        assert_eq!(Verdict::pass_if(error <= 1.0), Verdict::Fail);
        assert_eq!(Verdict::of_test(false, error <= 1.0), Verdict::Inconclusive);
    }

    #[test]
    fn the_words_on_disk_are_the_words_on_screen() {
        for verdict in [Verdict::Pass, Verdict::Inconclusive, Verdict::Fail] {
            let on_disk = serde_json::to_string(&verdict).unwrap();
            assert_eq!(on_disk, format!("\"{verdict}\""));
        }
    }
}
