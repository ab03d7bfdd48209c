//! Samplers of directions, those of BSDFs included, against the densities they claim.

mod consecutive_samples;
mod density;
pub(in crate::checks) mod distribution;
mod extreme_numbers;
pub(in crate::checks) mod extremes;
#[cfg(test)]
mod fake;
mod moments_follow_pdf;
mod numbers_as_given;
mod pdf_integrates_to_one;
pub(in crate::checks) mod replay;
mod sample_jacobian;
mod samples_follow_pdf;
mod way;
mod weights_integrate;

pub use consecutive_samples::ConsecutiveSamples;
pub use extreme_numbers::ExtremeNumbers;
pub use moments_follow_pdf::MomentsFollowPdf;
pub use numbers_as_given::NumbersAsGiven;
pub use pdf_integrates_to_one::PdfIntegratesToOne;
pub use sample_jacobian::SampleJacobian;
pub use samples_follow_pdf::SamplesFollowPdf;
pub use weights_integrate::WeightsIntegrate;
