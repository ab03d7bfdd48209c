//! What is promised, what it may cost, and how a verdict is reached in stages: claims, budgets, the
//! ledger of error probabilities.

mod budget;
mod claim;
mod escalation;
mod ledger;
mod report;
mod verdict;

pub use budget::{Allowance, Budget, Effort};
pub use claim::{Band, Claim, Sides};
pub use escalation::{ESCALATION_FALSE_ALARM, Escalation, STAGE_LEVEL, Scored, Stage};
pub use ledger::{Hypothesis, Ledger, LedgerEntry, SUITE_FALSE_ALARM, TestKind};
pub use report::{Judgement, Report};
pub use verdict::Verdict;

/// Probability of missing an error as large as the smallest detectable one.
pub(super) const MISS_LEVEL: f64 = 1e-3;
/// Level of one side of the printed intervals.
pub(super) const INTERVAL_LEVEL: f64 = 5e-4;
