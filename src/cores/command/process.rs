//! A program run to its end or to the end of its time, with everything it has started.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// How much of the end of what a program said is shown.
const LAST_WORDS: u64 = 2_000;
/// How much of what a program said is read at all.
const LONGEST_LOG: u64 = 1 << 22;

/// How a program ended.
#[derive(Debug)]
pub enum Ended {
    /// By itself.
    Exited(ExitStatus),
    /// It was killed, with all it had started.
    OutOfTime,
}

/// What a program said, kept in files while it runs: however much it is, it blocks nobody.
pub struct Words<'a> {
    folder: &'a Path,
}

const STDOUT: &str = "stdout.txt";
const STDERR: &str = "stderr.txt";

impl Words<'_> {
    /// The end of its standard error, or else of its standard output.
    pub fn last(&self) -> String {
        let tails = [STDERR, STDOUT].map(|name| tail(&self.folder.join(name), LAST_WORDS));
        let said = tails.into_iter().map(|tail| tail.trim_end().to_owned());
        let last = said.into_iter().find(|tail| !tail.is_empty());
        last.unwrap_or_else(|| "nothing at all".to_owned())
    }

    /// The end of both, for patterns to look through.
    pub fn all(&self) -> String {
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
pub fn run<'a>(
    command: &mut Command,
    folder: &'a Path,
    limit: Duration,
) -> std::io::Result<(Ended, Words<'a>)> {
    command.stdin(Stdio::null()).current_dir(folder);
    command.stdout(File::create(folder.join(STDOUT))?);
    command.stderr(File::create(folder.join(STDERR))?);
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let child = command.spawn()?;
    Ok((wait(child, limit)?, Words { folder }))
}

/// Waits in a thread of its own, so that there can be an end to waiting.
fn wait(mut child: Child, limit: Duration) -> std::io::Result<Ended> {
    let (sender, receiver) = mpsc::channel();
    let group = child.id();
    let waiter = std::thread::spawn(move || {
        until_exit(&child);
        // Not yet reaped: the number of its group is still its own.
        kill_group(group);
        let _ = sender.send(());
        child.wait()
    });
    let in_time = receiver.recv_timeout(limit).is_ok();
    if !in_time {
        kill_group(group);
    }
    let status =
        waiter.join().map_err(|_| std::io::Error::other("the waiting thread panicked"))??;
    Ok(if in_time { Ended::Exited(status) } else { Ended::OutOfTime })
}

/// Waits for the end of a child that is still to be reaped.
#[cfg(unix)]
fn until_exit(child: &Child) {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT;
    while let Err(rustix::io::Errno::INTR) = waitid(WaitId::Pid(Pid::from_child(child)), options) {}
}

#[cfg(not(unix))]
fn until_exit(_child: &Child) {}

/// Kills a group of processes, if it is there.
#[cfg(unix)]
fn kill_group(group: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let group = i32::try_from(group).ok().and_then(Pid::from_raw);
    // Nobody left to kill is as good.
    let _ = group.map(|group| kill_process_group(group, Signal::KILL));
}

#[cfg(not(unix))]
fn kill_group(_group: u32) {}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::time::Instant;

    fn shell(script: &str, limit: Duration) -> (Ended, String) {
        let folder = tempfile::tempdir().unwrap();
        let (ended, words) =
            run(Command::new("sh").args(["-c", script]), folder.path(), limit).unwrap();
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
        let (ended, _) =
            run(command.args(["-c", script]), folder.path(), Duration::from_millis(800)).unwrap();
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
            run(command.args(["-c", script]), folder.path(), Duration::from_secs(20)).unwrap();
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
