//! False colour for numbers: a signed scale for "too dark, too bright", and one for magnitudes.
//!
//! Both are ordered in lightness, so that they survive printing in grey and colour-blind readers.

use super::png::Picture;
use super::tonemap::NOT_A_NUMBER;

/// Blue for too little, pale grey for right, red for too much: ColorBrewer's RdBu, seven classes,
/// reversed.
const SIGNED: [u32; 7] = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];

/// Dark for none, bright for much: nine stops of matplotlib's viridis.
const MAGNITUDE: [u32; 9] =
    [0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725];

/// A scale from numbers to colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// From −`limit` to +`limit`.
    Signed {
        /// The magnitude that gets the strongest colour.
        limit: f64,
    },
    /// From 0 to `limit`.
    Magnitude {
        /// The value that gets the brightest colour.
        limit: f64,
    },
}

impl Scale {
    /// The colour of a value; magenta for NaN, the end of the scale beyond it.
    pub(crate) fn colour(self, value: f64) -> [u8; 3] {
        let (stops, position): (&[_], _) = match self {
            Scale::Signed { limit } => (&SIGNED, 0.5 + 0.5 * value / limit),
            Scale::Magnitude { limit } => (&MAGNITUDE, value / limit),
        };
        if position.is_nan() { NOT_A_NUMBER } else { between(stops, position) }
    }

    /// The value that the strongest colour stands for.
    pub(crate) fn limit(self) -> f64 {
        match self {
            Scale::Signed { limit } | Scale::Magnitude { limit } => limit,
        }
    }
}

/// Linear between neighbouring stops; `position` in [0, 1] over all of them.
fn between(stops: &[u32], position: f64) -> [u8; 3] {
    let along = position.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let left = (along as usize).min(stops.len() - 2);
    let part = along - left as f64;
    std::array::from_fn(|i| {
        let [from, to] = [left, left + 1].map(|stop| f64::from(stops[stop].to_be_bytes()[1 + i]));
        // Between two codes: rounding cannot leave [0, 255].
        (from + part * (to - from)).round() as u8
    })
}

/// An image of `values`, row-major from the top left in rows of `width`; each becomes `magnify` by
/// `magnify` pixels.
pub(crate) fn heatmap(values: &[f64], width: usize, scale: Scale, magnify: usize) -> Picture {
    let height = values.len() / width.max(1);
    let rows = 0..height * magnify;
    let pixel = |x: usize, y: usize| scale.colour(values[y / magnify * width + x / magnify]);
    let pixels = rows.flat_map(|y| (0..width * magnify).map(move |x| pixel(x, y))).collect();
    Picture { width: width * magnify, height: height * magnify, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_dark_is_blue_too_bright_is_red_and_nan_is_seen() {
        let scale = Scale::Signed { limit: 3.0 };
        let [red, _, blue] = scale.colour(-3.0);
        assert!(blue > red);
        let [red, _, blue] = scale.colour(99.0);
        assert!(red > blue);
        assert_eq!(scale.colour(0.0), [247, 247, 247]);
        assert_eq!(scale.colour(f64::NAN), NOT_A_NUMBER);
    }

    #[test]
    fn larger_magnitudes_are_lighter() {
        let scale = Scale::Magnitude { limit: 1.0 };
        let lightness = |value| {
            let [red, green, blue] = scale.colour(value).map(f64::from);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        let steps: Vec<f64> = (0..=50).map(|i| lightness(f64::from(i) / 50.0)).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn a_magnified_map_keeps_its_layout() {
        let picture = heatmap(&[0.0, 1.0, 2.0, 3.0], 2, Scale::Magnitude { limit: 3.0 }, 2);
        assert_eq!((picture.width, picture.height), (4, 4));
        assert_eq!(picture.pixels[0], [68, 1, 84]);
        assert_eq!(picture.pixels[15], [253, 231, 37]);
        assert_eq!(picture.pixels[3], picture.pixels[6]);
    }
}
