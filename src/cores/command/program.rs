//! One picture: the scene is written, the program is started, and what it wrote is read.

use super::adapter::{Adapter, Encoding, Feature, LogPatterns, Pattern, Runs};
use super::picture::{self, Picture};
use super::process::{self, Ended, Group, Words, found};
use crate::contract::{CoreError, DirectSampling, RenderSettings, Result};
use crate::scene::format::{self, ExportError, Request, Written};
use crate::scene::{Camera, Light, SceneDescription, Shape, Surface};
use crate::text::{Diagnostic, Source};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// A program and how it is called.
#[derive(Debug)]
pub(crate) struct Program {
    adapter: Adapter,
    /// Where the adapter's file is.
    folder: PathBuf,
    /// Whom what it starts belongs to.
    group: Group,
    /// The number of each seed, where runs are told apart by their samples.
    runs: Mutex<HashMap<u64, u32>>,
}

/// Why an adapter cannot be had.
#[derive(Debug, thiserror::Error)]
pub(crate) enum AdapterError {
    #[error("{path} cannot be read: {error}")]
    Unreadable { path: PathBuf, error: std::io::Error },
    #[error("{0}")]
    Wrong(Box<Diagnostic>),
}

/// What a program made, and what it said about it.
#[derive(Clone, Debug)]
pub(crate) struct Rendered {
    pub(crate) picture: Picture,
    pub(crate) log: Log,
}

/// Numbers from a program's own words; none where it says nothing, or nothing is declared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Log {
    pub(crate) seconds: Option<f64>,
    pub(crate) rays: Option<f64>,
    /// Boxes and primitives tested for one ray.
    pub(crate) tests_per_ray: Option<f64>,
}

impl Program {
    /// Reads an adapter's file. The program itself is not looked for.
    ///
    /// # Errors
    /// If the file cannot be read, or says something wrong.
    pub(crate) fn load(path: &Path) -> std::result::Result<Self, AdapterError> {
        let unreadable = |error| AdapterError::Unreadable { path: path.to_owned(), error };
        let source = Source::read(path).map_err(unreadable)?;
        let adapter =
            Adapter::parse(&source).map_err(|error| AdapterError::Wrong(Box::new(error)))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let folder = std::path::absolute(folder).map_err(unreadable)?;
        Ok(Self { adapter, folder, group: Group::Own, runs: Mutex::default() })
    }

    /// The same in a worker, which is ended with all that it has started.
    pub(crate) fn within_a_worker(self) -> Self {
        Self { group: Group::Workers, ..self }
    }

    /// The program, and what it is started with as far as that is known before there is a scene.
    pub(crate) fn words(&self) -> Vec<String> {
        let folder = self.folder.display().to_string();
        let arguments = self.adapter.arguments.iter();
        let arguments = arguments.map(|argument| argument.replace("{adapter}", &folder));
        [self.executable()].into_iter().chain(arguments).collect()
    }

    /// Of the user's environment, what the program gets to see.
    pub(crate) fn variables(&self) -> Vec<(String, String)> {
        let kept = self.adapter.keeps.iter();
        let kept = kept.filter_map(|name| Some((name.clone(), std::env::var(name).ok()?)));
        let program = (self.adapter.program.variable.clone(), self.executable());
        [program].into_iter().chain(kept).collect()
    }

    pub(crate) fn adapter(&self) -> &Adapter {
        &self.adapter
    }

    /// Whether its pictures hold radiance as it is, not cut to 8 bits.
    pub(crate) fn is_linear(&self) -> bool {
        self.adapter.output.encoding == Encoding::Linear
    }

    /// Renders a picture.
    ///
    /// # Errors
    /// If the program or the format cannot hold the scene ([`CoreError::Beyond`]), or the program fails, takes
    /// too long or writes something else.
    pub(crate) fn render(
        &self,
        scene: &SceneDescription,
        camera: &Camera,
        settings: &RenderSettings,
    ) -> Result<Rendered> {
        if let Some(what) = self.lacking(scene, settings.integrator.direct) {
            return Err(CoreError::Beyond(format!("{} has no {what}", self.adapter.name)));
        }
        let folder = tempfile::tempdir().map_err(|error| refused(&error))?;
        let film = [settings.width, settings.height];
        let scene = SceneDescription { camera: Some(Camera { film, ..*camera }), ..scene.clone() };
        let run = self.run_of(settings);
        let written =
            format::write(&scene, self.adapter.scene, run.request(settings), folder.path());
        let written = written.map_err(|error| match error {
            ExportError::Io { .. } => refused(&error),
            ExportError::CannotHold { .. } => CoreError::Beyond(error.to_string()),
        })?;
        let words = Vocabulary { program: self, scene: &scene, camera, settings, run, written };
        let log = self.execute(&words, folder.path())?;
        let picture = self.read(folder.path(), film)?;
        Ok(Rendered { picture, log })
    }

    fn execute(&self, words: &Vocabulary<'_>, folder: &Path) -> Result<Log> {
        let mut command = self.command(words, folder);
        let during = format!("`{}`", self.adapter.name);
        let limit = Duration::from_secs(u64::from(self.adapter.time_limit));
        let (ended, said) =
            process::run(&mut command, folder, limit, self.group).map_err(|error| {
                let executable = &self.adapter.program;
                CoreError::Refused(format!(
                    "`{}` cannot be started ({error}); set {} to {}",
                    command.get_program().display(),
                    executable.variable,
                    executable.needs
                ))
            })?;
        match ended {
            Ended::Exited(status) if status.success() => {}
            Ended::Exited(status) => {
                let how = format!("{status}; the end of its output: {}", said.last());
                return Err(CoreError::Crashed { how, during, element: None });
            }
            Ended::OutOfTime => {
                let during = format!("{during}; the end of its output: {}", said.last());
                return Err(CoreError::TimedOut { limit, during });
            }
        }
        if !folder.join(&self.adapter.output.file).is_file() {
            return Err(CoreError::Refused(format!(
                "{during} exited successfully without writing {}; the end of its output: {}",
                self.adapter.output.file,
                said.last()
            )));
        }
        Ok(self.adapter.log.read(&said))
    }

    fn command(&self, words: &Vocabulary<'_>, folder: &Path) -> Command {
        let mut command = Command::new(self.executable());
        for argument in &self.adapter.arguments {
            if argument == "{direct}" {
                command.args(words.direct());
            } else {
                command.arg(words.fill(argument, folder));
            }
        }
        for (name, value) in &self.adapter.environment {
            command.env(name, words.fill(value, folder));
        }
        command
    }

    /// By its whole path, since it runs in a folder of its own; as it was named, if it is nowhere.
    fn executable(&self) -> String {
        let Adapter { program, .. } = &self.adapter;
        let named = std::env::var(&program.variable).unwrap_or_else(|_| program.default.clone());
        found(&named).map_or(named, |path| path.display().to_string())
    }

    fn read(&self, folder: &Path, film: [u32; 2]) -> Result<Picture> {
        let picture = picture::read(&self.adapter.output, folder)
            .map_err(|error| CoreError::breach(error.to_string()))?;
        let [width, height] = film.map(|pixels| pixels as usize);
        let found = [picture.image.width, picture.image.height];
        if found == [width, height] {
            return Ok(picture);
        }
        let [found_width, found_height] = found;
        Err(CoreError::breach(format!(
            "its image has {found_width} x {found_height} pixels, not {width} x {height}"
        )))
    }

    /// What of the scene the program is known not to do.
    fn lacking(&self, scene: &SceneDescription, direct: DirectSampling) -> Option<&'static str> {
        let lacks = |feature| self.adapter.lacks.contains(&feature);
        let sampled = direct == DirectSampling::Lights
            && scene.lights.iter().any(|light| matches!(light, Light::Area { .. }));
        let pdf = (Feature::AreaLightPdf, "area lights that are sampled by a pdf of directions");
        let mut asked = sampled.then_some(pdf).into_iter().chain(features(scene));
        asked.find(|(feature, _)| lacks(*feature)).map(|(_, name)| name)
    }

    fn run_of(&self, settings: &RenderSettings) -> Run {
        let seed = settings.integrator.seed;
        match self.adapter.runs {
            Runs::SeedBits(64) => Run { seed, more_samples: 0 },
            Runs::SeedBits(bits) => Run { seed: seed % (1 << bits), more_samples: 0 },
            Runs::OneSampleMore => {
                let mut runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
                let next = runs.len() as u32;
                Run { seed: 0, more_samples: *runs.entry(seed).or_insert(next) }
            }
        }
    }
}

fn refused(error: &dyn std::fmt::Display) -> CoreError {
    CoreError::Refused(error.to_string())
}

/// What makes a run another one.
#[derive(Clone, Copy)]
struct Run {
    seed: u64,
    more_samples: u32,
}

impl Run {
    fn request(self, settings: &RenderSettings) -> Request {
        Request {
            last_bounce: *settings.integrator.bounces.end(),
            samples: settings.samples_per_pixel + self.more_samples,
            seed: self.seed,
        }
    }
}

/// What the words of a template stand for.
struct Vocabulary<'a> {
    program: &'a Program,
    scene: &'a SceneDescription,
    camera: &'a Camera,
    settings: &'a RenderSettings,
    run: Run,
    written: Written,
}

impl Vocabulary<'_> {
    fn direct(&self) -> &[String] {
        match self.settings.integrator.direct {
            DirectSampling::Lights => &[],
            DirectSampling::Hemisphere => {
                self.program.adapter.can.hemisphere.as_deref().unwrap_or_default()
            }
        }
    }

    fn fill(&self, template: &str, folder: &Path) -> String {
        let mut filled = String::new();
        let mut rest = template;
        while let Some((before, after)) = rest.split_once('{') {
            let Some((word, after)) = after.split_once('}') else { break };
            filled += before;
            filled += &self.value(word, folder);
            rest = after;
        }
        filled + rest
    }

    /// Words are checked when the adapter is read.
    fn value(&self, word: &str, folder: &Path) -> String {
        let integrator = &self.settings.integrator;
        let (first, last) = (*integrator.bounces.start(), *integrator.bounces.end());
        let path = |path: &Path| path.display().to_string();
        match word {
            "program" => self.program.executable(),
            "adapter" => path(&self.program.folder),
            "scene" => path(&self.written.scene),
            "camera" => self.written.camera.as_deref().map(path).unwrap_or_default(),
            "folder" => path(folder),
            "output" => path(&folder.join(&self.program.adapter.output.file)),
            "width" => self.settings.width.to_string(),
            "height" => self.settings.height.to_string(),
            "spp" => (self.settings.samples_per_pixel + self.run.more_samples).to_string(),
            "seed" => self.run.seed.to_string(),
            "first-bounce" => first.to_string(),
            "last-bounce" => last.to_string(),
            "depth" => (last + self.program.adapter.depth_offset).to_string(),
            // Trials run side by side already.
            "threads" => integrator.threads.max(1).to_string(),
            "light-samples" => integrator.samples_per_light.to_string(),
            "horizontal-fov" => self.camera.horizontal_fov.to_degrees().to_string(),
            "vertical-fov" => self.camera.vertical_fov.to_degrees().to_string(),
            "name" => self.scene.name.clone(),
            _ => String::new(),
        }
    }
}

impl LogPatterns {
    fn read(&self, said: &Words<'_>) -> Log {
        if self.seconds.is_none() && self.rays.is_none() && self.tests_per_ray.is_none() {
            return Log::default();
        }
        let text = said.all();
        let number = |pattern: &Option<Pattern>| {
            let found = pattern.as_ref()?.0.captures_iter(&text).last()?;
            found.get(1)?.as_str().replace(',', "").parse().ok()
        };
        Log {
            seconds: number(&self.seconds),
            rays: number(&self.rays),
            tests_per_ray: number(&self.tests_per_ray),
        }
    }
}

/// Everything in a scene that a program may lack, with its name.
fn features(scene: &SceneDescription) -> Vec<(Feature, &'static str)> {
    let mut found = Vec::new();
    for number in 0..scene.shape_count() as u32 {
        let material = scene.material_of(number);
        match material.surface {
            Surface::Diffuse { .. } => {}
            Surface::Mirror { .. } => found.push((Feature::Mirror, "mirrors")),
            Surface::Glass { reflectance, transmittance, .. }
            | Surface::RoughGlass { reflectance, transmittance, .. } => {
                let is_rough = matches!(material.surface, Surface::RoughGlass { .. });
                found.push(match is_rough {
                    true => (Feature::RoughGlass, "rough glass"),
                    false => (Feature::Glass, "glass"),
                });
                if [reflectance, transmittance] != [[1.0; 3]; 2] {
                    found.push((Feature::TintedGlass, "tinted glass"));
                }
            }
            Surface::Conductor { .. } => found
                .push((Feature::RoughMetal, "rough conductors with this masking-shadowing term")),
        }
        let black = Surface::Diffuse { reflectance: [0.0; 3] };
        if material.emission.is_some() && material.surface != black {
            found.push((Feature::EmissiveSurface, "emitters that also reflect"));
        }
        if let Shape::Sphere(sphere) = scene.shape(number) {
            if material.emission.is_some() {
                found.push((Feature::SphereLight, "sphere lights"));
            }
            if sphere.inward {
                found.push((Feature::InwardSphere, "spheres with inward normals"));
            }
        }
    }
    found.extend(scene.lights.iter().filter_map(|light| match light {
        Light::Point { .. } => Some((Feature::PointLight, "point lights")),
        Light::Directional { .. } => Some((Feature::DirectionalLight, "directional lights")),
        Light::ConstantSky { .. } => Some((Feature::ConstantSky, "skies")),
        Light::GradientSky { .. } => Some((Feature::GradientSky, "gradient environment lights")),
        Light::Area { .. } => None,
    }));
    found
}
