//! The mean weight of samples, f cos / pdf, is the albedo: what a path tracer really multiplies by.

use super::albedo::Albedo;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::{degrees, figure};
use crate::checks::surface::{SurfaceEntry, sampled, seen_from};
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Capabilities, Core};
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, judge_means};
use crate::text::{Count, Percent, Polar, Several};

check! {
    pub(crate) struct WeightsMakeTheAlbedo {
        surface: Several<SurfaceEntry>,
        seen_from: Several<Polar>,
        detects: Percent,
        at_most: Count,
    }
    name: "weights-make-the-albedo",
    summary: "the mean of f cos / pdf over samples is the albedo",
    needs: SAMPLE_BSDF,
}

impl Check for WeightsMakeTheAlbedo {
    fn needs_besides(&self) -> Capabilities {
        SurfaceEntry::all_need(&self.surface)
    }

    fn validate(&self) -> Result<(), String> {
        SurfaceEntry::refuse_delta(&self.surface, "has weights of its own: `reflects-and-refracts`")
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let effort = context.effort(self.detects, self.at_most);
        let band = Band::math(context.info.precision);
        let conventions = context.info.conventions;
        let mut measures = Vec::new();
        for surface in self.surface.iter() {
            for Polar(angle) in self.seen_from.iter() {
                let seed = context.seed.child(surface).child(angle);
                let albedo = Albedo::expected(*surface, *angle, conventions).sum();
                let claim = Claim::value(albedo, band);
                let reports = judge_means(&[claim], &effort, &mut |draw| {
                    let samples = usize::try_from(draw.samples).unwrap_or(usize::MAX);
                    mean_weight(context.core, *surface, *angle, draw.seed(seed), samples)
                })?;
                let row = format!("{surface} seen from {}", degrees(*angle));
                measures.push(Measure::of("mean weight", &reports[0]).of_row(row));
            }
        }
        let complaint = measures.iter().find(|measure| measure.failed()).map(|measure| {
            let (measured, expected) = (figure(measure.measured), figure(measure.expected));
            format!("{} is {measured}, and the albedo is {expected}", measure.name())
        });
        let right = format!("{} mean weights are albedos", measures.len());
        Ok(Finding::measured(right, measures).complaining(complaint))
    }
}

/// Of the green channel; a failed sample weighs nothing.
fn mean_weight(
    core: &mut dyn Core,
    surface: SurfaceEntry,
    angle: f64,
    seed: Seed,
    count: usize,
) -> Result<Vec<f64>> {
    let views = vec![seen_from(angle); count];
    let numbers = Numbers::new(seed, count);
    let samples = sampled(core, &surface.material(), &views, numbers.randomness())?;
    let valid = samples.iter().filter(|sample| sample.is_valid == 1);
    let sum: f64 = valid.map(|sample| sample.f[1] * sample.wi.z.abs() / sample.pdf).sum();
    Ok(vec![sum / count as f64])
}

#[cfg(test)]
mod tests {
    use super::super::fake::Lambertian;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    const CASE: &str = r#"
        [expect]
        surface   = [{ diffuse = 0.5 }]
        seen-from = ["20 deg", "70 deg"]
        detects   = "1 %"
        at-most   = "100 k"
    "#;

    fn found(fake: Lambertian) -> Finding {
        judge(&check_of::<WeightsMakeTheAlbedo>(CASE), &mut fake.core())
    }

    #[test]
    fn cosine_samples_of_a_diffuse_surface_all_weigh_the_albedo() {
        assert_passes(&found(Lambertian::default()));
    }

    #[test]
    fn a_hundredth_in_the_value_or_in_the_pdf_is_seen() {
        let bright = found(Lambertian { sampled_value: 1.01, ..Lambertian::default() });
        assert!(failure(&bright).contains("is 0.505, and the albedo is 0.5"));
        failure(&found(Lambertian { sampled_pdf: 1.01, ..Lambertian::default() }));
    }
}
