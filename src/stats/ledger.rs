//! What a run has spent of the probability of blaming a correct core.
//!
//! Every leaf that can fail by chance enters what it may cost. The sum bounds the probability that
//! a correct core fails anything at all, however the leaves hang together (union bound).

use serde::{Deserialize, Serialize};

/// What a whole suite may spend.
pub const SUITE_FALSE_ALARM: f64 = 1e-6;

/// Leaves of one kind in one check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LedgerEntry {
    /// Which check of which case.
    pub name: String,
    /// How many claims it made.
    pub leaves: u32,
    /// What each may cost.
    pub false_alarm: f64,
}

impl LedgerEntry {
    /// What all of them may cost.
    pub fn total(&self) -> f64 {
        f64::from(self.leaves) * self.false_alarm
    }
}

/// The book.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    entries: Vec<LedgerEntry>,
}

impl Ledger {
    /// Enters `leaves` claims that each fail a correct core with probability `false_alarm`.
    pub fn enter(&mut self, name: impl Into<String>, leaves: u32, false_alarm: f64) {
        self.entries.push(LedgerEntry { name: name.into(), leaves, false_alarm });
    }

    /// In the order entered.
    pub fn entries(&self) -> &[LedgerEntry] {
        &self.entries
    }

    /// All claims.
    pub fn leaves(&self) -> u32 {
        self.entries.iter().map(|entry| entry.leaves).sum()
    }

    /// At most this is the probability that a correct core fails anything.
    pub fn spent(&self) -> f64 {
        self.entries.iter().map(LedgerEntry::total).sum()
    }

    /// Whether that is within what a suite may spend. NaN is not.
    pub fn is_within_budget(&self) -> bool {
        self.spent() <= SUITE_FALSE_ALARM
    }

    /// The entries that cost most, most first.
    pub fn dearest(&self, count: usize) -> Vec<&LedgerEntry> {
        let mut entries: Vec<&LedgerEntry> = self.entries.iter().collect();
        entries.sort_by(|a, b| b.total().total_cmp(&a.total()));
        entries.truncate(count);
        entries
    }
}

impl std::fmt::Display for Ledger {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (leaves, spent) = (self.leaves(), self.spent());
        write!(
            f,
            "{leaves} random claims; a correct core fails any of them with probability below "
        )?;
        write!(f, "{spent:.1e}")?;
        if self.is_within_budget() {
            return Ok(());
        }
        write!(f, ", more than the {SUITE_FALSE_ALARM:.0e} a suite may spend")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{IMAGE_FALSE_ALARM, LEAF_FALSE_ALARM};

    #[test]
    fn a_suite_of_a_thousand_means_and_twelve_pictures_is_within_its_budget() {
        let mut ledger = Ledger::default();
        ledger.enter("means", 1000, LEAF_FALSE_ALARM);
        ledger.enter("pictures", 12, IMAGE_FALSE_ALARM);
        assert!(ledger.is_within_budget(), "{ledger}");
        assert_eq!(ledger.dearest(1)[0].name, "means");
        let text = "1012 random claims; a correct core fails any of them with probability below";
        assert!(ledger.to_string().starts_with(text), "{ledger}");
    }

    #[test]
    fn more_is_admitted() {
        let mut ledger = Ledger::default();
        ledger.enter("means", 10_000, LEAF_FALSE_ALARM);
        assert!(!ledger.is_within_budget());
        assert!(ledger.to_string().contains("more than the 1e-6"), "{ledger}");
        ledger.enter("nonsense", 1, f64::NAN);
        assert!(!ledger.is_within_budget());
    }
}
