//! Exposures that show an image of high dynamic range from its highlights to its shadows.

use crate::image::{Image, luminance};

/// Coefficients of Narkowicz's fit to the ACES film curve, (x (a x + b)) / (x (c x + d) + e), with
/// its exposure of 0.6 taken into them.
const A: f32 = 0.6 * 0.6 * 2.51;
const B: f32 = 0.6 * 0.03;
const C: f32 = 0.6 * 0.6 * 2.43;
const D: f32 = 0.6 * 0.59;
const E: f32 = 0.14;
/// What the film curve gives the brightest pixel at the first exposure, and the middle one at the
/// last.
const SHOWN_BRIGHT: f32 = 0.85;
/// Brighter than this, every pixel is white; and squares of larger numbers would be infinite.
const WHITE: f32 = 1e6;

/// The film curve, clipped to [0, 1].
#[inline(always)]
pub(super) fn tone_map(value: f32) -> f32 {
    let x = value.clamp(0.0, WHITE);
    let shown = (x * (A * x + B)) / (x * (C * x + D) + E);
    if shown < 1.0 { shown } else { 1.0 }
}

/// What the film curve makes [`SHOWN_BRIGHT`] of: the positive root of a quadratic equation.
fn shown_bright() -> f32 {
    let t = SHOWN_BRIGHT;
    let (a, b, c) = (A - t * C, B - t * D, -t * E);
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
}

/// Exposures in stops, about one apart: from the one that shows the brightest pixel of `reference`
/// to the one that shows the middle one.
pub(super) fn exposures(reference: &Image) -> Vec<f32> {
    let [brightest, middle] = brightest_and_middle(reference);
    let [first, last] = [brightest, middle].map(|level| (shown_bright() / level).log2());
    let count = (last - first).ceil().max(2.0) as usize;
    let step = (last - first) / (count - 1) as f32;
    (0..count).map(|i| first + i as f32 * step).collect()
}

/// The largest and the middle luminance of the pixels that are finite; 1 of a black image. Where
/// more than half of the image is black, the middle of the rest.
fn brightest_and_middle(reference: &Image) -> [f32; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
    let levels = reference.pixels.iter().map(|pixel| luminance(*pixel) as f32);
    let mut levels: Vec<f32> = levels.filter(|level| level.is_finite()).collect();
    let mut middle = middle_of(&mut levels);
    if middle <= 0.0 {
        levels.retain(|level| *level > 0.0);
        middle = middle_of(&mut levels);
    }
    let brightest = levels.iter().copied().fold(0.0, f32::max);
    if middle > 0.0 { [brightest, middle] } else { [1.0; 2] }
}

/// The upper median; 0 of none.
fn middle_of(levels: &mut [f32]) -> f32 {
    if levels.is_empty() {
        return 0.0;
    }
    let (_, middle, _) = levels.select_nth_unstable_by(levels.len() / 2, f32::total_cmp);
    *middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_show_the_brightest_and_the_middle_pixel_alike() {
        let image = Image::from_fn(9, 1, |x, _| [0.01 * 4f32.powi(x as i32); 3]);
        let exposures = exposures(&image);
        let shown = |stops: f32, x: usize| tone_map(stops.exp2() * image.pixels[x][0]);
        assert_eq!(exposures.len(), 8);
        assert!((shown(exposures[0], 8) - 0.85).abs() < 1e-4);
        assert!((shown(exposures[7], 4) - 0.85).abs() < 1e-4);
    }

    #[test]
    fn a_black_picture_and_one_with_a_single_light_have_exposures_too() {
        let mut image = Image::new(8, 8, [0.0; 3]);
        assert!(exposures(&image).iter().all(|stops| stops.is_finite()));
        image.pixels[5] = [3.0; 3];
        image.pixels[6] = [f32::NAN; 3];
        assert!(exposures(&image).iter().all(|stops| stops.is_finite()));
    }

    #[test]
    fn the_film_curve_ends_at_white_whatever_the_light() {
        assert_eq!([0.0, -1.0, 1e3, 1e30, f32::INFINITY].map(tone_map), [0.0, 0.0, 1.0, 1.0, 1.0]);
    }
}
