//! What a BSDF samples is what it evaluates: the same value, the same pdf, nothing below the horizon.

use super::drawn::Drawn;
use crate::checks::surface::SurfaceEntry;
use crate::checks::{Check, Context, Finding, Result, check};
use crate::contract::Capabilities;
use crate::text::Several;

check! {
    pub(crate) struct AgreesWithItself {
        surface: Several<SurfaceEntry>,
    }
    name: "bsdf-agrees-with-itself",
    summary: "sampled values and pdfs are those that are evaluated",
    needs: EVAL_BSDF | SAMPLE_BSDF,
}

impl Check for AgreesWithItself {
    fn needs_besides(&self) -> Capabilities {
        SurfaceEntry::all_need(&self.surface)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let mut judged = Vec::new();
        for surface in self.surface.iter() {
            judged.push(Drawn::new(context, *surface)?.judge(context)?);
        }
        let mut causes: Vec<_> = judged.iter().filter_map(|one| one.cause).collect();
        causes.dedup();
        let complaints: Vec<_> = judged.iter_mut().filter_map(|one| one.complaint.take()).collect();
        let laws: Vec<_> =
            judged.iter_mut().flat_map(|one| std::mem::take(&mut one.laws)).collect();
        let measures = judged.into_iter().flat_map(|one| one.measures).collect();
        let right = format!("{} surfaces agree with themselves", self.surface.len());
        Ok(Finding::of(right, "would have caught one sample in a hundred thousand", measures)
            .complaining(complaints)
            .because_each(causes, "predicts all samples and values that were compared")
            .by_law(laws))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::Lambertian;
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, info, judge};
    use crate::contract::{BsdfSample, BsdfValue, Precision};
    use crate::math::sphere::at_height;
    use crate::scene::Material;
    use glam::DVec3;
    use std::f64::consts::TAU;

    const CASE: &str = "[expect]\nsurface = [{ diffuse = 0.5 }]";

    fn found(fake: Lambertian) -> Finding {
        judge(&check_of::<AgreesWithItself>(CASE), &mut fake.core())
    }

    #[test]
    fn a_lambertian_surface_agrees() {
        assert_passes(&found(Lambertian::default()));
    }

    #[test]
    fn another_pdf_in_samples_is_seen() {
        let fake = Lambertian { sampled_pdf: 0.999, ..Lambertian::default() };
        assert!(failure(&found(fake)).contains("another pdf"));
    }

    #[test]
    fn another_value_in_samples_is_seen() {
        let fake = Lambertian { sampled_value: 2.0, ..Lambertian::default() };
        assert!(failure(&found(fake)).contains("another value"));
    }

    /// A core in single precision whose pdf changes by 60 % within 1e-4 radians, and whose samples are
    /// `factor` off.
    fn steep(factor: f64) -> Finding {
        let value = |material: &Material, wi: DVec3| {
            let value = Lambertian::default().value(material, DVec3::Z, wi);
            BsdfValue { pdf: value.pdf * (1.0 + 0.4 * (5e4 * wi.x).sin()), ..value }
        };
        let mut core = Fake {
            info: info(Precision::Single),
            value: Box::new(move |material, query| value(material, query.wi)),
            sample: Box::new(move |material, _, point, _| {
                let wi = at_height((1.0 - point.x).sqrt(), TAU * point.y);
                let BsdfValue { f, pdf } = value(material, wi);
                let wi = wi.to_array().map(|part| f64::from(part as f32)).into();
                BsdfSample { wi, f, pdf: factor * pdf, is_delta: 0, is_valid: 1 }
            }),
            ..Fake::default()
        };
        judge(&check_of::<AgreesWithItself>(CASE), &mut core)
    }

    #[test]
    fn a_steep_pdf_is_forgiven_what_rounding_changes_and_no_more() {
        assert_passes(&steep(1.0));
        assert!(failure(&steep(1.1)).contains("another pdf"));
    }

    #[test]
    fn light_from_below_is_seen() {
        let fake = Lambertian { shines_through: true, ..Lambertian::default() };
        let finding = found(fake);
        assert!(failure(&finding).contains("below the horizon"));
        assert_eq!(finding.clues[0].cause, "light-from-below");
    }
}
