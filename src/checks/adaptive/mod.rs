//! Adaptive sampling.

mod answered_stream;
mod known_stream;
mod picture_counts;
mod random_stream;
mod rule;
mod sample_counts;
mod stops_by_its_law;
mod stops_where_it_should;

use super::checks;

checks! {
    stops_where_it_should::StopsWhereItShould,
    stops_by_its_law::StopsByItsLaw,
    sample_counts::SampleCounts,
    picture_counts::PictureCounts,
}
