//! Random numbers: every path has its own stream, named by what it is for and never by which thread draws it.

use super::steps::{LESSON, Steps};
use crate::contract::Randomness;
use crate::math::rng::{Stream, uniform};
use glam::DVec2;
use rand::SeedableRng;

/// The random numbers of one path.
#[derive(Clone, Debug)]
pub(crate) struct Random<'a> {
    /// What the stream starts from.
    pub(crate) name: u64,
    pub(crate) stream: Stream,
    steps: &'a Steps,
}

impl<'a> Random<'a> {
    /// For ray number `ray` of one call.
    pub(crate) fn for_ray(seed: u64, ray: usize) -> Self {
        Self::named(&[seed, ray as u64])
    }

    /// For camera sample `sample` of pixel number `pixel`.
    pub(crate) fn for_sample(seed: u64, pixel: usize, sample: u32) -> Self {
        Self::named(&[seed, pixel as u64, u64::from(sample)])
    }

    fn named(labels: &[u64]) -> Self {
        let name = labels.iter().fold(0, |name, label| scramble(name ^ label));
        Self { name, stream: Stream::seed_from_u64(name), steps: &LESSON }
    }

    /// The same stream, drawn from as these steps say.
    pub(crate) fn drawn_by(self, steps: &Steps) -> Random<'_> {
        Random { name: self.name, stream: self.stream, steps }
    }

    /// A number in [0, 1).
    pub(crate) fn number(&mut self) -> f64 {
        self.steps.number(self)
    }

    /// A point of the unit square.
    pub(crate) fn point(&mut self) -> DVec2 {
        let x = self.number();
        DVec2::new(x, self.number())
    }
}

/// A number in [0, 1): the next of the stream.
pub(crate) fn number(random: &mut Random<'_>) -> f64 {
    uniform(&mut random.stream)
}

/// The stream of one sample of one pixel.
pub(crate) fn sample_stream(seed: u64, pixel: usize, sample: u32) -> Random<'static> {
    Random::for_sample(seed, pixel, sample)
}

/// The seed that numbers are drawn by is the one that was given.
pub(crate) fn seed(given: u64) -> u64 {
    given
}

/// Sampling uses the caller's numbers: a point of the unit square, and one to choose a lobe.
pub(crate) fn callers_numbers(random: &Randomness<'_>, index: usize) -> (DVec2, f64) {
    (random.points[index], random.lobes[index])
}

/// One step of SplitMix64 (Steele, Lea and Flood 2014): a bijection that leaves no trace of the
/// order of labels, so that neighbouring seeds and neighbouring pixels are unrelated.
pub(crate) fn scramble(label: u64) -> u64 {
    let mut z = label.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn neighbouring_names_give_different_streams() {
        let mut first_numbers = HashSet::new();
        for seed in 0..20 {
            for pixel in 0..20 {
                for sample in 0..20 {
                    let number = Random::for_sample(seed, pixel, sample).number();
                    first_numbers.insert(number.to_bits());
                }
            }
        }
        assert_eq!(first_numbers.len(), 20 * 20 * 20);
    }

    #[test]
    fn the_same_name_gives_the_same_numbers() {
        assert_eq!(Random::for_ray(3, 4).point(), Random::for_ray(3, 4).point());
    }
}
