//! Numbers that are checked as they are read, so that a wrong one is underlined where it stands.

use super::units::{Angle, Colour};
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::PI;
use std::ops::Deref;

/// A point or an edge: three finite numbers.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "[f64; 3]")]
pub(crate) struct Vector(pub(crate) DVec3);

/// A direction of any length but zero, made unit.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "[f64; 3]")]
pub(crate) struct Direction(pub(crate) DVec3);

/// A share of light, in [0, 1] per channel.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Colour")]
pub(crate) struct Reflectance(pub(crate) [f64; 3]);

/// A colour with some light in every channel: what relative errors can be relative to.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Colour")]
pub(crate) struct Lit(pub(crate) [f64; 3]);

/// A direction that keeps its length, which is not zero.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vector")]
pub(crate) struct Arrow(pub(crate) DVec3);

/// The angle of a direction from a normal, in radians: 0 to 180 degrees.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Angle")]
pub(crate) struct Polar(pub(crate) f64);

/// A probability below 1.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(crate) struct Chance(pub(crate) f64);

/// How many times as much: more than 1, finite.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(crate) struct Factor(pub(crate) f64);

/// The first and the last bounce that are added up.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "[Between<0, 1000>; 2]")]
pub(crate) struct Bounces(pub(crate) [u32; 2]);

/// Columns and rows of a small picture.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(from = "[Between<1, 4096>; 2]")]
pub(crate) struct Size(pub(crate) [u32; 2]);

/// A list that is not empty.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "Vec<T>")]
pub(crate) struct Several<T>(Vec<T>);

/// Words that say something.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Words(pub(crate) String);

/// A length or an index of refraction: above zero, finite.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(crate) struct Positive(pub(crate) f64);

/// An index of refraction that bends light: above zero, finite, not 1.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Positive")]
pub(crate) struct Bending(pub(crate) f64);

/// The width parameter of a microfacet distribution, in (0, 1].
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(crate) struct Roughness(pub(crate) f64);

/// A whole number from `MIN` to `MAX`: generators whose output grows like a power need an end.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub(crate) struct Between<const MIN: u32, const MAX: u32>(pub(crate) u32);

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
        direction.map(Self).ok_or_else(|| "invalid direction: must not be zero".to_owned())
    }
}

impl TryFrom<Colour> for Reflectance {
    type Error = String;

    fn try_from(Colour(share): Colour) -> Result<Self, String> {
        match share.iter().find(|channel| !(0.0..=1.0).contains(*channel)) {
            None => Ok(Self(share)),
            Some(wrong) => {
                Err(format!("invalid reflectance or transmittance {wrong}: must be in [0, 1]"))
            }
        }
    }
}

impl TryFrom<Colour> for Lit {
    type Error = String;

    fn try_from(Colour(colour): Colour) -> Result<Self, String> {
        let is_lit = colour.iter().all(|channel| *channel > 0.0);
        is_lit
            .then_some(Self(colour))
            .ok_or_else(|| "invalid colour: every channel must be above 0".to_owned())
    }
}

impl TryFrom<Vector> for Arrow {
    type Error = String;

    fn try_from(Vector(vector): Vector) -> Result<Self, String> {
        Direction::try_from(vector.to_array()).map(|_| Self(vector))
    }
}

impl TryFrom<Angle> for Polar {
    type Error = String;

    fn try_from(Angle(angle): Angle) -> Result<Self, String> {
        let is_polar = (0.0..=PI).contains(&angle);
        is_polar.then_some(Self(angle)).ok_or_else(|| {
            format!(
                "invalid angle from the normal {}: must be from 0 to 180 deg",
                angle.to_degrees()
            )
        })
    }
}

impl TryFrom<f64> for Chance {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_chance = (0.0..1.0).contains(&number);
        is_chance
            .then_some(Self(number))
            .ok_or_else(|| format!("invalid probability {number}: must be in [0, 1)"))
    }
}

impl TryFrom<f64> for Factor {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_more = number > 1.0 && number.is_finite();
        is_more
            .then_some(Self(number))
            .ok_or_else(|| format!("invalid factor {number}: must be above 1"))
    }
}

impl TryFrom<[Between<0, 1000>; 2]> for Bounces {
    type Error = String;

    fn try_from(bounces: [Between<0, 1000>; 2]) -> Result<Self, String> {
        let [first, last] = bounces.map(|bounce| bounce.0);
        let is_range = first <= last;
        is_range.then_some(Self([first, last])).ok_or_else(|| {
            format!("invalid bounces: the first comes before the last: [{last}, {first}]?")
        })
    }
}

impl From<[Between<1, 4096>; 2]> for Size {
    fn from(size: [Between<1, 4096>; 2]) -> Self {
        Self(size.map(|pixels| pixels.0))
    }
}

impl<T> TryFrom<Vec<T>> for Several<T> {
    type Error = String;

    fn try_from(list: Vec<T>) -> Result<Self, String> {
        if list.is_empty() {
            Err("must not be empty: at least one is needed".to_owned())
        } else {
            Ok(Self(list))
        }
    }
}

impl TryFrom<String> for Words {
    type Error = String;

    fn try_from(words: String) -> Result<Self, String> {
        match words.trim() {
            "" => Err("this is empty".to_owned()),
            _ => Ok(Self(words)),
        }
    }
}

impl<T> Deref for Several<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl TryFrom<f64> for Positive {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_positive = number > 0.0 && number.is_finite();
        is_positive
            .then_some(Self(number))
            .ok_or_else(|| format!("invalid number {number}: must be positive"))
    }
}

impl TryFrom<Positive> for Bending {
    type Error = String;

    fn try_from(Positive(index): Positive) -> Result<Self, String> {
        let problem = "invalid index of refraction 1: a rough dielectric needs a different one";
        (index != 1.0).then_some(Self(index)).ok_or_else(|| problem.to_owned())
    }
}

impl TryFrom<f64> for Roughness {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        let is_valid = number > 0.0 && number <= 1.0;
        is_valid
            .then_some(Self(number))
            .ok_or_else(|| format!("invalid roughness {number}: must be in (0, 1]"))
    }
}

impl<const MIN: u32, const MAX: u32> TryFrom<i64> for Between<MIN, MAX> {
    type Error = String;

    fn try_from(number: i64) -> Result<Self, String> {
        u32::try_from(number)
            .ok()
            .filter(|number| (MIN..=MAX).contains(number))
            .map(Self)
            .ok_or_else(|| {
                format!("invalid count {number}: must be an integer from {MIN} to {MAX}")
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::DeserializeOwned;

    fn refused<T: DeserializeOwned>(value: &str) -> bool {
        toml::Value::deserialize(toml::de::ValueDeserializer::parse(value).unwrap())
            .unwrap()
            .try_into::<T>()
            .is_err()
    }

    #[test]
    fn every_range_ends_where_it_says() {
        assert!(!refused::<Bounces>("[5, 5]") && refused::<Bounces>("[5, 0]"));
        assert!(refused::<Bounces>("[0, 1001]") && refused::<Bounces>("[-1, 0]"));
        assert!(!refused::<Size>("[1, 4096]") && refused::<Size>("[0, 1]"));
        assert!(!refused::<Chance>("0") && refused::<Chance>("1.0") && refused::<Chance>("nan"));
        assert!(!refused::<Factor>("1.5") && refused::<Factor>("1.0") && refused::<Factor>("inf"));
        assert!(!refused::<Polar>("'180 deg'") && refused::<Polar>("'-1 deg'"));
        assert!(!refused::<Lit>("[1, 2, 3]") && refused::<Lit>("[1, 0, 3]"));
        assert!(!refused::<Arrow>("[0, 0, 9]") && refused::<Arrow>("[0, 0, 0]"));
        assert!(!refused::<Several<u32>>("[1]") && refused::<Several<u32>>("[]"));
        assert!(!refused::<Words>("'x'") && refused::<Words>("' '"));
    }
}
