//! What a core is held to: a true mean, and how far from it rounding may take a correct core.

use crate::math::Precision;
use serde::Deserialize;

/// The half width of a null hypothesis, relative to the scale of its claim.
///
/// A mean is never tested against a point: single precision, shadow-ray offsets and accumulation in
/// `f32` move a correct core by parts in ten thousand (Mitsuba's own furnace is off by 2.7e-4), and
/// enough samples would condemn it for that. The field is private so that a band is chosen by name,
/// not typed.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Band(f64);

impl Band {
    /// Nothing to forgive: counts of the harness's own draws.
    #[cfg(test)]
    pub(crate) const NONE: Band = Band(0.0);
    /// Radiance that a renderer has traced, shaded and accumulated.
    pub(crate) const RADIANCE: Band = Band(1e-3);
    /// One evaluation in double precision.
    pub(crate) const DOUBLE_MATH: Band = Band(2e-5);
    /// One evaluation in single precision.
    pub(crate) const SINGLE_MATH: Band = Band(2e-4);
    /// The variance of an estimator: two legitimate ways to write one differ by a few per cent.
    pub(crate) const VARIANCE: Band = Band(0.2);
    /// The logarithm to base 2 of a ratio: twice and half are near enough for whoever decides by it
    /// where to spend samples.
    pub(crate) const FACTOR_OF_TWO: Band = Band(1.0);

    /// How far a picture may be displaced, pixels: what no eye and no float notices.
    pub(crate) const ALIGNMENT: Band = Band(0.01);

    pub(crate) const fn math(precision: Precision) -> Band {
        match precision {
            Precision::Double => Self::DOUBLE_MATH,
            Precision::Single => Self::SINGLE_MATH,
        }
    }

    /// The half width relative to the scale of the claim.
    pub(crate) const fn relative(self) -> f64 {
        self.0
    }
}

/// On which side of the expected value a core may fail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sides {
    /// Too much and too little are both wrong.
    #[default]
    Both,
    /// Only less than expected is wrong.
    AtLeast,
    /// Only more than expected is wrong.
    AtMost,
}

/// One hypothesis of the suite: a mean and what it has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// The true mean, in the unit of what is drawn.
    pub(crate) expected: f64,
    /// What relative errors are relative to, positive. `expected` itself, unless that is a
    /// difference.
    pub(crate) scale: f64,
    /// How far from `expected` a correct core may be, relative to `scale`.
    pub(crate) band: Band,
    /// Standard deviation of *one sample* of a correct core, where theory gives it. Protects a
    /// claim whose estimator meets light less often than once in 10⁴ samples; elsewhere the other
    /// stages measure it.
    pub(crate) null_deviation: Option<f64>,
    pub(crate) sides: Sides,
}

impl Claim {
    /// The mean is `expected`, which is not 0.
    pub(crate) fn value(expected: f64, band: Band) -> Self {
        Self { expected, scale: expected.abs(), band, null_deviation: None, sides: Sides::Both }
    }

    /// The mean of a difference is 0. `scale` is the size of the things subtracted.
    pub(crate) fn difference(scale: f64, band: Band) -> Self {
        Self { expected: 0.0, ..Self::value(scale, band) }
    }

    /// A share of independent yes-or-no samples is `probability`, in (0, 1).
    pub(crate) fn share(probability: f64, band: Band) -> Self {
        let deviation = (probability * (1.0 - probability)).sqrt();
        Self::value(probability, band).with_null_deviation(deviation)
    }

    /// The same claim with the standard deviation of one sample known from theory.
    pub(crate) fn with_null_deviation(self, deviation: f64) -> Self {
        Self { null_deviation: Some(deviation), ..self }
    }

    /// The same claim, forgiving one side.
    pub(crate) fn on_side(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// Half width of the null, in the unit of what is drawn.
    pub(crate) fn band_width(&self) -> f64 {
        self.band.relative() * self.scale
    }

    /// How far a finite mean lies outside the band, with its sign; 0 inside, and on the forgiven
    /// side.
    pub(crate) fn departure(&self, mean: f64) -> f64 {
        let difference = mean - self.expected;
        let outside = (difference.abs() - self.band_width()).max(0.0) * difference.signum();
        match self.sides {
            Sides::Both => outside,
            Sides::AtLeast => outside.min(0.0),
            Sides::AtMost => outside.max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_inside_the_band_does_not_depart() {
        let claim = Claim::value(2.0, Band::RADIANCE);
        assert_eq!(claim.departure(2.0019), 0.0);
        assert!((claim.departure(2.01) - 0.008).abs() < 1e-12);
        assert!((claim.departure(1.99) + 0.008).abs() < 1e-12);
    }

    #[test]
    fn a_forgiven_side_does_not_depart() {
        let claim = Claim::value(1.0, Band::NONE);
        assert_eq!(claim.on_side(Sides::AtLeast).departure(3.0), 0.0);
        assert_eq!(claim.on_side(Sides::AtLeast).departure(0.5), -0.5);
        assert_eq!(claim.on_side(Sides::AtMost).departure(0.5), 0.0);
    }

    #[test]
    fn the_band_of_a_difference_is_relative_to_what_is_subtracted() {
        let claim = Claim::difference(40.0, Band::RADIANCE);
        assert_eq!(claim.departure(0.039), 0.0);
        assert!(claim.departure(0.041) > 0.0);
    }
}
