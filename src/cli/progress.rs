//! What is shown while a run goes on, on standard error: a live display on a terminal, elsewhere a line for what does
//! not pass and now and then how far it is, nothing if the user wants quiet. Results go to standard output, and not from here.

use crate::report::text::{Detail, Paint, Style, clean, cut, paint_of};
use crate::run::{Counts, Event, RunRecord, Status, TrialRecord};
use crate::text::colour::Colour;
use crate::text::number::{count, duration};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

const WHOLE: &str =
    "  {pos}/{len} trials  {wide_bar}  {elapsed} elapsed, about {eta} left\n  {msg}";
/// A log that is silent for longer looks dead.
pub(super) const HEARTBEAT: Duration = Duration::from_secs(30);
/// The line of a trial that runs now.
pub(super) const RUNNING: &str = "  {elapsed:>5}  {msg}";

/// Listens to a run and shows how it goes.
pub(crate) struct Progress {
    display: Display,
    counts: Counts,
    /// Width of the column of cores, if there are several.
    longest_core: usize,
    /// Cores that fail to start: they are told of once.
    absent: BTreeSet<String>,
    /// Where to go on when the trials have ended; nowhere if the user wants quiet.
    after: Option<Box<dyn Write>>,
}

enum Display {
    Quiet,
    Lines(Lines),
    Live(Live),
}

/// A log: what does not pass, and now and then how far it is.
struct Lines {
    out: Box<dyn Write>,
    last: Instant,
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
        let display = match () {
            () if quiet => Display::Quiet,
            () if is_live() => {
                let colour = Colour::is_wanted(true);
                Display::Live(Live::new(ProgressDrawTarget::stderr(), colour))
            }
            () => Display::Lines(Lines::new(std::io::stderr())),
        };
        let after = (!quiet).then(|| Box::new(std::io::stderr()) as Box<dyn Write>);
        Self { after, ..Self::on(display) }
    }

    fn on(display: Display) -> Self {
        let (counts, absent) = (Counts::default(), BTreeSet::new());
        Self { display, counts, longest_core: 0, absent, after: None }
    }

    pub(crate) fn hear(&mut self, event: Event<'_>) {
        match event {
            Event::Planned { run, folder, earlier } => self.planned(run, folder, earlier),
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

    fn planned(&mut self, run: &RunRecord, folder: &Path, earlier: &[TrialRecord]) {
        self.counts = Counts::of(run.trials, earlier);
        if let [_, _, ..] = run.cores[..] {
            self.longest_core = run.cores.iter().map(|core| core.spec.len()).max().unwrap_or(0);
        }
        let absent = run.cores.iter().map(|core| &core.spec).filter(|core| run.is_absent(core));
        self.absent = absent.cloned().collect();
        let told = self.absent.iter().map(|core| format!("{} fails to start", clean(core)));
        match &mut self.display {
            Display::Quiet => {}
            Display::Lines(lines) => {
                lines.print(&opening(run, folder, earlier.len()));
                told.for_each(|line| lines.print(&line));
            }
            Display::Live(live) => {
                live.plan(run.trials, earlier.len());
                told.for_each(|line| live.whole.println(format!("  {line}")));
            }
        }
        self.close_at_the_end();
    }

    fn ended(&mut self, trial: &TrialRecord) {
        self.counts.add(trial);
        let is_told = deserves_a_line(trial) && !self.absent.contains(&trial.core);
        let told = is_told.then(|| line(trial, self.longest_core));
        match &mut self.display {
            Display::Quiet => {}
            Display::Lines(lines) => lines.end(told, &self.counts),
            Display::Live(live) => live.end(trial, told, self.counts.words()),
        }
        self.close_at_the_end();
    }

    /// Takes the bars away before anything else is printed: whatever stands below them would be erased.
    fn close_at_the_end(&mut self) {
        if self.counts.ended() >= self.counts.planned && matches!(self.display, Display::Live(_)) {
            self.display = Display::Quiet;
        }
    }
}

impl Lines {
    fn new(out: impl Write + 'static) -> Self {
        Self { out: Box::new(out), last: Instant::now() }
    }

    fn print(&mut self, line: &str) {
        print(&mut self.out, line);
        self.last = Instant::now();
    }

    fn end(&mut self, told: Option<Told>, counts: &Counts) {
        if let Some(told) = told {
            self.print(&told.plain());
        } else if self.last.elapsed() > HEARTBEAT {
            self.print(&format!("{}: {}", counts.trials(), counts.words()));
        }
    }
}

impl Live {
    fn new(target: ProgressDrawTarget, colour: bool) -> Self {
        let screen = MultiProgress::with_draw_target(target);
        let whole = screen.add(ProgressBar::new(0));
        whole.set_style(template(WHOLE));
        let style = Style { colour, ..super::report::style(Detail::Usual) };
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
    fn end(&mut self, trial: &TrialRecord, told: Option<Told>, counts: String) {
        if let Some(bar) = self.running.remove(&(trial.core.clone(), trial.case.clone())) {
            bar.finish_and_clear();
            self.screen.remove(&bar);
        }
        if let Some(told) = told {
            self.whole.println(told.painted(self.style));
        }
        self.whole.inc(1);
        self.whole.set_message(counts);
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

/// Whether standard error is where a display can draw over itself.
pub(super) fn is_live() -> bool {
    let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    std::io::stderr().is_terminal() && !is_dumb
}

/// The style of a bar; a mistake in it costs the looks, not the run.
pub(super) fn template(text: &str) -> ProgressStyle {
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

/// Whether an end is told while the run goes on. What was not tried is counted: one failure can block a hundred cases.
fn deserves_a_line(trial: &TrialRecord) -> bool {
    !matches!(trial.outcome.status(), Status::Pass | Status::Skipped | Status::Blocked)
}

/// One trial in one line.
struct Told {
    word: &'static str,
    paint: Paint,
    /// Time, core if there are several, case, and what was found.
    words: String,
}

fn line(trial: &TrialRecord, longest_core: usize) -> Told {
    let (seconds, core) = (duration(trial.timing.seconds), clean(&trial.core));
    let core = match longest_core {
        0 => String::new(),
        width => format!("{core:<width$}  "),
    };
    let statement = trial.outcome.statement();
    let statement = clean(statement.lines().next().unwrap_or_default());
    let words = format!("{seconds:>9}  {core}{}: {statement}", clean(&trial.case));
    match trial.outcome.status() {
        // What counts nothing has not failed.
        Status::Fail if !trial.tier.is_graded() => {
            Told { word: "note", paint: Paint::Unknown, words }
        }
        status => Told { word: status.word(), paint: paint_of(status), words },
    }
}

impl Told {
    fn plain(&self) -> String {
        format!("{:<12} {}", self.word, self.words)
    }

    /// Cut at the end of the line: a display that goes on needs the room.
    fn painted(&self, style: Style) -> String {
        let word = style.paint(self.paint, &format!("{:<12}", self.word));
        format!("  {word} {}", cut(&self.words, style.columns.saturating_sub(15)))
    }
}

/// A closed standard error must not end the run.
pub(super) fn print(out: &mut impl Write, line: &str) {
    let _ = writeln!(out, "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Tier;
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
        let earlier = &example.trials[..already_done];
        progress.hear(Event::Planned { run: &example.run, folder, earlier });
        for trial in &example.trials[already_done..] {
            progress.hear(Event::Started { core: &trial.core, case: &trial.case });
            progress.hear(Event::Ended { trial });
        }
    }

    fn lines(example: &Example, already_done: usize) -> Vec<String> {
        let shared = Shared::default();
        let mut progress = Progress::on(Display::Lines(Lines::new(shared.clone())));
        tell(&mut progress, example, already_done);
        let text = String::from_utf8(shared.0.take()).unwrap();
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn without_a_terminal_what_does_not_pass_is_one_plain_line() {
        let lines = lines(&Example::mixed(), 0);
        assert_eq!(lines[0], "24 trials on builtin and textbook; results go to runs/one");
        assert_eq!(lines.len(), 1 + 7, "{lines:?}");
        assert!(lines.iter().all(|line| !line.contains('\x1b')));
        assert!(lines.iter().any(|line| line.starts_with("timed out") && line.contains("30 s")));
        assert!(lines[1..].iter().all(|line| line.contains(": ")), "{lines:?}");
    }

    #[test]
    fn what_counts_nothing_is_a_note() {
        let words = |tier| {
            let mut example = Example::mixed();
            example.trials.iter_mut().for_each(|trial| trial.tier = tier);
            let lines = lines(&example, 0);
            ["fail ", "note "].map(|word| lines.iter().any(|line| line.starts_with(word)))
        };
        assert_eq!(words(Tier::Graded), [true, false]);
        assert_eq!(words(Tier::Informational), [false, true]);
    }

    #[test]
    fn a_log_that_was_silent_for_long_says_how_far_it_is() {
        let shared = Shared::default();
        let mut lines = Lines::new(shared.clone());
        let counts = Counts::of(24, &Example::green().trials[..7]);
        lines.end(None, &counts);
        assert!(shared.0.borrow().is_empty());
        lines.last = Instant::now().checked_sub(2 * HEARTBEAT).unwrap();
        lines.end(None, &counts);
        assert_eq!(shared.0.take(), b"7 of 24 trials: 7 pass\n");
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
        assert_eq!(
            lines,
            ["24 trials on builtin and textbook, 20 already done; results go to runs/one"]
        );
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
