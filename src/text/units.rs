//! Values with their unit inside: `"45 deg"`, `"1 %"`, `"400 k paths"`, and colours.

use super::suggestion::listed;
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

/// An angle, in radians. Written `"45 deg"` or `"0.8 rad"`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Angle(pub(crate) f64);

/// A share of one, more than nothing and less than all. Written `"1 %"`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Percent(pub(crate) f64);

/// How many, from 1 to [`Count::MOST`]. Written `4096`, `"400 k"` or `"2 M paths"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Count(pub(crate) u64);

/// Linear RGB, not negative and finite. Written as one number for grey, or as three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour(pub(crate) [f64; 3]);

/// What may be counted: a noun after a [`Count`] is read aloud and means nothing.
const COUNTABLE: [&str; 9] =
    ["directions", "pairs", "paths", "pixels", "points", "rays", "samples", "streams", "triangles"];

/// A number and the words after it.
fn number_and_words(text: &str) -> Option<(f64, Vec<&str>)> {
    let is_number = |c: char| c.is_ascii_digit() || "+-._eE".contains(c);
    let end = text.find(|c| !is_number(c)).unwrap_or(text.len());
    let number: f64 = text[..end].replace('_', "").parse().ok()?;
    number.is_finite().then(|| (number, text[end..].split_whitespace().collect()))
}

impl FromStr for Angle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match number_and_words(text) {
            Some((number, words)) if words == ["deg"] => Ok(Self(number.to_radians())),
            Some((number, words)) if words == ["rad"] => Ok(Self(number)),
            _ => Err(format!("`{text}` is not {}", Self::EXPECTED)),
        }
    }
}

impl FromStr for Percent {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match number_and_words(text) {
            Some((number, words)) if words == ["%"] && number > 0.0 && number < 100.0 => {
                Ok(Self(number / 100.0))
            }
            _ => Err(format!("`{text}` is not {}", Self::EXPECTED)),
        }
    }
}

impl FromStr for Count {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not {}", Self::EXPECTED);
        let (number, words) = number_and_words(text).ok_or_else(wrong)?;
        let (factor, noun) = match words.as_slice() {
            ["k", noun @ ..] => (1e3, noun),
            ["M", noun @ ..] => (1e6, noun),
            noun => (1.0, noun),
        };
        match noun {
            [] => {}
            [noun] if COUNTABLE.contains(noun) => {}
            [noun, ..] => return Err(format!("`{noun}` is not one of {}", listed(COUNTABLE))),
        }
        whole_number(number * factor).map(Self).ok_or_else(wrong)
    }
}

impl Count {
    /// More would not fit into any memory.
    pub(crate) const MOST: u64 = 100_000_000;
}

/// `value` as something that can be counted.
fn whole_number(value: f64) -> Option<u64> {
    let countable = (1.0..=Count::MOST as f64).contains(&value) && value.fract() == 0.0;
    #[expect(clippy::cast_sign_loss, clippy::cast_possible_truncation, reason = "checked above")]
    countable.then_some(value as u64)
}

/// A value that is written as a string with its unit.
trait Written: FromStr<Err = String> {
    /// What should have been written, after "expected" or "is not".
    const EXPECTED: &'static str;

    /// The value of a bare number, where that is unmistakable.
    fn from_number(_number: f64) -> Option<Self> {
        None
    }
}

impl Written for Angle {
    const EXPECTED: &'static str = "an angle with its unit, such as \"45 deg\" or \"0.8 rad\"";
}

impl Written for Percent {
    const EXPECTED: &'static str = "a percentage above 0 and below 100, such as \"1 %\"";
}

impl Written for Count {
    const EXPECTED: &'static str =
        "a whole number from 1 to 100 million, such as 4096, \"400 k\" or \"2 M\"";

    fn from_number(number: f64) -> Option<Self> {
        whole_number(number).map(Self)
    }
}

struct WrittenVisitor<T>(PhantomData<T>);

impl<T: Written> WrittenVisitor<T> {
    fn number<E: de::Error>(&self, number: f64, found: de::Unexpected<'_>) -> Result<T, E> {
        T::from_number(number).ok_or_else(|| E::invalid_type(found, &T::EXPECTED))
    }
}

impl<T: Written> Visitor<'_> for WrittenVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<T, E> {
        text.parse().map_err(E::custom)
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<T, E> {
        self.number(number as f64, de::Unexpected::Signed(number))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<T, E> {
        self.number(number, de::Unexpected::Float(number))
    }
}

macro_rules! deserialize_as_written {
    ($($kind:ty),*) => {$(
        impl<'de> Deserialize<'de> for $kind {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(WrittenVisitor(PhantomData))
            }
        }
    )*};
}
deserialize_as_written!(Angle, Percent, Count);

impl<'de> Deserialize<'de> for Colour {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColourVisitor)
    }
}

struct ColourVisitor;

impl<'de> Visitor<'de> for ColourVisitor {
    type Value = Colour;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a colour: one number for grey, or [red, green, blue]")
    }

    fn visit_i64<E: de::Error>(self, grey: i64) -> Result<Colour, E> {
        self.visit_f64(grey as f64)
    }

    fn visit_f64<E: de::Error>(self, grey: f64) -> Result<Colour, E> {
        checked([grey; 3])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut channels: A) -> Result<Colour, A::Error> {
        let mut colour = [0.0; 3];
        for (position, channel) in colour.iter_mut().enumerate() {
            *channel = channels
                .next_element()?
                .ok_or_else(|| de::Error::invalid_length(position, &self))?;
        }
        match channels.next_element::<f64>()? {
            None => checked(colour),
            Some(_) => Err(de::Error::invalid_length(4, &self)),
        }
    }
}

fn checked<E: de::Error>(colour: [f64; 3]) -> Result<Colour, E> {
    match colour.iter().find(|channel| !(0.0..=f64::MAX).contains(*channel)) {
        None => Ok(Colour(colour)),
        Some(wrong) => {
            Err(E::custom(format!("invalid colour {wrong}: must be finite and not negative")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::read_key;
    use serde::de::DeserializeOwned;

    /// What a string says, or what stands after `=`.
    fn read<T: DeserializeOwned>(written: &str) -> Result<T, String> {
        let text = match written.strip_prefix('=') {
            Some(value) => format!("x = {value}"),
            None => format!("x = '{written}'"),
        };
        read_key(&text, "x").map_err(|error| error.message().to_owned())
    }

    /// What is refused, each with words of the message.
    fn assert_refused<T: DeserializeOwned + fmt::Debug>(wrong: &[&str], words: &str) {
        for wrong in wrong {
            let message = read::<T>(wrong).unwrap_err();
            assert!(message.contains(words), "{wrong}: {message}");
        }
    }

    #[test]
    fn angles_carry_their_unit_and_are_refused_without_one_with_an_example() {
        assert_eq!(read("180 deg"), Ok(Angle(std::f64::consts::PI)));
        assert_eq!(read("-0.5 rad"), Ok(Angle(-0.5)));
        assert_eq!(read("40deg"), Ok(Angle(40f64.to_radians())));
        assert_refused::<Angle>(&["=45", "=45.0", "45", "45 degrees", "deg", "inf deg"], "45 deg");
    }

    #[test]
    fn percentages_are_shares_of_one() {
        assert_eq!(read("1 %"), Ok(Percent(0.01)));
        assert_eq!(read("0.5%"), Ok(Percent(0.005)));
        assert_refused::<Percent>(&["=0.01", "0 %", "-1 %", "100 %", "500 %"], "1 %");
    }

    #[test]
    fn counts_are_whole_and_positive_and_may_name_what_they_count() {
        assert_eq!(read("=4096"), Ok(Count(4096)));
        assert_eq!(read("400 k"), Ok(Count(400_000)));
        assert_eq!(read("2.5 M paths"), Ok(Count(2_500_000)));
        assert_eq!(read("64 samples"), Ok(Count(64)));
        assert_refused::<Count>(&["=-1", "0 paths", "101 M rays", "=1.5", "0.0001 k"], "");
        assert_refused::<Count>(&["4 thousand"], "`thousand`");
    }

    #[test]
    fn colours_are_one_number_or_three() {
        assert_eq!(read("=1"), Ok(Colour([1.0; 3])));
        assert_eq!(read("=[0.1, 0, 3]"), Ok(Colour([0.1, 0.0, 3.0])));
        assert_refused::<Colour>(&["=[1, 2]", "=[1, 2, 3, 4]", "red"], "red, green, blue");
        let impossible = ["=-1", "=[nan, 0, 0]", "=[0, inf, 0]"];
        assert_refused::<Colour>(&impossible, "must be finite and not negative");
    }
}
