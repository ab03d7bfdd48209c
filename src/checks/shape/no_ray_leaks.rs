//! Rays from inside a closed surface: every one has to meet it.
//!
//! A triangle test that is a hair too strict loses rays at the edges that triangles share, and a BVH whose boxes
//! are a hair too small loses them anywhere: cracks that let light through walls.

use super::leaks::causes;
use crate::cause::Cause;
use crate::checks::bvh::comparison::closest_hits;
use crate::checks::phrase::{figure, percent};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Ray};
use crate::math::rng::{Seed, Stream, uniform};
use crate::math::sphere::on_sphere;
use crate::scene::{Aabb, SceneDescription};
use crate::stats::{RareReport, Rarity, Verdict, judge_rare};
use crate::text::Count;
use glam::DVec3;

/// Rays asked in one call.
const BATCH: u64 = 1 << 16;
/// Rays start within this share of the half size of the surface around its middle.
const INNER: f64 = 0.4;
/// Rays at vertices for every hundred others: shown, not graded, since a rounding decides.
const AT_VERTICES: u64 = 100;
check! {
    /// No ray from the middle of a closed mesh escapes.
    pub(crate) struct NoRayLeaks {
        /// In random directions, at the default budget.
        rays: Count,
    }
    name: "no-ray-leaks",
    summary: "rays from inside a closed surface all meet it",
    needs: BUILD_SCENE | INTERSECT,
}

impl Check for NoRayLeaks {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let inside = Inside::of(&scene)?;
        let count = context.budget.samples(self.rays.0);
        let seed = context.seed;
        let leaks = leaks(context, &scene, count, &mut |batch, size| {
            let stream = &mut seed.child("anywhere").child(batch).stream();
            (0..size).map(|_| Ray::new(inside.point(stream), on_sphere(stream))).collect()
        })?;
        let at_vertices = (count / AT_VERTICES).max(1);
        let slipped = leaks_at_vertices(context, &scene, &inside, at_vertices)?;
        let report =
            judge_rare(leaks.len() as u64, count, Rarity::LEAKS.of(context.info.precision));
        let causes = match report.verdict {
            Verdict::Fail => causes(context, &scene, &leaks, count)?,
            _ => Vec::new(),
        };
        Ok(finding(&report, slipped as f64 / at_vertices as f64, causes))
    }
}

/// The rays that meet nothing, of `count` that `draw` makes batch by batch.
fn leaks(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    count: u64,
    draw: &mut dyn FnMut(u64, usize) -> Vec<Ray>,
) -> Result<Vec<Ray>, CheckError> {
    let mut built = context.core.build_scene(scene, Acceleration::DEFAULT)?;
    let mut leaks = Vec::new();
    for batch in 0..count.div_ceil(BATCH) {
        let size = usize::try_from(BATCH.min(count - batch * BATCH)).unwrap_or(usize::MAX);
        let rays = draw(batch, size);
        let hits = closest_hits(built.as_mut(), &rays)?;
        leaks.extend(rays.iter().zip(&hits).filter(|(_, hit)| !hit.is_hit()).map(|(ray, _)| *ray));
    }
    Ok(leaks)
}

fn leaks_at_vertices(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    inside: &Inside,
    count: u64,
) -> Result<usize, CheckError> {
    let vertices: Vec<_> = scene.meshes.iter().flat_map(|mesh| &mesh.positions).collect();
    let seed: Seed = context.seed.child("vertices");
    let leaks = leaks(context, scene, count, &mut |batch, size| {
        let stream = &mut seed.child(batch).stream();
        let ray = |_| {
            let vertex = *vertices[(uniform(stream) * vertices.len() as f64) as usize];
            let origin = inside.point(stream);
            Ray::new(origin, (vertex - origin).normalize())
        };
        (0..size).map(ray).collect()
    })?;
    Ok(leaks.len())
}

/// Points well inside.
struct Inside {
    middle: DVec3,
    radius: f64,
}

impl Inside {
    fn of(scene: &SceneDescription) -> Result<Self, CheckError> {
        let Some(Aabb { min, max }) = scene.bounds().filter(|_| !scene.meshes.is_empty()) else {
            return Err(CheckError::Broken("the scene has no mesh to be inside of".to_owned()));
        };
        Ok(Self { middle: 0.5 * (min + max), radius: INNER * 0.5 * (max - min).min_element() })
    }

    fn point(&self, stream: &mut Stream) -> DVec3 {
        self.middle + self.radius * uniform(stream).cbrt() * on_sphere(stream)
    }
}

fn finding(report: &RareReport, at_vertices: f64, causes: Vec<(&Cause, String)>) -> Finding {
    let share = report.hits as f64 / report.trials as f64;
    let statement = match (report.verdict, report.hits) {
        (Verdict::Pass, 0) => format!("none of {} rays leaks", report.trials),
        (_, hits) => {
            let [share, allowed] = [share, report.allowed].map(percent);
            let all = report.trials;
            format!("{hits} of {all} rays from inside leak, {share}; at most {allowed} may")
        }
    };
    let measures = vec![
        Measure::of("share of rays that leak", report),
        Measure::exact("share of rays at vertices that leak (not graded)", at_vertices, 0.0, 0.0)
            .not_graded(),
    ];
    let one_in = figure(report.resolution.recip().floor());
    let resolution = format!("would have caught one leak in {one_in} rays");
    Finding::of(statement, resolution, measures).because_of(causes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::bvh::fake::{FakeCore, Slip};
    use crate::checks::bvh::question::scene_of;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::scene::procedural::bumpy_sphere;

    fn found(slip: Slip) -> Finding {
        let check: NoRayLeaks = check_of("[expect]\nrays = \"20 k\"");
        try_judge(&check, &mut FakeCore(slip), Some(scene_of(bumpy_sphere(3)))).unwrap()
    }

    #[test]
    fn a_closed_surface_passes() {
        let finding = found(Slip::None);
        assert_passes(&finding);
        assert_eq!(finding.statement, "none of 20000 rays leaks");
        assert_eq!(finding.resolution, "would have caught one leak in 2895 rays");
    }

    #[test]
    fn every_kind_of_leak_has_its_name() {
        for (slip, cause) in [
            (Slip::ShrinksTriangles, "edges-excluded"),
            (Slip::ShrinksBoxes, "bvh-loses-hits"),
            (Slip::CullsBack, "back-culled"),
            (Slip::LosesTheLast, "primitives-lost"),
        ] {
            assert_eq!(causes(&found(slip)), [cause]);
        }
    }

    #[test]
    fn the_number_of_leaks_is_told() {
        let finding = found(Slip::LosesTheLast);
        let statement = failure(&finding);
        assert!(statement.contains(" of 20000 rays from inside leak, 0.0"), "{statement}");
        let evidence = &finding.clues[0].evidence;
        assert!(evidence.ends_with("pass through 1 triangles: 1279"), "{evidence}");
    }
}
