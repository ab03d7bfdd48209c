//! Samplers of directions, those of BSDFs included, against the densities they claim.

mod cell_source;
mod consecutive_samples;
mod counted;
mod density;
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

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<numbers_as_given::NumbersAsGiven>(),
    CheckKind::of::<extreme_numbers::ExtremeNumbers>(),
    CheckKind::of::<pdf_integrates_to_one::PdfIntegratesToOne>(),
    CheckKind::of::<sample_jacobian::SampleJacobian>(),
    CheckKind::of::<samples_follow_pdf::SamplesFollowPdf>(),
    CheckKind::of::<moments_follow_pdf::MomentsFollowPdf>(),
    CheckKind::of::<weights_integrate::WeightsIntegrate>(),
    CheckKind::of::<consecutive_samples::ConsecutiveSamples>(),
];
