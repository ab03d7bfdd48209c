//! Samples of an area light, and what their rays meet in the scene.

use super::area_pdf::Geometry;
use crate::checks::phrase::some_are;
use crate::checks::{Measure, Result};
use crate::contract::{BuiltScene, Hit, LightSample, Ray};
use crate::stats::{Compared, Verdict, judge_exact};
use glam::DVec3;

/// Shadow rays start and the light is looked for this share of the distance away from either end.
const SLACK: f64 = 1e-3;

pub(super) fn is_lit(sample: &LightSample) -> bool {
    sample.is_valid == 1 && sample.pdf > 0.0 && sample.radiance != [0.0; 3]
}

/// Some samples, and what their rays meet in the scene.
pub(super) struct Traced {
    pub(super) samples: Vec<LightSample>,
    pub(super) hits: Vec<Hit>,
    pub(super) shape: u32,
}

impl Traced {
    pub(super) fn new(
        scene: &mut dyn BuiltScene,
        from: DVec3,
        mut samples: Vec<LightSample>,
        shape: u32,
    ) -> Result<Self> {
        samples.retain(is_lit);
        // From close before the light: what lies in between is the business of shadow rays.
        let ray = |sample: &LightSample| {
            let start = (1.0 - SLACK) * sample.distance;
            Ray { t_min: start, ..Ray::new(from, sample.wi) }
        };
        let rays: Vec<_> = samples.iter().map(ray).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        if !rays.is_empty() {
            scene.intersect(&rays, &mut hits)?;
        }
        Ok(Self { samples, hits, shape })
    }

    /// Every lit sample ends on the light, where it says.
    pub(super) fn reached(&self, label: &str, tolerance: f64) -> Measure {
        let compared = self.samples.iter().zip(&self.hits).map(|(sample, hit)| {
            let found = if hit.is_hit() && hit.shape == self.shape { hit.t } else { f64::NAN };
            Compared::relative(found, sample.distance, tolerance.max(1e-6))
        });
        let report = judge_exact(compared);
        if report.compared == 0 {
            return Measure::none("samples that see light", 0).of_row(label);
        }
        let some = some_are(report.disagree, report.compared, "samples");
        let measure = match report.verdict {
            Verdict::Pass => Measure::worst("distance to the light", &report),
            _ => {
                Measure::none(format!("{some} not on the light at that distance"), report.disagree)
            }
        };
        measure.of_row(label)
    }

    /// Of the samples that met the light.
    pub(super) fn geometry(&self, area: f64, normal: DVec3) -> Vec<(Geometry, f64)> {
        Geometry::of(area, normal, &self.samples, &self.hits)
    }

    /// A light that looks away sends nothing.
    pub(super) fn dark(&self, label: &str) -> Measure {
        Measure::none("lit samples of a light that looks away", self.samples.len()).of_row(label)
    }
}
