//! An answer that has not the contract's form, as data: where, which field, and what is wrong with it.
//!
//! Sentences are made where they are shown ([`fmt::Display`]); causes are matched by value (`checks::breach`).

use super::crossing::Request;
use crate::image::CHANNELS;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// What is wrong with an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Breach {
    /// In which of its elements.
    pub(crate) place: Place,
    /// Which of the element's fields, as the contract calls it.
    pub(crate) field: Cow<'static, str>,
    /// Which colour of the field, if it has three: 0 is red.
    pub(crate) channel: Option<usize>,
    /// What is wrong with that.
    pub(crate) kind: BreachKind,
    /// What the core was asked there, where somebody knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) asked: Option<Box<AskedFor>>,
}

/// One element of a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct AskedFor {
    /// In the words of the protocol: `intersect-sphere`.
    pub(crate) question: String,
    /// With these numbers.
    pub(crate) numbers: String,
}

/// Where an answer is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Place {
    /// In the answer as a whole.
    Answer,
    /// In element `index` of a batch of `of`.
    Element {
        /// What the elements are: `hit`, `sample`.
        what: Cow<'static, str>,
        /// From 0.
        index: usize,
        /// How many there are.
        of: usize,
    },
    /// In a pixel of a picture.
    Pixel {
        /// What of it: `pixel`, `variance of pixel`.
        what: Cow<'static, str>,
        /// From the left.
        x: usize,
        /// From the top.
        y: usize,
    },
}

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum BreachKind {
    /// The core has not written it.
    Untouched,
    /// It is NaN.
    NotANumber,
    /// It is infinite where it has to be finite.
    Infinite,
    /// It is this, below zero.
    Negative(f64),
    /// It is a direction of this length.
    NotUnit(f64),
    /// It is a flag with this value.
    NotAFlag(u32),
    /// It is this, and cannot be.
    OutOfRange(f64),
    /// It names a primitive that does not exist.
    NoSuchPrimitive {
        /// Number of the shape.
        shape: u32,
        /// Number of the primitive.
        primitive: u32,
    },
    /// The answer as a whole is not what was asked for, in words.
    Other(String),
}

impl Breach {
    /// A breach by `field`; where, the caller says.
    pub(crate) fn of(field: impl Into<Cow<'static, str>>, kind: BreachKind) -> Self {
        let (place, field) = (Place::Answer, field.into());
        Self { place, field, channel: None, kind, asked: None }
    }

    /// A breach that only words can tell.
    pub(crate) fn other(words: impl Into<String>) -> Self {
        Self::of("", BreachKind::Other(words.into()))
    }

    /// The same in element `index` of `of`.
    #[must_use]
    pub(crate) fn in_element(self, what: &'static str, index: usize, of: usize) -> Self {
        Self { place: Place::Element { what: what.into(), index, of }, ..self }
    }

    /// Whether what was meant is clear: a direction that is not unit points somewhere, and a mean can be taken of pixels
    /// some of which are negative.
    pub(crate) const fn can_be_mended(&self) -> bool {
        self.mend().is_some()
    }

    /// What is done to mend it, in words.
    pub(crate) const fn mend(&self) -> Option<&'static str> {
        match (&self.kind, &self.place) {
            (BreachKind::NotUnit(length), _) if *length > 0.0 => Some("made unit"),
            (BreachKind::Negative(_), Place::Pixel { .. }) => Some("taken as it is"),
            _ => None,
        }
    }

    /// The same with what was asked for its element in this request.
    #[must_use]
    pub(crate) fn with_question(self, request: &Request<'_>) -> Self {
        let numbers = match self.place {
            Place::Element { index, of, .. } => request.describe(index, of),
            Place::Answer | Place::Pixel { .. } => None,
        };
        let question = || request.name().to_owned();
        let asked = |numbers| Box::new(AskedFor { question: question(), numbers });
        Self { asked: numbers.map(asked), ..self }
    }

    /// What came and what would have been right alone.
    pub(crate) fn without_question(&self) -> Self {
        Self { asked: None, ..self.clone() }
    }

    /// Whether this was asked, in the words of the protocol.
    pub(crate) fn is_about(&self, question: &str) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.question == question)
    }

    /// What the elements of the answer are; nothing of one that is wrong as a whole.
    pub(crate) fn element(&self) -> &str {
        match &self.place {
            Place::Answer => "",
            Place::Element { what, .. } | Place::Pixel { what, .. } => what,
        }
    }
}

impl BreachKind {
    /// What would have been right, where the words for what is wrong do not say so.
    const fn right(&self) -> Option<&'static str> {
        match self {
            Self::Untouched => Some("every field of an answer has to be written"),
            Self::NotANumber | Self::Infinite => Some("a finite number is right"),
            Self::Negative(_) => Some("0 or more is right"),
            _ => None,
        }
    }
}

/// What came, what would have been right, what was asked.
impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, field, channel, kind, asked } = self;
        match place {
            Place::Answer => {}
            Place::Element { what, index, of } => write!(f, "{what} {index} of {of}: ")?,
            Place::Pixel { what, x, y } => write!(f, "{what} ({x}, {y}) from the top left: ")?,
        }
        match kind {
            BreachKind::Untouched => write!(f, "{field} was left untouched"),
            BreachKind::NotANumber => write!(f, "{field} is NaN"),
            BreachKind::Infinite => write!(f, "{field} is infinite"),
            BreachKind::Negative(value) => write!(f, "{field} = {value} is negative"),
            BreachKind::NotUnit(length) => write!(f, "{field} has length {length}, not 1"),
            BreachKind::NotAFlag(value) => write!(f, "{field} is {value}, neither 0 nor 1"),
            BreachKind::OutOfRange(value) => write!(f, "{field} is {value}, which cannot be"),
            BreachKind::NoSuchPrimitive { shape, primitive } => {
                write!(f, "shape {shape} has no primitive {primitive}")
            }
            BreachKind::Other(words) => f.write_str(words),
        }?;
        if let Some(channel) = *channel {
            write!(f, " ({})", CHANNELS[channel % 3])?;
        }
        if let Some(right) = kind.right() {
            write!(f, "; {right}")?;
        }
        if (self.element(), field.as_ref()) == ("hit", "t") {
            f.write_str(", or a miss (`primitive` is NONE) where the ray meets nothing")?;
        }
        if let Some(asked) = asked {
            let AskedFor { question, numbers } = &**asked;
            write!(f, "; asked was {question} with {numbers}")?;
        }
        Ok(())
    }
}
