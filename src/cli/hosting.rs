//! What the command line says of the processes of cores.

use crate::cores::Hosting;
use crate::worker::Limits;
use clap::Args;
use std::path::{Path, PathBuf};

/// Where cores live and what they may use up.
#[derive(Clone, Debug, Args)]
pub(crate) struct HostingArguments {
    /// Time limit of a trial in seconds [default: 120], of one answer a quarter, and less once a
    /// core has hung; for an adapter's program, its file sets the time limit of an image.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    time_limit: Option<f64>,
    /// Memory limit of a core's process: 512M, 4G, or `none` [default: 4G].
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    memory_limit: Option<Memory>,
    /// Let sandboxed cores read this file or folder too; may be repeated.
    #[arg(long, value_name = "PATH")]
    allow_read: Vec<PathBuf>,
    /// Run cores without the sandbox: files, network and processes are open to them.
    #[arg(long)]
    unconfined: bool,
    /// Run our own cores in worker processes too.
    #[arg(long)]
    isolate: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Memory(Option<u64>);

impl HostingArguments {
    /// The same with another default of the time limit.
    pub(crate) fn with_time_limit(&self, seconds: f64) -> Self {
        Self { time_limit: self.time_limit.or(Some(seconds)), ..self.clone() }
    }

    /// How cores are hosted, out of sight of the results in `runs`.
    pub(crate) fn hosting(&self, runs: &Path) -> Hosting {
        let mut limits = Limits::default();
        limits.seconds = self.time_limit.or(limits.seconds);
        limits.memory = self.memory_limit.map_or(limits.memory, |limit| limit.0);
        Hosting {
            limits,
            hidden: vec![runs.to_owned()],
            readable: self.allow_read.clone(),
            confined: !self.unconfined,
            isolates_own: self.isolate,
            ..Hosting::default()
        }
    }
}

fn positive(word: &str) -> Result<f64, String> {
    let number = word.parse().ok().filter(|seconds: &f64| *seconds > 0.0 && seconds.is_finite());
    number.ok_or_else(|| "invalid time limit: must be a positive number of seconds".to_owned())
}

fn memory(word: &str) -> Result<Memory, String> {
    if word == "none" {
        return Ok(Memory(None));
    }
    let (digits, shift) = match word.strip_suffix('G') {
        Some(digits) => (digits, 30),
        None => (word.strip_suffix('M').unwrap_or(""), 20),
    };
    let size = digits.parse::<u64>().ok().and_then(|number| number.checked_mul(1 << shift));
    let size = size.ok_or_else(|| "not a size: write 512M, 4G or none".to_owned())?;
    Ok(Memory(Some(size)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_as_they_are_written() {
        assert_eq!(memory("512M"), Ok(Memory(Some(512 << 20))));
        assert_eq!(memory("4G"), Ok(Memory(Some(4 << 30))));
        assert_eq!(memory("none"), Ok(Memory(None)));
        assert!(memory("4").is_err() && memory("-1G").is_err() && memory("").is_err());
    }
}
