//! Samples of an area light, and what their rays meet in the scene.
//!
//! Of a sample that lies on an edge of the light to rounding, its ray may go by: that is no error.

use super::area_pdf::Geometry;
use crate::checks::phrase::some_are;
use crate::checks::{Measure, Result};
use crate::contract::{BuiltScene, Hit, LightSample, Ray};
use crate::stats::{Compared, Verdict, judge_exact};
use glam::DVec3;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Shadow rays start and the light is looked for this share of the distance away from either end.
const SLACK: f64 = 1e-3;
/// Directions around that of a sample in which the light is looked for where its own ray goes by.
const AROUND: u32 = 8;

pub(super) fn is_lit(sample: &LightSample) -> bool {
    sample.is_valid == 1 && sample.pdf > 0.0 && sample.radiance != [0.0; 3]
}

/// Some samples, and what their rays meet in the scene.
pub(super) struct Traced {
    pub(super) samples: Vec<LightSample>,
    pub(super) hits: Vec<Hit>,
    /// Those whose ray goes by, and that lie on an edge of the light to rounding.
    on_edge: BTreeSet<usize>,
    shape: u32,
    tolerance: f64,
}

impl Traced {
    /// `tolerance` is relative to the distance.
    pub(super) fn new(
        scene: &mut dyn BuiltScene,
        from: DVec3,
        mut samples: Vec<LightSample>,
        shape: u32,
        tolerance: f64,
    ) -> Result<Self> {
        samples.retain(is_lit);
        let tolerance = tolerance.max(1e-6);
        let rays: Vec<_> = samples.iter().map(|sample| towards(sample, from, sample.wi)).collect();
        let hits = met(scene, &rays)?;
        let missed: Vec<_> = (0..hits.len()).filter(|n| !is_on(&hits[*n], shape)).collect();
        let near = missed.iter().flat_map(|n| {
            let sample = &samples[*n];
            around(sample.wi, tolerance).map(move |wi| towards(sample, from, wi))
        });
        let near = met(scene, &near.collect::<Vec<_>>())?;
        let is_beside_light = |(n, hits): &(&usize, &[Hit])| {
            let distance = samples[**n].distance;
            hits.iter().any(|hit| is_on(hit, shape) && (hit.t - distance).abs() <= SLACK * distance)
        };
        let of_each = missed.iter().zip(near.chunks(AROUND as usize));
        let on_edge = of_each.filter(is_beside_light).map(|(n, _)| *n).collect();
        Ok(Self { samples, hits, on_edge, shape, tolerance })
    }

    /// Every lit sample ends on the light, where it says. Of one on its edge roundings decide whether the ray meets it.
    pub(super) fn reached(&self, label: &str) -> Measure {
        let inside = (0..self.samples.len()).filter(|n| !self.on_edge.contains(n));
        let compared = inside.map(|n| {
            let (sample, hit) = (&self.samples[n], &self.hits[n]);
            let found = if is_on(hit, self.shape) { hit.t } else { f64::NAN };
            Compared::relative(found, sample.distance, self.tolerance)
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

fn is_on(hit: &Hit, shape: u32) -> bool {
    hit.is_hit() && hit.shape == shape
}

/// From close before the light: what lies in between is the business of shadow rays.
fn towards(sample: &LightSample, from: DVec3, wi: DVec3) -> Ray {
    Ray { t_min: (1.0 - SLACK) * sample.distance, ..Ray::new(from, wi) }
}

fn met(scene: &mut dyn BuiltScene, rays: &[Ray]) -> Result<Vec<Hit>> {
    let mut hits = vec![Hit::MISS; rays.len()];
    // No core is asked about nothing.
    if !rays.is_empty() {
        scene.intersect(rays, &mut hits)?;
    }
    Ok(hits)
}

/// Unit directions at this angle from `wi`, radians, one for each eighth of a turn.
fn around(wi: DVec3, angle: f64) -> impl Iterator<Item = DVec3> {
    let (x, y) = wi.any_orthonormal_pair();
    (0..AROUND).map(move |n| {
        let (sin, cos) = (TAU * f64::from(n) / f64::from(AROUND)).sin_cos();
        (wi + angle * (cos * x + sin * y)).normalize()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::contract::{Acceleration, Core};
    use crate::scene::SceneDescription;

    const LIGHT: u32 = 1;

    /// Half of the plane z = 1.5, up to x = 0.6.
    fn light(ray: &Ray) -> Hit {
        let t = 1.5 / ray.direction.z;
        let is_met = t * ray.direction.x <= 0.6;
        if is_met { Hit { t, shape: LIGHT, primitive: 0, ..Hit::MISS } } else { Hit::MISS }
    }

    /// What is said of a sample so far beyond the edge, as a share of its distance, beside one that is on the light.
    fn reached(beyond: f64) -> Measure {
        let mut core = Fake { hit: Box::new(light), ..Fake::default() };
        let scene = SceneDescription::default();
        let mut built = core.build_scene(&scene, Acceleration::DEFAULT).unwrap();
        let edge = DVec3::new(0.6, 0.1, 1.5);
        let sample = |end: DVec3| LightSample {
            wi: end.normalize(),
            distance: end.length(),
            radiance: [1.0; 3],
            pdf: 1.0,
            is_valid: 1,
            ..LightSample::NONE
        };
        let samples =
            [1.5 * DVec3::Z, edge + beyond * edge.length() * DVec3::X].map(sample).to_vec();
        Traced::new(built.as_mut(), DVec3::ZERO, samples, LIGHT, 1e-4).unwrap().reached("a")
    }

    #[test]
    fn a_sample_on_the_lights_edge_may_be_missed_and_one_beyond_it_may_not() {
        assert!(!reached(-1e-3).failed());
        assert!(!reached(1e-5).failed(), "to rounding");
        assert!(reached(1e-3).failed());
    }
}
