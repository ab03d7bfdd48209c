//! `furnace writeup`: the course's tables and ladders of images, for one core.

use super::hosting::HostingArguments;
use super::say::{complain, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::cores::CoreSpec;
use crate::render::size;
use crate::scene::Library;
use crate::stats::Budget;
use crate::text::number::{count, duration};
use crate::writeup::{self, Cast, Effort, Plan, Told};
use clap::Args;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

const BAR: &str = "  {pos}/{len} figures  {wide_bar}  {elapsed} elapsed{left}\n  {msg}";
/// A log that is silent for longer looks dead.
const HEARTBEAT: Duration = Duration::from_secs(30);
/// For one figure: nobody waits longer for one of them, and slow cores need more than a trial has.
const SECONDS: f64 = 3600.0;

/// What `furnace writeup` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct WriteupArguments {
    /// The renderer.
    #[arg(long, value_name = "CORE", default_value = "builtin")]
    core: CoreSpec,
    /// The folder of the course's `.dae` scenes [default: scenes of the bench stand in].
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    /// How large and how well sampled figures are: quick, default or strict.
    #[arg(long, default_value_t = Budget::Default)]
    budget: Budget,
    /// Columns and rows of figures; a quick one of 1024 samples has half of both [default: 120x90 quick,
    /// 240x180 default, 480x360 strict].
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// The folder of the pages and their images. Figures that it has with equal settings are taken.
    #[arg(short, long, value_name = "DIR", default_value = "writeup")]
    output: PathBuf,
    /// Make every figure again.
    #[arg(long)]
    fresh: bool,
    /// Show no progress.
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Makes the figures that are not there yet, and the pages.
pub(crate) fn writeup(arguments: &WriteupArguments) -> Answer {
    let project = arguments.project.find()?;
    let cast = match &arguments.scenes {
        Some(folder) => Cast::in_folder(folder).map_err(Failure::request)?,
        None => Cast::of_project(),
    };
    let hosting = arguments.hosting.with_time_limit(SECONDS).hosting(&project.runs());
    let hosting = hosting.hiding(project.secrets());
    let core = &arguments.core;
    let hosted = hosting.host(core);
    let info = hosted.map_err(|error| super::render::not_started(core, error))?.core_mut().info();
    let effort = Effort::from(arguments.budget);
    let plan = Plan {
        core,
        info,
        hosting: &hosting,
        scenes: &Library::of(&project),
        cast: &cast,
        effort: Effort { size: arguments.size.unwrap_or(effort.size), ..effort },
        folder: &arguments.output,
        fresh: arguments.fresh,
    };
    let begun = Instant::now();
    let mut progress = Progress::new(arguments.quiet);
    let written = writeup::write(&plan, &mut |told| progress.hear(&told));
    progress.end();
    let written = written.map_err(Failure::broken)?;
    let took = duration(begun.elapsed().as_secs_f64());
    let figures = count(written.made, "figure");
    say_line!("  {figures} made in {took}, {} taken, {} missing", written.kept, written.missing);
    say_line!("  markdown  {}", written.markdown.display());
    say_line!("  page      {}", super::report::address(&written.page));
    Ok(if written.made + written.kept > 0 { ExitCode::Good } else { ExitCode::NothingProven })
}

/// A bar on a terminal; elsewhere now and then a line.
enum Progress {
    Quiet,
    Live(ProgressBar, Left),
    Lines(Instant),
}

/// Seconds that were left, and when. They run on while a figure is made.
type Left = Arc<Mutex<Option<(f64, Instant)>>>;

impl Progress {
    fn new(quiet: bool) -> Self {
        let left = Left::default();
        match () {
            () if quiet => Self::Quiet,
            () if std::io::stderr().is_terminal() => Self::Live(bar(&left), left),
            () => Self::Lines(Instant::now()),
        }
    }

    fn hear(&mut self, told: &Told<'_>) {
        let [done, all] = told.figures;
        let samples = told.samples.map(|[some, of]| format!(", {some} of {of} samples"));
        let now = format!("{}{}", told.name, samples.unwrap_or_default());
        match self {
            Self::Quiet => {}
            Self::Live(bar, left) => {
                let known = told.left.map(|seconds| (seconds, Instant::now()));
                *left.lock().unwrap_or_else(PoisonError::into_inner) = known;
                bar.set_length(all as u64);
                bar.set_position(done as u64);
                bar.set_message(now);
            }
            Self::Lines(last) if last.elapsed() > HEARTBEAT => {
                let left = told.left.map(in_words).unwrap_or_default();
                complain(format_args!("{done} of {all} figures{left}; now {now}"));
                *last = Instant::now();
            }
            Self::Lines(_) => {}
        }
    }

    fn end(&self) {
        if let Self::Live(bar, _) = self {
            bar.finish_and_clear();
        }
    }
}

fn in_words(left: f64) -> String {
    format!(", about {} left", duration(left))
}

fn bar(left: &Left) -> ProgressBar {
    let bar = ProgressBar::new(0);
    bar.set_style(style(left));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn style(left: &Left) -> ProgressStyle {
    let left = Arc::clone(left);
    let style = ProgressStyle::with_template(BAR).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.with_key("left", move |_: &ProgressState, out: &mut dyn Write| {
        let known = *left.lock().unwrap_or_else(PoisonError::into_inner);
        let now = known.map(|(left, since)| (left - since.elapsed().as_secs_f64()).max(0.0));
        // A bar that cannot be drawn is no failure.
        let _ = out.write_str(&now.map(in_words).unwrap_or_default());
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_has_its_own_looks() {
        assert!(ProgressStyle::with_template(BAR).is_ok());
    }
}
