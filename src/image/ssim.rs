//! Structural similarity (Wang et al., "Image Quality Assessment: From Error Visibility to
//! Structural Similarity", 2004): windows are alike if brightness, contrast and pattern are.

use super::filter::{PaddedRow, along, down, gaussian};
use super::pair::{Pair, Plane};
use rayon::prelude::*;

/// Standard deviation of the window, pixels.
const DEVIATION: f64 = 1.5;
/// The window ends this far from its centre.
pub(super) const RADIUS: usize = 5;
/// (0.01)² and (0.03)² of white: what keeps flat dark windows from dividing by nothing.
const STABILISERS: [f64; 2] = [1e-4, 9e-4];
/// Taken off every value: variances of numbers around zero lose fewer digits in single precision.
const MIDDLE: f32 = 0.5;

/// The mean over windows of how alike both are in brightness, contrast and pattern, as a screen shows them: of
/// codes the mean over channels, of radiance in grey.
pub(super) fn structural_similarity(pair: &Pair<'_>) -> f64 {
    mean_of_planes(pair, |image, reference| similarity(image, reference).whole)
}

/// The mean over the planes of a pair as it is shown.
pub(super) fn mean_of_planes(pair: &Pair<'_>, alike: impl Fn(&Plane, &Plane) -> f64) -> f64 {
    let planes = pair.shown();
    planes.iter().map(|[image, reference]| alike(image, reference)).sum::<f64>()
        / planes.len() as f64
}

/// How alike two images are, the mean over windows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Similarity {
    /// In brightness, contrast and pattern.
    pub(super) whole: f64,
    /// In contrast and pattern alone.
    pub(super) pattern: f64,
}

/// Compares the windows around all pixels whose window is inside the image; in an image that is
/// smaller than a window, around all, as if its border went on.
pub(super) fn similarity(image: &Plane, reference: &Plane) -> Similarity {
    let (width, height) = (image.width, image.height);
    let margin = if width.min(height) > 2 * RADIUS { RADIUS } else { 0 };
    let planes = Moments::of(image, reference);
    let weights = gaussian(DEVIATION, RADIUS);
    let rows = (margin..height - margin).into_par_iter();
    let of_row = |scratch: &mut Scratch, y: usize| {
        scratch.blur(&planes, &weights, y);
        scratch.sums(margin..width - margin)
    };
    let sums: Vec<[f64; 2]> = rows.map_init(|| Scratch::new(width), of_row).collect();
    let windows = ((width - 2 * margin) * (height - 2 * margin)) as f64;
    let mean = |i: usize| sums.iter().map(|sum| sum[i]).sum::<f64>() / windows;
    Similarity { whole: mean(0), pattern: mean(1) }
}

/// Both images less [`MIDDLE`], their squares and their product: their blurs are the moments of
/// the windows.
struct Moments([Plane; 5]);

impl Moments {
    fn of(a: &Plane, b: &Plane) -> Self {
        let each = |value: &(dyn Fn(f32, f32) -> f32 + Sync)| {
            let pairs = a.values.par_iter().zip(&b.values);
            let values = pairs.map(|(a, b)| value(a - MIDDLE, b - MIDDLE)).collect();
            Plane { values, ..*a }
        };
        Self([
            each(&|a, _| a),
            each(&|_, b| b),
            each(&|a, _| a * a),
            each(&|_, b| b * b),
            each(&|a, b| a * b),
        ])
    }
}

/// Rows that one thread works in.
struct Scratch {
    padded: PaddedRow,
    means: [Vec<f32>; 5],
}

impl Scratch {
    fn new(width: usize) -> Self {
        let means = std::array::from_fn(|_| vec![0.0; width]);
        Self { padded: PaddedRow::new(width, RADIUS), means }
    }

    /// The moments of the windows around row `y`.
    fn blur(&mut self, planes: &Moments, weights: &[f32], y: usize) {
        for (plane, mean) in planes.0.iter().zip(&mut self.means) {
            let neighbour = |i: usize| (y + i).saturating_sub(RADIUS).min(plane.height - 1);
            let rows: [&[f32]; 2 * RADIUS + 1] = std::array::from_fn(|i| plane.row(neighbour(i)));
            down(weights, &rows, self.padded.inside_mut());
            self.padded.repeat_ends();
            along(weights, &self.padded, mean);
        }
    }

    fn sums(&self, columns: std::ops::Range<usize>) -> [f64; 2] {
        let [a, b, aa, bb, ab] = &self.means;
        let mut sums = [0.0; 2];
        for x in columns {
            let moments = [a[x], b[x], aa[x], bb[x], ab[x]].map(f64::from);
            let [brightness, pattern] = likeness(moments);
            sums[0] += brightness * pattern;
            sums[1] += pattern;
        }
        sums
    }
}

/// Likeness in brightness, and in contrast and pattern, of two windows with these [`Moments`].
fn likeness([a, b, aa, bb, ab]: [f64; 5]) -> [f64; 2] {
    let [of_means, of_patterns] = STABILISERS;
    let (variances, covariance) = (aa - a * a + bb - b * b, ab - a * b);
    let [a, b] = [a, b].map(|mean| mean + f64::from(MIDDLE));
    let brightness = (2.0 * a * b + of_means) / (a * a + b * b + of_means);
    [brightness, (2.0 * covariance + of_patterns) / (variances + of_patterns)]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Two smooth images with noise from a formula, the same as in tests/fixtures/ssim/make.py.
    pub(crate) fn plane(width: usize, height: usize, shift: f64) -> Plane {
        let value = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let noise = (12.9898 * x + 78.233 * y + 37.7 * shift).sin() * 437.58;
            let smooth = 0.5 + 0.3 * ((x + shift) / 7.0).sin() * (y / 5.0).cos();
            (smooth + 0.1 * shift * (noise - noise.floor() - 0.5)) as f32
        };
        Plane { width, height, values: (0..width * height).map(value).collect() }
    }

    #[test]
    fn it_is_the_number_of_scikit_image() {
        // Written by tests/fixtures/ssim/make.py.
        for (size, expected) in
            [([64, 48], 0.867_204_523_7), ([97, 31], 0.863_334_116_5), ([11, 11], 0.880_358_151_6)]
        {
            let [width, height] = size;
            let (image, reference) = (plane(width, height, 1.0), plane(width, height, 0.0));
            let found = similarity(&image, &reference).whole;
            assert!((found - expected).abs() < 1e-6, "{size:?}: {found}, {expected}");
        }
    }

    #[test]
    fn a_picture_smaller_than_a_window_is_compared_too() {
        let found = similarity(&plane(4, 3, 1.0), &plane(4, 3, 0.0)).whole;
        assert!(found > -1.0 && found < 1.0);
    }

    #[test]
    fn a_brighter_picture_of_the_same_pattern_differs_in_brightness_alone() {
        let reference = plane(32, 32, 0.0);
        let mut image = reference.clone();
        image.values.iter_mut().for_each(|value| *value += 0.2);
        let found = similarity(&image, &reference);
        assert!((found.pattern - 1.0).abs() < 1e-5, "{found:?}");
        assert!(found.whole < 0.99, "{found:?}");
    }
}
