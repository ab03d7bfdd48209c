//! What is promised, what it may cost, and how a verdict is reached in stages: claims, budgets, the
//! ledger of error probabilities.

mod budget;
mod claim;
mod escalation;
mod ledger;
pub(super) mod level;
mod report;
mod verdict;

pub use budget::Budget;
pub(crate) use budget::{Allowance, Effort};
pub(crate) use claim::{Band, Claim, Sides};
pub(crate) use escalation::{Escalation, Scored, Stage};
pub use ledger::TestKind;
pub(crate) use ledger::{Hypothesis, Ledger, LedgerEntry};
pub(crate) use level::SUITE_FALSE_ALARM;
pub(crate) use report::{Doubt, Judgement, Report};
pub use verdict::Verdict;
