//! What rays that leak out of a closed surface have in common.

use crate::cause::{Cause, bvh, shape};
use crate::checks::bvh::comparison::hits_with;
use crate::checks::oracle::{self, Met};
use crate::checks::phrase::figure;
use crate::checks::{CheckError, Context};
use crate::contract::{Acceleration, Capabilities, Hit, Ray};
use crate::scene::SceneDescription;

/// Leaks that are looked at one by one.
const LOOKED_AT: usize = 300;

/// A leak this near an edge, in weights, is one of the edge.
const EDGE: f64 = 0.01;

/// A hit this near the right one, in parts of its t, is no other: wide for single precision, whose digits end at 1e-7,
/// and narrow beside the distance to another triangle.
const NEAR: f64 = 1e-3;

/// What the leaks have in common.
pub(super) fn causes(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    leaks: &[Ray],
    count: u64,
) -> Result<Vec<(&'static Cause, String)>, CheckError> {
    let looked_at = &leaks[..leaks.len().min(LOOKED_AT)];
    let nearest: Vec<_> = looked_at.iter().map(|ray| oracle::nearest(scene, ray)).collect();
    let is_found = is_found_by_loop(context, scene, looked_at, &nearest)?;
    let met: Vec<_> = nearest.into_iter().flatten().collect();
    if is_found {
        let evidence = format!("the loop over all triangles meets all {} rays", looked_at.len());
        return Ok(vec![missing_triangles(&met).unwrap_or((&bvh::HITS_LOST, evidence))]);
    }
    if leaks.len() as u64 == count {
        return Ok(culled(context, scene, looked_at)?.into_iter().collect());
    }
    let farthest = met.iter().map(distance_to_edge).fold(0.0, f64::max);
    if met.len() == looked_at.len() && farthest < EDGE {
        let (all, weight) = (met.len(), figure(farthest));
        let evidence = format!(
            "all {all} leaks that were looked at pass within a weight of {weight} of an edge"
        );
        return Ok(vec![(&shape::EDGES_EXCLUDED, evidence)]);
    }
    Ok(missing_triangles(&met).into_iter().collect())
}

/// What every ray misses from inside is there from outside.
fn culled(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    leaks: &[Ray],
) -> Result<Option<(&'static Cause, String)>, CheckError> {
    let far = scene.bounds().map_or(0.0, |bounds| 2.0 * bounds.diagonal());
    let back = |ray: &Ray| Ray::new(ray.at(far), -ray.direction);
    let rays: Vec<_> = leaks.iter().map(back).collect();
    let hits = hits_with(context, scene, Acceleration::DEFAULT, &rays)?;
    let evidence = "every ray misses the surface from inside, and meets it from outside";
    let is_culled = hits.iter().all(|hit| hit.is_hit());
    Ok(is_culled.then(|| (&shape::BACK_CULLED, evidence.to_owned())))
}

/// Whether the core's loop meets what each ray should meet: one that meets what is not there says nothing of the BVH.
fn is_found_by_loop(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    rays: &[Ray],
    nearest: &[Option<Met>],
) -> Result<bool, CheckError> {
    if !context.info.capabilities.contains(Capabilities::BRUTE_FORCE) {
        return Ok(false);
    }
    let hits = hits_with(context, scene, Acceleration::BruteForce, rays)?;
    let is_right = |(hit, met): (&Hit, &Option<Met>)| {
        let is_near = |met: Met| (hit.t - met.answer.t).abs() < NEAR * met.answer.t;
        hit.is_hit() && met.is_some_and(is_near)
    };
    Ok(hits.iter().zip(nearest).all(is_right))
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
        let names = triangles.iter().take(3).map(|(_, number)| number.to_string());
        let names = names.collect::<Vec<_>>().join(", ");
        let more = if triangles.len() > 3 { ", …" } else { "" };
        let through = format!("pass through {} triangles: {names}{more}", triangles.len());
        let evidence = format!("all {} leaks that were looked at {through}", met.len());
        (&bvh::PRIMITIVES_LOST, evidence)
    })
}
