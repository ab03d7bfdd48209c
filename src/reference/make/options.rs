//! How a reference is made where the recipe does not say, or says otherwise.

use super::recipe::Recipe;
use super::{MakeError, MitsubaOptions};
use std::ops::Range;
use std::path::PathBuf;

/// How to make a reference, where it differs from the recipe.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct MakeOptions {
    /// Make it even if there is one already.
    pub(crate) replace: bool,
    /// Add the passes that the one there is lacks.
    pub(crate) extend: bool,
    /// Render these seeds only, and leave their sums for a merge.
    pub(crate) seeds: Option<Range<u32>>,
    /// Files of sums: render nothing, and add these up, with those of the reference there is.
    pub(crate) merge: Vec<PathBuf>,
    pub(crate) mitsuba: MitsubaOptions,
    /// Passes, instead of the recipe's.
    pub(crate) passes: Option<u32>,
    /// Samples a pixel in all passes together, instead of the recipe's, rounded up to whole passes.
    pub(crate) samples: Option<u32>,
    /// Samples a pixel in each pass, instead of the recipe's.
    pub(crate) samples_per_pass: Option<u32>,
}

impl MakeOptions {
    /// The recipe with what is different here.
    pub(super) fn recipe(&self, mut recipe: Recipe) -> Result<Recipe, MakeError> {
        recipe.samples_per_pass = self.samples_per_pass.unwrap_or(recipe.samples_per_pass);
        let enough = self.samples.map(|samples| samples.div_ceil(recipe.samples_per_pass.max(1)));
        recipe.passes = self.passes.or(enough).unwrap_or(recipe.passes);
        recipe.check().map_err(MakeError::Options)?;
        Ok(recipe)
    }

    /// The command line that says the same.
    pub(super) fn command(&self, name: &str) -> String {
        let mut command = format!("furnace reference make {name}");
        if self.extend {
            command += " --extend";
        }
        for path in &self.merge {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            command += &format!(" --merge {file}");
        }
        let numbers = [
            ("passes", self.passes),
            ("spp", self.samples),
            ("samples-per-pass", self.samples_per_pass),
        ];
        for (flag, number) in numbers {
            if let Some(number) = number {
                command += &format!(" --{flag} {number}");
            }
        }
        if let Some(variant) = &self.mitsuba.variant {
            command += &format!(" --variant {variant}");
        }
        command
    }
}
