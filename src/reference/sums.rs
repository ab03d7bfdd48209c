//! Sums over passes, from which mean and standard error follow: exact, so that passes may be added
//! in any order and in any parts.

use crate::image::Image;
use bytemuck::{Pod, Zeroable};

/// Precision of a stored mean, as in OpenEXR's 24-bit floats. The rest is noise, and would fill half the file.
const MEAN_BITS: u32 = 16;

/// The largest error of rounding a mean, relative to it: 1.5e-5.
const MEAN_ROUNDING: f64 = 1.0 / (1u64 << MEAN_BITS) as f64;

/// Precision of a stored standard error, which 64 passes know to 9 %.
const ERROR_BITS: u32 = 6;

/// A sum in two doubles: 106 bits, which hold every sum of squares of single precision whose
/// summands are less than 2⁵⁰ apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// D. E. Knuth, The Art of Computer Programming 2, 4.2.2, theorem B: nothing is lost.
    fn add(&mut self, value: f64) {
        let sum = self.high + value;
        let virtual_part = sum - self.high;
        let lost = (self.high - (sum - virtual_part)) + (value - virtual_part);
        let low = self.low + lost;
        self.high = sum + low;
        self.low = low - (self.high - sum);
    }
}

/// Σ x and Σ x² of one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Moments {
    sum: Double,
    squares: Double,
}

/// The sums of the passes taken in so far, pixel by pixel and channel by channel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sums {
    width: usize,
    passes: u32,
    moments: Vec<[Moments; 3]>,
}

/// A share of the values, from the smallest.
#[derive(Clone, Copy)]
pub(super) enum Rank {
    /// Half of them.
    Middle,
    /// 99 of 100.
    High,
}

impl Sums {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { width, passes: 0, moments: vec![[Moments::default(); 3]; width * height] }
    }

    /// Takes in one pass of the same size.
    pub(crate) fn push(&mut self, pass: &Image) {
        self.passes += 1;
        for (moments, pixel) in self.moments.iter_mut().zip(&pass.pixels) {
            for (channel, value) in moments.iter_mut().zip(pixel) {
                let value = f64::from(*value);
                channel.sum.add(value);
                // 24 bits times 24 bits: exact.
                channel.squares.add(value * value);
            }
        }
    }

    /// Takes in the passes of other sums of the same size.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.passes += other.passes;
        let pairs = self.moments.as_flattened_mut().iter_mut().zip(other.moments.as_flattened());
        for (moments, other) in pairs {
            for (mine, theirs) in
                [(&mut moments.sum, other.sum), (&mut moments.squares, other.squares)]
            {
                mine.add(theirs.high);
                mine.add(theirs.low);
            }
        }
    }

    /// All sums, as they are kept in a file.
    pub(crate) fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self.moments.as_flattened())
    }

    /// Sums of so many passes from a file; none if it has another length.
    pub(crate) fn from_bytes(
        [width, height]: [usize; 2],
        passes: u32,
        bytes: &[u8],
    ) -> Option<Self> {
        let mut sums = Self { passes, ..Self::new(width, height) };
        let kept: &mut [u8] = bytemuck::cast_slice_mut(sums.moments.as_flattened_mut());
        if kept.len() != bytes.len() {
            return None;
        }
        kept.copy_from_slice(bytes);
        Some(sums)
    }

    pub(crate) fn mean(&self) -> Image {
        self.mean_rounded(MEAN_BITS)
    }

    /// The mean, rounded to so many bits of precision.
    pub(crate) fn mean_rounded(&self, bits: u32) -> Image {
        self.image(|moments| rounded(self.mean_of(moments) as f32, bits))
    }

    /// The standard error of the mean as it is stored: that of the passes, and that of rounding.
    pub(crate) fn standard_error(&self) -> Image {
        self.image(|moments| {
            let rounding = self.mean_of(moments) * MEAN_ROUNDING / 3f64.sqrt();
            rounded(self.error_of(moments).hypot(rounding) as f32, ERROR_BITS)
        })
    }

    /// Standard error over mean at a rank among all values that are not black. 0 if all are.
    pub(crate) fn relative_error(&self, rank: Rank) -> f64 {
        let lit = self.moments.as_flattened().iter().filter(|moments| moments.sum.high > 0.0);
        let mut errors: Vec<f64> =
            lit.map(|moments| self.error_of(moments) / self.mean_of(moments)).collect();
        errors.sort_unstable_by(f64::total_cmp);
        let index = match rank {
            Rank::Middle => errors.len() / 2,
            Rank::High => errors.len() * 99 / 100,
        };
        errors.get(index).copied().unwrap_or(0.0)
    }

    fn mean_of(&self, moments: &Moments) -> f64 {
        moments.sum.high / f64::from(self.passes)
    }

    fn error_of(&self, moments: &Moments) -> f64 {
        let passes = f64::from(self.passes);
        // What cancels, 1e-16 of the squares, is far below the rounding of the mean.
        let deviations = moments.squares.high - moments.sum.high * moments.sum.high / passes;
        (deviations.max(0.0) / (passes - 1.0) / passes).sqrt()
    }

    fn image(&self, value: impl Fn(&Moments) -> f32) -> Image {
        let pixels = self.moments.iter().map(|pixel| pixel.each_ref().map(&value)).collect();
        Image { width: self.width, height: self.moments.len() / self.width, pixels }
    }
}

/// The nearest number with `precision` bits, ties to even.
fn rounded(value: f32, precision: u32) -> f32 {
    let dropped = f32::MANTISSA_DIGITS - precision;
    let (bits, half) = (value.to_bits(), 1 << (dropped - 1));
    f32::from_bits((bits + half - 1 + (bits >> dropped & 1)) & !(2 * half - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_that_of_the_mean() {
        let mut sums = Sums::new(1, 1);
        for value in [1.0, 2.0, 3.0, 6.0] {
            sums.push(&Image::new(1, 1, [value, 0.0, 0.5]));
        }
        assert_eq!(sums.mean().pixels[0], [3.0, 0.0, 0.5]);
        let [spread, black, constant] = sums.standard_error().pixels[0];
        // Squared deviations 4, 1, 0 and 9 over 3, over 4 passes.
        let expected = (14.0f32 / 12.0).sqrt();
        assert!((spread - expected).abs() < expected / 64.0);
        assert_eq!(black, 0.0);
        assert!(constant > 4e-6 && constant < 5e-6, "rounding remains: {constant}");
        assert!((sums.relative_error(Rank::High) - (14.0f64 / 12.0).sqrt() / 3.0).abs() < 1e-12);
    }

    #[test]
    fn rounding_keeps_the_bits_it_says() {
        for value in [0.1f32, 1.0 / 3.0, 11.999_999, 1e-20, 0.0] {
            let mean = rounded(value, MEAN_BITS);
            assert!(f64::from((mean - value).abs()) <= f64::from(value) * MEAN_ROUNDING, "{value}");
            assert_eq!(mean.to_bits() & 0xff, 0);
            assert!((rounded(value, ERROR_BITS) - value).abs() <= value / 64.0, "{value}");
        }
        assert_eq!(rounded(1.5, 2), 1.5);
        assert_eq!(rounded(1.75, 2), 2.0, "ties to even");
    }

    #[test]
    fn a_black_picture_has_no_relative_error() {
        let mut sums = Sums::new(2, 2);
        sums.push(&Image::new(2, 2, [0.0; 3]));
        sums.push(&Image::new(2, 2, [0.0; 3]));
        assert_eq!(sums.relative_error(Rank::Middle), 0.0);
    }

    /// A pass of one row, its values up to 2¹⁰ apart.
    fn pass(seed: u32) -> Image {
        Image::from_fn(32, 1, |x, _| {
            let value = (seed * 7919 + x as u32 * 104_729) % 9973;
            [value as f32 / 977.0, 1.0 / (1 + value) as f32, 0.1]
        })
    }

    #[test]
    fn passes_add_up_to_the_same_bits_in_any_order_and_in_any_parts() {
        let sums = |seeds: &mut dyn Iterator<Item = u32>| {
            let mut sums = Sums::new(32, 1);
            seeds.for_each(|seed| sums.push(&pass(seed)));
            sums
        };
        let whole = sums(&mut (0..100));
        assert_eq!(sums(&mut (0..100).rev()), whole);
        let mut parts = sums(&mut (60..100));
        parts.merge(&sums(&mut (0..7)));
        parts.merge(&sums(&mut (7..60)));
        assert_eq!(parts, whole);
        let kept = Sums::from_bytes([32, 1], 100, whole.bytes()).unwrap();
        assert_eq!(kept, whole);
        assert_eq!(Sums::from_bytes([32, 2], 100, whole.bytes()), None);
        let constant = whole.error_of(&whole.moments[0][2]);
        assert!(constant < 1e-9, "{constant}");
    }
}
