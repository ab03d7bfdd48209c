//! Where a core lives: our own in this process, everybody else's in a worker.

use super::CoreSpec;
use super::dylib::LoadError;
use super::remote::Remote;
use crate::contract::{Components, Core};
use crate::worker::{
    Confinement, CoreOrigin, CpuClock, Launch, Limits, Patience, StartError, WorkerSpec, crowding,
};
use std::path::PathBuf;
use std::time::Duration;

/// How cores are hosted in a run.
#[derive(Clone, Debug)]
pub struct Hosting {
    /// The `furnace` program, which is what a worker runs.
    pub program: PathBuf,
    /// What each worker may use up.
    pub limits: Limits,
    /// What no core may read, wherever it lies: cases, references, results.
    pub hidden: Vec<PathBuf>,
    /// What the user lets cores read besides themselves and the system.
    pub readable: Vec<PathBuf>,
    /// Whether workers are sandboxed at all.
    pub confined: bool,
    /// Whether our own cores live in workers too.
    pub isolates_own: bool,
    /// What is known of the silences of cores.
    pub patience: Patience,
}

impl Default for Hosting {
    /// Workers of this program, sandboxed.
    fn default() -> Self {
        Self {
            program: std::env::current_exe().unwrap_or_else(|_| "furnace".into()),
            limits: Limits::default(),
            hidden: Vec::new(),
            readable: Vec::new(),
            confined: true,
            isolates_own: false,
            patience: Patience::default(),
        }
    }
}

/// A core, wherever it lives.
pub enum Hosted {
    /// In this process.
    Here(Box<dyn Core>),
    /// In a worker.
    Away(Box<Remote>),
}

/// Why a core fails to start.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// There is no such core.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// Its worker failed to start.
    #[error(transparent)]
    Start(#[from] StartError),
}

impl Hosting {
    /// The same with more out of sight.
    pub(crate) fn hiding(mut self, paths: impl IntoIterator<Item = PathBuf>) -> Self {
        self.hidden.extend(paths);
        self
    }

    /// The same, for a case.
    pub(crate) fn in_case(&self, case: &str) -> Self {
        Self { patience: self.patience.in_case(case), ..self.clone() }
    }

    /// The same with nothing known of silences.
    pub(crate) fn patient(self) -> Self {
        Self { patience: Patience::unhurried(), ..self }
    }

    /// Brings up a core.
    ///
    /// # Errors
    /// If it fails to start.
    pub fn host(&self, spec: &CoreSpec) -> Result<Hosted, HostError> {
        if *spec.origin() == CoreOrigin::BuiltIn && !self.isolates_own {
            return Ok(Hosted::Here(spec.make()?));
        }
        Ok(Hosted::Away(Box::new(Remote::start(&self.launch(spec))?)))
    }

    /// How the workers of a core are started.
    pub(crate) fn launch(&self, spec: &CoreSpec) -> Launch {
        let renderer = spec.program().and_then(Result::ok);
        // Its file says how long each picture may take.
        let seconds = if renderer.is_some() { None } else { self.limits.seconds };
        // What does not exist yet has no real path, but a place.
        let real = |path: &PathBuf| path.canonicalize().or_else(|_| std::path::absolute(path)).ok();
        Launch {
            program: self.program.clone(),
            worker: WorkerSpec {
                core: spec.to_string(),
                origin: spec.origin().clone(),
                limits: Limits { seconds, ..self.limits },
                scratch: PathBuf::new(),
                hidden: self.hidden.iter().filter_map(real).collect(),
                readable: self.readable.iter().filter_map(real).collect(),
                confined: self.confined,
            },
            patience: self.patience.with(&spec.to_string()),
            variables: renderer.map(|program| program.variables()).unwrap_or_default(),
        }
    }
}

impl Hosted {
    /// The core.
    pub fn core_mut(&mut self) -> &mut dyn Core {
        match self {
            Self::Here(core) => core.as_mut(),
            Self::Away(remote) => remote.as_mut(),
        }
    }

    /// The time after which a core in this process is asked nothing more in a trial: longer where other programs want the
    /// processors, too. A worker is watched while it answers.
    pub(crate) fn time_limit(&self, limits: Limits) -> Option<Duration> {
        let crowded = || limits.seconds.map(|seconds| seconds * crowding());
        match self {
            Self::Here(_) => Some(Limits { seconds: crowded(), ..limits }.time()),
            Self::Away(_) => None,
        }
    }

    /// What the system enforces on it; none for a core in this process.
    pub fn confinement(&self) -> Option<&Confinement> {
        match self {
            Self::Here(_) => None,
            Self::Away(remote) => Some(remote.confinement()),
        }
    }

    /// CPU time of its process while it answers; stands still for a core in this process.
    pub(crate) fn clock(&self) -> CpuClock {
        match self {
            Self::Here(_) => CpuClock::default(),
            Self::Away(remote) => remote.clock(),
        }
    }

    /// What a program was told to take of the bench's, and has never asked for; nothing is known of other cores.
    pub(crate) fn unasked(&self) -> Components {
        match self {
            Self::Here(_) => Components::empty(),
            Self::Away(remote) => remote.unasked(),
        }
    }

    /// What it has printed; nothing of a core in this process is kept.
    pub(crate) fn printed(&self) -> String {
        match self {
            Self::Here(_) => String::new(),
            Self::Away(remote) => remote.printed(),
        }
    }
}
