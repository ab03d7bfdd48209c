//! Where a reference comes from: enough to make it again, and to know when it has to be.

use crate::scene::Overrides;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// What `provenance.toml` says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Provenance {
    pub(crate) scene: String,
    /// Its [content hash](crate::scene::hash::content_hash) when the reference was made.
    pub(crate) scene_hash: String,
    /// First and last bounce that are added up: 0 is directly visible emission.
    pub(crate) bounces: [u32; 2],
    pub(crate) film: [u32; 2],
    pub(crate) renderer: String,
    pub(crate) version: String,
    /// Which of its back ends.
    pub(crate) variant: String,
    pub(crate) sampler: String,
    /// Independent passes. The standard error is taken between them.
    pub(crate) passes: u32,
    pub(crate) samples_per_pass: u32,
    /// First and last seed of each unbroken range; every pass has a seed of its own.
    pub(crate) seeds: Vec<[u32; 2]>,
    /// Standard error over mean, the middle one of all pixels and channels that are not black.
    pub(crate) median_relative_error: f64,
    /// The same, exceeded by one value in a hundred.
    pub(crate) high_relative_error: f64,
    /// SHA-256 of `reference.exr`.
    pub(crate) picture_hash: String,
    pub(crate) command: String,
    /// Day it was made, UTC.
    pub(crate) date: String,
    /// Processor seconds it took, less those of attempts that were cut off.
    pub(crate) cpu_seconds: f64,
    /// Passes that each bounce alone is the mean of, with the first of the seeds; 0 if the reference
    /// does not hold them.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) bounce_passes: u32,
    /// Values that were given to parameters of the scene.
    #[serde(default, skip_serializing_if = "Overrides::is_empty")]
    pub(crate) parameters: Overrides,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
fn is_zero(number: &u32) -> bool {
    *number == 0
}

impl Provenance {
    pub(crate) fn samples_per_pixel(&self) -> u64 {
        u64::from(self.passes) * u64::from(self.samples_per_pass)
    }

    /// What the header of `reference.exr` says, so that an image on its own can be made again.
    pub(crate) fn header(&self) -> String {
        let mut text = format!(
            "furnace {}\nscene {} {}\n",
            env!("CARGO_PKG_VERSION"),
            self.scene,
            self.scene_hash
        );
        for (name, value) in &self.parameters {
            // Writing into a string does not fail.
            let _ = writeln!(text, "parameter {name} = {value}");
        }
        let [first, last] = self.bounces;
        let seeds: Vec<String> =
            self.seeds.iter().map(|[first, last]| format!("{first} to {last}")).collect();
        let _ = write!(
            text,
            "bounces {first} to {last}\n{} {}, {}, {}\n{} passes of {} samples a pixel, seeds {}",
            self.renderer,
            self.version,
            self.variant,
            self.sampler,
            self.passes,
            self.samples_per_pass,
            seeds.join(" and ")
        );
        text
    }
}
