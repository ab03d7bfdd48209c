//! From a recipe to a reference on disk.

use super::average::{Average, Rank};
use super::date::today;
use super::mitsuba::{Job, Mitsuba, Spent};
use super::recipe::{self, Recipe};
use super::{Listener, MakeError, References, environment};
use crate::image::Image;
use crate::image::exr::{self, Exr, Storage};
use crate::scene::SceneDescription;
use crate::scene::hash::content_hash;
use crate::scene::mitsuba::{SAMPLER, export};
use crate::scene::reference::{
    ERROR_PREFIX, Provenance, Reference, fingerprint, load, picture_path, provenance_path,
};
use std::path::Path;
use std::sync::Arc;

/// How to make a reference, where it differs from the recipe.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MakeOptions {
    /// Make it even if there is one already.
    pub replace: bool,
    /// Install Mitsuba into `references/.venv` if it is not there.
    pub create_environment: bool,
    /// Passes, instead of the recipe's.
    pub passes: Option<u32>,
    /// Samples a pixel in each pass, instead of the recipe's.
    pub samples_per_pass: Option<u32>,
    /// Mitsuba's back end, instead of the fastest that works.
    pub variant: Option<String>,
}

/// A reference about to be rendered.
pub(super) struct Plan {
    pub name: String,
    pub recipe: Recipe,
    pub scene: Arc<SceneDescription>,
    pub job: Job,
}

impl References {
    /// Makes reference `name` as its recipe says, and writes it. Goes on where an earlier attempt was cut off.
    pub fn make(
        &self,
        name: &str,
        options: &MakeOptions,
        progress: Listener<'_>,
    ) -> Result<Reference, MakeError> {
        if !options.replace && provenance_path(&self.folder, name).exists() {
            return Err(MakeError::Exists(name.to_owned()));
        }
        let mut recipe = recipe::read(&self.folder, name)?;
        recipe.passes = options.passes.unwrap_or(recipe.passes);
        recipe.samples_per_pass = options.samples_per_pass.unwrap_or(recipe.samples_per_pass);
        recipe.check().map_err(MakeError::Options)?;
        let plan = self.plan(name, recipe, "make")?;
        let python = environment::python(&self.folder, options.create_environment, progress)?;
        let asked = options.variant.as_deref();
        let mitsuba = environment::mitsuba(python, asked, &plan.job, progress)?;
        let seeds: Vec<u32> = (0..plan.recipe.passes).collect();
        let spent = mitsuba.render(&plan.job, &seeds, progress)?;
        let average = plan.average(&seeds)?;
        self.write(&plan, &average, plan.provenance(&mitsuba, spent, &average, options))?;
        remove(&plan.job.folder)?;
        Ok(load(&self.folder, name, &plan.scene)?)
    }

    /// Writes a scene for Mitsuba into a working folder of its own, or finds it there from an earlier attempt.
    pub(super) fn plan(
        &self,
        name: &str,
        recipe: Recipe,
        purpose: &str,
    ) -> Result<Plan, MakeError> {
        let scene = self.scenes.load(&recipe.scene, &recipe.parameters)?;
        let film = scene.camera.as_ref().map_or([0, 0], |camera| camera.film);
        let exported = export(&scene, recipe.bounces)?;
        if !film.iter().all(|pixels| pixels.is_multiple_of(32)) {
            return Err(MakeError::Film { scene: recipe.scene, film });
        }
        // Passes of another scene, bounce or length never mix.
        let samples = recipe.samples_per_pass;
        let key = format!("{} {} {samples}", content_hash(&scene), recipe.bounces);
        let key = &fingerprint(key.as_bytes())[..12];
        let folder = self.folder.join(".work").join(format!("{purpose}-{name}-{key}"));
        let write = || {
            std::fs::create_dir_all(&folder)?;
            exported.write_to(&folder)
        };
        write().map_err(|problem| MakeError::file(&folder, &problem))?;
        let job = Job { folder, film, samples };
        Ok(Plan { name: name.to_owned(), recipe, scene, job })
    }

    fn write(
        &self,
        plan: &Plan,
        average: &Average,
        provenance: impl FnOnce(String) -> Provenance,
    ) -> Result<(), MakeError> {
        let picture = picture_path(&self.folder, &plan.name);
        let beside = picture.with_extension("exr.tmp");
        let folder = self.folder.join(&plan.name);
        std::fs::create_dir_all(&folder).map_err(|problem| MakeError::file(&folder, &problem))?;
        let file = Exr::from_image(&average.mean())
            .with_colours(ERROR_PREFIX, &average.standard_error(), Storage::Half)
            .with_attribute("furnace scene", plan.recipe.scene.clone())
            .with_attribute("furnace scene hash", content_hash(&plan.scene))
            .with_attribute("furnace provenance", "provenance.toml");
        exr::write(&beside, &file)?;
        let content =
            std::fs::read(&beside).map_err(|problem| MakeError::file(&beside, &problem))?;
        let provenance = provenance(fingerprint(&content));
        write_provenance(&provenance_path(&self.folder, &plan.name), &provenance)?;
        std::fs::rename(&beside, &picture).map_err(|problem| MakeError::file(&picture, &problem))
    }
}

impl Plan {
    /// The passes of these seeds, averaged.
    fn average(&self, seeds: &[u32]) -> Result<Average, MakeError> {
        let [width, height] = self.job.film.map(|pixels| pixels as usize);
        let mut average = Average::new(width, height);
        for &seed in seeds {
            let pass = self.pass(seed)?;
            average.push(&pass);
        }
        Ok(average)
    }

    /// The pass of one seed, which has been rendered.
    pub fn pass(&self, seed: u32) -> Result<Image, MakeError> {
        let pass = self.job.pass(seed).ok_or_else(|| {
            MakeError::file(&self.job.folder, &format!("pass {seed} is missing or cut off"))
        })?;
        let is_light = |value: &f32| *value >= 0.0 && value.is_finite();
        if pass.pixels.iter().flatten().all(is_light) {
            Ok(pass)
        } else {
            Err(MakeError::ImpossiblePass { name: self.name.clone(), seed })
        }
    }

    /// What there is to say about the reference, once the picture's own fingerprint is known.
    fn provenance(
        &self,
        mitsuba: &Mitsuba,
        spent: Spent,
        average: &Average,
        options: &MakeOptions,
    ) -> impl FnOnce(String) -> Provenance {
        let command = options.command(&self.name);
        move |picture_hash| Provenance {
            scene: self.recipe.scene.clone(),
            scene_hash: content_hash(&self.scene),
            bounces: [0, self.recipe.bounces],
            film: self.job.film,
            renderer: "mitsuba".to_owned(),
            version: spent.version,
            variant: mitsuba.variant.name.clone(),
            sampler: SAMPLER.to_owned(),
            passes: self.recipe.passes,
            samples_per_pass: self.recipe.samples_per_pass,
            seeds: [0, self.recipe.passes - 1],
            median_relative_error: rounded(average.relative_error(Rank::Middle)),
            high_relative_error: rounded(average.relative_error(Rank::High)),
            picture_hash,
            command,
            date: today(),
            cpu_seconds: rounded(spent.cpu_seconds),
            parameters: self.recipe.parameters.clone(),
        }
    }
}

impl MakeOptions {
    /// The command line that says the same.
    fn command(&self, name: &str) -> String {
        let mut command = format!("furnace reference make {name}");
        let numbers = [("passes", self.passes), ("samples-per-pass", self.samples_per_pass)];
        for (flag, number) in numbers {
            if let Some(number) = number {
                command += &format!(" --{flag} {number}");
            }
        }
        if let Some(variant) = &self.variant {
            command += &format!(" --variant {variant}");
        }
        command
    }
}

fn write_provenance(path: &Path, provenance: &Provenance) -> Result<(), MakeError> {
    let beside = path.with_extension("toml.tmp");
    let body = toml::to_string(provenance).map_err(|problem| MakeError::file(path, &problem))?;
    let text = format!("# Written by `furnace reference make`; not for editing.\n{body}");
    let write = || {
        std::fs::write(&beside, text)?;
        std::fs::rename(&beside, path)
    };
    write().map_err(|problem| MakeError::file(path, &problem))
}

pub(super) fn remove(folder: &Path) -> Result<(), MakeError> {
    std::fs::remove_dir_all(folder).map_err(|problem| MakeError::file(folder, &problem))
}

/// Three significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
