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
pub(crate) mod timing;

pub(crate) use correlation::{CorrelationReport, judge_most_related, judge_uncorrelated};
pub(crate) use counts::{
    CountDoubt, CountReport, CountSource, batch_size, follows_law, judge_count_source, judge_counts,
};
pub(crate) use exact::{Compared, ExactReport, Tolerance, judge_exact};
pub(crate) use mean::{MeanReport, judge_means};
pub(crate) use rare::{RareReport, Rarity, judge_rare};
pub(crate) use reported_variance::{ReportedVariance, TwoVariances};
pub(crate) use share::{ShareReport, judge_share};
pub(crate) use slope::{ErrorLevel, Sampling, SlopeReport, judge_slope};
