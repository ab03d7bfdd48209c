//! What is shown while a run goes on, on standard error: a live display on a terminal, a line a trial elsewhere,
//! nothing if the user wants quiet. Results go to standard output, and not from here.

use crate::report::digest::Tally;
use crate::report::text::{Paint, Style, clean, paint_of};
use crate::run::{Event, RunRecord, Status, TrialRecord};
use crate::text::number::{count, duration};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::Duration;

const WHOLE: &str =
    "  {pos}/{len} trials  {wide_bar}  {elapsed} elapsed, about {eta} left\n  {msg}";
/// The line of a trial that runs now.
const RUNNING: &str = "  {elapsed:>5}  {msg}";

/// Listens to a run and shows how it goes.
pub(crate) struct Progress {
    display: Display,
    tally: Tally,
    ended: usize,
    planned: usize,
    longest_core: usize,
    /// Cores that fail to start: they are told of once.
    absent: BTreeSet<String>,
    /// Where to go on when the trials have ended; nowhere if the user wants quiet.
    after: Option<Box<dyn Write>>,
}

enum Display {
    Quiet,
    Lines(Box<dyn Write>),
    Live(Live),
}

/// Bars that draw over themselves: what runs now, and one for the whole.
struct Live {
    screen: MultiProgress,
    whole: ProgressBar,
    running: BTreeMap<(String, String), ProgressBar>,
    style: Style,
}

impl Progress {
    /// What suits standard error. Quiet shows nothing.
    pub(crate) fn new(quiet: bool) -> Self {
        let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let display = match () {
            () if quiet => Display::Quiet,
            () if std::io::stderr().is_terminal() && !is_dumb => {
                let colour = std::env::var_os("NO_COLOR").is_none();
                Display::Live(Live::new(ProgressDrawTarget::stderr(), colour))
            }
            () => Display::Lines(Box::new(std::io::stderr())),
        };
        let after = (!quiet).then(|| Box::new(std::io::stderr()) as Box<dyn Write>);
        Self { after, ..Self::on(display) }
    }

    fn on(display: Display) -> Self {
        let (tally, absent) = (Tally::default(), BTreeSet::new());
        Self { display, tally, ended: 0, planned: 0, longest_core: 0, absent, after: None }
    }

    pub(crate) fn hear(&mut self, event: Event<'_>) {
        match event {
            Event::Planned { run, folder, already_done } => self.planned(run, folder, already_done),
            Event::Started { core, case } => {
                if let Display::Live(live) = &mut self.display {
                    live.start(core, case);
                }
            }
            Event::Ended { trial } => self.ended(trial),
            Event::Transplanting { core } => self.transplanting(core),
        }
    }

    /// The bars are gone by then: a line tells that it goes on.
    fn transplanting(&mut self, core: &str) {
        if let Some(out) = &mut self.after {
            let failures = format!("failures of {} are tried again", clean(core));
            print(out, &format!("{failures}, with the bench's components in place of its own"));
        }
    }

    fn planned(&mut self, run: &RunRecord, folder: &Path, already_done: usize) {
        self.planned = run.trials;
        self.ended = already_done;
        self.longest_core = run.cores.iter().map(|core| core.spec.len()).max().unwrap_or(0);
        let absent = run.cores.iter().map(|core| &core.spec).filter(|core| run.is_absent(core));
        self.absent = absent.cloned().collect();
        let told = self.absent.iter().map(|core| format!("{} fails to start", clean(core)));
        match &mut self.display {
            Display::Quiet => {}
            Display::Lines(out) => {
                print(out, &opening(run, folder, already_done));
                told.for_each(|line| print(out, &line));
            }
            Display::Live(live) => {
                live.plan(run.trials, already_done);
                told.for_each(|line| live.whole.println(format!("  {line}")));
            }
        }
        self.close_at_the_end();
    }

    fn ended(&mut self, trial: &TrialRecord) {
        self.ended += 1;
        self.tally.add(trial.outcome.status());
        let planned = self.planned.to_string();
        let place = format!("{:>width$}/{planned}", self.ended, width = planned.len());
        let is_told = self.absent.contains(&trial.core);
        match &mut self.display {
            Display::Lines(_) if is_told => {}
            Display::Quiet => {}
            Display::Lines(out) => {
                print(out, &format!("{place}  {}", line(trial, self.longest_core, Style::PLAIN)));
            }
            Display::Live(live) => {
                live.end(trial, self.tally.words(), self.longest_core, is_told);
            }
        }
        self.close_at_the_end();
    }

    /// Takes the bars away before anything else is printed: whatever stands below them would be erased.
    fn close_at_the_end(&mut self) {
        if self.ended >= self.planned && matches!(self.display, Display::Live(_)) {
            self.display = Display::Quiet;
        }
    }
}

impl Live {
    fn new(target: ProgressDrawTarget, colour: bool) -> Self {
        let screen = MultiProgress::with_draw_target(target);
        let whole = screen.add(ProgressBar::new(0));
        whole.set_style(template(WHOLE));
        let style = Style { colour, ..Style::PLAIN };
        Self { screen, whole, running: BTreeMap::new(), style }
    }

    fn plan(&self, trials: usize, already_done: usize) {
        self.whole.set_length(trials as u64);
        self.whole.set_position(already_done as u64);
        // What an earlier run has done says nothing about the speed of this one.
        self.whole.reset_eta();
        self.whole.enable_steady_tick(Duration::from_secs(1));
    }

    fn start(&mut self, core: &str, case: &str) {
        let bar = self.screen.insert_before(&self.whole, ProgressBar::new_spinner());
        bar.set_style(template(RUNNING));
        bar.set_message(format!("{} on {}", clean(case), clean(core)));
        bar.enable_steady_tick(Duration::from_secs(1));
        self.running.insert((core.to_owned(), case.to_owned()), bar);
    }

    /// What did not pass stays on the screen.
    fn end(&mut self, trial: &TrialRecord, tally: String, longest_core: usize, is_told: bool) {
        if let Some(bar) = self.running.remove(&(trial.core.clone(), trial.case.clone())) {
            bar.finish_and_clear();
            self.screen.remove(&bar);
        }
        if trial.outcome.status() != Status::Pass && !is_told {
            self.whole.println(format!("  {}", line(trial, longest_core, self.style)));
        }
        self.whole.inc(1);
        self.whole.set_message(tally);
    }
}

impl Drop for Live {
    /// Also when a run stops half-way.
    fn drop(&mut self) {
        for bar in self.running.values() {
            bar.finish_and_clear();
        }
        self.whole.finish_and_clear();
    }
}

/// The style of a bar; a mistake in it costs the looks, not the run.
fn template(text: &str) -> ProgressStyle {
    let style = ProgressStyle::with_template(text).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.progress_chars("##-")
}

fn opening(run: &RunRecord, folder: &Path, already_done: usize) -> String {
    let cores: Vec<_> = run.cores.iter().map(|core| clean(&core.spec)).collect();
    let trials = count(run.trials, "trial");
    let done =
        if already_done == 0 { String::new() } else { format!(", {already_done} already done") };
    format!("{trials} on {}{done}; results go to {}", cores.join(" and "), folder.display())
}

/// One trial: outcome, time, core, case; what was found unless it passed.
fn line(trial: &TrialRecord, longest_core: usize, style: Style) -> String {
    let status = trial.outcome.status();
    let word = style.paint(paint_of(status), &format!("{:<12}", status.word()));
    let (seconds, core) = (duration(trial.timing.seconds), clean(&trial.core));
    let head = format!("{word} {seconds:>9}  {core:<longest_core$}  {}", clean(&trial.case));
    if status == Status::Pass {
        return head;
    }
    let statement = clean(&trial.outcome.statement()).replace('\n', "; ");
    format!("{head}: {}", style.paint(Paint::Faint, &statement))
}

/// A closed standard error must not end the run.
fn print(out: &mut impl Write, line: &str) {
    let _ = writeln!(out, "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::Example;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// A standard error that can be read.
    #[derive(Clone, Default)]
    struct Shared(Rc<RefCell<Vec<u8>>>);

    impl Write for Shared {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.borrow_mut().write(bytes)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    fn tell(progress: &mut Progress, example: &Example, already_done: usize) {
        let folder = Path::new("runs/one");
        progress.hear(Event::Planned { run: &example.run, folder, already_done });
        for trial in &example.trials[already_done..] {
            progress.hear(Event::Started { core: &trial.core, case: &trial.case });
            progress.hear(Event::Ended { trial });
        }
    }

    fn lines(example: &Example, already_done: usize) -> Vec<String> {
        let shared = Shared::default();
        let mut progress = Progress::on(Display::Lines(Box::new(shared.clone())));
        tell(&mut progress, example, already_done);
        let text = String::from_utf8(shared.0.take()).unwrap();
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn without_a_terminal_every_trial_is_one_plain_line() {
        let lines = lines(&Example::mixed(), 0);
        assert_eq!(lines.len(), 1 + 24);
        assert_eq!(lines[0], "24 trials on builtin and textbook; results go to runs/one");
        assert!(lines.iter().all(|line| !line.contains('\x1b')));
        assert!(lines.iter().any(|line| line.contains("timed out") && line.contains("30 s")));
        assert!(lines[24].starts_with("24/24  "), "{}", lines[24]);
    }

    #[test]
    fn only_what_did_not_pass_says_what_was_found() {
        let lines = lines(&Example::mixed(), 0);
        let passed = lines.iter().filter(|line| line.contains("  pass  "));
        assert_eq!(passed.filter(|line| line.contains(": ")).count(), 0);
        let failed: Vec<_> = lines.iter().filter(|line| line.contains("  fail  ")).collect();
        assert_eq!(failed.len(), 3);
        assert!(failed.iter().all(|line| line.contains(": ")), "{failed:?}");
    }

    #[test]
    fn a_core_that_does_not_start_is_told_of_once() {
        let mut example = Example::mixed();
        example.run.cores[1].problem = Some("the core crashed during hello".to_owned());
        let lines = lines(&example, 0);
        let of_it = lines.iter().filter(|line| line.contains("textbook"));
        assert_eq!(of_it.collect::<Vec<_>>(), [&lines[0], "textbook fails to start"]);
    }

    #[test]
    fn a_resumed_run_counts_on() {
        let lines = lines(&Example::green(), 20);
        assert!(lines[0].contains("24 trials on builtin and textbook, 20 already done"));
        assert!(lines[1].starts_with("21/24  pass"));
    }

    #[test]
    fn the_live_display_forgets_what_has_ended() {
        let live = Live::new(ProgressDrawTarget::hidden(), true);
        let mut progress = Progress::on(Display::Live(live));
        let mut example = Example::mixed();
        example.run.trials += 1;
        tell(&mut progress, &example, 4);
        let Display::Live(live) = &progress.display else { panic!("not live") };
        assert_eq!((live.whole.position(), live.whole.length()), (24, Some(25)));
        assert!(live.running.is_empty());
        assert!(live.whole.message().contains("3 fail"), "{}", live.whole.message());
    }

    #[test]
    fn the_live_display_is_gone_when_the_last_trial_has_ended() {
        for already_done in [0, 24] {
            let live = Live::new(ProgressDrawTarget::hidden(), true);
            let mut progress = Progress::on(Display::Live(live));
            tell(&mut progress, &Example::green(), already_done);
            assert!(matches!(progress.display, Display::Quiet));
        }
    }

    #[test]
    fn bars_have_their_own_looks() {
        for looks in [WHOLE, RUNNING] {
            assert!(ProgressStyle::with_template(looks).is_ok(), "{looks}");
        }
    }
}
