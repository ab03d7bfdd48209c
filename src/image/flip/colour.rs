//! The colour spaces of FLIP: one to blur in, one to compare in. All for the white of D65.

use super::approximate::{cube_root, power};

/// Linear RGB to CIE XYZ, exactly as the primaries of Rec. 709 give it.
const TO_XYZ: [[f32; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];
/// Its inverse.
const TO_RGB: [[f32; 3]; 3] = [
    [3.241_003_3, -1.537_399, -0.498_615_86],
    [-0.969_224_33, 1.875_930_1, 0.041_554_224],
    [0.055_639_423, -0.204_011_2, 1.057_149],
];
/// XYZ of white.
const WHITE: [f32; 3] = [0.950_428_54, 1.0, 1.088_900_4];
/// Differences of colour are raised to this power before they are mapped to [0, 1].
const EXPONENT: f32 = 0.7;
/// Differences up to this share of the largest are mapped to errors up to [`KNEE_ERROR`].
const KNEE: f32 = 0.4;
const KNEE_ERROR: f32 = 0.95;

/// A colour that is linear in light, with axes as the eye has them: lightness Y, red against green
/// Cx, and blue against yellow Cz.
pub(super) type Opponent = [f32; 3];

#[inline(always)]
fn transform(matrix: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    let row = |r: [f32; 3]| r[0] * x + r[1] * y + r[2] * z;
    [row(matrix[0]), row(matrix[1]), row(matrix[2])]
}

#[inline(always)]
fn relative_xyz(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = transform(&TO_XYZ, rgb);
    [x / WHITE[0], y / WHITE[1], z / WHITE[2]]
}

#[inline(always)]
pub(super) fn opponent(rgb: [f32; 3]) -> Opponent {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The grey in [0, 1] that features are looked for in, of a Y.
#[inline(always)]
pub(super) fn grey(y: f32) -> f32 {
    (y + 16.0) / 116.0
}

/// Linear RGB, clipped to what a screen can show.
#[inline(always)]
fn shown([lightness, red_green, blue_yellow]: Opponent) -> [f32; 3] {
    let y = grey(lightness);
    let (x, z) = (y + red_green / 500.0, y - blue_yellow / 200.0);
    let [r, g, b] = transform(&TO_RGB, [x * WHITE[0], y * WHITE[1], z * WHITE[2]]);
    [r.clamp(0.0, 1.0), g.clamp(0.0, 1.0), b.clamp(0.0, 1.0)]
}

/// CIE L*a*b*, its colourfulness times lightness: in the dark, the eye sees less colour (Hunt).
#[inline(always)]
fn even_steps(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = relative_xyz(rgb);
    let (x, y, z) = (lightness_step(x), lightness_step(y), lightness_step(z));
    let lightness = 116.0 * y - 16.0;
    let colourful = 0.01 * lightness;
    [lightness, colourful * 500.0 * (x - y), colourful * 200.0 * (y - z)]
}

#[inline(always)]
fn lightness_step(t: f32) -> f32 {
    const EDGE: f32 = 6.0 / 29.0;
    let straight = t / (3.0 * EDGE * EDGE) + 4.0 / 29.0;
    // Both are computed and one is chosen: no branch, so that pixels go together.
    let root = cube_root(t.max(EDGE * EDGE * EDGE));
    if t > EDGE * EDGE * EDGE { root } else { straight }
}

/// The distance that is city-block between lightness and colour, Euclidean within colour (HyAB).
#[inline(always)]
fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [red_green, blue_yellow] = [a[1] - b[1], a[2] - b[2]];
    (a[0] - b[0]).abs() + (red_green * red_green + blue_yellow * blue_yellow).sqrt()
}

/// How differences of colour become errors in [0, 1].
#[derive(Clone, Copy)]
pub(super) struct ColourError {
    largest: f32,
}

impl ColourError {
    /// Of all colours, green and blue are farthest apart.
    pub(super) fn new() -> Self {
        let farthest = distance(even_steps([0.0, 1.0, 0.0]), even_steps([0.0, 0.0, 1.0]));
        Self { largest: power(farthest, EXPONENT) }
    }

    /// The error of a blurred colour.
    #[inline(always)]
    pub(super) fn between(self, image: Opponent, reference: Opponent) -> f32 {
        let far = power(distance(even_steps(shown(image)), even_steps(shown(reference))), EXPONENT);
        let knee = KNEE * self.largest;
        let small = far * (KNEE_ERROR / knee);
        let large = KNEE_ERROR + (far - knee) / (self.largest - knee) * (1.0 - KNEE_ERROR);
        if far < knee { small } else { large }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_comes_back_from_where_it_is_blurred() {
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.2, 0.7, 0.1], [0.9, 0.05, 0.6]] {
            for (found, expected) in shown(opponent(rgb)).into_iter().zip(rgb) {
                assert!((found - expected).abs() < 1e-5, "{rgb:?}");
            }
        }
    }

    #[test]
    fn white_and_black_have_the_lightness_of_the_standard() {
        let [white, red_green, blue_yellow] = even_steps([1.0; 3]);
        assert!((white - 100.0).abs() < 1e-3 && red_green.abs().max(blue_yellow.abs()) < 1e-2);
        assert!(even_steps([0.0; 3])[0].abs() < 1e-4);
    }

    #[test]
    fn equal_colours_have_no_error_and_green_against_blue_has_all() {
        let error = ColourError::new();
        let [green, blue] = [opponent([0.0, 1.0, 0.0]), opponent([0.0, 0.0, 1.0])];
        assert_eq!(error.between(green, green), 0.0);
        assert!((error.between(green, blue) - 1.0).abs() < 1e-4);
    }
}
