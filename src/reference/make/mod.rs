//! From a recipe, or from parts of it, to a reference.

mod options;
#[cfg(test)]
mod tests;

pub(crate) use options::MakeOptions;

use super::mitsuba::{Job, Mitsuba, Spent};
use super::recipe::{self, Recipe};
use super::seeds::Seeds;
use super::shard::{About, Shard};
use super::sums::Sums;
use super::{Listener, MakeError, MitsubaOptions, References, environment};
use crate::image::Image;
use crate::scene::SceneDescription;
use crate::scene::format::mitsuba::{SAMPLER, export};
use crate::scene::hash::content_hash;
use crate::scene::reference::{Reference, fingerprint, load, provenance_path};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Made {
    Reference(Box<Reference>),
    /// The sums of some of its passes, in this file.
    Part(PathBuf),
}

/// A reference about to be rendered.
pub(super) struct Plan {
    pub(crate) name: String,
    pub(crate) recipe: Recipe,
    pub(crate) scene: Arc<SceneDescription>,
    pub(crate) job: Job,
}

impl References {
    /// Makes reference `name` as its recipe says, and writes it. Goes on where an earlier attempt
    /// was cut off. Replaces nothing unasked.
    pub(crate) fn make(
        &self,
        name: &str,
        options: &MakeOptions,
        progress: Listener<'_>,
    ) -> Result<Made, MakeError> {
        let recipe = options.recipe(recipe::read(&self.folder, name)?)?;
        let exists = provenance_path(&self.folder, name).exists();
        if !options.merge.is_empty() {
            return self.merge(name, recipe, options, exists);
        }
        if let Some(seeds) = &options.seeds {
            return self.part(name, recipe, seeds, options, progress);
        }
        if exists && !options.replace && !options.extend {
            return Err(MakeError::Exists(name.to_owned()));
        }
        let plan = self.plan(name, recipe, "make")?;
        let wanted = 0..plan.recipe.passes;
        if !options.extend {
            let shard = self.render(&plan, wanted.collect(), options, progress)?;
            let reference = self.store(&plan, &shard, options.command(name))?;
            remove(&plan.job.folder)?;
            return self.made(&reference, progress);
        }
        let (mut whole, before) = self.kept(name)?;
        let lacking: Vec<u32> = wanted.filter(|seed| !whole.seeds.contains(*seed)).collect();
        if lacking.is_empty() {
            let problem = format!(
                "`{name}` has all of its {} passes\nhint: ask for more in references/recipes.toml, \
                 by --passes or by --spp",
                plan.recipe.passes
            );
            return Err(MakeError::Options(problem));
        }
        let shard = self.render(&plan, lacking, options, progress)?;
        whole.merge(&shard, &plan.job.folder)?;
        let command = format!("{} && {}", before.command, options.command(name));
        let reference = self.store(&plan, &whole, command)?;
        remove(&plan.job.folder)?;
        self.made(&reference, progress)
    }

    /// A reference that Mitsuba has just rendered, with its layers.
    fn made(&self, reference: &Reference, progress: Listener<'_>) -> Result<Made, MakeError> {
        // The environment is there, and the back end that made the picture works.
        let options = MitsubaOptions {
            create_environment: false,
            variant: Some(reference.provenance.variant.clone()),
        };
        let layered = self.add_layers(&reference.name, &options, progress)?;
        Ok(Made::Reference(Box::new(layered)))
    }

    /// Renders the passes of some seeds, and leaves their sums in a file.
    fn part(
        &self,
        name: &str,
        recipe: Recipe,
        seeds: &Range<u32>,
        options: &MakeOptions,
        progress: Listener<'_>,
    ) -> Result<Made, MakeError> {
        if seeds.is_empty() {
            return Err(MakeError::Options("--seeds A..B needs A below B".to_owned()));
        }
        let part = format!("{name}-{}-{}", seeds.start, seeds.end - 1);
        let path = self.sums_path(&part);
        if path.exists() && !options.replace {
            return Err(MakeError::Exists(path.display().to_string()));
        }
        // A folder of its own: other seeds may be rendered at the same time.
        let plan = self.plan(name, recipe, &format!("part-{}", seeds.start))?;
        let shard = self.render(&plan, seeds.clone().collect(), options, progress)?;
        shard.write(&path)?;
        remove(&plan.job.folder)?;
        Ok(Made::Part(path))
    }

    /// Adds up files of sums, and those of the reference if there is one.
    fn merge(
        &self,
        name: &str,
        recipe: Recipe,
        options: &MakeOptions,
        exists: bool,
    ) -> Result<Made, MakeError> {
        let plan = self.plan(name, recipe, "merge")?;
        remove(&plan.job.folder)?;
        let (mut whole, mut command) = (None, String::new());
        if exists && !options.replace {
            let (kept, before) = self.kept(name)?;
            whole = Some(kept);
            command = before.command + " && ";
        }
        for path in &options.merge {
            let shard = Shard::read(path)?;
            if !plan.is_of_its_kind(&shard.about) {
                let problem = format!("its passes are not of `{name}` as the recipe says");
                return Err(MakeError::file(path, &problem));
            }
            match &mut whole {
                None => whole = Some(shard),
                Some(whole) => whole.merge(&shard, path)?,
            }
        }
        let Some(whole) = whole else {
            return Err(MakeError::Options("--merge needs files of sums".to_owned()));
        };
        // The layers are of the same scene and the same bounces, whatever the passes.
        let is_same = |before: &Reference| before.provenance.bounces == plan.about().bounces;
        let before = load(&self.folder, name, &plan.scene).ok().filter(is_same);
        let mut reference = self.store(&plan, &whole, command + &options.command(name))?;
        if let Some(before) = before {
            reference.layers = before.layers;
            reference.provenance.bounce_passes = before.provenance.bounce_passes;
            self.write(&mut reference)?;
        }
        Ok(Made::Reference(Box::new(reference)))
    }

    /// Renders the passes of these seeds that are not there yet, and adds all of them up.
    fn render(
        &self,
        plan: &Plan,
        seeds: Vec<u32>,
        options: &MakeOptions,
        progress: Listener<'_>,
    ) -> Result<Shard, MakeError> {
        let mitsuba = environment::mitsuba(&self.folder, &options.mitsuba, &plan.job, progress)?;
        let spent = mitsuba.render(&plan.job, &seeds, progress)?;
        plan.shard(&seeds, &mitsuba, &spent)
    }

    /// A reference that is there, and a plan to render what it shows.
    pub(super) fn stored(&self, name: &str, purpose: &str) -> Result<(Reference, Plan), MakeError> {
        let mut recipe = recipe::read(&self.folder, name)?;
        let scene = self.scenes.load(&recipe.scene, &recipe.parameters)?;
        let stored = load(&self.folder, name, &scene)?;
        recipe.bounces = stored.provenance.bounces[1];
        recipe.samples_per_pass = stored.provenance.samples_per_pass;
        Ok((stored, self.plan(name, recipe, purpose)?))
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
        std::fs::create_dir_all(&folder).map_err(MakeError::at(&folder))?;
        exported.write_to(&folder)?;
        let job = Job { folder, film, samples, last_bounce: None };
        Ok(Plan { name: name.to_owned(), recipe, scene, job })
    }
}

impl Plan {
    /// The passes of these seeds, added up.
    pub(crate) fn shard(
        &self,
        seeds: &[u32],
        mitsuba: &Mitsuba,
        spent: &Spent,
    ) -> Result<Shard, MakeError> {
        let [width, height] = self.job.film.map(|pixels| pixels as usize);
        let (mut sums, mut set) = (Sums::new(width, height), Seeds::default());
        for &seed in seeds {
            sums.push(&self.pass(seed)?);
            set.add_one(seed);
        }
        let about = About {
            version: mitsuba.version.clone(),
            variant: mitsuba.variant.name.clone(),
            ..self.about()
        };
        Ok(Shard { about, seeds: set, cpu_seconds: spent.cpu_seconds, sums })
    }

    /// What its passes are of, whoever rendered them.
    fn about(&self) -> About {
        About {
            scene: self.recipe.scene.clone(),
            scene_hash: content_hash(&self.scene),
            bounces: [0, self.recipe.bounces],
            film: self.job.film,
            samples_per_pass: self.recipe.samples_per_pass,
            sampler: SAMPLER.to_owned(),
            ..About::default()
        }
    }

    fn is_of_its_kind(&self, about: &About) -> bool {
        let (version, variant) = (about.version.clone(), about.variant.clone());
        About { version, variant, ..self.about() } == *about
    }

    /// The pass of one seed, which has been rendered.
    pub(crate) fn pass(&self, seed: u32) -> Result<Image, MakeError> {
        self.whole(self.job.pass(seed), seed)
    }

    /// What has been read of a pass, if it is there and can be light.
    pub(crate) fn whole(&self, pass: Option<Image>, seed: u32) -> Result<Image, MakeError> {
        let pass = pass.ok_or_else(|| {
            MakeError::file(&self.job.folder, &format!("pass {seed} is missing or cut off"))
        })?;
        let is_light = |value: &f32| *value >= 0.0 && value.is_finite();
        if pass.pixels.iter().flatten().all(is_light) {
            Ok(pass)
        } else {
            Err(MakeError::ImpossiblePass { name: self.name.clone(), seed })
        }
    }
}

pub(super) fn remove(folder: &Path) -> Result<(), MakeError> {
    std::fs::remove_dir_all(folder).map_err(MakeError::at(folder))
}
