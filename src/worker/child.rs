//! The worker's own end: takes the channel, confines itself, says so, and becomes the core.

use super::Channel;
use super::confine::confine;
use super::frame::{self, FrameError};
use super::message::{Answer, encode};
use super::spec::WorkerSpec;
use std::io;
use std::process::Command;

pub(crate) use inherited::Inherited;

/// The variable that tells a program where its channel is: the number of an inherited socket, or
/// `stdio` where there are none to inherit.
pub(crate) const CHANNEL_VARIABLE: &str = "FURNACE_CHANNEL";

#[derive(Debug, thiserror::Error)]
pub(crate) enum ChildError {
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The bench is gone.
    #[error(transparent)]
    Frame(#[from] FrameError),
    #[error("the command is empty")]
    NoProgram,
}

/// Takes the channel away from whatever foreign code will find, confines the process, and tells the bench what holds.
/// Fails if there is no channel.
pub(crate) fn begin(worker: &WorkerSpec) -> Result<Inherited, ChildError> {
    let mut channel = inherited::take()?;
    let mut buffer = Vec::new();
    encode(&mut buffer, 0, Answer::Confined { confinement: confine(worker) }, &[], None)?;
    frame::send(&mut channel.output(), &buffer)?;
    Ok(channel)
}

/// Becomes the program; comes back only if that failed, or where a process cannot become another, when the program has
/// ended. Fails if the program cannot be started.
pub(crate) fn run_program(words: &[String], channel: Inherited) -> Result<i32, ChildError> {
    let [program, arguments @ ..] = words else { return Err(ChildError::NoProgram) };
    let mut command = Command::new(program);
    command.args(arguments);
    Ok(channel.hand_to(command)?)
}

/// The channel is a socket that stands as standard input.
#[cfg(unix)]
mod inherited {
    use super::super::eager::Eager;
    use super::{CHANNEL_VARIABLE, Channel};
    use rustix::io::{FdFlags, fcntl_dupfd_cloexec, fcntl_setfd};
    use std::fs::File;
    use std::io;
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
        pub(super) fn output(&mut self) -> &mut UnixStream {
            &mut self.0
        }

        pub(crate) fn into_channel(self) -> io::Result<Channel> {
            Ok(Channel { input: Box::new(Eager(self.0.try_clone()?)), output: Box::new(self.0) })
        }

        pub(crate) fn hand_to(self, mut command: Command) -> io::Result<i32> {
            fcntl_setfd(&self.0, FdFlags::empty())?;
            Err(command.env(CHANNEL_VARIABLE, self.0.as_raw_fd().to_string()).exec())
        }
    }
}

/// The channel is standard input and output: the core must not print there.
#[cfg(not(unix))]
mod inherited {
    use super::{CHANNEL_VARIABLE, Channel};
    use std::io;
    use std::process::Command;

    pub(crate) struct Inherited;

    pub(crate) fn take() -> io::Result<Inherited> {
        Ok(Inherited)
    }

    impl Inherited {
        pub(super) fn output(&mut self) -> io::Stdout {
            io::stdout()
        }

        pub(crate) fn into_channel(self) -> io::Result<Channel> {
            Ok(Channel { input: Box::new(io::stdin()), output: Box::new(io::stdout()) })
        }

        pub(crate) fn hand_to(self, mut command: Command) -> io::Result<i32> {
            let status = command.env(CHANNEL_VARIABLE, "stdio").status()?;
            Ok(status.code().unwrap_or(1))
        }
    }
}
