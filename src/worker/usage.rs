//! What a worker uses at a moment, with all that it has started.

use super::scratch;
use super::spec::WorkerSpec;
use std::process::Child;
use std::time::Duration;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Usage {
    pub(crate) processes: usize,
    /// Memory they occupy together.
    pub(crate) bytes: u64,
    /// What its files take up.
    pub(crate) written: u64,
    /// Processor time that those there are have had so far.
    pub(crate) computed: Duration,
    /// Whether some thread computes, or waits only for its turn.
    pub(crate) would_compute: bool,
}

/// How many times as long as on an idle machine work takes here now, 1 at least: what has wanted a processor in the last
/// minute, for each processor that there is.
#[cfg(target_os = "linux")]
pub(crate) fn crowding() -> f64 {
    let wanting = std::fs::read_to_string("/proc/loadavg").ok();
    let wanting = wanting.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    let processors = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    wanting.map_or(1.0, |wanting| (wanting / processors as f64).max(1.0))
}

/// Elsewhere nobody is asked, and the machine is taken for idle.
#[cfg(not(target_os = "linux"))]
pub(crate) fn crowding() -> f64 {
    1.0
}

/// Of `child` and, where it is a program, of all it has started.
#[cfg(not(target_os = "linux"))]
pub(crate) fn usage(_: &Child, spec: &WorkerSpec) -> Usage {
    Usage { written: scratch::written(&spec.scratch, &[]), ..Usage::default() }
}

/// Of `child` and, where it is a program, of all it has started.
#[cfg(target_os = "linux")]
pub(crate) fn usage(child: &Child, spec: &WorkerSpec) -> Usage {
    let candidates =
        if spec.origin.may_start_processes() { linux::processes() } else { vec![child.id()] };
    let of = |process: u32| Some((process, linux::usage_of(process, child.id())?));
    let (members, each): (Vec<_>, Vec<_>) = candidates.into_iter().filter_map(of).unzip();
    let together = each.into_iter().fold(Usage::default(), |sum, one| Usage {
        processes: sum.processes + one.processes,
        bytes: sum.bytes + one.bytes,
        computed: sum.computed + one.computed,
        would_compute: sum.would_compute || one.would_compute,
        ..sum
    });
    Usage { written: scratch::written(&spec.scratch, &members), ..together }
}

#[cfg(target_os = "linux")]
mod linux {
    use super::Usage;
    use std::path::{Path, PathBuf};
    use std::time::Duration;

    /// The numbers of all there are.
    pub(super) fn processes() -> Vec<u32> {
        let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
        processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect()
    }

    /// What one process uses, if it is of the group.
    pub(super) fn usage_of(process: u32, group: u32) -> Option<Usage> {
        let folder = PathBuf::from(format!("/proc/{process}"));
        let fields = stat(&folder.join("stat"))?;
        let number = |index: usize| fields.get(index)?.parse::<u64>().ok();
        if number(2)? != u64::from(group) {
            return None;
        }
        let ticks = number(11)? + number(12)?;
        let seconds = ticks as f64 / rustix::param::clock_ticks_per_second() as f64;
        Some(Usage {
            processes: 1,
            bytes: number(21)? * rustix::param::page_size() as u64,
            computed: Duration::from_secs_f64(seconds),
            would_compute: has_runnable_thread(&folder),
            ..Usage::default()
        })
    }

    fn has_runnable_thread(process: &Path) -> bool {
        let threads = std::fs::read_dir(process.join("task")).into_iter().flatten().flatten();
        let mut states =
            threads.filter_map(|thread| stat(&thread.path().join("stat"))?.into_iter().next());
        // Waiting for a disk is no idleness either.
        states.any(|state| state == "R" || state == "D")
    }

    /// The fields of a `stat` file from the state on: `pid (name) state parent group …`. A name may have blanks and
    /// brackets.
    fn stat(path: &Path) -> Option<Vec<String>> {
        let text = std::fs::read_to_string(path).ok()?;
        Some(text.rsplit_once(')')?.1.split_whitespace().map(str::to_owned).collect())
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::*;
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    #[test]
    fn a_group_is_measured() {
        let mut child = Command::new("sleep").arg("10").process_group(0).spawn().unwrap();
        let group = child.id();
        let members: Vec<_> =
            linux::processes().into_iter().filter_map(|one| linux::usage_of(one, group)).collect();
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(members.len(), 1);
    }

    #[test]
    fn a_machine_is_never_less_than_idle() {
        assert!(crowding() >= 1.0);
    }

    #[test]
    fn who_computes_is_told_from_who_sleeps() {
        let group = rustix::process::getpgrp().as_raw_nonzero().get().unsigned_abs();
        let now = || linux::usage_of(std::process::id(), group).unwrap();
        let before = now();
        let begun = std::time::Instant::now();
        while begun.elapsed() < Duration::from_millis(200) {
            std::hint::spin_loop();
        }
        let after = now();
        assert!(after.would_compute && after.bytes > 0, "{after:?} of {group:?}");
        assert!(after.computed >= before.computed);
    }
}
