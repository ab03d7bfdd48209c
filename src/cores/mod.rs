//! Renderer cores: who keeps the promise of [`crate::contract`]. Two of our own, written independently.

pub mod builtin;
pub mod dylib;
pub mod textbook;

use crate::contract::Core;
use crate::text::did_you_mean;
use std::fmt;
use std::str::FromStr;

/// A line of [`CORES`].
pub struct CoreKind {
    /// What the user types after `--core`.
    pub name: &'static str,
    /// One line for `furnace list cores`.
    pub summary: &'static str,
    make: fn() -> Box<dyn Core>,
}

/// Every core of our own.
pub static CORES: &[CoreKind] = &[
    CoreKind {
        name: "builtin",
        summary: "f32, wide hierarchy, SIMD, threads: the one to trust and to benchmark",
        make: || Box::new(builtin::Builtin::new()),
    },
    CoreKind {
        name: "textbook",
        summary: "f64, plain, one function a course task: the second witness",
        make: || Box::new(textbook::Textbook::new()),
    },
];

/// Which core, as the user typed it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoreSpec(String);

/// The words after `--core` name no core.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no core `{word}`\nhint: {hint}")]
pub struct UnknownCore {
    word: String,
    hint: String,
}

impl CoreSpec {
    /// Makes the core.
    ///
    /// # Panics
    /// Never: a specification is only made of a core that exists.
    pub fn make(&self) -> Box<dyn Core> {
        if let Some(change) = self.change() {
            return textbook::with_change(change).expect("checked when it was read");
        }
        let kind = CORES.iter().find(|kind| kind.name == self.0).expect("checked when it was read");
        (kind.make)()
    }

    /// As the user typed it.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// What follows `textbook:`.
    fn change(&self) -> Option<&str> {
        self.0.strip_prefix(CHANGED)
    }
}

/// What the name of a changed copy of the plain core begins with.
const CHANGED: &str = "textbook:";

impl FromStr for CoreSpec {
    type Err = UnknownCore;

    fn from_str(word: &str) -> Result<Self, UnknownCore> {
        if CORES.iter().any(|kind| kind.name == word) {
            return Ok(Self(word.to_owned()));
        }
        if let Some(change) = word.strip_prefix(CHANGED) {
            return changed(word, change);
        }
        let names: Vec<_> = CORES.iter().map(|kind| format!("`{}`", kind.name)).collect();
        let hint = format!("the cores are {}", names.join(" and "));
        Err(UnknownCore { word: word.to_owned(), hint })
    }
}

/// A copy of the plain core, if there is such a change.
fn changed(word: &str, change: &str) -> Result<CoreSpec, UnknownCore> {
    if textbook::change_names().any(|name| name == change) {
        return Ok(CoreSpec(word.to_owned()));
    }
    let hint = did_you_mean(change, textbook::change_names())
        .unwrap_or_else(|| "`furnace list faults` shows every fault".to_owned());
    Err(UnknownCore { word: word.to_owned(), hint })
}

impl fmt::Display for CoreSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
