//! What a BSDF samples is what it evaluates: the same value, the same density, nothing below the horizon.

use super::drawn::Drawn;
use crate::checks::surface::SurfaceEntry;
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::Capabilities;
use crate::text::Several;
use serde::Deserialize;

/// Sampled directions are evaluated again.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AgreesWithItself {
    surface: Several<SurfaceEntry>,
}

impl Check for AgreesWithItself {
    const NAME: &'static str = "bsdf-agrees-with-itself";
    const SUMMARY: &'static str = "sampled values and densities are those that are evaluated";

    fn needs(&self) -> Capabilities {
        Capabilities::EVAL_BSDF | Capabilities::SAMPLE_BSDF | SurfaceEntry::all_need(&self.surface)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut judged = Vec::new();
        for surface in self.surface.iter() {
            judged.push(Drawn::new(context, *surface)?.judge(context)?);
        }
        let mut causes: Vec<_> = judged.iter().filter_map(|one| one.cause).collect();
        causes.dedup();
        let complaints: Vec<_> = judged.iter_mut().filter_map(|one| one.complaint.take()).collect();
        let measures = judged.into_iter().flat_map(|one| one.measures).collect();
        let right = format!("{} surfaces agree with themselves", self.surface.len());
        Ok(Finding::of(right, "would have caught one sample in a hundred thousand", measures)
            .complaining(complaints)
            .because_each(causes, "predicts all samples and values that were compared"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::Lambertian;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    const CASE: &str = "[expect]\nsurface = [{ diffuse = 0.5 }]";

    fn found(fake: Lambertian) -> Finding {
        judge(&check_of::<AgreesWithItself>(CASE), &mut fake.core())
    }

    #[test]
    fn a_lambertian_surface_agrees() {
        assert_passes(&found(Lambertian::default()));
    }

    #[test]
    fn another_density_in_samples_is_seen() {
        let fake = Lambertian { sampled_pdf: 0.999, ..Lambertian::default() };
        assert!(failure(&found(fake)).contains("another density"));
    }

    #[test]
    fn another_value_in_samples_is_seen() {
        let fake = Lambertian { sampled_value: 2.0, ..Lambertian::default() };
        assert!(failure(&found(fake)).contains("another value"));
    }

    #[test]
    fn light_from_below_is_seen() {
        let fake = Lambertian { shines_through: true, ..Lambertian::default() };
        let finding = found(fake);
        assert!(failure(&finding).contains("below the horizon"));
        assert_eq!(finding.clues[0].cause, "light-from-below");
    }
}
