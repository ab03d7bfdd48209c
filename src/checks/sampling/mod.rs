//! Samplers of directions, those of BSDFs included, against the pdfs they claim.

mod cell_source;
mod claimed_pdf;
mod consecutive_samples;
mod counted;
pub(in crate::checks) mod distribution;
mod extreme_numbers;
pub(in crate::checks) mod extremes;
#[cfg(test)]
mod fake;
mod mass;
mod moments;
mod moments_follow_pdf;
mod numbers_as_given;
mod of_distributions;
mod pairs;
mod pdf_integrates_to_one;
mod products;
pub(in crate::checks) mod replay;
mod sample_jacobian;
mod samples_follow_pdf;
mod way;
mod weights_integrate;

use super::checks;

checks! {
    numbers_as_given::NumbersAsGiven,
    extreme_numbers::ExtremeNumbers,
    pdf_integrates_to_one::PdfIntegratesToOne,
    sample_jacobian::SampleJacobian,
    samples_follow_pdf::SamplesFollowPdf,
    moments_follow_pdf::MomentsFollowPdf,
    weights_integrate::WeightsIntegrate,
    consecutive_samples::ConsecutiveSamples,
}
