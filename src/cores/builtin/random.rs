//! Random numbers: one stream for each (seed, element, sample), so that the answer does not depend on which
//! thread draws it, or when.
//!
//! The generator is SplitMix64 (Steele, Lea and Flood 2014): a counter and a mixing function. Two streams of
//! an image overlap with probability about 2⁻⁶⁴ times their length, which no statistic can see.

use glam::DVec2;

/// The increment of the counter: 2⁶⁴ divided by the golden ratio, made odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

#[derive(Clone, Debug)]
pub(crate) struct Stream {
    counter: u64,
}

impl Stream {
    /// The stream of one sample of one element (a pixel, a ray) under one seed.
    pub(crate) fn new(seed: u64, element: u64, sample: u64) -> Self {
        let keyed = mix(seed.wrapping_add(STEP)) ^ element;
        let counter = mix(mix(keyed.wrapping_add(STEP)) ^ sample);
        Self { counter }
    }

    fn bits(&mut self) -> u64 {
        self.counter = self.counter.wrapping_add(STEP);
        mix(self.counter)
    }

    /// A multiple of 2⁻³² in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        halves(self.bits())[0]
    }

    /// A point of the unit square, of multiples of 2⁻³².
    pub(crate) fn point(&mut self) -> DVec2 {
        DVec2::from_array(halves(self.bits()))
    }
}

/// The two halves of some bits as numbers in [0, 1).
fn halves(bits: u64) -> [f64; 2] {
    const UNIT: f64 = 1.0 / 4_294_967_296.0;
    let bytes = bits.to_le_bytes();
    let half =
        |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    [f64::from(half(4)) * UNIT, f64::from(half(0)) * UNIT]
}

/// Stafford's variant 13 of the 64-bit finaliser of MurmurHash3, as SplitMix64 has it.
fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stay_below_one() {
        assert!(halves(u64::MAX).iter().all(|&number| number < 1.0));
        assert_eq!(halves(0), [0.0, 0.0]);
    }

    #[test]
    fn every_part_of_the_key_changes_the_stream() {
        let first = |seed, element, sample| Stream::new(seed, element, sample).bits();
        let drawn = [first(0, 0, 0), first(1, 0, 0), first(0, 1, 0), first(0, 0, 1)];
        for (index, bits) in drawn.iter().enumerate() {
            assert!(!drawn[..index].contains(bits), "stream {index} repeats an earlier one");
        }
    }

    #[test]
    fn neighbouring_streams_are_uncorrelated() {
        let count = 100_000_u32;
        let product = |element| {
            let here = Stream::new(7, element, 0).unit() - 0.5;
            let next = Stream::new(7, element + 1, 0).unit() - 0.5;
            12.0 * here * next
        };
        let correlation = (0..u64::from(count)).map(product).sum::<f64>() / f64::from(count);
        assert!(correlation.abs() < 7.0 / f64::from(count).sqrt(), "{correlation}");
    }
}
