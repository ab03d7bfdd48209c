//! Laws of chance and what describes samples: moments, quantiles, binomial tails, cells of the sphere.
//! No verdicts.

mod binomial;
mod histogram;
mod moments;
mod quantile;
mod spread;
mod stopping;

pub(crate) use binomial::binomial_at_most;
pub use binomial::{binomial_at_least, share_interval};
pub use histogram::Counts;
pub(crate) use histogram::{CellProbabilities, SphereCells};
pub use moments::Moments;
pub use quantile::normal_upper;
pub(crate) use quantile::{
    chi_square_tail, chi_square_upper, detectable_noncentrality, fisher_upper, student_upper,
};
pub(super) use quantile::{student_tail, upper_median};
pub(super) use spread::Spread;
pub(crate) use stopping::{StoppingLaw, TwoValues};
