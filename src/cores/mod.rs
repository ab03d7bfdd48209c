//! Renderer cores: who keeps the promise of [`crate::contract`]. Two of our own, written independently;
//! everybody else's through a shared library ([`dylib`]) or a program, in a worker ([`remote`]), or as pictures
//! that any program makes ([`command`]).

pub mod builtin;
pub(crate) mod command;
pub mod dylib;
mod foreign;
mod hosting;
pub(crate) mod remote;
pub(crate) mod textbook;

#[cfg(test)]
mod stage;

pub use hosting::{HostError, Hosted, Hosting};

use crate::contract::Core;
use crate::text::hint;
use crate::worker::CoreOrigin;
use command::{AdapterError, Program};
use dylib::{Dylib, LoadError};
use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;
use textbook::variant::{self, NoVariant};

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
        summary: "f32, wide BVH, SIMD, threads: the one to trust and to benchmark",
        make: || Box::new(builtin::Builtin::new()),
    },
    CoreKind {
        name: "textbook",
        summary: "f64, plain, one function per course task: the independent second implementation",
        make: || Box::new(textbook::Textbook::new()),
    },
];

/// Which core, as the user typed it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoreSpec {
    word: String,
    origin: CoreOrigin,
    /// Of one that the program brings along, which no word leads to.
    brought: Option<Brought>,
}

/// A core of the program that uses this library.
#[derive(Clone)]
struct Brought {
    make: Arc<dyn Fn() -> Box<dyn Core> + Send + Sync>,
    /// What repeats a case, before its name.
    command: String,
}

impl fmt::Debug for Brought {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Brought").field("command", &self.command).finish_non_exhaustive()
    }
}

impl PartialEq for Brought {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.make, &other.make)
    }
}

impl Eq for Brought {}

/// The words after `--core` name no core.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct UnknownCore(String);

impl UnknownCore {
    fn new(word: &str, hint: &str) -> Self {
        Self(format!("there is no core `{word}`\nhint: {hint}"))
    }
}

impl CoreSpec {
    /// A core that this program makes; `command` and the name of a case repeat that case.
    pub(crate) fn brought(
        name: &str,
        command: String,
        make: Arc<dyn Fn() -> Box<dyn Core> + Send + Sync>,
    ) -> Self {
        let brought = Some(Brought { make, command });
        Self { word: name.to_owned(), origin: CoreOrigin::BuiltIn, brought }
    }

    fn of(word: &str, origin: CoreOrigin) -> Self {
        Self { word: word.to_owned(), origin, brought: None }
    }

    /// The command that repeats cases, where it is not `furnace run`.
    pub(crate) fn command(&self) -> Option<&str> {
        self.brought.as_ref().map(|brought| brought.command.as_str())
    }

    /// Makes the core in this process. A library can do anything to it: only a worker loads one.
    ///
    /// # Errors
    /// If it is a library that cannot be loaded, or a program, which is not loaded at all.
    ///
    /// # Panics
    /// Never: a specification is only made of a core that exists.
    pub fn make(&self) -> Result<Box<dyn Core>, LoadError> {
        match &self.origin {
            CoreOrigin::BuiltIn => Ok(self.resident()),
            CoreOrigin::Library(path) => Ok(Box::new(Dylib::load(path)?)),
            CoreOrigin::Program(_) | CoreOrigin::Renderer { .. } => {
                Err(LoadError::IsProgram(self.word.clone()))
            }
        }
    }

    /// One of our own, or of the program.
    fn resident(&self) -> Box<dyn Core> {
        if let Some(brought) = &self.brought {
            return (brought.make)();
        }
        if let Some(change) = self.change() {
            return variant::core(change).expect("checked when it was read");
        }
        let kind = CORES.iter().find(|kind| kind.name == self.word);
        (kind.expect("checked when it was read").make)()
    }

    /// The program that an adapter's file describes, if this is one.
    pub(crate) fn program(&self) -> Option<Result<Program, AdapterError>> {
        let path = Path::new(&self.word);
        path.extension().is_some_and(|ending| ending == "toml").then(|| Program::load(path))
    }

    /// What kind of core it is.
    pub(crate) const fn origin(&self) -> &CoreOrigin {
        &self.origin
    }

    /// As the user typed it.
    pub fn as_str(&self) -> &str {
        &self.word
    }

    /// What follows `textbook:`.
    fn change(&self) -> Option<&str> {
        self.word.strip_prefix(CHANGED)
    }
}

/// What the name of a changed copy of the plain core begins with.
const CHANGED: &str = "textbook:";

impl FromStr for CoreSpec {
    type Err = UnknownCore;

    fn from_str(word: &str) -> Result<Self, UnknownCore> {
        if CORES.iter().any(|kind| kind.name == word) {
            return Ok(Self::of(word, CoreOrigin::BuiltIn));
        }
        if let Some(change) = word.strip_prefix(CHANGED) {
            return changed(word, change);
        }
        match foreign::origin(word) {
            Some(Ok(origin)) => Ok(Self::of(word, origin)),
            Some(Err(problem)) => Err(UnknownCore(problem)),
            None => Err(UnknownCore::new(word, &meant(word))),
        }
    }
}

/// The core that was probably meant, or how cores are named.
fn meant(word: &str) -> String {
    let changed: Vec<_> = variant::names().map(|name| format!("{CHANGED}{name}")).collect();
    let names = CORES.iter().map(|kind| kind.name).chain(changed.iter().map(String::as_str));
    hint(word, names, || {
        let own: Vec<_> = CORES.iter().map(|kind| format!("`{}`", kind.name)).collect();
        let forms = "or path/to/lib.so, or an adapter's .toml, or 'exec: COMMAND'";
        format!("the cores are {}, {forms}", own.join(" and "))
    })
}

/// A copy of the plain core, if there is one with these changes.
fn changed(word: &str, changes: &str) -> Result<CoreSpec, UnknownCore> {
    let hint = match variant::core(changes) {
        Ok(_) => return Ok(CoreSpec::of(word, CoreOrigin::BuiltIn)),
        Err(NoVariant::Unknown(name)) => {
            let names: Vec<_> = variant::names().collect();
            let all = || "`furnace list faults` shows every fault".to_owned();
            hint(name, names.into_iter(), all)
        }
        Err(clash) => format!("{clash}: only one of them can be on"),
    };
    Err(UnknownCore::new(word, &hint))
}

impl fmt::Display for CoreSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.word)
    }
}

#[cfg(test)]
mod tests {
    use super::stage::{Stage, clear_glass, grey, looks};
    use super::*;
    use crate::contract::{Acceleration, IntegratorSettings, Ray};
    use crate::scene::{Light, Surface};
    use glam::DVec3;

    #[test]
    fn mirrors_and_glass_scatter_no_light_that_was_sampled() {
        let sun = Light::Directional { direction: DVec3::NEG_Z, irradiance: grey(1.0) };
        let ray = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
        let settings = IntegratorSettings { bounces: 0..=5, ..IntegratorSettings::default() };
        let looks = [looks(Surface::Mirror { reflectance: grey(1.0) }), clear_glass()];
        for (look, kind) in
            looks.into_iter().flat_map(|look| CORES.iter().map(move |it| (look, it)))
        {
            let scene = Stage::empty().sphere(DVec3::ZERO, 1.0, look).light(sun).scene();
            let mut core = (kind.make)();
            let mut built = core.build_scene(&scene, Acceleration::DEFAULT).unwrap();
            let mut radiance = [[f64::NAN; 3]; 500];
            built.radiance(&[ray; 500], &settings, &mut radiance).unwrap();
            assert_eq!(radiance, [[0.0; 3]; 500], "{}", kind.name);
        }
    }
}
