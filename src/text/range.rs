//! Numbers that are checked as they are read, so that a wrong one is underlined where it stands.

use super::units::{Angle, Colour};
use glam::DVec3;
use serde::{Deserialize, Deserializer, de::Error};
use std::f64::consts::PI;
use std::ops::Deref;

/// `Name(Inner), given: Read => value, else complaint`: an `Inner` made of what is read, if there is a value.
macro_rules! checked {
    ($($(#[$meta:meta])* $name:ident($inner:ty), $given:ident: $read:ty => $value:expr, else $wrong:expr;)*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $name(pub(crate) $inner);

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let $given = <$read>::deserialize(deserializer)?;
                let value: Option<$inner> = $value;
                value.map(Self).ok_or_else(|| D::Error::custom($wrong))
            }
        }
    )*};
}

checked! {
    /// A point or an edge: three finite numbers.
    #[derive(Default)]
    Vector(DVec3), numbers: [f64; 3] => Some(DVec3::from_array(numbers)).filter(|vector| vector.is_finite()),
        else "a vector needs finite numbers";

    /// A direction of any length but zero, made unit.
    Direction(DVec3), numbers: [f64; 3] => DVec3::from_array(numbers).try_normalize(), else NO_DIRECTION;

    /// A direction that keeps its length, which is not zero.
    Arrow(DVec3), vector: Vector => vector.0.try_normalize().map(|_| vector.0), else NO_DIRECTION;

    /// A share of light, in [0, 1] per channel.
    Reflectance([f64; 3]), share: Colour => beyond_one(share).is_none().then_some(share.0),
        else format!(
            "invalid reflectance or transmittance {}: must be in [0, 1]",
            beyond_one(share).unwrap_or_default()
        );

    /// A colour with some light in every channel: what relative errors can be relative to.
    Lit([f64; 3]), colour: Colour => colour.0.iter().all(|channel| *channel > 0.0).then_some(colour.0),
        else "invalid colour: every channel must be above 0";

    /// The angle of a direction from a normal, in radians: 0 to 180 degrees.
    Polar(f64), angle: Angle => (0.0..=PI).contains(&angle.0).then_some(angle.0),
        else format!("invalid angle from the normal {}: must be from 0 to 180 deg", angle.0.to_degrees());

    /// A probability below 1.
    Chance(f64), number: f64 => (0.0..1.0).contains(&number).then_some(number),
        else format!("invalid probability {number}: must be in [0, 1)");

    /// How many times as much: more than 1, finite.
    Factor(f64), number: f64 => (number > 1.0 && number.is_finite()).then_some(number),
        else format!("invalid factor {number}: must be above 1");

    /// A length or an index of refraction: above zero, finite.
    Positive(f64), number: f64 => (number > 0.0 && number.is_finite()).then_some(number),
        else format!("invalid number {number}: must be positive");

    /// An index of refraction that bends light: above zero, finite, not 1.
    Bending(f64), index: Positive => (index.0 != 1.0).then_some(index.0),
        else "invalid index of refraction 1: a rough dielectric needs a different one";

    /// The width parameter of a microfacet distribution, in (0, 1].
    Roughness(f64), number: f64 => (number > 0.0 && number <= 1.0).then_some(number),
        else format!("invalid roughness {number}: must be in (0, 1]");

    /// The first and the last bounce that are added up.
    Bounces([u32; 2]), bounces: [Between<0, 1000>; 2] =>
        (bounces[0].0 <= bounces[1].0).then_some(bounces.map(|bounce| bounce.0)),
        else format!(
            "invalid bounces: the first comes before the last: [{}, {}]?", bounces[1].0, bounces[0].0
        );

    /// Columns and rows of a small picture.
    Size([u32; 2]), size: [Between<1, 4096>; 2] => Some(size.map(|pixels| pixels.0)),
        else "`Between` has complained already";
}

const NO_DIRECTION: &str = "invalid direction: must not be zero";

/// The first channel that is more than all of the light.
fn beyond_one(Colour(share): Colour) -> Option<f64> {
    share.into_iter().find(|channel| !(0.0..=1.0).contains(channel))
}

/// A list that is not empty.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "Vec<T>")]
pub(crate) struct Several<T>(Vec<T>);

impl<T> TryFrom<Vec<T>> for Several<T> {
    type Error = &'static str;

    fn try_from(list: Vec<T>) -> Result<Self, &'static str> {
        match list.is_empty() {
            true => Err("must not be empty: at least one is needed"),
            false => Ok(Self(list)),
        }
    }
}

impl<T> Deref for Several<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

/// Words that say something.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Words(pub(crate) String);

impl TryFrom<String> for Words {
    type Error = &'static str;

    fn try_from(words: String) -> Result<Self, &'static str> {
        if words.trim().is_empty() { Err("this is empty") } else { Ok(Self(words)) }
    }
}

/// A whole number from `MIN` to `MAX`: generators whose output grows like a power need an end.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub(crate) struct Between<const MIN: u32, const MAX: u32>(pub(crate) u32);

impl<const MIN: u32, const MAX: u32> TryFrom<i64> for Between<MIN, MAX> {
    type Error = String;

    fn try_from(number: i64) -> Result<Self, String> {
        let wrong = || format!("invalid count {number}: must be an integer from {MIN} to {MAX}");
        let found = u32::try_from(number).ok().filter(|number| (MIN..=MAX).contains(number));
        found.map(Self).ok_or_else(wrong)
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
