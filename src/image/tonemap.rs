//! Tone mapping: exposure, then the sRGB transfer function. NaN is magenta, so that it
//! is seen.

use super::encoding::{Curve, Encoding};
use super::{Image, luminance, png::Picture};
use rayon::prelude::*;

/// The colour of a pixel that is NaN or infinite.
pub(crate) const NOT_A_NUMBER: [u8; 3] = [255, 0, 255];

/// The share of pixels that the exposure of [`exposure_of`] keeps below white.
const WHITE_PERCENTILE: f64 = 0.95;
/// The linear value those pixels stay below.
const WHITE: f64 = 0.8;

/// Linear light, clipped to [0, 1], to sRGB in [0, 1] (IEC 61966-2-1). NaN stays NaN.
#[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
pub(crate) fn encode_srgb(linear: f32) -> f32 {
    Curve::Srgb.encode(f64::from(linear)) as f32
}

/// The linear light of a share of white in sRGB.
#[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
pub(crate) fn decode_srgb(share: f32) -> f32 {
    Curve::Srgb.decode(f64::from(share)) as f32
}

/// Linear light in [0, 1] to an sRGB code.
pub(crate) fn srgb_code(linear: f32) -> u8 {
    Encoding::of(Curve::Srgb).code(f64::from(linear))
}

/// The image times 2^`stops`, clipped to white.
pub(crate) fn tonemap(image: &Image, stops: f32) -> Picture {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded once, as the report's viewer does"
    )]
    let gain = f64::from(stops).exp2() as f32;
    let shown = |pixel: &[f32; 3]| {
        if !pixel.iter().all(|value| value.is_finite()) {
            NOT_A_NUMBER
        } else {
            pixel.map(|value| srgb_code(gain * value))
        }
    };
    let pixels = image.pixels.iter().map(shown).collect();
    Picture { width: image.width, height: image.height, pixels }
}

/// Stops with which nearly all of an image is bright and not clipped. Use that of the reference
/// for both.
pub(crate) fn exposure_of(image: &Image) -> f32 {
    let mut values: Vec<f64> = image.pixels.par_iter().map(|pixel| luminance(*pixel)).collect();
    values.retain(|value| value.is_finite() && *value > 0.0);
    if values.is_empty() {
        return 0.0;
    }
    let rank = ((WHITE_PERCENTILE * values.len() as f64) as usize).min(values.len() - 1);
    let (_, level, _) = values.select_nth_unstable_by(rank, f64::total_cmp);
    (WHITE / *level).log2() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    // The codes that every sRGB table gives for these.
    #[test]
    fn the_curve_is_srgb() {
        assert_eq!([0.0, 0.0021, 0.2158605, 0.5, 1.0].map(srgb_code), [0, 7, 128, 188, 255]);
        assert_eq!([-1.0, 7.0, f32::INFINITY].map(srgb_code), [0, 255, 255]);
    }

    #[test]
    fn one_stop_doubles_and_nan_is_seen() {
        let shown = |colour, stops| tonemap(&Image::new(1, 1, colour), stops).pixels;
        assert_eq!(shown([0.25; 3], 1.0), shown([0.5; 3], 0.0));
        assert_eq!(shown([0.5, f32::NAN, 0.5], 0.0), [NOT_A_NUMBER]);
    }

    #[test]
    fn the_exposure_brings_a_dim_picture_up_and_survives_a_black_one() {
        let dim = Image::new(8, 8, [0.001; 3]);
        let shown = 0.001 * exposure_of(&dim).exp2();
        assert!((shown - 0.8).abs() < 1e-3);
        assert_eq!(exposure_of(&Image::new(8, 8, [0.0; 3])), 0.0);
        assert_eq!(exposure_of(&Image::new(8, 8, [f32::NAN; 3])), 0.0);
    }
}
