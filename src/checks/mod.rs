//! How answers are judged: one check a file, its name the `check = "…"` of cases, its struct their `[expect]`.
//!
//! A check sees a `&mut dyn Core` and never a particular core; it draws its random numbers from the trial's seed; it
//! leaves every verdict to [`crate::stats`]. To add one: write the file, and its lines in the `mod.rs` of its subject.

pub(crate) mod adaptive;
pub(crate) mod breach;
pub(crate) mod bsdf;
pub(crate) mod bvh;
pub(crate) mod camera;
mod context;
mod convergence;
mod declared;
#[cfg(test)]
mod fake;
mod few;
mod finding;
mod form;
pub(crate) mod image;
pub(crate) mod integrator;
pub(crate) mod law;
pub(crate) mod light;
mod numbers;
mod oracle;
mod phrase;
mod ray_row;
mod rendering;
pub(crate) mod sampling;
pub(crate) mod series;
pub(crate) mod shape;
mod surface;
#[cfg(test)]
mod testing;

pub(crate) use context::{
    CheckError, Context, Layer, Picture, PictureRole, RejectedCell, Result, camera_of,
};
pub(crate) use declared::{Declared, check, checks};
pub use finding::{Clue, Finding, Measure};
pub(crate) use finding::{STANDARD_ERRORS, number};

use crate::contract::Capabilities;
use crate::text::document::trace;
use crate::text::schema::Trace;
use crate::text::{TomlError, read_key};

/// A way to judge a core. The struct that implements it is the `[expect]` of its cases.
pub(crate) trait Check: Declared {
    /// What its settings need besides [`Declared::NEEDS`].
    fn needs_besides(&self) -> Capabilities {
        Capabilities::empty()
    }

    /// Other capabilities that do as well, if any do.
    fn needs_instead(&self) -> Option<Capabilities> {
        None
    }

    /// What is wrong with the settings themselves, before any core is asked.
    ///
    /// # Errors
    /// A sentence for the author of the case.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// Scenes that the settings name, beside that of the case.
    fn scenes(&self) -> &[String] {
        &[]
    }

    /// Asks the core and judges.
    ///
    /// # Errors
    /// If the core did not answer, or the case or harness is at fault.
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError>;
}

/// A check with its settings read, ready to run.
pub trait Prepared: Send + Sync {
    /// What the core must be able to do; a core without it skips the trial.
    fn needs(&self) -> Capabilities;

    /// What of that it cannot do, if it has these capabilities; nothing where others do as well.
    fn missing(&self, has: Capabilities) -> Capabilities;

    /// Scenes that the settings name, beside that of the case.
    fn scenes(&self) -> &[String];

    /// Asks the core and judges.
    ///
    /// # Errors
    /// If the core did not answer, or the case or harness is at fault.
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError>;
}

impl<C: Check> Prepared for C {
    fn needs(&self) -> Capabilities {
        C::NEEDS | self.needs_besides()
    }

    fn missing(&self, has: Capabilities) -> Capabilities {
        match Check::needs_instead(self) {
            Some(instead) if has.contains(instead) => Capabilities::empty(),
            _ => self.needs() - has,
        }
    }

    fn scenes(&self) -> &[String] {
        Check::scenes(self)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        Check::run(self, context)
    }
}

/// Why a case's text did not become a check.
#[derive(Debug)]
pub(crate) enum PrepareError {
    /// The `[expect]` table is not what the check wants; carries the place in the text.
    Toml(TomlError),
    /// The values make no sense together.
    Invalid(String),
}

/// A line of the `CHECKS` of a subject.
pub struct CheckKind {
    /// The word in `check = "…"`.
    pub(crate) name: &'static str,
    /// One line for `furnace list checks`.
    pub(crate) summary: &'static str,
    /// Reads the `[expect]` table out of the whole text of a case, so that errors know their line.
    pub(crate) prepare: fn(&str) -> Result<Box<dyn Prepared>, PrepareError>,
    /// Tells which keys `[expect]` has.
    pub(crate) trace: Trace,
}

impl CheckKind {
    /// The line for check `C`.
    pub(crate) const fn of<C: Check>() -> Self {
        Self { name: C::NAME, summary: C::SUMMARY, prepare: prepare::<C>, trace: trace::<C> }
    }
}

fn prepare<C: Check>(text: &str) -> Result<Box<dyn Prepared>, PrepareError> {
    let check: C = read_key(text, "expect").map_err(PrepareError::Toml)?;
    check.validate().map_err(PrepareError::Invalid)?;
    Ok(Box::new(check))
}

/// Every check there is, subject by subject.
pub(crate) fn all() -> impl Iterator<Item = &'static CheckKind> {
    [
        camera::CHECKS,
        shape::CHECKS,
        bvh::CHECKS,
        sampling::CHECKS,
        bsdf::CHECKS,
        light::CHECKS,
        integrator::CHECKS,
        adaptive::CHECKS,
        image::CHECKS,
    ]
    .into_iter()
    .flatten()
}

/// Words of old cases, each with the check that judges so now.
pub(crate) static RENAMED: &[(&str, &str)] = &[
    ("divides-long-scenes", "tests-per-ray"), // arrangement = "long-boxes"
    ("stops-behind-hits", "tests-per-ray"),   // arrangement = "layers"
    ("lamp-at-the-eye", "no-self-shadowing"),
];

pub(crate) fn find(name: &str) -> Option<&'static CheckKind> {
    all().find(|kind| kind.name == name)
}
