//! Tests of numbers, each with its report: means, counts and shares in three stages; slopes,
//! correlations and rare events at once; comparisons without noise.

mod correlation;
mod counts;
mod exact;
mod mean;
mod rare;
mod reported_variance;
mod share;
mod slope;
pub mod timing;

pub(super) use correlation::CORRELATION_FALSE_ALARM;
pub use correlation::{CorrelationReport, judge_uncorrelated};
pub use counts::{
    CountDoubt, CountReport, CountSource, follows_law, judge_count_source, judge_counts,
};
pub use exact::{Compared, ExactReport, Tolerance, judge_exact};
pub(super) use mean::MEAN_FALSE_ALARM;
pub use mean::{Draw, MeanReport, judge_means};
pub(super) use rare::RARE_FALSE_ALARM;
pub use rare::{RareReport, Rarity, judge_rare};
pub use reported_variance::{ReportedVariance, TwoVariances};
pub use share::{ShareReport, judge_share};
pub(super) use slope::SLOPE_FALSE_ALARM;
pub use slope::{ErrorLevel, Sampling, SlopeReport, judge_slope};
