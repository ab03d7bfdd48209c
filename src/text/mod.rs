//! What people write, and what they are told about it: messages that point into a file, and the
//! values with units that scene files and case files share; and how numbers are written for people.
//!
//! Not here: what any key of a file means. Scenes and cases keep their own vocabulary.

pub(crate) mod colour;
mod diagnostic;
mod digest;
pub(crate) mod document;
pub(crate) mod number;
mod program;
mod range;
pub(crate) mod schema;
mod spoken;
mod suggestion;
mod units;

pub(crate) use diagnostic::{Diagnostic, Source};
pub use digest::fingerprint;
pub(crate) use digest::hexadecimal;
pub(crate) use document::read_table;
pub(crate) use document::{Spanned, TomlError, read_key, read_toml};
pub(crate) use program::program;
pub(crate) use range::{
    Arrow, Bending, Between, Bounces, Chance, Direction, Factor, Lit, Polar, Positive, Reflectance,
    Roughness, Several, Size, Vector, Words,
};
pub(crate) use spoken::spoken;
pub(crate) use suggestion::{all_of, did_you_mean, hint, listed};
pub(crate) use units::{Angle, Colour, Count, Percent};
