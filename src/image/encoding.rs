//! Transfer functions: how linear radiance becomes the codes of an 8-bit image. An exposure, a curve, and
//! how what lies between two codes is rounded.

use super::Image;
use super::png::Picture;
use crate::text::number::figure;
use crate::text::spoken;
use serde::{Deserialize, Serialize};

/// The largest code.
pub(crate) const WHITE: f64 = 255.0;
/// Below this light, the sRGB curve is a line...
const SRGB_TOE: f64 = 0.003_130_8;
/// ...of this slope.
const SRGB_SLOPE: f64 = 12.92;
/// What the sRGB curve takes off its power.
const SRGB_OFFSET: f64 = 0.055;
/// The power that light is the root of in sRGB.
const SRGB_POWER: f64 = 2.4;

/// From linear light to a share of white.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Curve {
    /// Twice the number is twice the light.
    Linear,
    /// The curve of IEC 61966-2-1.
    #[default]
    Srgb,
    /// Light to the power of one over this.
    Gamma(f64),
}

impl Curve {
    /// The share of white that shows this light; light beyond [0, 1] is clipped. NaN stays NaN.
    pub(crate) fn encode(self, light: f64) -> f64 {
        let light = light.clamp(0.0, 1.0);
        match self {
            Self::Linear => light,
            Self::Gamma(gamma) => light.powf(gamma.recip()),
            Self::Srgb if light <= SRGB_TOE => SRGB_SLOPE * light,
            // Of white, rounding would leave a little less than white.
            Self::Srgb if light >= 1.0 => 1.0,
            Self::Srgb => (1.0 + SRGB_OFFSET) * light.powf(SRGB_POWER.recip()) - SRGB_OFFSET,
        }
    }

    /// The light of a share of white.
    pub(crate) fn decode(self, share: f64) -> f64 {
        match self {
            Self::Linear => share,
            Self::Gamma(gamma) => share.powf(gamma),
            Self::Srgb if share <= 0.040_45 => share / SRGB_SLOPE,
            Self::Srgb => ((share + SRGB_OFFSET) / (1.0 + SRGB_OFFSET)).powf(SRGB_POWER),
        }
    }

    /// Share of white that is gained if light grows by a small factor, over the logarithm of that
    /// factor.
    pub(crate) fn slope(self, light: f64) -> f64 {
        let light = light.clamp(0.0, 1.0);
        match self {
            Self::Linear => light,
            Self::Gamma(gamma) => light.powf(gamma.recip()) / gamma,
            Self::Srgb if light <= SRGB_TOE => SRGB_SLOPE * light,
            Self::Srgb => (1.0 + SRGB_OFFSET) / SRGB_POWER * light.powf(SRGB_POWER.recip()),
        }
    }

    /// How strongly the curve is bent around a share of white: minus its second derivative over the
    /// square of its first. Noise of variance v there takes half of this times v from the mean.
    pub(crate) fn bend(self, share: f64) -> f64 {
        match self {
            Self::Linear => 0.0,
            Self::Gamma(gamma) => (gamma - 1.0) / share,
            Self::Srgb if share <= 0.040_45 => 0.0,
            Self::Srgb => (SRGB_POWER - 1.0) / (share + SRGB_OFFSET),
        }
    }
}

impl std::fmt::Display for Curve {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Linear => f.pad("linear"),
            Self::Srgb => f.pad("sRGB"),
            Self::Gamma(gamma) => write!(f, "gamma {gamma}"),
        }
    }
}

spoken! {
    /// What becomes of the fraction of a code.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub(crate) enum Rounding {
        /// The nearest code is taken.
        #[default]
        Nearest = "rounded",
        /// The fraction is dropped: half a code too dark on average.
        Down = "truncated",
    }
}

/// From light to codes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Encoding {
    pub(crate) curve: Curve,
    #[serde(default)]
    pub(crate) rounding: Rounding,
    /// What light is multiplied with before.
    #[serde(default = "unexposed")]
    pub(crate) exposure: f64,
}

impl Default for Encoding {
    fn default() -> Self {
        Self::of(Curve::Srgb)
    }
}

const fn unexposed() -> f64 {
    1.0
}

impl Encoding {
    /// Rounded codes of a curve.
    pub(crate) const fn of(curve: Curve) -> Self {
        Self { curve, rounding: Rounding::Nearest, exposure: 1.0 }
    }

    /// The course's: ⌊255 (√2 L)^(1/2.2)⌋.
    pub(crate) const COURSE: Self = Self {
        curve: Curve::Gamma(2.2),
        rounding: Rounding::Down,
        exposure: std::f64::consts::SQRT_2,
    };

    /// The code of this light; 0 of NaN.
    pub(crate) fn code(self, light: f64) -> u8 {
        // In [0, 256): the cast drops the fraction and cannot overflow.
        (WHITE * self.curve.encode(self.exposure * light) + self.half()) as u8
    }

    /// The least light with this code; between codes, that of the code there would be.
    pub(crate) fn edge(self, code: f64) -> f64 {
        self.curve.decode(((code - self.half()) / WHITE).max(0.0)) / self.exposure
    }

    /// The mean code around this light, were there noise enough to hide the steps.
    pub(crate) fn level(self, light: f64) -> f64 {
        WHITE * self.curve.encode(self.exposure * light) + self.half() - 0.5
    }

    /// Codes gained if light grows by a small factor, over the logarithm of that factor.
    pub(crate) fn slope(self, light: f64) -> f64 {
        WHITE * self.curve.slope(self.exposure * light)
    }

    /// The light in the middle of what gives a code; none of 0.
    pub(crate) fn light(self, code: u8) -> f64 {
        let middle = f64::from(code) + 0.5 - self.half();
        if code == 0 { 0.0 } else { self.curve.decode(middle / WHITE) / self.exposure }
    }

    /// The codes of an image.
    pub(crate) fn picture(self, image: &Image) -> Picture {
        let pixels = image.pixels.iter().map(|pixel| pixel.map(|light| self.code(light.into())));
        Picture { width: image.width, height: image.height, pixels: pixels.collect() }
    }

    fn half(self) -> f64 {
        match self.rounding {
            Rounding::Nearest => 0.5,
            Rounding::Down => 0.0,
        }
    }
}

impl std::fmt::Display for Encoding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {}", self.curve, self.rounding)?;
        if self.exposure == 1.0 {
            Ok(())
        } else {
            write!(f, ", exposed {} times", figure(self.exposure))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [Curve; 4] = [Curve::Linear, Curve::Srgb, Curve::Gamma(2.2), Curve::Gamma(1.8)];

    #[test]
    fn curves_are_undone_and_their_slopes_are_differences() {
        for curve in CURVES {
            for light in [1e-4, 2e-3, 0.02, 0.3, 0.97] {
                assert!((curve.decode(curve.encode(light)) / light - 1.0).abs() < 1e-6, "{curve}");
                let (up, down) = (curve.encode(light * 1.0001), curve.encode(light / 1.0001));
                let slope = (up - down) / (2.0 * 1.0001f64.ln());
                assert!((slope / curve.slope(light) - 1.0).abs() < 1e-4, "{curve} at {light}");
            }
        }
    }

    #[test]
    fn the_bend_is_what_noise_takes_from_the_mean() {
        for curve in CURVES {
            for light in [0.02, 0.3, 0.9] {
                let step = 0.001 * light;
                let [low, middle, high] =
                    [light - step, light, light + step].map(|light| curve.encode(light));
                let (lost, variance) = (middle - 0.5 * (low + high), (0.5 * (high - low)).powi(2));
                let bend = 2.0 * lost / variance;
                assert!((bend - curve.bend(middle)).abs() < 1e-3 * (1.0 + bend), "{curve} {light}");
            }
        }
    }

    #[test]
    fn a_code_begins_at_its_edge_and_its_light_lies_inside() {
        let encodings = CURVES.map(Encoding::of);
        for encoding in encodings.into_iter().chain([Encoding::COURSE]) {
            for code in [1u8, 2, 17, 128, 254] {
                let edge = encoding.edge(f64::from(code));
                assert_eq!(encoding.code(edge * (1.0 + 1e-9)), code, "{encoding}");
                assert_eq!(encoding.code(edge * (1.0 - 1e-9)), code - 1, "{encoding}");
                assert_eq!(encoding.code(encoding.light(code)), code, "{encoding}");
            }
            assert_eq!(encoding.light(0), 0.0);
        }
    }
}
