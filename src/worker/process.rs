//! One worker: a process with a core in it, from its start to its end.

use super::Channel;
use super::client::{Client, Silence};
use super::clock::CpuClock;
use super::guard::{Guard, Watch};
use super::lender::Lender;
use super::message::{Answer, Request, Wanted};
use super::output::Output;
use super::patience::Patience;
use super::spec::{Confinement, Limits, WorkerSpec};
use crate::contract::{Components, CoreError, CoreInfo};
use std::io;
use std::path::PathBuf;
use std::process::{Child, Command};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

/// How long to wait for the last words of a core that has crashed.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// How the workers of a core are started, always the same way.
#[derive(Clone, Debug)]
pub struct Launch {
    /// The `furnace` program.
    pub(crate) program: PathBuf,
    /// What each worker is started for, but for its scratch folder.
    pub(crate) worker: WorkerSpec,
    /// For its environment, besides what every worker keeps.
    pub(crate) variables: Vec<(String, String)>,
    /// What is known of its silences.
    pub(crate) patience: Patience,
}

/// Why there is no worker.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The bench cannot start one.
    #[error("no worker can be started with {program}: {error}")]
    Bench {
        /// The `furnace` program.
        program: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The core failed to start.
    #[error("{error}")]
    Core {
        /// How it ended, or what it refused.
        error: CoreError,
        /// The end of what it printed.
        printed: String,
    },
}

/// Variables that a worker keeps; whatever else the bench knows, secrets above all, is not for it.
const KEPT_VARIABLES: &str = "PATH LANG LC_ALL LD_LIBRARY_PATH DYLD_LIBRARY_PATH PYTHONPATH VIRTUAL_ENV PYENV_VERSION \
    OMP_NUM_THREADS OPENBLAS_NUM_THREADS MKL_NUM_THREADS ASAN_OPTIONS UBSAN_OPTIONS \
    RUST_BACKTRACE SystemRoot PATHEXT";

/// A process with a core in it. It ends, with all it has started, when this is dropped.
pub struct Worker {
    client: Client,
    guard: Arc<Guard>,
    output: Output,
    limits: Limits,
    patience: Patience,
    info: CoreInfo,
    confinement: Confinement,
    /// Why it answers no more.
    dead: Option<CoreError>,
    _watch: Watch,
    /// Deleted when the process has ended.
    _scratch: TempDir,
}

impl Worker {
    /// Starts the process and waits until the core says who it is. Fails if there is no process, or the core fails to
    /// start.
    pub(crate) fn start(launch: &Launch) -> Result<Self, StartError> {
        let failed = |error| StartError::Bench { program: launch.program.clone(), error };
        let scratch = TempDir::with_prefix("furnace-").map_err(failed)?;
        let (reader, writer) = io::pipe().map_err(failed)?;
        let folder = scratch.path().canonicalize().map_err(failed)?;
        let spec = WorkerSpec { scratch: folder, ..launch.worker.clone() };
        let mut command = launch.command(&spec).map_err(failed)?;
        command.stderr(writer.try_clone().map_err(failed)?);
        let Started { child, channel, hang_up } =
            start_with_channel(command, writer).map_err(failed)?;
        let limits = spec.limits;
        let folder = spec.scratch.clone();
        let guard = Guard::new(child, spec, hang_up);
        let mut worker = Self {
            client: Client::new(channel),
            _watch: guard.watch(),
            guard,
            output: Output::of(reader),
            limits,
            patience: launch.patience.clone(),
            info: CoreInfo::default(),
            confinement: Confinement::default(),
            dead: None,
            _scratch: scratch,
        };
        match worker.meet(&limits) {
            Ok(()) => Ok(worker),
            Err(error) => {
                let printed = launch.worker.origin.retold(&worker.printed(), &folder);
                Err(StartError::Core { error, printed })
            }
        }
    }

    /// Hears how the worker is confined, and asks the core who it is.
    fn meet(&mut self, limits: &Limits) -> Result<(), CoreError> {
        let first = self.guarded("start", |client| client.hear(&mut []))?;
        if let Answer::Confined { confinement } = first {
            self.confinement = confinement;
        }
        self.confinement.in_force.push(match limits.seconds {
            Some(seconds) => format!("time: {seconds} s a trial"),
            None => "time: what its adapter's file allows for a picture".to_owned(),
        });
        match self.ask(&Request::new("hello"), &mut [])? {
            Answer::Core { core } => self.info = core,
            other => {
                let what = format!("when it was greeted, it answered `{}`", other.word());
                return Err(CoreError::breach(what));
            }
        }
        Ok(())
    }

    /// Asks the core, and fills `wanted`. Fails with what the core answers, if it is an error, or how it ended. After
    /// that it only says the same.
    pub(crate) fn ask(
        &mut self,
        request: &Request<'_>,
        wanted: &mut [Wanted<'_>],
    ) -> Result<Answer, CoreError> {
        self.guarded(request.name(), |client| client.ask(request, wanted))?.into_result()
    }

    /// From now on the core may ask the bench while it answers.
    pub(crate) fn lend(&mut self, lender: Lender) {
        self.client.lend(lender);
    }

    /// What is lent to the core, and it has never asked for.
    pub(crate) fn unasked(&self) -> Components {
        self.client.unasked()
    }

    /// CPU time of its process while the core answers.
    pub(crate) fn clock(&self) -> CpuClock {
        self.client.clock().clone()
    }

    fn guarded(
        &mut self,
        during: &str,
        exchange: impl FnOnce(&mut Client) -> Result<Answer, Silence>,
    ) -> Result<Answer, CoreError> {
        if let Some(error) = &self.dead {
            return Err(error.clone());
        }
        if let Some(error) = self.patience.refuses(during, &self.limits) {
            return Err(self.ended(error));
        }
        self.guard.asked(self.patience.limit(during, &self.limits));
        let outcome = exchange(&mut self.client);
        let thought = self.guard.answered();
        match outcome {
            // A program that its worker has ended.
            Ok(Answer::TimedOut { limit, during: program }) => {
                self.patience.timed_out(during, limit);
                Ok(Answer::TimedOut { limit, during: program })
            }
            Ok(answer) => {
                self.patience.answered(during, thought);
                Ok(answer)
            }
            Err(silence) => {
                let error = self.why(silence, during);
                Err(self.ended(error))
            }
        }
    }

    /// Why no answer has come.
    fn why(&self, silence: Silence, during: &str) -> CoreError {
        let error = match silence {
            Silence::Gone => self.guard.explain(during, || self.output.last_words(LAST_WORDS)),
            Silence::Nonsense(what) => CoreError::breach(format!("during {during} {what}")),
        };
        if let Some(limit) = self.guard.silence() {
            self.patience.timed_out(during, limit);
        }
        error
    }

    /// Ends it; all it says from now on is why.
    fn ended(&mut self, error: CoreError) -> CoreError {
        // Waiting for a status is all that can fail, and then nobody is there to be ended.
        let _ = self.guard.end();
        self.dead.insert(error).clone()
    }

    pub(crate) const fn info(&self) -> &CoreInfo {
        &self.info
    }

    pub(crate) const fn confinement(&self) -> &Confinement {
        &self.confinement
    }

    /// What the core has printed: all of it, if it has crashed; so far, if it lives.
    pub(crate) fn printed(&self) -> String {
        match self.dead {
            Some(_) => self.output.last_words(LAST_WORDS),
            None => self.output.text(),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // As above.
        let _ = self.guard.end();
    }
}

impl Launch {
    fn command(&self, worker: &WorkerSpec) -> io::Result<Command> {
        let scratch = &worker.scratch;
        let mut command = Command::new(&self.program);
        command.arg("worker").arg(serde_json::to_string(worker)?).env_clear();
        let kept = KEPT_VARIABLES.split_whitespace();
        command.envs(kept.filter_map(|name| Some((name, std::env::var_os(name)?))));
        command.envs(self.variables.iter().map(|(name, value)| (name, value)));
        // What a core writes at home or for a while goes to the folder that it may write.
        command.envs(["HOME", "TMPDIR", "TMP", "TEMP"].map(|name| (name, scratch)));
        command.env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONUNBUFFERED", "1");
        command.current_dir(scratch);
        Ok(command)
    }
}

/// A process, and the bench's end of its channel.
struct Started {
    child: Child,
    channel: Channel,
    hang_up: Box<dyn Fn() + Send + Sync>,
}

/// The channel is a socket that the worker finds as its standard input, and moves away from there.
#[cfg(unix)]
fn start_with_channel(mut command: Command, printed: io::PipeWriter) -> io::Result<Started> {
    use super::eager::Eager;
    use std::net::Shutdown;
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;
    use std::os::unix::process::CommandExt;

    #[cfg(target_os = "linux")]
    super::confine_linux::adopt_orphans();
    let (ours, theirs) = UnixStream::pair()?;
    let child = command.process_group(0).stdin(OwnedFd::from(theirs)).stdout(printed).spawn()?;
    let (reader, handle) = (ours.try_clone()?, ours.try_clone()?);
    let hang_up = Box::new(move || drop(handle.shutdown(Shutdown::Both)));
    let channel = Channel { input: Box::new(Eager(reader)), output: Box::new(ours) };
    Ok(Started { child, channel, hang_up })
}

/// The channel is standard input and output; what the core prints there breaks it.
#[cfg(not(unix))]
fn start_with_channel(mut command: Command, printed: io::PipeWriter) -> io::Result<Started> {
    use std::process::Stdio;
    drop(printed);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let missing = || io::Error::other("a worker without standard streams");
    let output = child.stdin.take().ok_or_else(missing)?;
    let input = child.stdout.take().ok_or_else(missing)?;
    let channel = Channel { input: Box::new(input), output: Box::new(output) };
    Ok(Started { child, channel, hang_up: Box::new(|| {}) })
}
