//! How a verdict is reached. Every check decides here, and only here: no check types its own threshold.
//!
//! - [`judge_means`]: the three-stage ladder, the only way a mean can fail.
//! - [`Claim`]: what is true if the core is right, with the band that rounding may use up.
//! - [`Effort`] and [`Budget`]: how small an error has to be seen, and how many samples that may cost.
//!
//! Not here: how samples are drawn (`checks`), or what a failure means (`diagnosis`).

mod budget;
mod claim;
mod ladder;
mod mean_report;
mod moments;
mod quantile;
mod trail;
mod verdict;

pub use budget::{Budget, Effort};
pub use claim::{Band, Claim, Sides};
pub use ladder::{Draw, LEAF_FALSE_ALARM, STAGE_LEVEL, Stage, judge_means};
pub use mean_report::{MeanReport, StageScore};
pub use moments::Moments;
pub use quantile::{chi_square_upper, normal_upper, student_upper};
pub use verdict::Verdict;
