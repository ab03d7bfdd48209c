//! `furnace reference`: makes, verifies and lists Mitsuba references.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::reference::{
    Made, MakeError, MakeOptions, MitsubaOptions, Progress, Reference, References, State,
};
use crate::scene::Library;
use crate::scene::reference::Layers;
use crate::stats::Verdict;
use crate::text::number::percent;
use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::Range;
use std::path::PathBuf;

/// What `furnace reference` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReferenceArguments {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    project: ProjectArguments,
}

#[derive(Clone, Debug, Subcommand)]
enum Verb {
    /// Render a reference by its recipe in references/recipes.toml; resumes an interrupted run.
    Make {
        /// The reference.
        name: String,
        /// Replace an existing reference.
        #[arg(long)]
        replace: bool,
        /// Add the passes that the existing one lacks by the recipe, --passes or --spp.
        #[arg(long, conflicts_with = "replace")]
        extend: bool,
        /// Render only the passes of these seeds (end excluded), and keep their sums for --merge.
        #[arg(long, value_name = "A..B", value_parser = range, conflicts_with = "extend")]
        seeds: Option<Range<u32>>,
        /// Merge the sums in these files with those of the existing reference.
        #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["extend", "seeds"])]
        merge: Vec<PathBuf>,
        /// Samples per pixel in total, overriding the recipe; rounded up to whole passes.
        #[arg(long, value_name = "N", conflicts_with = "passes")]
        spp: Option<u32>,
        /// Number of passes, overriding the recipe.
        #[arg(long, value_name = "N")]
        passes: Option<u32>,
        /// Samples per pixel in each pass, at most 256, overriding the recipe.
        #[arg(long, value_name = "N")]
        samples_per_pass: Option<u32>,
        #[command(flatten)]
        mitsuba: MitsubaArguments,
    },
    /// Add layers to references: each bounce alone, depth and normals.
    Layers {
        /// The references.
        #[arg(required = true, value_name = "NAME")]
        names: Vec<String>,
        #[command(flatten)]
        mitsuba: MitsubaArguments,
    },
    /// Render a few passes with new seeds and test that they agree with a reference.
    Verify {
        /// The reference.
        name: String,
        #[command(flatten)]
        mitsuba: MitsubaArguments,
    },
    /// List every reference, its standard error, and whether it still matches its scene.
    List,
}

#[derive(Clone, Debug, Args)]
struct MitsubaArguments {
    /// Install Mitsuba into references/.venv if it is not there.
    #[arg(long = "create-venv")]
    create_environment: bool,
    /// Mitsuba's back end [default: llvm_ad_rgb where an LLVM works, scalar_rgb elsewhere].
    #[arg(long, value_name = "NAME")]
    variant: Option<String>,
}

impl MitsubaArguments {
    fn options(&self) -> MitsubaOptions {
        MitsubaOptions {
            create_environment: self.create_environment,
            variant: self.variant.clone(),
        }
    }
}

pub(crate) fn reference(arguments: &ReferenceArguments) -> Answer {
    let project = arguments.project.find()?;
    let references = References::new(project.recipes(), Library::of(&project));
    match &arguments.verb {
        Verb::Make {
            name,
            replace,
            extend,
            seeds,
            merge,
            spp,
            passes,
            samples_per_pass,
            mitsuba,
        } => {
            let options = MakeOptions {
                replace: *replace,
                extend: *extend,
                seeds: seeds.clone(),
                merge: merge.clone(),
                samples: *spp,
                mitsuba: mitsuba.options(),
                passes: *passes,
                samples_per_pass: *samples_per_pass,
            };
            make(&references, name, &options)
        }
        Verb::Layers { names, mitsuba } => {
            let options = mitsuba.options();
            names.iter().try_fold(ExitCode::Good, |_, name| layers(&references, name, &options))
        }
        Verb::Verify { name, mitsuba } => verify(&references, name, &mitsuba.options()),
        Verb::List => list(&references),
    }
}

fn make(references: &References, name: &str, options: &MakeOptions) -> Answer {
    let display = Display::new();
    let made = references.make(name, options, &mut |progress| display.show(progress));
    match made.map_err(failure)? {
        Made::Reference(made) => {
            say_line!(
                "made {name}: median relative standard error {}; check references/{name}, then commit it",
                percent(made.provenance.median_relative_error)
            );
            if made.layers == Layers::default() {
                say_line!(
                    "hint: `furnace reference layers {name}` adds its bounces, depth and normals"
                );
            }
        }
        Made::Part(path) => say_line!(
            "made a part of {name}; `furnace reference make {name} --merge {}` adds it",
            path.display()
        ),
    }
    Ok(ExitCode::Good)
}

/// A name that nothing has is a wrong request; all else is the bench's.
fn failure(error: MakeError) -> Failure {
    match error {
        MakeError::NoRecipe { .. } => Failure::request(error),
        _ => Failure::broken(error),
    }
}

fn layers(references: &References, name: &str, options: &MitsubaOptions) -> Answer {
    let display = Display::new();
    let layered = references.add_layers(name, options, &mut |progress| display.show(progress));
    let reference = layered.map_err(failure)?;
    let hint = match reference.layers.bounces.is_empty() {
        true => "; bounces apart need Mitsuba's llvm_ad_rgb",
        false => "",
    };
    say_line!("{name}: {}{hint}", content(&reference));
    Ok(ExitCode::Good)
}

/// `bounces 0 to 6 apart, depth and normals`
fn content(reference: &Reference) -> String {
    let bounces = match reference.layers.bounces.len() {
        0 => None,
        count => Some(format!("bounces 0 to {} apart", count - 1)),
    };
    let seen = reference.layers.first_hits.is_some().then(|| "depth and normals".to_owned());
    bounces.into_iter().chain(seen).collect::<Vec<_>>().join(", ")
}

fn verify(references: &References, name: &str, options: &MitsubaOptions) -> Answer {
    let display = Display::new();
    let verified = references.verify(name, options, &mut |progress| display.show(progress));
    let report = verified.map_err(failure)?.report;
    say_line!(
        "{name}: {} after {} runs; would have caught an error of {} of the whole picture",
        report.verdict,
        report.runs,
        percent(report.resolution)
    );
    Ok(match report.verdict {
        Verdict::Pass => ExitCode::Good,
        Verdict::Fail => ExitCode::Failed,
        Verdict::Inconclusive => ExitCode::Broken,
    })
}

fn list(references: &References) -> Answer {
    let listed = references.list().map_err(Failure::broken)?;
    let mut all_good = true;
    for entry in &listed {
        let state = match &entry.state {
            State::Good(reference) => format!(
                "{:>6} samples per pixel, median relative standard error {}  {}",
                reference.provenance.samples_per_pixel(),
                percent(reference.provenance.median_relative_error),
                content(reference)
            ),
            State::Bad(error) => {
                all_good = false;
                error.to_string()
            }
            State::NoScene(error) => {
                all_good = false;
                error.to_string()
            }
        };
        say_line!("{:26}  {state}", entry.name);
    }
    Ok(if all_good { ExitCode::Good } else { ExitCode::Broken })
}

fn range(text: &str) -> Result<Range<u32>, String> {
    let parsed = text.split_once("..").and_then(|(start, end)| {
        let [start, end] = [start, end].map(|number| number.trim().parse().ok());
        Some(start?..end?)
    });
    parsed.ok_or_else(|| "write 0..64 for the seeds from 0 to 63".to_owned())
}

/// Progress on standard error: a bar while passes are rendered, a line for all else.
struct Display {
    bar: ProgressBar,
}

impl Display {
    fn new() -> Self {
        let style = ProgressStyle::with_template("  {pos}/{len} passes  {wide_bar}  {eta} left");
        let bar = ProgressBar::new(0);
        Self { bar: style.map_or(ProgressBar::hidden(), |style| bar.with_style(style)) }
    }

    fn show(&self, progress: Progress) {
        match progress {
            Progress::CreatingEnvironment { folder } => {
                self.bar.println(format!("  installing Mitsuba into {}", folder.display()));
            }
            Progress::TryingVariant { variant } => {
                self.bar.println(format!("  trying {variant}"));
            }
            Progress::Rendering { done, of } => {
                self.bar.set_length(u64::from(of));
                self.bar.set_position(u64::from(done));
            }
        }
    }
}
