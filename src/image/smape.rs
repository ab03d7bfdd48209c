//! Symmetric mean absolute percentage error.

use super::metric::Metric;
use super::pair::Pair;

/// Keeps two black pixels from dividing nothing by nothing.
const REGULARISER: f64 = 1e-2;

/// Mean over pixels and channels of |a − b| / (|a| + |b| + 0.01), from 0 to 1.
pub(super) struct SymmetricRelative;

impl Metric for SymmetricRelative {
    fn name(&self) -> &'static str {
        "SMAPE"
    }

    fn meaning(&self) -> &'static str {
        "difference relative to the sum of both, from 0 to 1; too dark and too bright weigh alike"
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        let relative = |a: f32, b: f32| {
            let (a, b) = (f64::from(a), f64::from(b));
            (a - b).abs() / (a.abs() + b.abs() + REGULARISER)
        };
        let pixel = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| relative(a[i], b[i])).sum::<f64>();
        pair.mean(pixel) / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;

    #[test]
    fn half_and_double_are_equally_far() {
        let grey = Image::new(4, 4, [1.0; 3]);
        let measure = |level| {
            let image = Image::new(4, 4, [level; 3]);
            SymmetricRelative.measure(&Pair::new(&image, &grey).unwrap())
        };
        // 0.5 / 1.51 and 1 / 3.01
        assert!((measure(0.5) - 0.331_125_8).abs() < 1e-6);
        assert!((measure(2.0) - 0.332_225_9).abs() < 1e-6);
    }
}
