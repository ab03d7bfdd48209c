//! Holds a worker to its limits, ends it with everything it has started, and says how it ended.

use super::spec::WorkerSpec;
use super::usage::{Usage, usage};
use crate::contract::CoreError;
use std::io;
use std::process::{Child, ExitStatus};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// How often a worker is looked at: while processes can multiply, and otherwise.
const TICK_OF_PROGRAMS: Duration = Duration::from_millis(25);
const TICK: Duration = Duration::from_millis(200);

/// How long a worker that has closed its channel may take to end.
const FAREWELL: Duration = Duration::from_secs(1);

/// How many times its limit the bench waits for a worker in all, however busy the machine is: one
/// that computes a little now and then does not go on for ever.
const PATIENCE: u32 = 20;

pub(crate) struct Guard {
    /// Its limits and its folder; and whether it may start processes, which are then counted.
    spec: WorkerSpec,
    state: Mutex<State>,
    /// Wakes whoever reads the channel, though a process that got away may hold its other end.
    hang_up: Box<dyn Fn() + Send + Sync>,
}

struct State {
    child: Child,
    /// The time that it has for the question that it is asked, if it is.
    asked: Option<Duration>,
    /// The time that is charged to it for that question.
    thought: Duration,
    /// The time that is charged to it; see [`charge`].
    charged: Duration,
    /// The time that the bench has waited for it.
    waited: Duration,
    /// When it was last looked at, and what it had used by then.
    seen: (Instant, Usage),
    sentence: Option<Sentence>,
    status: Option<ExitStatus>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sentence {
    Time,
    /// It has had so much for one question.
    Silence(Duration),
    Processes(usize),
    Memory(u64),
    Files(u64),
}

/// Stops the looking when it is dropped.
pub(crate) struct Watch(#[expect(dead_code, reason = "held, never used")] mpsc::Sender<()>);

impl Guard {
    /// Over `child`, which leads a process group.
    pub(crate) fn new(
        child: Child,
        spec: WorkerSpec,
        hang_up: Box<dyn Fn() + Send + Sync>,
    ) -> Arc<Self> {
        let state = State {
            child,
            asked: None,
            thought: Duration::ZERO,
            charged: Duration::ZERO,
            waited: Duration::ZERO,
            seen: (Instant::now(), Usage::default()),
            sentence: None,
            status: None,
        };
        Arc::new(Self { spec, state: Mutex::new(state), hang_up })
    }

    /// Looks at the worker again and again until the answer is dropped.
    pub(crate) fn watch(self: &Arc<Self>) -> Watch {
        let guard = Arc::clone(self);
        let (sender, receiver) = mpsc::channel();
        let tick = self.tick();
        thread::spawn(move || {
            while receiver.recv_timeout(tick) == Err(mpsc::RecvTimeoutError::Timeout) {
                guard.look();
            }
        });
        Watch(sender)
    }

    fn tick(&self) -> Duration {
        if self.spec.origin.may_start_processes() { TICK_OF_PROGRAMS } else { TICK }
    }

    /// It is asked a question that it may think about for so long.
    pub(crate) fn asked(&self, limit: Duration) {
        let mut state = self.lock();
        (state.asked, state.thought) = (Some(limit), Duration::ZERO);
    }

    /// It has answered, or never will: the time that was charged to it for this, as far as it was looked at.
    pub(crate) fn answered(&self) -> Duration {
        let mut state = self.lock();
        state.asked = None;
        state.thought
    }

    fn look(&self) {
        let mut state = self.lock();
        if state.sentence.is_some() || state.status.is_some() {
            return;
        }
        let usage = usage(&state.child, &self.spec);
        charge(&mut state, usage, self.tick());
        let Some(sentence) = self.judge(&state) else { return };
        state.sentence = Some(sentence);
        kill(&mut state.child);
        (self.hang_up)();
    }

    fn judge(&self, state: &State) -> Option<Sentence> {
        let Usage { processes, bytes, written, .. } = state.seen.1;
        let limits = &self.spec.limits;
        let late = state.waited > limits.time().saturating_mul(PATIENCE);
        if let Some(limit) = state.asked.filter(|limit| state.thought > *limit) {
            Some(Sentence::Silence(limit))
        } else if late || state.charged > limits.time() {
            Some(Sentence::Time)
        } else if processes > limits.processes {
            Some(Sentence::Processes(processes))
        } else if written > limits.scratch {
            Some(Sentence::Files(written))
        } else {
            limits.memory.filter(|limit| bytes > *limit).map(|_| Sentence::Memory(bytes))
        }
    }

    /// Ends the worker, if it has not ended, with all it has started; nothing of it is left afterwards.
    pub(crate) fn end(&self) -> io::Result<ExitStatus> {
        let mut state = self.lock();
        if let Some(status) = state.status {
            return Ok(status);
        }
        // Before it is waited for: until then its group is nobody else's.
        kill(&mut state.child);
        let status = state.child.wait()?;
        state.status = Some(status);
        bury(&state.child);
        Ok(status)
    }

    /// The time in which it did not answer one question, if it was ended for that.
    pub(crate) fn silence(&self) -> Option<Duration> {
        match self.lock().sentence {
            Some(Sentence::Silence(limit)) => Some(limit),
            _ => None,
        }
    }

    /// Why no answer has come, once the channel is closed. `printed` is what the core has printed.
    pub(crate) fn explain(&self, during: &str, printed: impl FnOnce() -> String) -> CoreError {
        let ended_by_itself = self.wait_for_the_end();
        let sentence = self.lock().sentence;
        let during = during.to_owned();
        let crashed =
            |how: String| CoreError::Crashed { how, during: during.clone(), element: None };
        match (sentence, self.end()) {
            (Some(Sentence::Time), _) => {
                CoreError::TimedOut { limit: self.spec.limits.time(), during }
            }
            (Some(Sentence::Silence(limit)), _) => CoreError::TimedOut { limit, during },
            (Some(Sentence::Processes(count)), _) => {
                crashed(format!("ended: it had started {count} processes"))
            }
            (Some(Sentence::Memory(bytes)), _) => {
                crashed(format!("ended: out of memory, {} MiB in all its processes", bytes >> 20))
            }
            (Some(Sentence::Files(bytes)), _) => {
                crashed(format!("ended: out of scratch space, {} MiB in its files", bytes >> 20))
            }
            (None, Ok(_)) if !ended_by_itself => {
                crashed("it closed its channel and went on running".to_owned())
            }
            (None, Ok(status)) => {
                let out_of_memory = is_about_memory(&printed());
                let why = if out_of_memory { ", out of memory" } else { "" };
                crashed(format!("{}{why}", death(status)))
            }
            (None, Err(error)) => crashed(format!("its process cannot be waited for: {error}")),
        }
    }

    fn wait_for_the_end(&self) -> bool {
        let begun = Instant::now();
        while begun.elapsed() < FAREWELL {
            let state = self.lock();
            if state.status.is_some() || state.sentence.is_some() || has_ended(&state.child) {
                return true;
            }
            drop(state);
            thread::sleep(Duration::from_millis(1));
        }
        false
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What runtimes of C++, Python and Rust say when there is no more.
fn is_about_memory(printed: &str) -> bool {
    let words = ["bad_alloc", "MemoryError", "memory allocation of", "annot allocate memory"];
    words.iter().any(|word| printed.contains(word))
}

/// Charges the time since the last look, if the bench waits. To a worker that would compute, only as much as it was given:
/// a machine that is busy with something else makes nobody late. To one that does nothing, no more than until the next look
/// but one was due: where looks come later, so does whoever reads what it may have answered.
fn charge(state: &mut State, usage: Usage, tick: Duration) {
    let (seen, before) = std::mem::replace(&mut state.seen, (Instant::now(), usage));
    if state.asked.is_some() {
        let passed = seen.elapsed();
        let computed = usage.computed.saturating_sub(before.computed);
        let is_idle = !before.would_compute && !usage.would_compute && computed.is_zero();
        let charged = passed.min(if is_idle { 2 * tick } else { computed });
        state.charged += charged;
        state.thought += charged;
        state.waited += passed;
    }
}

#[cfg(unix)]
use unix::{bury, death, has_ended, kill};

#[cfg(unix)]
mod unix {
    use crate::worker::overflow;
    use rustix::process::{
        Pid, Signal, WaitId, WaitIdOptions, WaitOptions, kill_process_group, waitid, waitpgid,
    };
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Child, ExitStatus};

    /// Ends the whole group at once: nobody in it can start anything any more.
    pub(crate) fn kill(child: &mut Child) {
        // Nothing to be done if it is gone already.
        let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
    }

    /// Whether it has ended; whoever asks for its status still gets it.
    pub(crate) fn has_ended(child: &Child) -> bool {
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
        !matches!(waitid(WaitId::Pid(Pid::from_child(child)), options), Ok(None))
    }

    /// Waits for those it had started, who are ours since it ended.
    pub(crate) fn bury(child: &Child) {
        while let Ok(Some(_)) = waitpgid(Pid::from_child(child), WaitOptions::empty()) {}
    }

    pub(crate) fn death(status: ExitStatus) -> String {
        match (status.signal(), status.code()) {
            (Some(signal), _) if overflow::tells(signal) => {
                "stack overflow (SIGSEGV: the end of the stack, as of a recursion without end)"
                    .to_owned()
            }
            (Some(signal), _) => format!("signal {signal}{}", meaning(signal)),
            (None, Some(code)) => format!("exit code {code} without an answer"),
            (None, None) => "it ended in an unknown way".to_owned(),
        }
    }

    fn meaning(signal: i32) -> &'static str {
        match signal {
            libc::SIGSEGV => " (SIGSEGV: memory that is not its own, or a stack that overflowed)",
            libc::SIGBUS => " (SIGBUS: memory that is not there)",
            libc::SIGABRT => " (SIGABRT: it gave up, as after an uncaught exception or a panic)",
            libc::SIGFPE => " (SIGFPE: an integer divided by zero)",
            libc::SIGILL => " (SIGILL: an instruction that does not exist)",
            libc::SIGTRAP => " (SIGTRAP: a trap, as at the end of a function without return)",
            libc::SIGKILL => " (SIGKILL: ended from outside, as when the machine is out of memory)",
            libc::SIGXFSZ => " (SIGXFSZ: a file longer than it may be)",
            libc::SIGPIPE => " (SIGPIPE: it wrote where nobody reads)",
            libc::SIGTERM => " (SIGTERM: it was asked to end)",
            libc::SIGSYS => " (SIGSYS: a call that it may not make)",
            _ => "",
        }
    }
}

#[cfg(not(unix))]
use elsewhere::{bury, death, has_ended, kill};

#[cfg(not(unix))]
mod elsewhere {
    use std::process::{Child, ExitStatus};

    /// Ends the process; what it has started goes on.
    pub(crate) fn kill(child: &mut Child) {
        // Nothing to be done if it is gone already.
        let _ = child.kill();
    }

    /// Not to be known without taking its status: whoever waits finds out.
    pub(crate) fn has_ended(_: &Child) -> bool {
        true
    }

    pub(crate) fn bury(_: &Child) {}

    pub(crate) fn death(status: ExitStatus) -> String {
        match status.code() {
            Some(code) => format!("exit code {code} without an answer"),
            None => "it ended in an unknown way".to_owned(),
        }
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn a_look_that_comes_late_charges_an_idle_worker_two_looks_at_most() {
        let five = Duration::from_secs(5);
        let mut state = State {
            child: Command::new("sleep").arg("10").spawn().unwrap(),
            asked: Some(five),
            thought: Duration::ZERO,
            charged: Duration::ZERO,
            waited: Duration::ZERO,
            seen: (Instant::now().checked_sub(five).unwrap(), Usage::default()),
            sentence: None,
            status: None,
        };
        charge(&mut state, Usage::default(), TICK);
        assert_eq!((state.thought, state.charged), (2 * TICK, 2 * TICK));
        assert!(state.waited >= five);
        // What it computes is its own, however late the look.
        state.seen.0 = Instant::now().checked_sub(five).unwrap();
        let computed = Duration::from_secs(1);
        charge(&mut state, Usage { computed, ..Usage::default() }, TICK);
        assert_eq!(state.thought, 2 * TICK + computed);
        state.child.kill().unwrap();
        state.child.wait().unwrap();
    }
}
