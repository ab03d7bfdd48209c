//! Adaptive sampling.

mod answered_stream;
mod known_stream;
mod random_stream;
mod rule;
mod sample_counts;
mod stops_by_its_law;
mod stops_where_it_should;

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<stops_where_it_should::StopsWhereItShould>(),
    CheckKind::of::<stops_by_its_law::StopsByItsLaw>(),
    CheckKind::of::<sample_counts::SampleCounts>(),
];
