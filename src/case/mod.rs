//! A case is a claim about path tracers that can be false: one TOML file, its folder the part of a path tracer it
//! is about, its name the claim.

mod catalog;
mod file;
mod filter;
mod foundation;
mod next_step;
mod part;
mod renamed;
mod role;
mod scene_choice;
mod tier;

pub(crate) use catalog::load_project;
pub use catalog::{CatalogError, load_all, load_one};
#[cfg(feature = "cli")]
pub(crate) use file::schema;
pub use filter::{Filter, NothingSelected};
pub(crate) use foundation::{Foundation, asked_about, asked_by, foundations};
pub(crate) use next_step::{best_step, next_steps};
pub(crate) use part::{PARTS, Part, Subject};
pub(crate) use role::Role;
pub(crate) use scene_choice::SceneChoice;
pub use tier::Tier;

use crate::checks::{CheckKind, Prepared};
use crate::contract::Capabilities;
use std::fmt;
use std::path::PathBuf;

/// A claim, ready to be tried on a core.
pub struct Case {
    /// Folder and claim: `shape/rays-meet-a-triangle`.
    pub id: String,
    /// The claim in words.
    pub title: String,
    /// What a student should remember.
    pub teaches: String,
    /// Why the expected numbers are true.
    pub source: String,
    /// Words to select by, without `@`.
    pub tags: Vec<String>,
    /// What its result counts for.
    pub tier: Tier,
    /// What is proven where it passes.
    pub proves: Vec<Foundation>,
    /// What it rests on beside what follows from its scene.
    pub rests_on: Vec<Foundation>,
    /// What it shows to the rules of the diagnosis, if they ask for it.
    pub role: Option<Role>,
    /// What a core has to promise to be graded by it: the contract leaves it free. Empty: nothing.
    pub(crate) promise: Capabilities,
    /// The scene it is tried in, if it names one.
    pub scene: Option<SceneChoice>,
    /// Which check judges.
    pub check: &'static CheckKind,
    /// The check with this case's settings.
    pub prepared: Box<dyn Prepared>,
    /// The file.
    pub path: PathBuf,
    /// SHA-256 of the file's text, hex.
    pub hash: String,
}

impl Case {
    /// What its result counts for on a core that can and promises so much.
    pub(crate) fn tier_on(&self, core: Capabilities) -> Tier {
        if core.contains(self.promise) { self.tier } else { Tier::Informational }
    }

    /// The part of a path tracer it is about.
    pub(crate) fn part(&self) -> Option<&'static Part> {
        Part::of_case(&self.id)
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Case({})", self.id)
    }
}
