//! What the code of one channel of one pixel should be, and how well that can be known.

use super::law::PixelLaw;
use crate::image::encoding::Encoding;
use crate::stats::Band;

/// Relative deviation of a pixel between pictures above which its codes say nothing.
pub(super) const TOO_NOISY: f64 = 0.5;
/// Probability of the largest code above which a pixel counts as clipped.
const CLIPPED: f64 = 0.5;
/// Variance of what rounding leaves of a fraction.
const ROUNDING: f64 = 1.0 / 12.0;
/// Standard errors of the reference, and factors of the noise, that clipping forgives.
const CLIPPING_SLACK: (f64, [f64; 2]) = (6.0, [1.0 / 1.5, 1.5]);
/// The noise of codes is believed to this factor when it is asked whether it hides the steps.
const HALF: f64 = 0.5;

/// One channel of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Channel {
    pub(super) standing: Standing,
    /// Mean code; 0 if it is not compared.
    pub(super) expected: f64,
    /// Codes for a small relative gain of light.
    pub(super) slope: f64,
    /// Error of `expected`, independent between pixels.
    pub(super) error: f64,
    /// Error of `expected`, the same way in all pixels at worst.
    pub(super) slack: f64,
    /// The least probability of the largest code that a correct core can have.
    pub(super) clipped: f64,
}

/// What a channel is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Standing {
    /// Its code.
    Compared,
    /// Only whether it is clipped too seldom.
    Clipped,
    /// Nothing.
    #[default]
    Unknown,
}

/// How noisy a pixel is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Standard deviation of its codes.
    pub(super) codes: f64,
    /// The same of its light, as its codes have it.
    pub(super) own: f64,
    /// Degrees of freedom of that.
    pub(super) freedom: f64,
    /// Standard deviation of its light, as the noise of the reference has it.
    pub(super) foretold: f64,
    /// Relative deviation of light in a typical pixel: clipped codes do not show their own.
    pub(super) typical: f64,
}

/// The share of what noise takes from the mean that is not known, for a relative deviation: the
/// variance is believed to a fifth, and the skewness of the mean may lie anywhere between none and
/// three times that of a Gamma variable. The third term of the mean of a root is cv² times the
/// second for Gamma, so that this is ±2 cv² of it.
pub(super) fn believed(noise: f64) -> f64 {
    Band::VARIANCE.relative() + 2.0 * noise * noise
}

impl Channel {
    /// A channel of which the reference says mean and standard error.
    pub(super) fn new(mean: f64, error: f64, noise: Noise, encoding: Encoding) -> Self {
        if mean == 0.0 && error == 0.0 {
            // Where there is no light, every picture is black.
            return Self { standing: Standing::Compared, ..Self::default() };
        }
        let deviation = noise.own.max(noise.foretold);
        if !(mean > 0.0 && deviation <= TOO_NOISY * mean) {
            return Self::default();
        }
        if (PixelLaw { mean, deviation }).clipped(encoding) > CLIPPED {
            let deviation = deviation.max(noise.typical * mean);
            return Self::of_clipped(least_clipped(mean, error, deviation, encoding));
        }
        Self::compared(mean, error, noise, encoding)
    }

    fn of_clipped(least: f64) -> Self {
        let standing = if least > CLIPPED { Standing::Clipped } else { Standing::Unknown };
        Self { standing, clipped: least, ..Self::default() }
    }

    fn compared(mean: f64, error: f64, noise: Noise, encoding: Encoding) -> Self {
        let law = |mean| PixelLaw { mean, deviation: noise.own }.codes(encoding);
        let found = law(mean);
        let shift = (found.mean - encoding.level(mean)).abs();
        let of_noise = (2.0 / noise.freedom).sqrt() * shift;
        // Codes that the noise would have if it were half as large as it seems.
        let spread = HALF * encoding.slope(mean) * noise.own / mean;
        let steps = 0.5 * (-2.0 * (std::f64::consts::PI * spread).powi(2)).exp();
        let of_reference = found.slope * error / mean;
        let slack = match noise.codes > 0.0 {
            true => believed(noise.own / mean) * shift + steps,
            false => {
                let band = Band::RADIANCE.relative();
                law(mean * (1.0 + band)).mean - law(mean * (1.0 - band)).mean
            }
        };
        Self {
            standing: Standing::Compared,
            expected: found.mean,
            slope: found.slope,
            error: of_reference.hypot(of_noise).hypot(steps),
            slack,
            clipped: 0.0,
        }
    }
}

/// The deviation of light behind that of codes, clipping and all.
pub(super) fn deviation_behind(mean: f64, codes: f64, encoding: Encoding) -> f64 {
    // Rounding adds the variance of a fraction, if noise reaches over it.
    let noise = |codes: f64| (codes * codes - ROUNDING).max(0.0).sqrt();
    let (wanted, most) = (noise(codes), 2.0 * TOO_NOISY * mean);
    let mut deviation = (wanted * mean / encoding.slope(mean)).min(most);
    if wanted < 1.0 {
        return deviation;
    }
    for _ in 0..8 {
        let found = noise(PixelLaw { mean, deviation }.codes(encoding).deviation);
        let factor = wanted / found;
        deviation = (deviation * factor).min(most);
        if (factor - 1.0).abs() < 0.02 {
            break;
        }
    }
    deviation
}

/// The least probability of the largest code, whatever the reference's error and the noise.
fn least_clipped(mean: f64, error: f64, deviation: f64, encoding: Encoding) -> f64 {
    let (sigmas, factors) = CLIPPING_SLACK;
    let mean = mean * (1.0 - Band::RADIANCE.relative()) - sigmas * error;
    let clipped = |factor: f64| PixelLaw { mean, deviation: factor * deviation }.clipped(encoding);
    factors.map(clipped).into_iter().fold(1.0, f64::min)
}
