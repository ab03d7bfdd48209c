//! Mean and standard error over passes, in double precision.

use crate::image::Image;
use crate::stats::Moments;

/// Precision of a stored mean, as in OpenEXR's 24-bit floats. The rest is noise, and would fill
/// half the file.
const MEAN_BITS: u32 = 16;

/// The largest error of rounding a mean, relative to it: 1.5e-5.
const MEAN_ROUNDING: f64 = 1.0 / (1u64 << MEAN_BITS) as f64;

/// Precision of a stored standard error, which 64 passes know to 9 %.
const ERROR_BITS: u32 = 6;

/// The passes taken in so far, pixel by pixel and channel by channel.
pub(super) struct Average {
    width: usize,
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

impl Average {
    /// No passes yet.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, moments: vec![[Moments::default(); 3]; width * height] }
    }

    /// Takes in one pass of the same size.
    pub fn push(&mut self, pass: &Image) {
        for (moments, pixel) in self.moments.iter_mut().zip(&pass.pixels) {
            for (channel, value) in moments.iter_mut().zip(pixel) {
                channel.push(f64::from(*value));
            }
        }
    }

    /// The mean, rounded to 16 bits of precision.
    pub fn mean(&self) -> Image {
        self.image(|moments| rounded(moments.mean() as f32, MEAN_BITS))
    }

    /// The standard error of the mean as it is stored: that of the passes, and that of rounding.
    pub fn standard_error(&self) -> Image {
        self.image(|moments| {
            let rounding = moments.mean() * MEAN_ROUNDING / 3f64.sqrt();
            rounded(moments.standard_error().hypot(rounding) as f32, ERROR_BITS)
        })
    }

    /// Standard error over mean at a rank among all values that are not black. 0 if all are.
    pub fn relative_error(&self, rank: Rank) -> f64 {
        let lit = self.moments.as_flattened().iter().filter(|moments| moments.mean() > 0.0);
        let mut errors: Vec<f64> =
            lit.map(|moments| moments.standard_error() / moments.mean()).collect();
        errors.sort_unstable_by(f64::total_cmp);
        let index = match rank {
            Rank::Middle => errors.len() / 2,
            Rank::High => errors.len() * 99 / 100,
        };
        errors.get(index).copied().unwrap_or(0.0)
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
        let mut average = Average::new(1, 1);
        for value in [1.0, 2.0, 3.0, 6.0] {
            average.push(&Image::new(1, 1, [value, 0.0, 0.5]));
        }
        assert_eq!(average.mean().pixels[0], [3.0, 0.0, 0.5]);
        let [spread, black, constant] = average.standard_error().pixels[0];
        // Squared deviations 4, 1, 0 and 9 over 3, over 4 passes.
        let expected = (14.0f32 / 12.0).sqrt();
        assert!((spread - expected).abs() < expected / 64.0);
        assert_eq!(black, 0.0);
        assert!(constant > 4e-6 && constant < 5e-6, "rounding remains: {constant}");
        assert!((average.relative_error(Rank::High) - (14.0f64 / 12.0).sqrt() / 3.0).abs() < 1e-12);
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
        let mut average = Average::new(2, 2);
        average.push(&Image::new(2, 2, [0.0; 3]));
        average.push(&Image::new(2, 2, [0.0; 3]));
        assert_eq!(average.relative_error(Rank::Middle), 0.0);
    }
}
