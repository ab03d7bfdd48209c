//! The worker's own end: takes the channel, shuts itself in, says so, and becomes the core.

use super::Channel;
use super::confine::{Confinement, confine};
use super::frame::{self, FrameError};
use super::message::{Answer, encode};
use super::process::Limits;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;
use std::process::Command;

/// The variable that tells a program where its channel is: the number of an inherited socket, or
/// `stdio` where there are none to inherit.
pub(crate) const CHANNEL_VARIABLE: &str = "FURNACE_CHANNEL";

/// What a worker is started for; its one argument, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Errand {
    /// The core, as the user named it.
    pub(crate) spec: String,
    /// What kind of core that is.
    pub(crate) guest: Guest,
    /// What it may use up.
    pub(crate) limits: Limits,
    /// The one folder it may write.
    pub(crate) scratch: PathBuf,
    /// What it may never read, wherever it lies.
    pub(crate) hidden: Vec<PathBuf>,
    /// What the user lets it read besides itself and the system.
    pub(crate) readable: Vec<PathBuf>,
    /// Whether it is shut in at all.
    pub(crate) confined: bool,
}

/// What kind of core a worker is for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Guest {
    /// One of our own, that is in this very program.
    Resident,
    /// A shared library.
    Library(PathBuf),
    /// A program that speaks the protocol itself: its words.
    Program(Vec<String>),
    /// A program that makes pictures, started by the worker for each.
    Renderer {
        /// The file that says how.
        adapter: PathBuf,
        /// What it is started with, as far as that is known before there is a scene.
        words: Vec<String>,
    },
}

impl Guest {
    /// Whether it may start processes.
    pub(crate) const fn starts_processes(&self) -> bool {
        matches!(self, Self::Program(_) | Self::Renderer { .. })
    }
}

/// Why a worker did not get as far as its core.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ChildError {
    /// The system says no.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The bench is gone.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// There is nothing to run.
    #[error("the command is empty")]
    NoProgram,
}

/// Takes the channel away from whatever foreign code will find, shuts the process in, and tells the
/// bench what holds.
///
/// # Errors
/// If there is no channel.
pub(crate) fn begin(errand: &Errand) -> Result<Entered, ChildError> {
    let mut entered = Entered { channel: inherited::take()? };
    let confinement = confine(errand);
    entered.announce(confinement)?;
    Ok(entered)
}

/// A worker that is shut in.
pub(crate) struct Entered {
    channel: inherited::Inherited,
}

impl Entered {
    fn announce(&mut self, confinement: Confinement) -> Result<(), ChildError> {
        let mut buffer = Vec::new();
        encode(&mut buffer, 0, Answer::Confined { confinement }, &[])?;
        Ok(frame::send(&mut self.channel, &buffer)?)
    }

    /// The channel, to serve a core that lives in this process.
    ///
    /// # Errors
    /// If the system says no.
    pub(crate) fn into_channel(self) -> io::Result<Channel> {
        self.channel.into_channel()
    }

    /// Becomes the program; comes back only if that failed, or where a process cannot become
    /// another, when the program has ended.
    ///
    /// # Errors
    /// If the program cannot be started.
    pub(crate) fn run_program(self, words: &[String]) -> Result<i32, ChildError> {
        let [program, arguments @ ..] = words else { return Err(ChildError::NoProgram) };
        let mut command = Command::new(program);
        command.args(arguments);
        Ok(self.channel.hand_to(command)?)
    }
}

/// The channel is a socket that stands as standard input.
#[cfg(unix)]
mod inherited {
    use super::super::eager::Eager;
    use super::{CHANNEL_VARIABLE, Channel};
    use rustix::io::{FdFlags, fcntl_dupfd_cloexec, fcntl_setfd};
    use std::fs::File;
    use std::io::{self, Write};
    use std::os::fd::AsRawFd;
    use std::os::unix::net::UnixStream;
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    pub(crate) struct Inherited(UnixStream);

    /// Moves the socket to where nobody looks for it, and leaves nothing to read behind.
    pub(crate) fn take() -> io::Result<Inherited> {
        let socket = fcntl_dupfd_cloexec(rustix::stdio::stdin(), 3)?;
        rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
        Ok(Inherited(UnixStream::from(socket)))
    }

    impl Inherited {
        pub(crate) fn into_channel(self) -> io::Result<Channel> {
            Ok(Channel { input: Box::new(Eager(self.0.try_clone()?)), output: Box::new(self.0) })
        }

        pub(crate) fn hand_to(self, mut command: Command) -> io::Result<i32> {
            fcntl_setfd(&self.0, FdFlags::empty())?;
            Err(command.env(CHANNEL_VARIABLE, self.0.as_raw_fd().to_string()).exec())
        }
    }

    impl Write for Inherited {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.flush()
        }
    }
}

/// The channel is standard input and output: the core must not print there.
#[cfg(not(unix))]
mod inherited {
    use super::{CHANNEL_VARIABLE, Channel};
    use std::io::{self, Write};
    use std::process::Command;

    pub(crate) struct Inherited;

    pub(crate) fn take() -> io::Result<Inherited> {
        Ok(Inherited)
    }

    impl Inherited {
        pub(crate) fn into_channel(self) -> io::Result<Channel> {
            Ok(Channel { input: Box::new(io::stdin()), output: Box::new(io::stdout()) })
        }

        pub(crate) fn hand_to(self, mut command: Command) -> io::Result<i32> {
            let status = command.env(CHANNEL_VARIABLE, "stdio").status()?;
            Ok(status.code().unwrap_or(1))
        }
    }

    impl Write for Inherited {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            io::stdout().write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            io::stdout().flush()
        }
    }
}
