//! Random numbers that are nobody's accident: a stream for each (suite seed, case, stage, run,
//! purpose).
//!
//! Seeds are derived by SHA-256 over the labels, so they are the same on every machine and a change
//! of one label changes everything. Seeds are never edited; [`Seed::SUITE`] changes with the
//! suite's version.

use glam::{DVec2, DVec3};
use rand::{Rng, SeedableRng};
use sha2::{Digest, Sha256};

/// The generator of the harness.
pub type Stream = rand_pcg::Pcg64Mcg;

/// A seed that other seeds are derived from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seed(pub u64);

impl Seed {
    /// The seed of the default suite. A new version of the suite draws new numbers.
    pub const SUITE: Seed = Seed(1);

    /// The seed for one label below this one: `seed.child("stage").child(2)`.
    pub fn child(self, label: impl std::fmt::Display) -> Seed {
        let mut hasher = Sha256::new();
        hasher.update(self.0.to_le_bytes());
        hasher.update(label.to_string().as_bytes());
        let digest = hasher.finalize();
        let mut first = [0; 8];
        first.copy_from_slice(&digest[..8]);
        Seed(u64::from_le_bytes(first))
    }

    /// The stream of random numbers of this seed.
    pub fn stream(self) -> Stream {
        Stream::seed_from_u64(self.0)
    }
}

/// A number in [0, 1).
pub fn uniform(stream: &mut Stream) -> f64 {
    // 53 bits: every multiple of 2⁻⁵³ below 1.
    (stream.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A whole number below `count`, which is not 0.
pub(crate) fn below(count: usize, stream: &mut Stream) -> usize {
    (uniform(stream) * count as f64) as usize
}

/// Fisher and Yates, as Durstenfeld has it (1964).
pub(crate) fn shuffle<T>(elements: &mut [T], stream: &mut Stream) {
    for last in (1..elements.len()).rev() {
        elements.swap(last, below(last + 1, stream));
    }
}

/// A point of the unit square.
pub(crate) fn in_square(stream: &mut Stream) -> DVec2 {
    DVec2::from_array(std::array::from_fn(|_| uniform(stream)))
}

/// A point of the unit cube.
pub(crate) fn in_cube(stream: &mut Stream) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| uniform(stream)))
}
