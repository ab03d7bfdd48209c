//! Haines's sphereflake: spheres upon spheres upon spheres.
//!
//! E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987: every sphere carries nine of a
//! third of its radius, six around its equator and three above it, as seen from its own parent.

use super::sphere::icosphere;
use crate::scene::Mesh;
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_3, TAU};

/// Centres and radii of a sphereflake, biggest first: one sphere of radius 1 around the origin and
/// (9ᵈ⁺¹ − 1)/8 spheres in all. The whole stays within distance 2 of the origin.
pub(crate) fn sphereflake_spheres(depth: u32) -> Vec<(DVec3, f64)> {
    let mut all = vec![(DVec3::ZERO, 1.0)];
    let mut generation = vec![(DVec3::ZERO, 1.0, DQuat::IDENTITY)];
    for _ in 0..depth {
        generation = generation.iter().flat_map(children).collect();
        all.extend(generation.iter().map(|&(centre, radius, _)| (centre, radius)));
    }
    all
}

/// A sphereflake whose spheres are icospheres of 20 · 4ˢ triangles each.
pub fn sphereflake(depth: u32, subdivisions: u32) -> Mesh {
    let unit = icosphere(subdivisions);
    let mut flake = Mesh::default();
    for (centre, radius) in sphereflake_spheres(depth) {
        let first = flake.positions.len() as u32;
        flake.positions.extend(unit.positions.iter().map(|p| centre + radius * *p));
        flake.indices.extend(unit.indices.iter().map(|corners| corners.map(|i| i + first)));
    }
    flake
}

/// The nine children of a sphere with centre, radius, and the rotation that takes +y to its own axis.
fn children(&(centre, radius, axis): &(DVec3, f64, DQuat)) -> Vec<(DVec3, f64, DQuat)> {
    let around = (0..6).map(|k| (0.0, f64::from(k) * FRAC_PI_3));
    let above = (0..3).map(|k| (FRAC_PI_3, (f64::from(k) + 0.25) * TAU / 3.0));
    let place = |(latitude, longitude): (f64, f64)| {
        let local = DVec3::new(
            latitude.cos() * longitude.cos(),
            latitude.sin(),
            latitude.cos() * longitude.sin(),
        );
        let towards = axis * local;
        let turn = DQuat::from_rotation_arc(DVec3::Y, towards.normalize());
        (centre + towards * (radius * 4.0 / 3.0), radius / 3.0, turn)
    };
    around.chain(above).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_child_touches_its_parent() {
        let spheres = sphereflake_spheres(1);
        assert_eq!(spheres.len(), 10);
        for (centre, radius) in &spheres[1..] {
            assert!((centre.length() - (1.0 + radius)).abs() < 1e-12);
        }
    }

    #[test]
    fn siblings_do_not_overlap() {
        let spheres = &sphereflake_spheres(1)[1..];
        for (i, (a, _)) in spheres.iter().enumerate() {
            for (b, _) in &spheres[..i] {
                assert!(a.distance(*b) > 2.0 / 3.0, "{a} {b}");
            }
        }
    }

    #[test]
    fn the_flake_counts_nine_times_more_with_each_generation_and_stays_in_reach() {
        let spheres = sphereflake_spheres(3);
        assert_eq!(spheres.len(), 820);
        assert!(spheres.iter().all(|(centre, radius)| centre.length() + radius < 2.0));
        assert_eq!(sphereflake(2, 1).indices.len(), 91 * 80);
    }
}
