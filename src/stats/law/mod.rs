//! Laws of chance and what describes samples: moments, quantiles, binomial tails, cells of the sphere.
//! No verdicts.

mod binomial;
mod histogram;
mod moments;
mod quantile;
mod spread;
mod stopping;

pub use binomial::{binomial_at_least, binomial_at_most, share_interval};
pub use histogram::{CellProbabilities, Counts, SphereCells};
pub use moments::Moments;
pub use quantile::{
    chi_square_tail, chi_square_upper, detectable_noncentrality, fisher_upper, normal_upper,
    student_upper,
};
pub(super) use quantile::{student_tail, upper_median};
pub(super) use spread::Spread;
pub use stopping::{StoppingLaw, TwoValues};
