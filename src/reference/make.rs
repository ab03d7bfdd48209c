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
    /// Makes reference `name` as its recipe says, and writes it. Goes on where an earlier attempt
    /// was cut off.
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

    /// Writes a scene for Mitsuba into a working folder of its own, or finds it there from an
    /// earlier attempt.
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
        // One attribute only: the encoder writes several in any order, and the bytes would not be
        // the same twice.
        let about = format!(
            "scene {} {}, see provenance.toml",
            plan.recipe.scene,
            content_hash(&plan.scene)
        );
        let file = Exr::from_image(&average.mean())
            .with_colours(ERROR_PREFIX, &average.standard_error(), Storage::Half)
            .with_attribute("furnace", about);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Library;
    use tempfile::TempDir;

    const RECIPE: &str = "bounces = 1\npasses = 16\nsamples-per-pass = 4\n";

    /// A folder with a scene and a recipe for each film, and no Mitsuba.
    fn workshop(film: &str) -> (TempDir, References) {
        let folder = tempfile::tempdir().unwrap();
        let scenes = folder.path().join("scenes");
        std::fs::create_dir(&scenes).unwrap();
        let scene = format!(
            "title = \"t\"\nsource = \"s\"\n[camera]\nposition = [0, 0, 1]\nlook-at = [0, 0, 0]\n\
             horizontal-fov = \"40 deg\"\nfilm = {film}\n"
        );
        std::fs::write(scenes.join("void.toml"), scene).unwrap();
        std::fs::write(folder.path().join("recipes.toml"), format!("[void]\n{RECIPE}")).unwrap();
        std::fs::write(folder.path().join("requirements.txt"), "mitsuba==3.9.1\n").unwrap();
        let references = References::new(folder.path(), Library::new(scenes));
        (folder, references)
    }

    fn refusal(references: &References, options: &MakeOptions) -> String {
        references.make("void", options, &mut |_| ()).unwrap_err().to_string()
    }

    #[test]
    fn what_exists_is_not_replaced_unasked() {
        let (folder, references) = workshop("[64, 32]");
        std::fs::create_dir(folder.path().join("void")).unwrap();
        std::fs::write(provenance_path(folder.path(), "void"), "precious").unwrap();
        let message = refusal(&references, &MakeOptions::default());
        assert!(message.contains("exists already\nhint: `--replace`"), "{message}");
        let kept = std::fs::read_to_string(provenance_path(folder.path(), "void")).unwrap();
        assert_eq!(kept, "precious");
    }

    #[test]
    fn films_that_make_seeds_overlap_are_refused() {
        let (_folder, references) = workshop("[100, 76]");
        let message = refusal(&references, &MakeOptions::default());
        assert!(message.contains("multiples of 32"), "{message}");
    }

    #[test]
    fn options_are_held_to_what_recipes_are_held_to() {
        let (_folder, references) = workshop("[64, 32]");
        let few = MakeOptions { passes: Some(2), ..MakeOptions::default() };
        assert!(refusal(&references, &few).contains("at least 16 passes"));
        let long = MakeOptions { samples_per_pass: Some(1000), ..MakeOptions::default() };
        assert!(refusal(&references, &long).contains("1 to 256 samples"));
    }

    #[test]
    fn without_mitsuba_the_scene_is_ready_and_the_way_to_get_it_is_named() {
        let (folder, references) = workshop("[64, 32]");
        let message = refusal(&references, &MakeOptions::default());
        assert!(message.contains("`--create-venv` installs mitsuba==3.9.1"), "{message}");
        let work = std::fs::read_dir(folder.path().join(".work")).unwrap().next().unwrap().unwrap();
        assert!(work.path().join("scene.xml").is_file());
    }

    #[test]
    fn passes_become_a_reference_that_loads() {
        let (folder, references) = workshop("[64, 32]");
        let recipe = recipe::read(folder.path(), "void").unwrap();
        let plan = references.plan("void", recipe, "make").unwrap();
        for seed in 0..16u32 {
            let value = if seed.is_multiple_of(2) { 0.5f32 } else { 1.5 };
            let bytes = vec![value.to_le_bytes(); 64 * 32 * 3].concat();
            std::fs::write(plan.job.folder.join(format!("pass-{seed}.f32")), bytes).unwrap();
        }
        let seeds: Vec<u32> = (0..16).collect();
        let average = plan.average(&seeds).unwrap();
        let variant = super::super::mitsuba::Variant { name: "none".to_owned(), llvm: None };
        let mitsuba = Mitsuba { python: "python".into(), variant };
        let options = MakeOptions { passes: Some(16), ..MakeOptions::default() };
        let provenance = plan.provenance(&mitsuba, Spent::default(), &average, &options);
        references.write(&plan, &average, provenance).unwrap();
        let reference = load(folder.path(), "void", &plan.scene).unwrap();
        assert_eq!(reference.mean.pixels[0], [1.0; 3]);
        // Squared deviations of a quarter, over 15, over 16 passes.
        let expected = (16.0f32 * 0.25 / 15.0 / 16.0).sqrt();
        assert!((reference.standard_error.pixels[0][0] - expected).abs() < expected / 64.0);
        assert_eq!(reference.provenance.command, "furnace reference make void --passes 16");
    }

    #[test]
    fn a_pass_with_light_that_cannot_be_is_named() {
        let (folder, references) = workshop("[64, 32]");
        let recipe = recipe::read(folder.path(), "void").unwrap();
        let plan = references.plan("void", recipe, "make").unwrap();
        let bytes = vec![f32::NAN.to_le_bytes(); 64 * 32 * 3].concat();
        std::fs::write(plan.job.folder.join("pass-7.f32"), bytes).unwrap();
        let message = plan.average(&[7]).err().unwrap().to_string();
        assert!(message.contains("pass 7 of `void`"), "{message}");
        let message = plan.average(&[8]).err().unwrap().to_string();
        assert!(message.contains("pass 8 is missing"), "{message}");
    }
}
