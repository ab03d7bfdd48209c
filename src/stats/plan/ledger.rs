//! What a run has spent of the probability of blaming a correct core.
//!
//! Every test that can fail by chance rejects a hypothesis and says what that may cost. The sum bounds
//! the probability that a correct core fails anything at all, however the hypotheses depend on each
//! other (union bound). Whether the bound is true can be seen long before anything fails: first stages have to
//! suspect correct cores just as often as their level says.
//!
//! It holds for estimates of finite variance, and for light that one sample in 30 000 or more carries, where a case may
//! spend so many. A tail that is seen to be heavier makes a mean inconclusive; what is rarer nobody can see.

use super::level::{
    CODES_FALSE_ALARM, CORRELATION_FALSE_ALARM, ESCALATION_FALSE_ALARM, IMAGE_FALSE_ALARM,
    MEAN_FALSE_ALARM, RARE_FALSE_ALARM, SCREEN_LEVEL, SLOPE_FALSE_ALARM, STAGE_LEVEL,
    SUITE_FALSE_ALARM,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How a hypothesis is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestKind {
    /// A mean, in three stages.
    Mean,
    /// Counts against a pdf, by χ² in three stages.
    Counts,
    /// A share of yes-or-no samples, by binomial tails in three stages.
    Share,
    /// A picture, by screen and confirm.
    Picture,
    /// A picture of 8-bit codes, by screen and confirm.
    Codes,
    /// The slope of an error, at once.
    Slope,
    /// The correlation of two series, at once.
    Correlation,
    /// A count of what must hardly ever happen, at once.
    Rare,
}

impl TestKind {
    /// As people read it, of one and of many.
    const fn names(self) -> [&'static str; 2] {
        match self {
            Self::Mean => ["mean", "means"],
            Self::Counts => ["pdf", "pdfs"],
            Self::Share => ["share", "shares"],
            Self::Picture => ["picture", "pictures"],
            Self::Codes => ["picture of codes", "pictures of codes"],
            Self::Slope => ["slope", "slopes"],
            Self::Correlation => ["correlation", "correlations"],
            Self::Rare => ["rare event", "rare events"],
        }
    }

    pub(crate) const fn singular(self) -> &'static str {
        self.names()[0]
    }

    /// As people read it, of many.
    pub const fn plural(self) -> &'static str {
        self.names()[1]
    }

    /// The probability that a correct core fails one such hypothesis.
    pub(crate) const fn false_alarm(self) -> f64 {
        match self {
            Self::Mean => MEAN_FALSE_ALARM,
            Self::Counts => ESCALATION_FALSE_ALARM,
            Self::Share => 2.0 * ESCALATION_FALSE_ALARM,
            Self::Picture => IMAGE_FALSE_ALARM,
            Self::Codes => CODES_FALSE_ALARM,
            Self::Slope => SLOPE_FALSE_ALARM,
            Self::Correlation => CORRELATION_FALSE_ALARM,
            Self::Rare => RARE_FALSE_ALARM,
        }
    }

    /// The probability that the first of several stages suspects a correct core; none where there is one stage. Of
    /// pictures with noise more skewed than their reference tells it is exceeded, which costs runs and no verdict: see
    /// `docs/simulations/screen-and-confirm.log` and the caustic in `false-alarms.log`.
    pub const fn suspicion(self) -> Option<f64> {
        match self {
            Self::Mean | Self::Share => Some(2.0 * STAGE_LEVEL),
            Self::Counts => Some(STAGE_LEVEL),
            Self::Picture | Self::Codes => Some(SCREEN_LEVEL),
            Self::Slope | Self::Correlation | Self::Rare => None,
        }
    }
}

/// What a test that can fail by chance may reject.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hypothesis {
    /// How it is judged.
    pub kind: TestKind,
    /// The probability that a correct core fails it.
    pub false_alarm: f64,
    /// Whether its first stage rejected, so that there was a second; never where there are no
    /// stages.
    pub suspected: bool,
}

impl Hypothesis {
    /// A hypothesis of this kind at its usual price.
    pub(crate) const fn new(kind: TestKind, suspected: bool) -> Self {
        Self { kind, false_alarm: kind.false_alarm(), suspected }
    }
}

/// All hypotheses of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LedgerEntry {
    pub(crate) hypotheses: usize,
    /// What they may cost together.
    pub(crate) false_alarm: f64,
    /// How many a first stage suspected.
    pub(crate) suspected: usize,
}

impl LedgerEntry {
    fn enter(&mut self, hypothesis: Hypothesis) {
        self.hypotheses += 1;
        self.false_alarm += hypothesis.false_alarm;
        self.suspected += usize::from(hypothesis.suspected);
    }
}

/// The book.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger(BTreeMap<TestKind, LedgerEntry>);

impl Ledger {
    pub(crate) fn entries(&self) -> impl Iterator<Item = (TestKind, LedgerEntry)> {
        self.0.iter().map(|(kind, entry)| (*kind, *entry))
    }

    pub(crate) fn hypotheses(&self) -> usize {
        self.0.values().map(|entry| entry.hypotheses).sum()
    }

    pub(crate) fn suspected(&self) -> usize {
        self.0.values().map(|entry| entry.suspected).sum()
    }

    /// At most this is the probability that a correct core fails anything.
    pub(crate) fn spent(&self) -> f64 {
        self.0.values().map(|entry| entry.false_alarm).sum()
    }

    /// Whether that is within what a suite may spend. NaN is not.
    pub(crate) fn is_within_budget(&self) -> bool {
        self.spent() <= SUITE_FALSE_ALARM
    }
}

impl FromIterator<Hypothesis> for Ledger {
    fn from_iter<T: IntoIterator<Item = Hypothesis>>(hypotheses: T) -> Self {
        let mut entries = BTreeMap::<_, LedgerEntry>::new();
        hypotheses.into_iter().for_each(|one| entries.entry(one.kind).or_default().enter(one));
        Self(entries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn means(count: usize) -> impl Iterator<Item = Hypothesis> {
        std::iter::repeat_n(Hypothesis::new(TestKind::Mean, false), count)
    }

    #[test]
    fn a_suite_of_a_thousand_means_and_twelve_pictures_is_within_its_budget() {
        let pictures = [Hypothesis::new(TestKind::Picture, true); 12];
        let ledger: Ledger = means(1000).chain(pictures).collect();
        assert!(ledger.is_within_budget(), "{ledger:?}");
        assert_eq!((ledger.hypotheses(), ledger.suspected()), (1012, 12));
        let kinds: Vec<_> =
            ledger.entries().map(|(kind, entry)| (kind, entry.hypotheses)).collect();
        assert_eq!(kinds, [(TestKind::Mean, 1000), (TestKind::Picture, 12)]);
    }

    #[test]
    fn more_is_not_and_nonsense_is_never() {
        assert!(!Ledger::from_iter(means(10_000)).is_within_budget());
        let nonsense =
            Hypothesis { false_alarm: f64::NAN, ..Hypothesis::new(TestKind::Mean, false) };
        assert!(!Ledger::from_iter([nonsense]).is_within_budget());
    }
}
