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

/// Whether a pixel can stop at all before its last sample.
fn looks_before_the_end(batch: u32, cap: u32) -> Result<(), String> {
    if batch < 2 || cap < batch {
        return Err("`batch` must be at least 2, and `cap` at least `batch`".to_owned());
    }
    Ok(())
}
