//! `furnace render`: one image of one scene, by one core.

mod output;
mod passes;

use super::hosting::HostingArguments;
use super::say::{complain, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::contract::validate::Validated;
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, Core, CoreError, CoreInfo, DirectSampling,
    IntegratorSettings, RenderSettings,
};
use crate::cores::{CoreSpec, HostError};
use crate::image::ImageError;
use crate::image::png::{self, Picture};
use crate::project::Project;
use crate::scene::reference::Provenance;
use crate::scene::{Camera, Library, Overrides, SceneDescription};
use crate::text::number::{count, duration};
use crate::worker::StartError;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use output::Output;
use passes::{Job, Rendered};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Calls that samples are split over, unless that is said.
const PASSES: u32 = 16;
/// The first and the last bounce where nobody says another.
const BOUNCES: [u32; 2] = [0, 5];
const BAR: &str =
    "  {pos}/{len} samples per pixel  {wide_bar}  {elapsed} elapsed, about {eta} left";
/// Of one call nothing is known but that it goes on.
const SPINNER: &str = "  {spinner} {len} samples per pixel in one call, {elapsed} elapsed";

/// What `furnace render` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct RenderArguments {
    /// A scene of the project, or a `.toml` or `.dae` file.
    scene: String,
    /// The renderer.
    #[arg(long, value_name = "CORE", default_value = "builtin")]
    core: CoreSpec,
    /// The file: .exr (with standard errors), .pfm, .hdr, or .png (sRGB).
    #[arg(short, long, value_name = "FILE")]
    output: Output,
    /// Samples per pixel.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..))]
    spp: u32,
    /// Columns and rows [default: those of the scene's camera].
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Maximum depth: the last bounce [default: that of the scene's reference, or 5].
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    /// Use hemisphere sampling instead of light sampling.
    #[arg(long)]
    hemisphere: bool,
    /// Calls that the samples are split over; how four or more differ gives the standard errors
    /// [default: 16, and 1 of a program that is started for each image].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    passes: Option<u32>,
    /// A parameter of the scene, such as albedo=0.5 or camera="camera.txt"; may be repeated.
    #[arg(long, value_name = "NAME=VALUE", value_parser = parameter)]
    set: Vec<(String, toml::Value)>,
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
    let project = arguments.project.find()?;
    let scene = scene(arguments, &Library::new(project.scenes()))?;
    let camera = camera(arguments, &scene)?;
    let reference = Known::of(&project, &scene.name);
    let settings = settings(arguments, &camera, reference.as_ref());
    let hosting = arguments.hosting.hosting(&project.runs()).hiding(project.secrets());
    let mut hosted =
        hosting.host(&arguments.core).map_err(|error| not_started(&arguments.core, error))?;
    let begun = Instant::now();
    let made = with_core(arguments, hosted.core_mut(), &scene, &camera, &settings);
    let made = made.map_err(|error| blamed(arguments, &error, &hosted.printed()))?;
    let from = provenance(arguments, &scene, &settings);
    made.write(&arguments.output, from).map_err(Failure::broken)?;
    say_line!("{}", arguments.output.path.display());
    if !arguments.quiet {
        let size = format!("{} × {} pixels", camera.film[0], camera.film[1]);
        let took = duration(begun.elapsed().as_secs_f64());
        complain(format_args!("  {size} in {took}; {}", made.told(arguments)));
        let alike = reference.filter(|known| known.is_of(&settings));
        alike.iter().for_each(|known| complain(known.next(&arguments.output)));
    }
    Ok(match made.breach() {
        None => ExitCode::Good,
        Some(breach) => {
            complain(format_args!("{}: {breach}; the image was written as it is", arguments.core));
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
        let folder = project.references().join(scene);
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

/// What a core has made.
enum Made {
    Radiance { rendered: Rendered, passes: u32 },
    Codes(Picture),
}

impl Made {
    /// Writes it, in EXR with where it is from.
    fn write(
        &self,
        output: &Output,
        mut from: Vec<(&'static str, String)>,
    ) -> Result<(), ImageError> {
        match self {
            Self::Codes(codes) => png::write(&output.path, codes),
            Self::Radiance { rendered, passes } => {
                let source = rendered.standard_error.as_ref().map(|(_, source)| source.to_string());
                from.push(("passes", passes.to_string()));
                from.push(("standard-errors-from", source.unwrap_or_else(|| "unknown".to_owned())));
                output.write(rendered, &from)
            }
        }
    }

    fn breach(&self) -> Option<&CoreError> {
        match self {
            Self::Codes(_) => None,
            Self::Radiance { rendered, .. } => rendered.breach.as_ref(),
        }
    }

    /// What is known of its noise.
    fn told(&self, arguments: &RenderArguments) -> String {
        let samples = count(arguments.spp as usize, "sample");
        match self {
            Self::Codes(_) => format!("{samples} per pixel; 8 bits, as the core writes them"),
            Self::Radiance { rendered, passes } => {
                let passes =
                    if *passes == 1 { "one call".to_owned() } else { format!("{passes} passes") };
                let errors = match &rendered.standard_error {
                    Some((_, source)) if arguments.output.holds_errors() => {
                        format!("standard errors in se.R, se.G, se.B, from {source}")
                    }
                    Some(_) => "standard errors are kept in .exr alone".to_owned(),
                    None => "standard errors are unknown".to_owned(),
                };
                format!("{samples} per pixel in {passes}; {errors}")
            }
        }
    }
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
        ("samples-per-pixel", arguments.spp.to_string()),
        ("seed", arguments.seed.to_string()),
        ("last-bounce", settings.integrator.bounces.end().to_string()),
    ]
}

fn with_core(
    arguments: &RenderArguments,
    core: &mut dyn Core,
    scene: &SceneDescription,
    camera: &Camera,
    settings: &RenderSettings,
) -> Result<Made, CoreError> {
    let mut core = Validated::new(core);
    let info = core.info();
    let mut built = core.build_scene(scene, Acceleration::DEFAULT)?;
    if renders_codes_alone(&info) {
        return codes(arguments, built.as_mut(), camera, settings);
    }
    let passes = passes(arguments);
    let progress = progress(arguments, passes);
    let job = Job { camera, settings, passes, capabilities: info.capabilities };
    let rendered = job.render(built.as_mut(), |samples| progress.set_position(samples.into()));
    progress.finish_and_clear();
    Ok(Made::Radiance { rendered: rendered?, passes })
}

fn codes(
    arguments: &RenderArguments,
    scene: &mut dyn BuiltScene,
    camera: &Camera,
    settings: &RenderSettings,
) -> Result<Made, CoreError> {
    if !arguments.output.is_png() {
        return Err(CoreError::Beyond("it renders 8 bits alone; name a .png file".to_owned()));
    }
    let progress = progress(arguments, 1);
    let mut codes = Picture::default();
    let answer = scene.render_codes(camera, settings, &mut codes);
    progress.finish_and_clear();
    answer.map(|_| Made::Codes(codes))
}

fn renders_codes_alone(info: &CoreInfo) -> bool {
    let can = |one| info.capabilities.contains(one);
    can(Capabilities::RENDER_CODES) && !can(Capabilities::RENDER)
}

fn settings(
    arguments: &RenderArguments,
    camera: &Camera,
    reference: Option<&Known>,
) -> RenderSettings {
    let [_, last] = reference.map_or(BOUNCES, |known| known.provenance.bounces);
    let direct = match arguments.hemisphere {
        true => DirectSampling::Hemisphere,
        false => DirectSampling::Lights,
    };
    let integrator = IntegratorSettings {
        bounces: 0..=arguments.bounces.unwrap_or(last),
        direct,
        seed: arguments.seed,
        ..IntegratorSettings::default()
    };
    let [width, height] = camera.film;
    RenderSettings {
        width,
        height,
        samples_per_pixel: arguments.spp,
        integrator,
        ..Default::default()
    }
}

/// No more than there are samples. A program is started for every call, which may take longer than the call.
fn passes(arguments: &RenderArguments) -> u32 {
    let usual = if arguments.core.program().is_some() { 1 } else { PASSES };
    arguments.passes.unwrap_or(usual).min(arguments.spp)
}

/// Hidden where nobody looks on: what is printed besides is enough there.
fn progress(arguments: &RenderArguments, passes: u32) -> ProgressBar {
    if arguments.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(arguments.spp.into());
    let looks = if passes == 1 { SPINNER } else { BAR };
    bar.set_style(
        ProgressStyle::with_template(looks).unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn scene(arguments: &RenderArguments, library: &Library) -> Result<Arc<SceneDescription>, Failure> {
    let overrides: Overrides = arguments.set.iter().cloned().collect();
    library.load(&arguments.scene, &overrides).map_err(Failure::request)
}

/// The camera of the scene, at the size that is asked for: rows are added or taken, pixels stay square.
fn camera(arguments: &RenderArguments, scene: &SceneDescription) -> Result<Camera, Failure> {
    let camera = scene.camera.ok_or_else(|| {
        Failure::request(format!(
            "scene `{}` has no camera to render from: add a `[camera]` to it, or for a .dae file \
             --set 'camera=\"FILE\"'",
            scene.name
        ))
    })?;
    Ok(arguments.size.map_or(camera, |film| camera.with_film(film)))
}

/// Whose fault it is that a core does not start.
fn not_started(core: &CoreSpec, error: HostError) -> Failure {
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
    let message = format!("{core} rendered no image of {}: {error}{next}", arguments.scene);
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

/// `640x480`
fn size(word: &str) -> Result<[u32; 2], String> {
    let sides = word.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some([width.trim().parse().ok()?, height.trim().parse().ok()?])
    });
    let sides =
        sides.filter(|sides: &[u32; 2]| sides.iter().all(|side| (1..=16_384).contains(side)));
    sides.ok_or_else(|| "not a size: write columns and rows from 1 to 16384, as 640x480".to_owned())
}

/// `name=value`, the value as in TOML.
fn parameter(word: &str) -> Result<(String, toml::Value), String> {
    let (name, _) = word.split_once('=').ok_or("write NAME=VALUE")?;
    let table: toml::Table = word.parse().map_err(|_| {
        "the value is not TOML: write 0.5, [1, 2, 3] or, with quotes, \"words\"".to_owned()
    })?;
    let value = table.into_iter().next();
    value.filter(|(key, _)| key == name.trim()).ok_or_else(|| "write NAME=VALUE".to_owned())
}

#[cfg(test)]
mod tests;
