//! How a verdict is reached. Every check decides here, and only here: no check types its own
//! threshold.
//!
//! - `law`: laws of chance, and what describes samples. No verdicts.
//! - `plan`: what is claimed ([`Claim`]), what it may cost ([`Effort`], [`Budget`]), how a test
//!   goes on from stage to stage (`Escalation`), what every test answers
//!   ([`Report`]), and what a run has spent of the probability of blaming a correct core
//!   ([`Ledger`]).
//! - `test`: tests of numbers. Means ([`judge_means`]), counts against a pdf
//!   ([`judge_counts`]), shares ([`judge_share`]), slopes ([`judge_slope`]), independence
//!   ([`judge_uncorrelated`]), rare events ([`judge_rare`]), and comparisons without noise
//!   ([`judge_exact`]).
//! - `image`: tests of pictures. Against a reference ([`judge_image`]), by the law of 8-bit codes
//!   ([`judge_codes`]), against another single picture ([`compare`]); and which mistake
//!   turns one picture into another ([`misfit`]), which names, and never grades.
//!
//! Not here: how samples are drawn (`checks`), or what a failure means (`diagnosis`).

mod image;
mod law;
mod plan;
mod test;

pub(crate) use image::{
    CellScore, Clipped, CodeReference, CodeReport, CodeSettings, CodesCompared, Comparison,
    Component, Deciphered, DifferenceReport, Ends, Extent, GlobalRatio, ImageDraw, ImageReport,
    Impossible, Measured, NoiseSource, OddCell, OddPixels, PARTS, PartRatio, Pattern,
    PatternReport, Scale, ScaleReport, Side, compare, flip_map, judge_codes, misfit,
};
pub use image::{ImageEffort, Question, Reference, judge_image, judge_image_pair};
pub(crate) use law::{
    CellProbabilities, SphereCells, StoppingLaw, TwoValues, chi_square_upper, student_upper,
};
pub use law::{Counts, Moments, binomial_at_least, normal_upper, share_interval};
pub(crate) use plan::{
    Allowance, Band, Claim, Doubt, Effort, Hypothesis, Ledger, LedgerEntry, Report,
    SUITE_FALSE_ALARM, Sides, Stage,
};
pub use plan::{Budget, TestKind, Verdict};
pub(crate) use test::{
    Compared, CorrelationReport, CountDoubt, CountReport, CountSource, ErrorLevel, ExactReport,
    MeanReport, RareReport, Rarity, ReportedVariance, Sampling, ShareReport, SlopeReport,
    Tolerance, TwoVariances, batch_size, follows_law, judge_count_source, judge_counts,
    judge_exact, judge_means, judge_most_related, judge_rare, judge_share, judge_slope,
    judge_uncorrelated, timing,
};
