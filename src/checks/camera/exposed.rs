//! Films that should hold the same radiance everywhere, and the mistakes that make what they hold.

use super::film_mistakes::{MISTAKES, Place, TILES, whole_tiles_only};
use crate::cause::{Cause, adaptive, image};
use crate::checks::Finding;
use crate::checks::rendering::places;
use crate::contract::Film;
use crate::stats::Compared;

/// How far a pixel may be from what a mistake writes, relative: different mistakes are several times as far apart.
const EXPLAINED: f64 = 1e-3;

/// A film and the samples that were asked for.
pub(super) struct Exposed {
    pub(super) samples: u32,
    pub(super) film: Film,
}

impl Exposed {
    pub(super) fn name(&self) -> String {
        format!("{} × {}, {} samples", self.film.width, self.film.height, self.samples)
    }

    /// Every pixel with its place.
    pub(super) fn pixels(&self) -> impl Iterator<Item = (Place, [f64; 3])> {
        let size = [self.film.width, self.film.height];
        let place = move |at| Place { at, size, samples: self.samples };
        places(size).map(place).zip(self.film.pixels.iter().map(|pixel| pixel.map(f64::from)))
    }

    fn counts_all(&self, expected: Option<u32>) -> bool {
        self.film.sample_counts.iter().all(|count| Some(*count) == expected)
    }
}

/// The channels of a pixel against those that it should have.
pub(super) fn channels(pixel: [f64; 3], radiance: [f64; 3], allowed: f64) -> [Compared; 3] {
    std::array::from_fn(|c| Compared::relative(pixel[c], radiance[c], allowed))
}

/// The finding, with the mistakes that make these films and what speaks for them: of pixels one of those that it names, and
/// whatever there is, of counts.
pub(super) fn explained(
    mut finding: Finding,
    films: &[Exposed],
    radiance: [f64; 3],
    allowed: f64,
) -> Finding {
    let all: usize = films.iter().map(|exposed| exposed.film.pixels.len()).sum();
    let mut pixels = films.iter().flat_map(Exposed::pixels);
    let is_wrong =
        pixels.any(|(_, pixel)| channels(pixel, radiance, allowed).iter().any(|c| !c.agrees()));
    if is_wrong {
        let evidence = |words: String| format!("{words}predicts all {all} pixels");
        let of_pixels = causes_of_pixels(films, radiance).into_iter();
        finding = finding.because_of(of_pixels.map(|(cause, words)| (cause, evidence(words))));
    }
    for step in [1, -1] {
        let is_off = |film: &Exposed| film.counts_all(film.samples.checked_add_signed(step));
        if films.iter().all(is_off) {
            let evidence = format!("all {all} counts are {step:+} off");
            finding = finding.because_all([&image::COUNTS_OFF_BY_ONE], &evidence);
        }
    }
    match stops_early(films).filter(|_| !is_wrong) {
        Some(count) => {
            let evidence = format!("pixels of more samples than {count} stop at {count}");
            finding.because(&adaptive::ADAPTIVE_ALWAYS, evidence)
        }
        None => finding,
    }
}

/// The mistakes that write just these pixels.
fn causes_of_pixels(films: &[Exposed], radiance: [f64; 3]) -> Vec<(&'static Cause, String)> {
    let predicts = |develop: &dyn Fn([f64; 3], Place) -> [f64; 3]| {
        films.iter().flat_map(Exposed::pixels).all(|(place, pixel)| {
            let made = develop(radiance, place);
            (0..3).all(|c| (pixel[c] - made[c]).abs() <= EXPLAINED * radiance[c])
        })
    };
    let plain = MISTAKES.iter().filter(|mistake| predicts(&mistake.develop));
    // Where nothing at all is seen, it is not the tiles.
    let is_lit = films.iter().flat_map(Exposed::pixels).any(|(_, pixel)| pixel != [0.0; 3]);
    let tile = TILES
        .iter()
        .filter(|_| is_lit)
        .find(|tile| predicts(&|radiance, place| whole_tiles_only(radiance, place, **tile)));
    let tile =
        tile.map(|tile| (&image::PARTIAL_TILES_LEFT_OUT, format!("a tile of {tile} × {tile} ")));
    plain.map(|mistake| (mistake.cause, String::new())).chain(tile).collect()
}

/// The count at which every pixel stops that was to take more.
fn stops_early(films: &[Exposed]) -> Option<u32> {
    let wrong: Vec<_> = films.iter().filter(|film| !film.counts_all(Some(film.samples))).collect();
    let stop = *wrong.first()?.film.sample_counts.first()?;
    let fewest_asked = wrong.iter().map(|film| film.samples).min()?;
    let all_stop = wrong.iter().all(|film| film.counts_all(Some(stop)));
    (stop > 1 && stop < fewest_asked && all_stop).then_some(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_that_stop_early_are_told_from_counts_that_are_off_by_one() {
        let exposed = |samples: u32, count: u32| {
            let sample_counts = vec![count];
            Exposed { samples, film: Film { sample_counts, ..Film::default() } }
        };
        assert_eq!(stops_early(&[exposed(1, 1), exposed(64, 32)]), Some(32));
        assert_eq!(stops_early(&[exposed(1, 0), exposed(64, 63)]), None);
        assert_eq!(stops_early(&[exposed(1, 1), exposed(64, 64)]), None);
    }
}
