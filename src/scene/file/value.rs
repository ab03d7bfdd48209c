//! Numbers that are checked as they are read, so that a wrong one is underlined where it stands.

use crate::scene::Rgb;
use crate::text::Colour;
use glam::DVec3;
use serde::Deserialize;

/// A point or an edge: three finite numbers.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "[f64; 3]")]
pub(super) struct Vector(pub DVec3);

/// A direction of any length but zero, made unit.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "[f64; 3]")]
pub(super) struct Direction(pub DVec3);

/// A share of light, in [0, 1] per channel.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Colour")]
pub(super) struct Reflectance(pub Rgb);

/// Radiance, intensity or irradiance: not negative, finite.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Colour")]
pub(super) struct Power(pub Rgb);

/// A length or an index of refraction: above zero, finite.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Positive(pub f64);

/// An index of refraction that bends light: above zero, finite, not 1.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Positive")]
pub(super) struct Bending(pub f64);

/// The width parameter of a microfacet distribution, in (0, 1].
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Roughness(pub f64);

/// A whole number from `MIN` to `MAX`: generators whose output grows like a power need an end.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub(super) struct Between<const MIN: u32, const MAX: u32>(pub u32);

impl TryFrom<[f64; 3]> for Vector {
    type Error = String;

    fn try_from(numbers: [f64; 3]) -> Result<Self, String> {
        let vector = DVec3::from_array(numbers);
        vector.is_finite().then_some(Self(vector)).ok_or("a vector needs finite numbers".to_owned())
    }
}

impl TryFrom<[f64; 3]> for Direction {
    type Error = String;

    fn try_from(numbers: [f64; 3]) -> Result<Self, String> {
        let direction = DVec3::from_array(numbers).try_normalize();
        direction.map(Self).ok_or_else(|| format!("{numbers:?} has no direction"))
    }
}

impl TryFrom<Colour> for Reflectance {
    type Error = String;

    fn try_from(Colour(share): Colour) -> Result<Self, String> {
        match share.iter().find(|channel| !(0.0..=1.0).contains(*channel)) {
            None => Ok(Self(share)),
            Some(wrong) => Err(format!("a share of light lies in [0, 1], and {wrong} does not")),
        }
    }
}

impl TryFrom<Colour> for Power {
    type Error = String;

    fn try_from(Colour(power): Colour) -> Result<Self, String> {
        match power.iter().find(|channel| !(0.0..=f64::MAX).contains(*channel)) {
            None => Ok(Self(power)),
            Some(wrong) => Err(format!("light is neither negative nor infinite, and {wrong} is")),
        }
    }
}

impl TryFrom<f64> for Positive {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_positive = number > 0.0 && number.is_finite();
        is_positive.then_some(Self(number)).ok_or_else(|| format!("{number} is not above zero"))
    }
}

impl TryFrom<Positive> for Bending {
    type Error = String;

    fn try_from(Positive(index): Positive) -> Result<Self, String> {
        let problem = "an index of 1 bends no light, and rough facets of it have no density";
        (index != 1.0).then_some(Self(index)).ok_or_else(|| problem.to_owned())
    }
}

impl TryFrom<f64> for Roughness {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_valid = number > 0.0 && number <= 1.0;
        is_valid
            .then_some(Self(number))
            .ok_or_else(|| format!("roughness lies in (0, 1], and {number} does not"))
    }
}

impl<const MIN: u32, const MAX: u32> TryFrom<i64> for Between<MIN, MAX> {
    type Error = String;

    fn try_from(number: i64) -> Result<Self, String> {
        u32::try_from(number)
            .ok()
            .filter(|number| (MIN..=MAX).contains(number))
            .map(Self)
            .ok_or_else(|| format!("{number} is not a whole number from {MIN} to {MAX}"))
    }
}
