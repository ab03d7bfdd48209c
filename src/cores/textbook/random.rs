//! Random numbers: every path has its own stream, named by what it is for and never by which thread
//! draws it.

use super::change::Change;
use crate::math::rng::{Stream, uniform};
use glam::DVec2;
use rand::SeedableRng;
use std::time::SystemTime;

/// The random numbers of one path.
#[derive(Debug)]
pub struct Random {
    stream: Stream,
    /// [`Change::OtherGenerator`].
    counter: u64,
    change: Change,
}

impl Random {
    /// For ray number `ray` of one call.
    pub fn for_ray(seed: u64, ray: usize) -> Self {
        Self::named(&[seed, ray as u64])
    }

    /// For camera sample `sample` of pixel number `pixel`.
    pub fn for_sample(seed: u64, pixel: usize, sample: u32) -> Self {
        Self::named(&[seed, pixel as u64, u64::from(sample)])
    }

    fn named(labels: &[u64]) -> Self {
        let name = labels.iter().fold(0, |name, label| scramble(name ^ label));
        Self { stream: Stream::seed_from_u64(name), counter: name, change: Change::None }
    }

    /// Draws as `change` does.
    pub fn changed(self, change: Change) -> Self {
        Self { change, ..self }
    }

    /// A number in [0, 1).
    pub fn number(&mut self) -> f64 {
        match self.change {
            Change::OtherGenerator => {
                self.counter = self.counter.wrapping_add(1);
                (scramble(self.counter) >> 11) as f64 * 0.5 * f64::EPSILON
            }
            Change::ExtraDimensions => {
                uniform(&mut self.stream);
                uniform(&mut self.stream)
            }
            _ => uniform(&mut self.stream),
        }
    }

    /// A point of the unit square.
    pub fn point(&mut self) -> DVec2 {
        let x = self.number();
        DVec2::new(x, self.number())
    }
}

/// The seed that numbers are drawn by.
pub fn seed(seed: u64, change: Change) -> u64 {
    match change {
        Change::SeedIgnored => 0,
        Change::SeedOfClock => {
            let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
            now.map_or(0, |now| now.as_nanos() as u64)
        }
        _ => seed,
    }
}

/// One step of SplitMix64 (Steele, Lea and Flood 2014): a bijection that leaves no trace of the
/// order of labels, so that neighbouring seeds and neighbouring pixels are unrelated.
fn scramble(label: u64) -> u64 {
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
