//! Images as they travel in a page: half floats, deflated, in base64. Its viewer unpacks them with what every browser has.

use crate::image::Image;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use half::f16;
use serde::Serialize;
use std::io::Write;

/// An image times 2^-`exponent`: planes of red, green and blue, the high bytes of all before the low ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Packed {
    data: String,
    exponent: i32,
}

/// The power of two below which the largest value is brought: twice this is the largest half float.
const LARGEST: i32 = 15;
/// Between two values of 6 bits there are so many half floats.
const ROUGH: u16 = 16;
/// Single precision can be scaled so far.
const EXPONENTS: std::ops::RangeInclusive<i32> = -100..=100;

impl Packed {
    pub(super) fn of(image: &Image) -> Self {
        Self::with(image, |code| code)
    }

    /// To 6 bits, a third lighter: for what is noisier than that.
    pub(super) fn roughly(image: &Image) -> Self {
        let rounded = |bits: u16| (bits + ROUGH / 2) / ROUGH * ROUGH;
        Self::with(image, |code| match code.is_finite() {
            true => f16::from_bits(rounded(code.to_bits())),
            false => code,
        })
    }

    fn with(image: &Image, rounded: impl Fn(f16) -> f16) -> Self {
        let exponent = exponent_of(image);
        let scale = (-f64::from(exponent)).exp2();
        let code = |value: f32| rounded(f16::from_f64(f64::from(value) * scale)).to_be_bytes();
        let planes = (0..3).flat_map(|channel| image.pixels.iter().map(move |p| code(p[channel])));
        let (high, low): (Vec<u8>, Vec<u8>) = planes.map(|[high, low]| (high, low)).unzip();
        let data = BASE64_STANDARD.encode(deflated(&[high, low].concat()));
        Self { data, exponent }
    }
}

/// How far an image is scaled, so that the digits of its darkest pixels survive too.
fn exponent_of(image: &Image) -> i32 {
    let values = image.pixels.as_flattened().iter().filter(|value| value.is_finite());
    let largest = values.fold(0.0_f32, |largest, value| largest.max(value.abs()));
    if largest == 0.0 {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of a number is small")]
    let exponent = f64::from(largest).log2().ceil() as i32;
    (exponent - LARGEST).clamp(*EXPONENTS.start(), *EXPONENTS.end())
}

/// The image that a viewer has: rounded to half floats.
#[cfg(test)]
pub(super) fn as_unpacked(image: &Image) -> Image {
    let scale = f64::from(exponent_of(image)).exp2();
    let rounded = |value: f32| f16::from_f64(f64::from(value) / scale).to_f64() * scale;
    #[expect(clippy::cast_possible_truncation, reason = "eleven bits times a power of two")]
    let image = image.map(|pixel| pixel.map(|value| rounded(value) as f32));
    image
}

/// Cannot fail: memory takes all bytes.
fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    /// What the viewer makes of it.
    fn unpacked(packed: &Packed) -> Vec<f64> {
        let deflated = BASE64_STANDARD.decode(&packed.data).unwrap();
        let mut bytes = Vec::new();
        flate2::read::ZlibDecoder::new(&deflated[..]).read_to_end(&mut bytes).unwrap();
        let (high, low) = bytes.split_at(bytes.len() / 2);
        let value = |(high, low): (&u8, &u8)| f16::from_be_bytes([*high, *low]).to_f64();
        let scale = f64::from(packed.exponent).exp2();
        high.iter().zip(low).map(|code| value(code) * scale).collect()
    }

    #[test]
    fn values_keep_eleven_bits_however_large_or_small_and_nan_stays() {
        for size in [1e-30_f32, 1e-6, 1.0, 3e7] {
            let image =
                Image::from_fn(3, 2, |x, y| [size, size * (0.1 + x as f32), y as f32 * -size]);
            let planes = (0..3).flat_map(|channel| image.pixels.iter().map(move |p| p[channel]));
            for (value, unpacked) in planes.zip(unpacked(&Packed::of(&image))) {
                assert!((unpacked - f64::from(value)).abs() <= 5e-4 * f64::from(value.abs()));
            }
        }
        let image = Image::from_fn(3, 2, |x, y| [0.1 + x as f32, -(y as f32), 0.7]);
        let planes = (0..3).flat_map(|channel| image.pixels.iter().map(move |p| p[channel]));
        for (value, unpacked) in planes.zip(unpacked(&Packed::roughly(&image))) {
            assert!((unpacked - f64::from(value)).abs() <= 8e-3 * f64::from(value.abs()));
        }
        let broken = unpacked(&Packed::of(&Image::new(1, 1, [f32::NAN, f32::INFINITY, 0.0])));
        assert!(broken[0].is_nan() && broken[1] == f64::INFINITY && broken[2] == 0.0);
    }
}
