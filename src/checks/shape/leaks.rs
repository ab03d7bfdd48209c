//! What rays that leak out of a closed surface have in common.

use crate::cause::{Cause, bvh, shape};
use crate::checks::bvh::comparison::closest_hits;
use crate::checks::oracle::{self, Met};
use crate::checks::phrase::figure;
use crate::checks::{CheckError, Context};
use crate::contract::{Acceleration, Capabilities, Ray};
use crate::scene::SceneDescription;

/// Leaks that are looked at one by one.
const LOOKED_AT: usize = 300;

/// A leak this near an edge, in weights, is one of the edge.
pub(super) const EDGE: f64 = 0.01;

/// What the leaks have in common.
pub(super) fn causes(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    leaks: &[Ray],
    count: u64,
) -> Result<Vec<(&'static Cause, String)>, CheckError> {
    let looked_at = &leaks[..leaks.len().min(LOOKED_AT)];
    let met: Vec<_> = looked_at.iter().filter_map(|ray| oracle::nearest(scene, ray)).collect();
    if found_by_loop(context, scene, looked_at)? == Some(looked_at.len()) {
        let evidence = format!("the loop over all triangles meets all {} rays", looked_at.len());
        return Ok(vec![missing_triangles(&met).unwrap_or((&bvh::HITS_LOST, evidence))]);
    }
    if leaks.len() as u64 == count {
        return Ok(culled(context, scene, looked_at)?.into_iter().collect());
    }
    let farthest = met.iter().map(distance_to_edge).fold(0.0, f64::max);
    if met.len() == looked_at.len() && farthest < EDGE {
        let evidence = format!(
            "all {} leaks that were looked at pass within a weight of {} of an edge",
            met.len(),
            figure(farthest)
        );
        return Ok(vec![(&shape::EDGES_EXCLUDED, evidence)]);
    }
    Ok(missing_triangles(&met).into_iter().collect())
}

/// What every ray misses from inside is there from outside.
pub(super) fn culled(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    leaks: &[Ray],
) -> Result<Option<(&'static Cause, String)>, CheckError> {
    let far = scene.bounds().map_or(0.0, |bounds| 2.0 * bounds.diagonal());
    let back = |ray: &Ray| Ray::new(ray.at(far), -ray.direction);
    let mut built = context.core.build_scene(scene, Acceleration::DEFAULT)?;
    let rays: Vec<_> = leaks.iter().map(back).collect();
    let hits = closest_hits(built.as_mut(), &rays)?;
    let evidence = "every ray misses the surface from inside, and meets it from outside";
    let is_culled = hits.iter().all(|hit| hit.is_hit());
    Ok(is_culled.then(|| (&shape::BACK_CULLED, evidence.to_owned())))
}

/// How many of the rays the loop meets; `None` if the core has no loop.
fn found_by_loop(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    rays: &[Ray],
) -> Result<Option<usize>, CheckError> {
    if !context.info.capabilities.contains(Capabilities::BRUTE_FORCE) {
        return Ok(None);
    }
    let mut brute = context.core.build_scene(scene, Acceleration::BruteForce)?;
    let hits = closest_hits(brute.as_mut(), rays)?;
    Ok(Some(hits.iter().filter(|hit| hit.is_hit()).count()))
}

/// The least of the three weights.
fn distance_to_edge(met: &Met) -> f64 {
    met.answer.weights.map_or(1.0, |weights| weights.into_iter().fold(1.0, f64::min))
}

/// Few triangles that many leaks pass through are missing.
fn missing_triangles(met: &[Met]) -> Option<(&'static Cause, String)> {
    let mut triangles: Vec<_> = met.iter().map(|met| (met.shape, met.primitive)).collect();
    triangles.sort_unstable();
    triangles.dedup();
    let is_few = !triangles.is_empty() && 4 * triangles.len() <= met.len();
    is_few.then(|| {
        let numbers: Vec<_> =
            triangles.iter().take(3).map(|(_, number)| number.to_string()).collect();
        let more = if triangles.len() > 3 { ", …" } else { "" };
        let evidence = format!(
            "all {} leaks that were looked at pass through {} triangles: {}{more}",
            met.len(),
            triangles.len(),
            numbers.join(", ")
        );
        (&bvh::PRIMITIVES_LOST, evidence)
    })
}
