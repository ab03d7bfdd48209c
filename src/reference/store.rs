//! From sums of passes to a reference on disk.

use super::make::Plan;
use super::shard::Shard;
use super::sums::Rank;
use super::{MakeError, References};
use crate::disk;
use crate::image::exr::{self, Exr, Storage};
use crate::scene::reference::{
    ERROR_PREFIX, Layers, Provenance, Reference, fingerprint, load, picture_path, provenance_path,
    read_provenance,
};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

impl References {
    pub(super) fn sums_path(&self, name: &str) -> PathBuf {
        self.folder.join(".work").join(format!("{name}.sums"))
    }

    /// The sums of the passes of a reference that is there.
    pub(super) fn kept(&self, name: &str) -> Result<(Shard, Provenance), MakeError> {
        let path = self.sums_path(name);
        let missing = |problem: String| MakeError::NoSums {
            name: name.to_owned(),
            path: path.clone(),
            problem,
        };
        let provenance =
            read_provenance(&self.folder, name).map_err(|problem| missing(problem.to_string()))?;
        let shard = Shard::read(&path).map_err(|error| missing(error.to_string()))?;
        let same = shard.seeds.ranges() == provenance.seeds
            && shard.about.scene_hash == provenance.scene_hash
            && shard.about.samples_per_pass == provenance.samples_per_pass;
        if !same {
            return Err(missing(
                "the existing ones are of other passes than the reference".to_owned(),
            ));
        }
        Ok((shard, provenance))
    }

    /// Writes the reference that a plan's passes add up to, and keeps the sums.
    pub(super) fn store(
        &self,
        plan: &Plan,
        shard: &Shard,
        command: String,
    ) -> Result<Reference, MakeError> {
        let mut recipe = plan.recipe.clone();
        recipe.passes = shard.seeds.count();
        recipe.check().map_err(MakeError::Options)?;
        self.write(&mut Reference {
            name: plan.name.clone(),
            mean: shard.sums.mean(),
            standard_error: shard.sums.standard_error(),
            layers: Layers::default(),
            provenance: plan.provenance(shard, command),
        })?;
        shard.write(&self.sums_path(&plan.name))?;
        Ok(load(&self.folder, &plan.name, &plan.scene)?)
    }

    /// Writes a reference with the layers that it has, and its fingerprint into its provenance.
    pub(super) fn write(&self, reference: &mut Reference) -> Result<(), MakeError> {
        let path = picture_path(&self.folder, &reference.name);
        // One attribute only: the encoder writes several in any order, and the bytes would not be the same twice.
        let file = Exr::from_image(&reference.mean)
            .with_colours(ERROR_PREFIX, &reference.standard_error, Storage::Half)
            .with_attribute("furnace", reference.provenance.header());
        let content = exr::encode(&path, &reference.layers.added_to(file))?;
        reference.provenance.picture_hash = fingerprint(&content);
        let provenance = provenance_path(&self.folder, &reference.name);
        write_provenance(&provenance, &reference.provenance)?;
        disk::replace(&path, &content).map_err(MakeError::at(&path))
    }
}

impl Plan {
    /// What there is to say about the reference but for the picture's own fingerprint.
    fn provenance(&self, shard: &Shard, command: String) -> Provenance {
        let about = shard.about.clone();
        Provenance {
            scene: about.scene,
            scene_hash: about.scene_hash,
            bounces: about.bounces,
            film: about.film,
            renderer: "mitsuba".to_owned(),
            version: about.version,
            variant: about.variant,
            sampler: about.sampler,
            passes: shard.seeds.count(),
            samples_per_pass: about.samples_per_pass,
            seeds: shard.seeds.ranges().to_vec(),
            median_relative_error: rounded(shard.sums.relative_error(Rank::Middle)),
            high_relative_error: rounded(shard.sums.relative_error(Rank::High)),
            picture_hash: String::new(),
            command,
            date: today(),
            cpu_seconds: rounded(shard.cpu_seconds),
            bounce_passes: 0,
            parameters: self.recipe.parameters.clone(),
        }
    }
}

fn write_provenance(path: &Path, provenance: &Provenance) -> Result<(), MakeError> {
    let body = toml::to_string(provenance).map_err(MakeError::at(path))?;
    let text = format!("# Written by `furnace reference make`; not for editing.\n{body}");
    disk::replace(path, text.as_bytes()).map_err(MakeError::at(path))
}

/// Today in UTC, as 2026-01-31.
fn today() -> String {
    let mut stamp = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    stamp.truncate(10);
    stamp
}

fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
