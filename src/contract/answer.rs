//! What an answer is made of: what it holds before a core has written it, what form it has to have, and how it crosses.
//!
//! Not here: whether an answer is *right*, which is what checks are for.

use super::crossing::{Element, Part, Sent, Value, Wanted};
use super::{Breach, BreachKind, Capabilities, CoreError, Result};
use crate::image::png::Picture;
use bytemuck::Pod;
use glam::DVec3;

/// How far from 1 the length of a unit vector may be: f32 cores normalise to about 1e-7.
const UNIT_LENGTH_ERROR: f64 = 1e-5;

/// What becomes of elements that have not the contract's form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unformed {
    /// The answer is refused.
    Refused,
    /// What was meant takes their place, where that is clear: whoever asks knows of the breach, and wants to know what
    /// else there is.
    Mended,
    /// They stay: whoever asked looks at them.
    Left,
}

/// What an answer has to fit.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// Elements of a batch, and 1; width and height of a picture.
    pub(crate) size: [usize; 2],
    /// What the core can do.
    pub(crate) capabilities: Capabilities,
    /// Primitives of each shape of the scene, to tell hits that cannot be.
    pub(crate) primitives_of_shape: &'a [usize],
    /// What becomes of elements that have not the contract's form.
    pub(crate) unformed: Unformed,
}

/// What a question fills: a batch, or a picture.
pub trait Answer {
    /// Its arrays; the one without a name is called as the table of questions calls the answer.
    const PARTS: &'static [Part];

    /// One of the size asked for, with nothing in it.
    fn blank(asked: &Asked<'_>) -> Box<Self>;

    /// Marks every value, so that "left untouched" is seen.
    fn untouch(&mut self, asked: &Asked<'_>);

    /// Takes it as an answer to what was asked.
    ///
    /// # Errors
    /// If it has not the contract's form.
    fn accept(&mut self, asked: &Asked<'_>) -> Result<()>;

    /// Rounds every number to single precision, if it is not in that anyway.
    fn round(&mut self) {}

    /// As it is sent.
    fn sent(&self, name: &'static str, can: Capabilities) -> Vec<Sent<'_>>;

    /// Lets `fill` write the arrays, and takes them over.
    ///
    /// # Errors
    /// Those of `fill`, and values that are none.
    fn receive(&mut self, name: &'static str, can: Capabilities, fill: Fill<'_>) -> Result<()>;
}

/// Writes the arrays of an answer.
pub(crate) type Fill<'a> = &'a mut dyn FnMut(&mut [Wanted<'_>]) -> Result<()>;

/// What is wrong with one element, before its number is known.
pub(crate) type Form = std::result::Result<(), Breach>;

/// An element that cores answer.
pub(crate) trait Answered: Element {
    /// What complaints call one.
    const NOUN: &'static str;

    /// Whether it has the contract's form.
    ///
    /// # Errors
    /// What is wrong first.
    fn check(&self, asked: &Asked<'_>) -> Form;

    /// Puts what was meant in the place of what breaks the form; whether that is known.
    fn mend(&mut self, _: &Breach) -> bool {
        false
    }
}

/// A value whose meaning may be clear though it has not the contract's form.
pub(crate) trait Meaning {
    /// Puts what was meant in its place; whether that is known.
    fn meant(&mut self, _: &BreachKind) -> bool {
        false
    }
}

impl Meaning for DVec3 {
    fn meant(&mut self, kind: &BreachKind) -> bool {
        let unit = self.try_normalize().filter(|_| matches!(kind, BreachKind::NotUnit(_)));
        *self = unit.unwrap_or(*self);
        unit.is_some()
    }
}

impl Meaning for f64 {}
impl Meaning for u32 {}
impl Meaning for [f64; 3] {}

impl<T: Answered> Answer for [T] {
    const PARTS: &'static [Part] = &[Part::array::<T>("")];

    fn blank(asked: &Asked<'_>) -> Box<Self> {
        vec![T::UNTOUCHED; asked.size[0]].into()
    }

    fn untouch(&mut self, _: &Asked<'_>) {
        self.fill(T::UNTOUCHED);
    }

    fn accept(&mut self, asked: &Asked<'_>) -> Result<()> {
        match asked.unformed {
            Unformed::Left => return Ok(()),
            Unformed::Mended => self.iter_mut().for_each(|element| mend(element, asked)),
            Unformed::Refused => {}
        }
        each(self, T::NOUN, |element| element.check(asked))
    }

    fn round(&mut self) {
        self.iter_mut().for_each(|element| *element = element.rounded());
    }

    fn sent(&self, name: &'static str, _: Capabilities) -> Vec<Sent<'_>> {
        vec![Sent::new(name, self)]
    }

    fn receive(&mut self, name: &'static str, _: Capabilities, fill: Fill<'_>) -> Result<()> {
        fill(&mut [Wanted::new(name, self)])
    }
}

/// Flags cross as bytes.
impl Answer for [bool] {
    const PARTS: &'static [Part] = &[Part::array::<u8>("")];

    fn blank(asked: &Asked<'_>) -> Box<Self> {
        vec![false; asked.size[0]].into()
    }

    /// A flag has no third value.
    fn untouch(&mut self, _: &Asked<'_>) {}

    fn accept(&mut self, _: &Asked<'_>) -> Result<()> {
        Ok(())
    }

    fn sent(&self, name: &'static str, _: Capabilities) -> Vec<Sent<'_>> {
        vec![Sent::new(name, bytemuck::cast_slice::<bool, u8>(self))]
    }

    fn receive(&mut self, name: &'static str, _: Capabilities, fill: Fill<'_>) -> Result<()> {
        self.receive_batch(|bytes: &mut [u8]| fill(&mut [Wanted::new(name, bytes)]))
    }
}

/// An answer that is one array: how foreign code writes it.
pub trait Batch: Answer {
    /// What it writes.
    type Foreign: Pod;

    /// Lets `fill` write every element.
    ///
    /// # Errors
    /// Those of `fill`, and values that are none.
    fn receive_batch(
        &mut self,
        fill: impl FnOnce(&mut [Self::Foreign]) -> Result<()>,
    ) -> Result<()>;
}

impl<T: Answered> Batch for [T] {
    type Foreign = T;

    fn receive_batch(&mut self, fill: impl FnOnce(&mut [T]) -> Result<()>) -> Result<()> {
        fill(self)
    }
}

impl Batch for [bool] {
    type Foreign = u8;

    fn receive_batch(&mut self, fill: impl FnOnce(&mut [u8]) -> Result<()>) -> Result<()> {
        let mut bytes = vec![u8::UNTOUCHED; self.len()];
        fill(&mut bytes)?;
        read_flags(&bytes, self)
    }
}

/// Reads flags that cross the boundary as bytes.
///
/// # Errors
/// If one is neither 0 nor 1.
pub(crate) fn read_flags(bytes: &[u8], flags: &mut [bool]) -> Result<()> {
    for (index, (flag, byte)) in flags.iter_mut().zip(bytes).enumerate() {
        *flag = match byte {
            0 => false,
            1 => true,
            _ => {
                let breach = Breach::of("it", BreachKind::NotAFlag(u32::from(*byte)));
                let breach = breach.in_element("occluded", index, bytes.len());
                return Err(breach.into());
            }
        };
    }
    Ok(())
}

impl Answer for Picture {
    const PARTS: &'static [Part] = &[Part::array::<[u8; 3]>("")];

    fn blank(asked: &Asked<'_>) -> Box<Self> {
        let [width, height] = asked.size;
        Box::new(Self { width, height, pixels: vec![[0; 3]; width * height] })
    }

    /// Every code is one that a core may have written.
    fn untouch(&mut self, asked: &Asked<'_>) {
        *self = *Self::blank(asked);
    }

    fn accept(&mut self, asked: &Asked<'_>) -> Result<()> {
        let is_whole = self.pixels.len() == self.width * self.height;
        if asked.size == [self.width, self.height] && is_whole {
            return Ok(());
        }
        let [width, height] = asked.size;
        let found = format!("{} × {} pixels", self.width, self.height);
        Err(CoreError::breach(format!("the picture has {found}, not {width} × {height}")))
    }

    fn sent(&self, name: &'static str, _: Capabilities) -> Vec<Sent<'_>> {
        vec![Sent::new(name, &self.pixels)]
    }

    fn receive(&mut self, name: &'static str, _: Capabilities, fill: Fill<'_>) -> Result<()> {
        fill(&mut [Wanted::new(name, &mut self.pixels)])
    }
}

/// Mends one field after the other, as far as it is known how.
fn mend<T: Answered>(element: &mut T, asked: &Asked<'_>) {
    while let Err(breach) = element.check(asked)
        && element.mend(&breach)
    {}
}

pub(super) fn each<T>(
    elements: &[T],
    what: &'static str,
    check: impl Fn(&T) -> Form,
) -> Result<()> {
    let of = elements.len();
    elements.iter().enumerate().try_for_each(|(index, element)| {
        check(element).map_err(|breach| breach.in_element(what, index, of).into())
    })
}

/// Three numbers that are finite and not negative.
pub(crate) fn colour(field: &'static str, value: [f64; 3]) -> Form {
    value.iter().enumerate().try_for_each(|(channel, value)| {
        let breach = |breach| Breach { channel: Some(channel), ..breach };
        not_negative(field, *value).map_err(breach)
    })
}

/// A number that is finite and not negative.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Form {
    finite(field, value)?;
    holds(value >= 0.0, field, || BreachKind::Negative(value))
}

pub(crate) fn finite(field: &'static str, value: f64) -> Form {
    not_nan(field, value)?;
    holds(value.is_finite(), field, || BreachKind::Infinite)
}

/// A number that is written, and is one.
pub(crate) fn not_nan(field: &'static str, value: f64) -> Form {
    holds(value.to_bits() != f64::UNTOUCHED.to_bits(), field, || BreachKind::Untouched)?;
    holds(!value.is_nan(), field, || BreachKind::NotANumber)
}

pub(crate) fn finite_vector(field: &'static str, value: DVec3) -> Form {
    value.to_array().iter().try_for_each(|component| finite(field, *component))
}

pub(crate) fn unit(field: &'static str, value: DVec3) -> Form {
    finite_vector(field, value)?;
    let length = value.length();
    holds((length - 1.0).abs() <= UNIT_LENGTH_ERROR, field, || BreachKind::NotUnit(length))
}

/// 0 or 1.
pub(crate) fn flag(field: &'static str, value: u32) -> Form {
    touched(field, value)?;
    holds(value <= 1, field, || BreachKind::NotAFlag(value))
}

/// A whole number that is written.
pub(crate) fn touched(field: &'static str, value: u32) -> Form {
    holds(value != u32::UNTOUCHED, field, || BreachKind::Untouched)
}

/// What has to be so, of one field.
pub(crate) fn holds(is_so: bool, field: &'static str, kind: impl FnOnce() -> BreachKind) -> Form {
    if is_so { Ok(()) } else { Err(Breach::of(field, kind())) }
}
