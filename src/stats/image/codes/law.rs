//! Which codes a noisy pixel gets in an 8-bit picture.

use crate::image::encoding::{Encoding, WHITE};
use statrs::function::erf::erfc;
use statrs::function::gamma::{gamma_ur, ln_gamma};

/// Beyond this shape a Gamma variable is normal after a cube root, to 1e-5 (Wilson and Hilferty
/// 1931).
const LARGE_SHAPE: f64 = 1000.0;
/// Probabilities below this are none.
const NOTHING: f64 = 1e-9;
/// Relative deviations above the mean beyond which no value lies.
const FAR: f64 = 12.0;

/// The law of a pixel's value: the mean of its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PixelLaw {
    pub(crate) mean: f64,
    /// Standard deviation between pictures.
    pub(crate) deviation: f64,
}

/// What can be said of a pixel's code.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CodeLaw {
    pub(crate) mean: f64,
    pub(crate) deviation: f64,
    /// Codes gained if all light grows by a small factor, over the logarithm of that factor.
    pub(crate) slope: f64,
}

impl PixelLaw {
    pub(crate) fn codes(self, encoding: Encoding) -> CodeLaw {
        if !(self.deviation > 0.0 && self.mean > 0.0) {
            let mean = f64::from(encoding.code(self.mean));
            let slope = if mean < WHITE { encoding.slope(self.mean) } else { 0.0 };
            return CodeLaw { mean, deviation: 0.0, slope };
        }
        let noise = encoding.slope(self.mean) * self.deviation / self.mean;
        let sums = self.sums(encoding, (0.5 * noise).floor().clamp(1.0, 16.0));
        let deviation = (sums.square - sums.mean * sums.mean).max(0.0).sqrt();
        // Where noise does not reach the next step, the steps themselves would be taken for it.
        let smooth = encoding.slope(self.mean) * (1.0 - self.clipped(encoding));
        let slope = if noise < 0.5 { smooth } else { sums.slope };
        CodeLaw { mean: sums.mean, deviation, slope }
    }

    /// The probability of the largest code.
    pub(crate) fn clipped(self, encoding: Encoding) -> f64 {
        if self.deviation > 0.0 && self.mean > 0.0 {
            return self.at_least(encoding.edge(WHITE));
        }
        f64::from(u8::from(f64::from(encoding.code(self.mean)) == WHITE))
    }

    /// Mean, mean square and slope of the code: Σ P(code ≥ j), Σ (2j − 1) P(code ≥ j), and what
    /// the first gains. Where noise hides the steps, `stride` of them are taken at their middle;
    /// what that leaves, by the formula of Euler and Maclaurin, is of the ends alone.
    fn sums(self, encoding: Encoding, stride: f64) -> Sums {
        let brightest = self.mean + FAR * self.deviation;
        let mut code = f64::from(encoding.code(brightest));
        let mut sums = Sums::default();
        if code == WHITE {
            sums.add_end(self, encoding, stride);
        }
        while code > 0.0 {
            let width = if code >= stride { stride } else { 1.0 };
            let middle = code - 0.5 * (width - 1.0);
            let light = encoding.edge(middle);
            let probability = self.at_least(light);
            if probability > 1.0 - NOTHING {
                break;
            }
            sums.mean += width * probability;
            sums.square += width * (2.0 * middle - 1.0) * probability;
            sums.slope += width * self.pdf_of_log(light);
            code -= width;
        }
        // All codes below are certain.
        sums.mean += code;
        sums.square += code * code - (stride * stride - 1.0) / 12.0;
        sums
    }

    /// 1/cv²: how many exponential variables would be as noisy.
    fn shape(self) -> f64 {
        (self.mean / self.deviation).powi(2)
    }

    fn at_least(self, light: f64) -> f64 {
        let (shape, relative) = (self.shape(), light / self.mean);
        if shape > LARGE_SHAPE {
            let spread = 1.0 / (9.0 * shape);
            let normal = (relative.cbrt() - 1.0 + spread) / spread.sqrt();
            return 0.5 * erfc(normal * std::f64::consts::FRAC_1_SQRT_2);
        }
        if light > 0.0 { gamma_ur(shape, shape * relative) } else { 1.0 }
    }

    /// The pdf of the logarithm of the value.
    fn pdf_of_log(self, light: f64) -> f64 {
        let shape = self.shape();
        let scaled = shape * light / self.mean;
        (shape * scaled.ln() - scaled - ln_gamma(shape)).exp()
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    mean: f64,
    square: f64,
    slope: f64,
}

impl Sums {
    /// What taking steps together leaves of the end at white, where the probabilities break off.
    fn add_end(&mut self, law: PixelLaw, encoding: Encoding, stride: f64) {
        let end = WHITE + 0.5;
        let light = encoding.edge(end);
        let falls = law.pdf_of_log(light) / encoding.slope(light);
        let left = (stride * stride - 1.0) / 24.0;
        self.mean -= left * falls;
        self.square += left * (2.0 * law.at_least(light) - (2.0 * end - 1.0) * falls);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::encoding::{Curve, Rounding};
    use crate::math::rng::{Seed, uniform};
    use crate::stats::Moments;

    const GAMMA: Encoding = Encoding::of(Curve::Gamma(2.2));

    /// 64 samples of relative deviation 1.
    fn of(mean: f64) -> PixelLaw {
        PixelLaw { mean, deviation: mean / 8.0 }
    }

    // With scipy.stats.gamma, code by code.
    #[test]
    fn codes_have_the_means_that_the_design_computed() {
        for (mean, code, deviation, clipped) in [
            (0.005, 22.897, 1.334, 0.0),
            (0.02, 42.997, 2.463, 0.0),
            (0.1, 89.362, 5.091, 0.0),
            (0.3, 147.240, 8.381, 0.0),
            (0.7, 216.412, 12.301, 0.0012),
            (0.95, 245.600, 10.247, 0.3371),
            (1.1, 252.912, 5.117, 0.7710),
            (2.0, 255.0, 0.003, 1.0),
        ] {
            let law = of(mean).codes(GAMMA);
            assert!((law.mean - code).abs() < 6e-4, "{mean}: {law:?}");
            assert!((law.deviation - deviation).abs() < 2e-3, "{mean}: {law:?}");
            assert!((of(mean).clipped(GAMMA) - clipped).abs() < 6e-5, "{mean}: {law:?}");
        }
    }

    #[test]
    fn steps_may_be_taken_together_where_noise_hides_them() {
        for encoding in [GAMMA, Encoding::of(Curve::Srgb), Encoding::COURSE] {
            for mean in [0.004, 0.1, 0.5, 0.95, 1.2] {
                for noise in [0.03, 0.1, 0.3, 0.5] {
                    let law = PixelLaw { mean, deviation: noise * mean };
                    let (found, one_by_one) = (law.codes(encoding), law.sums(encoding, 1.0));
                    let mean = one_by_one.mean;
                    let deviation = (one_by_one.square - mean * mean).max(0.0).sqrt();
                    let off = [found.mean - mean, found.deviation - deviation];
                    assert!(off.iter().all(|off| off.abs() < 5e-3), "{encoding} {law:?}: {off:?}");
                }
            }
        }
    }

    #[test]
    fn the_slope_is_a_difference() {
        for mean in [0.02, 0.3, 0.95] {
            for noise in [0.05, 0.125, 0.5] {
                let law = |mean: f64| PixelLaw { mean, deviation: noise * mean }.codes(GAMMA);
                let step = 1.001f64;
                let slope = (law(mean * step).mean - law(mean / step).mean) / (2.0 * step.ln());
                let found = law(mean).slope;
                assert!((found / slope - 1.0).abs() < 0.02, "{mean} {noise}: {found} {slope}");
            }
        }
    }

    #[test]
    fn truncation_takes_half_a_code() {
        let down = Encoding { rounding: Rounding::Down, ..GAMMA };
        for mean in [0.02, 0.1, 0.3] {
            let lost = of(mean).codes(GAMMA).mean - of(mean).codes(down).mean;
            assert!((lost - 0.5).abs() < 1e-3, "{mean}: {lost}");
        }
    }

    #[test]
    fn large_shapes_and_small_ones_meet() {
        let mean = 0.4;
        for code in [100.0, 150.0, 200.0] {
            let edge = GAMMA.edge(code);
            let at = |shape: f64| PixelLaw { mean, deviation: mean / shape.sqrt() }.at_least(edge);
            assert!((at(0.9999 * LARGE_SHAPE) - at(1.0001 * LARGE_SHAPE)).abs() < 1e-4, "{code}");
        }
    }

    #[test]
    fn without_noise_the_code_is_certain() {
        let silent = |mean| PixelLaw { mean, deviation: 0.0 };
        let law = silent(0.3).codes(GAMMA);
        assert_eq!((law.mean, law.deviation, silent(0.3).clipped(GAMMA)), (148.0, 0.0, 0.0));
        let black = silent(0.0).codes(GAMMA);
        assert_eq!((black.mean, black.slope), (0.0, 0.0));
        let white = silent(7.0).codes(GAMMA);
        assert_eq!((white.mean, white.slope, silent(7.0).clipped(GAMMA)), (255.0, 0.0, 1.0));
    }

    #[test]
    fn other_laws_of_samples_have_nearly_the_same_codes() {
        // 64 samples that are 2 with probability ½: relative deviation 1, and far from Gamma.
        let mut stream = Seed(3).stream();
        let pixel = |_| {
            let hits = (0..64).filter(|_| uniform(&mut stream) < 0.5).count();
            f64::from(GAMMA.code(0.3 * hits as f64 / 32.0))
        };
        let codes: Moments = (0..40_000).map(pixel).collect();
        let shift = of(0.3).codes(GAMMA).mean - GAMMA.level(0.3);
        let off = codes.mean() - of(0.3).codes(GAMMA).mean;
        assert!(off.abs() < 0.2 * shift.abs() + 4.0 * codes.standard_error(), "{off} of {shift}");
    }
}
