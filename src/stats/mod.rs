//! How a verdict is reached. Every check decides here, and only here: no check types its own
//! threshold.
//!
//! - [`judge_means`]: the three-stage ladder; where a run is in a hurry, bets before it.
//! - [`judge_counts`]: whether samples follow a density, by χ² on [`SphereCells`].
//! - [`judge_image`]: whether a picture is its reference, by screening and confirming cells of five
//!   sizes.
//! - [`judge_codes`]: whether an 8-bit picture is its reference, by the law of its codes.
//! - [`judge_difference`]: whether two pictures differ that were rendered once each;
//!   [`light_of_codes`]: what of an 8-bit one can be compared.
//! - [`misfit`]: which mistake turns one picture into another. It names, and never grades.
//! - [`judge_exact`]: comparisons without noise, with their [`Tolerance`]s.
//! - [`judge_share`], [`judge_slope`], [`judge_uncorrelated`]: shares, convergence, independence.
//! - [`judge_rare`]: what must hardly ever happen.
//! - [`Report`]: what each of them answers, whatever it tested.
//! - [`ReportedVariance`]: the noise that a renderer says its pixels have, for [`judge_means`].
//! - [`Hypothesis`], [`Ledger`]: what a run has spent of the probability of blaming a correct core.
//! - [`Claim`]: what is true if the core is right, with the band that rounding may use up.
//! - [`Effort`] and [`Budget`]: how small an error has to be seen, and how many samples that may
//!   cost.
//!
//! Not here: how samples are drawn (`checks`), or what a failure means (`diagnosis`).

mod adaptive_law;
mod betting;
mod brightness;
mod budget;
#[cfg(test)]
mod calibration;
mod cell_noise;
mod cells;
mod chi_square;
mod claim;
mod codes;
mod correlation;
mod count_report;
mod dead_pixels;
mod difference;
mod exact;
mod histogram;
mod image_report;
mod ladder;
mod ledger;
mod mean_report;
pub mod misfit;
mod moments;
mod noise;
mod proportion;
mod quantile;
mod rare;
mod report;
mod reported;
mod screen;
#[cfg(test)]
mod screen_simulation;
mod screening;
mod slope;
mod spread;
mod target;
pub mod timing;
mod trail;
mod verdict;

pub use adaptive_law::{StoppingLaw, TwoValues};
pub use betting::{EARLY_FALSE_ALARM, Support};
pub use budget::{Allowance, Budget, Effort};
pub use cells::{Component, Extent, Scale};
pub use chi_square::{
    COUNTS_FALSE_ALARM, CountSource, FEWEST_EXPECTED, follows_law, judge_count_source, judge_counts,
};
pub use claim::{Band, Claim, Sides};
pub use codes::{
    CODES_FALSE_ALARM, ClippingReport, CodeLaw, CodeReference, CodeReport, CodeSettings,
    Deciphered, LightOfCodes, NoiseSource, PixelLaw, judge_codes, light_of_codes,
};
pub use correlation::{CORRELATION_FALSE_ALARM, CorrelationReport, judge_uncorrelated};
pub use count_report::{CountDoubt, CountReport, CountStage, ForbiddenSamples};
pub use difference::{
    DIFFERENCE_FALSE_ALARM, DifferenceReport, OddPixels, Pattern, PatternReport, Sample,
    judge_difference,
};
pub use exact::{Compared, ExactReport, Tolerance, Worst, judge_exact};
pub use histogram::{BatchDensity, CellProbabilities, Counts, SphereCells};
pub use image_report::{
    CellScore, Confirmation, GlobalRatio, ImageReport, Impossible, ImpossiblePixels, ScaleReport,
    TileMap,
};
pub use ladder::{Draw, DrawMeans, MEAN_FALSE_ALARM, STAGE_LEVEL, Stage, judge_means};
pub use ledger::{Hypothesis, Ledger, LedgerEntry, SUITE_FALSE_ALARM, TestKind};
pub use mean_report::{MeanReport, StageScore};
pub use moments::Moments;
pub use proportion::{
    SHARE_FALSE_ALARM, ShareReport, ShareStage, binomial_at_least, binomial_at_most, judge_share,
    share_interval,
};
pub use quantile::{
    chi_square_tail, chi_square_upper, detectable_noncentrality, noncentral_chi_square_tail,
    normal_upper, student_upper,
};
pub use rare::{RARE_FALSE_ALARM, RareReport, Rarity, judge_rare};
pub use report::{Judgement, Report};
pub use reported::{ReportedVariance, TwoVariances};
pub use screen::{
    IMAGE_FALSE_ALARM, ImageDraw, ImageEffort, Reference, judge_image, judge_image_pair,
};
pub use slope::{ErrorLevel, ErrorPoint, SLOPE_FALSE_ALARM, Sampling, SlopeReport, judge_slope};
pub use verdict::Verdict;
