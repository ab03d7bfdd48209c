//! Samplers of directions, those of BSDFs included, against the densities they claim.

mod density;
mod distribution;
#[cfg(test)]
mod fake;
mod pdf_integrates_to_one;
mod sample_jacobian;
mod samples_follow_pdf;

pub use pdf_integrates_to_one::PdfIntegratesToOne;
pub use sample_jacobian::SampleJacobian;
pub use samples_follow_pdf::SamplesFollowPdf;
