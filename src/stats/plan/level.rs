//! What every test may cost: how often it may reject a correct core, and how often miss an error. The one place that
//! has these numbers; the ledger adds them up, the tests judge by them.

/// What a whole suite may spend.
pub(crate) const SUITE_FALSE_ALARM: f64 = 1e-6;

/// Probability of missing an error as large as the smallest detectable one.
pub(in crate::stats) const MISS_LEVEL: f64 = 1e-3;
/// Level of one side of the printed intervals.
pub(in crate::stats) const INTERVAL_LEVEL: f64 = 5e-4;

/// Level of one stage on one side.
pub(in crate::stats) const STAGE_LEVEL: f64 = 5e-4;
/// Probability that three stages reject a true hypothesis, on one side.
pub(super) const ESCALATION_FALSE_ALARM: f64 = STAGE_LEVEL * STAGE_LEVEL * STAGE_LEVEL;
/// Probability that a correct core fails one claim: two sides, and twice that because one stage whose variance came
/// out wrong may be repeated.
pub(in crate::stats) const MEAN_FALSE_ALARM: f64 = 2.0 * 2.0 * ESCALATION_FALSE_ALARM;

/// Probability that a correct core fails: two sides of 7 standard errors, with room for a t of 60 degrees of freedom.
pub(super) const SLOPE_FALSE_ALARM: f64 = 1e-8;
/// Probability that unrelated series are called related: two sides of 7 standard errors of a normal, with room.
pub(super) const CORRELATION_FALSE_ALARM: f64 = 1e-10;
/// Probability that a correct core fails: the level of the tail where some are allowed. Where none is, what a correct
/// core in double precision does in 10⁶ trials with a probability of about that.
pub(in crate::stats) const RARE_FALSE_ALARM: f64 = 1e-8;

/// How many sizes of cells a picture is screened at.
pub(in crate::stats) const SCALES: usize = 5;
/// Probability that the screen suspects a picture without cause.
pub(in crate::stats) const SCREEN_LEVEL: f64 = 1e-3;
/// Level of each confirmation, at each scale.
pub(in crate::stats) const CONFIRM_LEVEL: f64 = 2e-5;
/// Probability that the reference is off by more than its band, at each scale.
pub(in crate::stats) const REFERENCE_LEVEL: f64 = 1e-9;
/// Probability that a correct core fails one picture.
pub(super) const IMAGE_FALSE_ALARM: f64 =
    SCALES as f64 * (CONFIRM_LEVEL * CONFIRM_LEVEL + REFERENCE_LEVEL);

/// Probability that a correct core is said to encode otherwise than it does.
const DECIPHERING_FALSE_ALARM: f64 = 1e-10;
/// Probability that a correct core fails one picture of codes: cells, clipping, and an encoding that is taken for
/// another.
pub(super) const CODES_FALSE_ALARM: f64 =
    IMAGE_FALSE_ALARM + CONFIRM_LEVEL * CONFIRM_LEVEL + DECIPHERING_FALSE_ALARM;
