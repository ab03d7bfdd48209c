//! A program run to its end or to the end of its time, with everything it has started.

use std::collections::BTreeSet;
use std::env;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How much of the end of what a program said is shown.
const LAST_WORDS: u64 = 2_000;
/// How much of what a program said is read at all.
const LONGEST_LOG: u64 = 1 << 22;
/// How often it is looked whether a program has ended.
const GLANCE: Duration = Duration::from_millis(2);

#[derive(Debug)]
pub enum Ended {
    Exited(ExitStatus),
    /// It was killed, with all it had started.
    OutOfTime,
}

/// Whom the processes of a program belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    /// To a group of their own, which is ended with the program.
    Own,
    /// To that of the worker they are in, which may found no other and is ended as a whole.
    Workers,
}

/// What a program said, kept in files while it runs: however much it is, it blocks nobody.
pub(crate) struct Words<'a> {
    folder: &'a Path,
}

const STDOUT: &str = "stdout.txt";
const STDERR: &str = "stderr.txt";

impl Words<'_> {
    /// The end of its standard error, or else of its standard output.
    pub(crate) fn last(&self) -> String {
        let tails = [STDERR, STDOUT].map(|name| tail(&self.folder.join(name), LAST_WORDS));
        let said = tails.into_iter().map(|tail| tail.trim_end().to_owned());
        let last = said.into_iter().find(|tail| !tail.is_empty());
        last.unwrap_or_else(|| "nothing at all".to_owned())
    }

    /// The end of both, for patterns to look through.
    pub(crate) fn all(&self) -> String {
        [STDOUT, STDERR].map(|name| tail(&self.folder.join(name), LONGEST_LOG)).join("\n")
    }
}

fn tail(path: &Path, length: u64) -> String {
    let read = || -> std::io::Result<String> {
        let mut file = File::open(path)?;
        let size = file.metadata()?.len();
        file.seek(SeekFrom::Start(size.saturating_sub(length)))?;
        let mut bytes = Vec::new();
        file.take(length).read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    read().unwrap_or_default()
}

/// Runs `command` in `folder`, where its words are kept.
///
/// # Errors
/// If it cannot be started.
pub(crate) fn run<'a>(
    command: &mut Command,
    folder: &'a Path,
    limit: Duration,
    group: Group,
) -> std::io::Result<(Ended, Words<'a>)> {
    command.stdin(Stdio::null()).current_dir(folder);
    command.stdout(File::create(folder.join(STDOUT))?);
    command.stderr(File::create(folder.join(STDERR))?);
    #[cfg(unix)]
    if group == Group::Own {
        std::os::unix::process::CommandExt::process_group(command, 0);
    }
    #[cfg(target_os = "linux")]
    crate::worker::end_with_us(command);
    let mut groups = groups();
    let child = command.spawn()?;
    if group == Group::Own {
        groups.insert(child.id());
    }
    drop(groups);
    Ok((wait(child, limit, group)?, Words { folder }))
}

/// The groups that run now, by their leaders.
fn groups() -> MutexGuard<'static, BTreeSet<u32>> {
    static GROUPS: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());
    GROUPS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every program that runs in a group of its own, for a process that is about to end. Whoever waits for one waits for
/// ever: that it was ended says nothing about it.
pub(crate) fn end_all() {
    let groups = groups();
    groups.iter().for_each(|leader| end_group(*leader));
    std::mem::forget(groups);
}

/// Waits until it ends, and ends it if that takes too long; with what it has left behind.
fn wait(mut child: Child, limit: Duration, group: Group) -> std::io::Result<Ended> {
    let begun = Instant::now();
    let in_time = loop {
        if has_ended(&mut child)? {
            break true;
        }
        if begun.elapsed() > limit {
            break false;
        }
        std::thread::sleep(GLANCE);
    };
    // Not yet reaped: the number of its group is still its own.
    kill(&mut child, group);
    groups().remove(&child.id());
    let status = child.wait()?;
    Ok(if in_time { Ended::Exited(status) } else { Ended::OutOfTime })
}

/// Whether it has ended; it is still to be reaped.
#[cfg(unix)]
fn has_ended(child: &mut Child) -> std::io::Result<bool> {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
    match waitid(WaitId::Pid(Pid::from_child(child)), options) {
        Err(rustix::io::Errno::INTR) => Ok(false),
        ended => Ok(ended?.is_some()),
    }
}

#[cfg(not(unix))]
fn has_ended(child: &mut Child) -> std::io::Result<bool> {
    Ok(child.try_wait()?.is_some())
}

/// Ends a process, with its group if that is its own.
#[cfg(unix)]
fn kill(child: &mut Child, group: Group) {
    match group {
        Group::Own => end_group(child.id()),
        // Nobody left to end is as good.
        Group::Workers => drop(child.kill()),
    }
}

/// Nobody left to end is as good.
#[cfg(unix)]
fn end_group(leader: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let leader = i32::try_from(leader).ok().and_then(Pid::from_raw);
    let _ = leader.map(|leader| kill_process_group(leader, Signal::KILL));
}

/// There are no groups: a program ends with nobody.
#[cfg(not(unix))]
fn end_group(_leader: u32) {}

/// Ends a process; what it has started goes on. Nobody left to end is as good.
#[cfg(not(unix))]
fn kill(child: &mut Child, _group: Group) {
    let _ = child.kill();
}

/// Where a program is. Links are not followed: a program may ask by which name it was called.
pub(crate) fn found(program: &str) -> Option<PathBuf> {
    if Path::new(program).components().count() > 1 {
        return std::path::absolute(program).ok().filter(|path| path.is_file());
    }
    let folders = env::var_os("PATH")?;
    let suffix = env::consts::EXE_SUFFIX;
    let candidates = env::split_paths(&folders)
        .flat_map(|folder| [folder.join(program), folder.join(format!("{program}{suffix}"))]);
    candidates.filter_map(|path| std::path::absolute(path).ok()).find(|path| path.is_file())
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> (Ended, String) {
        let folder = tempfile::tempdir().unwrap();
        let (ended, words) =
            run(Command::new("sh").args(["-c", script]), folder.path(), limit, Group::Own).unwrap();
        (ended, words.last())
    }

    #[test]
    fn the_end_of_what_a_program_says_is_kept() {
        let long = Duration::from_secs(20);
        let (ended, words) = shell("echo said; yes complaint | head -1000 >&2; exit 3", long);
        assert!(matches!(ended, Ended::Exited(status) if status.code() == Some(3)));
        assert!(words.ends_with("complaint") && words.len() <= LAST_WORDS as usize);
        assert_eq!(shell("echo only this", long).1, "only this");
        assert_eq!(shell("true", long).1, "nothing at all");
    }

    #[test]
    fn a_program_out_of_time_is_killed_with_its_children() {
        let folder = tempfile::tempdir().unwrap();
        let script = "sleep 97 & echo $! > child; wait";
        let clock = Instant::now();
        let mut command = Command::new("sh");
        let (ended, _) = run(
            command.args(["-c", script]),
            folder.path(),
            Duration::from_millis(800),
            Group::Own,
        )
        .unwrap();
        assert!(matches!(ended, Ended::OutOfTime));
        assert!(clock.elapsed() < Duration::from_secs(20));
        assert!(is_gone(&folder.path().join("child")));
    }

    #[test]
    fn what_a_program_leaves_behind_is_killed() {
        let folder = tempfile::tempdir().unwrap();
        let script = "sleep 98 & echo $! > child";
        let mut command = Command::new("sh");
        let (ended, _) =
            run(command.args(["-c", script]), folder.path(), Duration::from_secs(20), Group::Own)
                .unwrap();
        assert!(matches!(ended, Ended::Exited(_)));
        assert!(is_gone(&folder.path().join("child")));
    }

    /// Whether the process whose number is in a file is dead, or is about to be reaped.
    fn is_gone(file: &Path) -> bool {
        let text = std::fs::read_to_string(file).unwrap();
        let number = rustix::process::Pid::from_raw(text.trim().parse().unwrap()).unwrap();
        let is_dead = || {
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", text.trim()));
            rustix::process::test_kill_process(number).is_err()
                || stat.is_ok_and(|stat| stat.contains(") Z "))
        };
        (0..100).any(|_| {
            std::thread::sleep(Duration::from_millis(20));
            is_dead()
        })
    }
}
