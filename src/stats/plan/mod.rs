//! What is promised, what it may cost, and how a verdict is reached in stages: claims, budgets, the
//! ledger of error probabilities.

mod budget;
mod claim;
mod escalation;
mod ledger;
pub(super) mod level;
mod report;
mod verdict;

pub use budget::{Allowance, Budget, Effort};
pub use claim::{Band, Claim, Sides};
pub use escalation::{Escalation, Scored, Stage};
pub use ledger::{Hypothesis, Ledger, LedgerEntry, TestKind};
pub use level::SUITE_FALSE_ALARM;
pub use report::{Doubt, Judgement, Report};
pub use verdict::Verdict;
