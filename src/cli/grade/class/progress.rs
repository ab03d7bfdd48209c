//! What is shown while a class is graded, on standard error: on a terminal a line for each submission that is being graded,
//! elsewhere one for each that has been, and now and then which are under way.

use crate::cli::progress::{HEARTBEAT, RUNNING, is_live, print, template};
use crate::text::number::count;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget};
use std::collections::BTreeMap;
use std::fmt;
use std::io::Write;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

const WHOLE: &str = "  {pos}/{len} submissions  {wide_bar}  {elapsed} elapsed";

/// What happens to a submission.
pub(super) struct News {
    /// As it may be called.
    pub(super) who: String,
    pub(super) step: Step,
}

pub(super) enum Step {
    Builds,
    /// So many of its trials have a result.
    Tries {
        ended: usize,
        of: usize,
    },
    /// What its failures come from is searched for.
    Searches,
    /// It has come to this.
    Graded(String),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Builds => f.write_str("builds"),
            Self::Tries { ended, of } => write!(f, "{ended} of {}", count(*of, "trial")),
            Self::Searches => f.write_str("causes are searched for"),
            Self::Graded(words) => f.write_str(words),
        }
    }
}

/// How far a class is.
pub(super) struct Progress {
    of: usize,
    graded: usize,
    under_way: BTreeMap<String, Step>,
    display: Display,
}

enum Display {
    Lines { out: Box<dyn Write>, last: Instant },
    Live { screen: MultiProgress, whole: ProgressBar, bars: BTreeMap<String, ProgressBar> },
}

impl Progress {
    /// What suits standard error.
    pub(super) fn new(of: usize, home: &Path) -> Self {
        let mut display = match is_live() {
            true => Display::live(ProgressDrawTarget::stderr(), of),
            false => Display::lines(std::io::stderr()),
        };
        display.print(&format!("{}; results go to {}", count(of, "submission"), home.display()));
        Self::on(display, of)
    }

    fn on(display: Display, of: usize) -> Self {
        Self { of, graded: 0, under_way: BTreeMap::new(), display }
    }

    /// Shows all that comes, until nobody has any more to tell.
    pub(super) fn follow(mut self, news: &Receiver<News>) {
        loop {
            match news.recv_timeout(HEARTBEAT) {
                Ok(news) => self.hear(news),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.remind(HEARTBEAT);
        }
    }

    fn hear(&mut self, News { who, step }: News) {
        if let Step::Graded(words) = &step {
            self.graded += 1;
            self.under_way.remove(&who);
            self.display.print(&format!("{} of {}  {who}: {words}", self.graded, self.of));
        }
        self.display.draw(&who, &step);
        if !matches!(step, Step::Graded(_)) {
            self.under_way.insert(who, step);
        }
    }

    /// A log that is silent for longer looks dead.
    fn remind(&mut self, longest: Duration) {
        let Display::Lines { last, .. } = &self.display else { return };
        if last.elapsed() < longest {
            return;
        }
        let under_way = self.under_way.iter().map(|(who, step)| format!("{who}, {step}"));
        let under_way: Vec<_> = under_way.collect();
        self.display.print(&format!("under way: {}", under_way.join("; ")));
    }
}

impl Display {
    fn lines(out: impl Write + 'static) -> Self {
        Self::Lines { out: Box::new(out), last: Instant::now() }
    }

    fn live(target: ProgressDrawTarget, of: usize) -> Self {
        let screen = MultiProgress::with_draw_target(target);
        let whole = screen.add(ProgressBar::new(of as u64));
        whole.set_style(template(WHOLE));
        whole.enable_steady_tick(Duration::from_secs(1));
        Self::Live { screen, whole, bars: BTreeMap::new() }
    }

    fn print(&mut self, line: &str) {
        match self {
            Self::Lines { out, last } => {
                print(out, line);
                *last = Instant::now();
            }
            Self::Live { whole, .. } => whole.println(format!("  {line}")),
        }
    }

    fn draw(&mut self, who: &str, step: &Step) {
        let Self::Live { screen, whole, bars } = self else { return };
        if let Step::Graded(_) = step {
            whole.inc(1);
            if let Some(bar) = bars.remove(who) {
                bar.finish_and_clear();
                screen.remove(&bar);
            }
            return;
        }
        let bar = bars.entry(who.to_owned()).or_insert_with(|| {
            let bar = screen.insert_before(whole, ProgressBar::new_spinner());
            bar.set_style(template(RUNNING));
            bar.enable_steady_tick(Duration::from_secs(1));
            bar
        });
        bar.set_message(format!("{who}: {step}"));
    }
}

impl Drop for Display {
    /// Whatever stands below the bars would be erased.
    fn drop(&mut self) {
        if let Self::Live { whole, bars, .. } = self {
            bars.values().for_each(ProgressBar::finish_and_clear);
            whole.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indicatif::ProgressStyle;
    use std::cell::RefCell;
    use std::rc::Rc;

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

    fn news(who: &str, step: Step) -> News {
        News { who: who.to_owned(), step }
    }

    #[test]
    fn a_log_has_a_line_for_each_that_is_graded_and_says_which_are_under_way() {
        let shared = Shared::default();
        let mut progress = Progress::on(Display::lines(shared.clone()), 14);
        progress.hear(news("ada", Step::Builds));
        progress.hear(news("submission 3 of 14", Step::Builds));
        progress.hear(news("ada", Step::Tries { ended: 2, of: 9 }));
        progress.hear(news("submission 3 of 14", Step::Graded("3 of 10 points".to_owned())));
        progress.hear(news("bea", Step::Searches));
        progress.remind(Duration::from_secs(60));
        progress.remind(Duration::ZERO);
        let told = String::from_utf8(shared.0.take()).unwrap();
        let lines = [
            "1 of 14  submission 3 of 14: 3 of 10 points\n",
            "under way: ada, 2 of 9 trials; bea, causes are searched for\n",
        ];
        assert_eq!(told, lines.concat());
    }

    #[test]
    fn a_terminal_forgets_what_is_graded() {
        let mut progress = Progress::on(Display::live(ProgressDrawTarget::hidden(), 2), 2);
        progress.hear(news("ada", Step::Builds));
        progress.hear(news("bea", Step::Tries { ended: 1, of: 9 }));
        progress.hear(news("ada", Step::Graded("10 of 10 points".to_owned())));
        let Display::Live { whole, bars, .. } = &progress.display else { panic!("not live") };
        assert_eq!(whole.position(), 1);
        assert_eq!(
            bars.values().map(ProgressBar::message).collect::<Vec<_>>(),
            ["bea: 1 of 9 trials"]
        );
        assert!(ProgressStyle::with_template(WHOLE).is_ok());
    }
}
