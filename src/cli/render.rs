//! `furnace render`: one image of one scene, by one core.

use super::hosting::HostingArguments;
use super::inline;
use super::say::{complain, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::contract::{Core, CoreError, RenderSettings};
use crate::cores::{CoreSpec, HostError};
use crate::project::Project;
use crate::render::{Made, Output, Request, Shot, Shown, renders_codes_alone};
use crate::report::html::develop::Shows;
use crate::scene::reference::{Provenance, folder_of};
use crate::scene::{Library, SceneDescription};
use crate::text::number::{count, duration};
use crate::worker::StartError;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use std::time::Duration;

/// The last bounce where nobody says another.
const LAST_BOUNCE: u32 = 5;
const BAR: &str =
    "  {pos}/{len} samples per pixel  {wide_bar}  {elapsed} elapsed, about {eta} left";
/// Of one call nothing is known but that it goes on.
const SPINNER: &str = "  {spinner} {len} samples per pixel in one call, {elapsed} elapsed";

/// What `furnace render` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    shot: Shot,
    /// The renderer.
    #[arg(long, value_name = "CORE", default_value = "builtin")]
    core: CoreSpec,
    /// The file: .exr (with standard errors), .pfm, .hdr, or .png (sRGB).
    #[arg(short, long, value_name = "FILE")]
    output: Output,
    /// Show no progress.
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

pub(crate) fn render(arguments: &RenderArguments) -> Answer {
    arguments.output.check().map_err(Failure::request)?;
    let shot = &arguments.shot;
    let project = arguments.project.find()?;
    let scene = shot.load(&Library::of(&project)).map_err(Failure::request)?;
    let camera = shot.camera(&scene).map_err(Failure::request)?;
    let reference = Known::of(&project, &scene.name);
    let last = reference.as_ref().map_or(LAST_BOUNCE, |known| known.provenance.bounces[1]);
    let settings = shot.settings(&camera, last);
    let passes = shot.passes(arguments.core.program().is_some());
    let hosting = arguments.hosting.hosting(&project.runs()).hiding(project.secrets());
    let mut hosted =
        hosting.host(&arguments.core).map_err(|error| not_started(&arguments.core, error))?;
    let request = Request { shot, scene: &scene, camera: &camera, settings: &settings, passes };
    let made = made(arguments, hosted.core_mut(), &request);
    let made = made.map_err(|error| blamed(arguments, &error, &hosted.printed()))?;
    let from = provenance(arguments, &scene, &settings);
    arguments.output.write(&made.shown, from).map_err(Failure::broken)?;
    say_line!("{}", arguments.output.path.display());
    if !arguments.quiet {
        match &made.shown {
            Shown::Radiance(rendered) => inline::show(&[(&rendered.image, Shows::Render)]),
            Shown::Codes(picture) => inline::show_pictures(std::slice::from_ref(picture)),
        }
        let size = format!("{} × {} pixels", camera.film[0], camera.film[1]);
        complain(format_args!(
            "  {size} in {}; {}",
            duration(made.seconds),
            told(&made, arguments)
        ));
        let alike = reference.filter(|known| known.is_of(&settings));
        alike.iter().for_each(|known| complain(known.next(&arguments.output)));
    }
    Ok(match made.breach() {
        None => ExitCode::Good,
        Some(breach) => {
            complain(format_args!(
                "{}: {breach}; the image was written all the same",
                arguments.core
            ));
            ExitCode::Failed
        }
    })
}

/// The reference that has the name of a scene.
struct Known {
    file: PathBuf,
    provenance: Provenance,
}

impl Known {
    fn of(project: &Project, scene: &str) -> Option<Self> {
        let folders = project.layers("references");
        let folder = folder_of(&folders, scene).join(scene);
        let text = std::fs::read_to_string(folder.join("provenance.toml")).ok()?;
        let provenance: Provenance = crate::text::read_toml(&text).ok()?;
        (provenance.scene == scene).then(|| Self { file: folder.join("reference.exr"), provenance })
    }

    /// Whether an image by these settings shows the same.
    fn is_of(&self, settings: &RenderSettings) -> bool {
        let bounces = &settings.integrator.bounces;
        [settings.width, settings.height] == self.provenance.film
            && [*bounces.start(), *bounces.end()] == self.provenance.bounces
    }

    fn next(&self, output: &Output) -> String {
        let files = [&output.path, &self.file].map(|path| path.display().to_string());
        let [image, reference] = files.each_ref().map(|file| shell_words::quote(file));
        format!("  next   furnace compare {image} {reference}")
    }
}

/// What is known of the noise of an image.
fn told(made: &Made, arguments: &RenderArguments) -> String {
    let samples = count(arguments.shot.spp as usize, "sample");
    let rendered = match &made.shown {
        _ if arguments.shot.normals => return "normals at pixel centres".to_owned(),
        Shown::Codes(_) => {
            return format!("{samples} per pixel; 8 bits, as the core writes them");
        }
        Shown::Radiance(rendered) => rendered,
    };
    let passes = match rendered.passes {
        1 => "one call".to_owned(),
        passes => format!("{passes} passes"),
    };
    let errors = match &rendered.standard_error {
        Some((_, source)) if arguments.output.holds_errors() => {
            format!("standard errors in se.R, se.G, se.B, from {source}")
        }
        Some(_) => "standard errors are kept in .exr alone".to_owned(),
        None => "standard errors are unknown".to_owned(),
    };
    format!("{samples} per pixel in {passes}; {errors}")
}

/// What an EXR file says of where it is from.
fn provenance(
    arguments: &RenderArguments,
    scene: &SceneDescription,
    settings: &RenderSettings,
) -> Vec<(&'static str, String)> {
    vec![
        ("scene", scene.name.clone()),
        ("core", arguments.core.to_string()),
        ("samples-per-pixel", arguments.shot.spp.to_string()),
        ("seed", arguments.shot.seed.to_string()),
        ("last-bounce", settings.integrator.bounces.end().to_string()),
    ]
}

fn made(
    arguments: &RenderArguments,
    core: &mut dyn Core,
    request: &Request<'_>,
) -> Result<Made, CoreError> {
    if renders_codes_alone(&core.info()) && !arguments.output.is_png() {
        return Err(CoreError::Beyond("it renders 8 bits alone; name a .png file".to_owned()));
    }
    let progress = progress(arguments, request.passes);
    let made = request.put_to(core, |samples| progress.set_position(samples.into()));
    progress.finish_and_clear();
    made
}

/// Hidden where nobody looks on: what is printed besides is enough there.
fn progress(arguments: &RenderArguments, passes: u32) -> ProgressBar {
    if arguments.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(arguments.shot.spp.into());
    let looks = if passes == 1 { SPINNER } else { BAR };
    bar.set_style(
        ProgressStyle::with_template(looks).unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Whose fault it is that a core does not start.
pub(super) fn not_started(core: &CoreSpec, error: HostError) -> Failure {
    let next = format!("furnace doctor --core {}", shell_words::quote(core.as_str()));
    let message = format!("{core} fails to start: {error}\n  look at it with: {next}");
    let (code, printed) = match error {
        HostError::Start(StartError::Core { error, printed }) => (code_of(&error), printed),
        HostError::Start(StartError::Bench { .. }) => (ExitCode::Broken, String::new()),
        HostError::Load(_) => (ExitCode::BadRequest, String::new()),
    };
    Failure { code, message: with_printed(message, &printed) }
}

/// Whose fault it is that there is no image, and what to do.
fn blamed(arguments: &RenderArguments, error: &CoreError, printed: &str) -> Failure {
    let core = &arguments.core;
    let next = match error {
        CoreError::Unsupported(_) => {
            let core = shell_words::quote(core.as_str());
            format!("\n  what it can do: furnace doctor --core {core}")
        }
        CoreError::BrokeContract(_) => {
            "\n  to fix in the core: every value of an image is written, finite and not negative"
                .to_owned()
        }
        CoreError::TimedOut { .. } => {
            "\n  --time-limit SECONDS gives it more, --spp or --size asks less".to_owned()
        }
        _ => String::new(),
    };
    let message = format!("{core} rendered no image of {}: {error}{next}", arguments.shot.scene);
    Failure { code: code_of(error), message: with_printed(message, printed) }
}

fn code_of(error: &CoreError) -> ExitCode {
    match error {
        CoreError::Unsupported(_) | CoreError::Beyond(_) => ExitCode::BadRequest,
        _ => ExitCode::Failed,
    }
}

fn with_printed(message: String, printed: &str) -> String {
    let lines = printed.lines().map(|line| format!("\n  printed: {line}"));
    std::iter::once(message).chain(lines).collect()
}

#[cfg(test)]
mod tests;
