//! `furnace export`: a scene in another program's words.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::scene::format::{self, ExportError, Format, Request};
use crate::scene::{Library, Overrides};
use clap::Args;
use std::path::PathBuf;

/// What `furnace export` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ExportArguments {
    /// A scene of the project, or a `.toml` or `.dae` file.
    scene: String,
    /// mitsuba, collada (with the course's CGL profile and camera file), pbrt or obj.
    #[arg(long, value_name = "FORMAT")]
    format: Format,
    /// The folder for the files; created if missing.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Maximum depth: the last bounce, for formats that store it in the scene.
    #[arg(long, value_name = "N", default_value_t = 5)]
    bounces: u32,
    /// Samples per pixel, for formats that store them in the scene.
    #[arg(long, value_name = "N", default_value_t = 64)]
    spp: u32,
    /// Seed of the random numbers, for formats that store it in the scene.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    project: ProjectArguments,
}

pub(crate) fn export(arguments: &ExportArguments) -> Answer {
    let project = arguments.project.find()?;
    let library = Library::of(&project);
    let scene = library.load(&arguments.scene, &Overrides::new()).map_err(Failure::request)?;
    std::fs::create_dir_all(&arguments.output).map_err(|error| {
        Failure::broken(format!("cannot make {}: {error}", arguments.output.display()))
    })?;
    let request =
        Request { last_bounce: arguments.bounces, samples: arguments.spp, seed: arguments.seed };
    let written = format::write(&scene, arguments.format, request, &arguments.output);
    let written = written.map_err(|error| match error {
        ExportError::Io { .. } => Failure::broken(error),
        ExportError::CannotHold { .. } => Failure::request(error),
    })?;
    say_line!("{}", written.scene.display());
    if let Some(camera) = written.camera {
        say_line!("{}", camera.display());
    }
    Ok(ExitCode::Good)
}
