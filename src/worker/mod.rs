//! Why a process: a core is foreign code. It crashes, hangs, prints, eats memory, and some would
//! cheat; whatever it does has to stay one trial's result.
//!
//! A core is asked through frames on a private channel (`frame`, `message`; `client` asks, `serve` answers). `process`
//! starts the worker that the core lives in, holds it to its limits (`guard`, `patience`), keeps what it prints (`output`) and says
//! how it ended; `child` is the other end of that, which confines itself (`confine`) before any foreign code runs.
//! A program that takes components of the bench asks for them in the same frames (`lender`). `narrow` finds the element of a batch that a core dies of.
//!
//! Not here: which cores there are (`cores`), and what their answers are worth (`checks`).

pub(crate) mod child;
mod client;
mod clock;
mod confine;
#[cfg(target_os = "linux")]
mod confine_linux;
#[cfg(unix)]
mod eager;
pub(crate) mod frame;
mod guard;
mod lender;
pub mod message;
pub(crate) mod narrow;
mod output;
pub(crate) mod overflow;
mod patience;
mod process;
#[cfg(target_os = "linux")]
mod readable;
mod scene;
mod scratch;
mod serve;
mod spec;
mod usage;

pub use client::Client;
pub(crate) use clock::CpuClock;
#[cfg(target_os = "linux")]
pub(crate) use confine_linux::end_with_us;
pub(crate) use lender::Lender;
pub(crate) use patience::Patience;
pub(crate) use process::{Launch, StartError, Worker};
pub use scene::build_request;
pub(crate) use serve::refuse;
pub use serve::serve;
pub use spec::Limits;
pub(crate) use spec::{Confinement, CoreOrigin, WorkerSpec};
pub(crate) use usage::crowding;

use std::io::{Read, Write};

/// Both directions of a private channel.
pub struct Channel {
    /// Where frames come from.
    pub input: Box<dyn Read + Send>,
    /// Where frames go.
    pub output: Box<dyn Write + Send>,
}
