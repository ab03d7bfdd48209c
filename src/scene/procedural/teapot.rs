//! The Utah teapot, tessellated.
//!
//! Martin Newell's 32 bicubic Bézier patches (1975; the bottom is Frank Crow's, 1987), y up, body radius 2, height
//! 3.15. Rim, body, lid and bottom are surfaces of revolution, four patches each; handle and spout are tubes of two
//! patches to each side. So 6 profiles and 14 sections say all that 306 control points do. One liberty: the knob's top
//! ring is as round as all others (its y was 0.45 where the circle gives 0.448).

use super::builder::Builder;
use crate::scene::Mesh;
use glam::DVec3;

/// A quarter circle as Newell drew it: (1, 0), (1, κ), (κ, 1), (0, 1).
const KAPPA: f64 = 0.56;

/// Control points (radius, height) of each surface of revolution, from the inside out or from top to bottom.
const PROFILES: [[(f64, f64); 4]; 6] = [
    [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)], // rim
    [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],           // body
    [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    [(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)], // knob
    [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],  // lid
    [(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)], // bottom
];

/// A section through handle or spout: (x, height) at its one end, at its other end, and its half width.
type Section = ((f64, f64), (f64, f64), f64);

const HANDLE: [Section; 7] = [
    ((-1.6, 2.025), (-1.5, 2.25), 0.3),
    ((-2.3, 2.025), (-2.5, 2.25), 0.3),
    ((-2.7, 2.025), (-3.0, 2.25), 0.3),
    ((-2.7, 1.8), (-3.0, 1.8), 0.3),
    ((-2.7, 1.575), (-3.0, 1.35), 0.3),
    ((-2.5, 1.125), (-2.65, 0.9375), 0.3),
    ((-2.0, 0.9), (-1.9, 0.6), 0.3),
];

const SPOUT: [Section; 7] = [
    ((1.7, 1.425), (1.7, 0.6), 0.66),
    ((2.6, 1.425), (3.1, 0.825), 0.66),
    ((2.3, 2.1), (2.4, 2.025), 0.25),
    ((2.7, 2.4), (3.3, 2.4), 0.25),
    ((2.8, 2.475), (3.525, 2.49375), 0.25),
    ((2.9, 2.475), (3.45, 2.5125), 0.15),
    ((2.8, 2.4), (3.2, 2.4), 0.15),
];

type Patch = [[DVec3; 4]; 4];

/// The teapot with each patch cut into `segments` × `segments` quadrilaterals: just under 64 ·
/// segments² triangles, for those at the poles vanish. Open where the original is: under the lid,
/// at the spout, and where handle and spout end inside the body.
///
/// # Panics
/// If `segments` is 0.
pub fn teapot(segments: u32) -> Mesh {
    assert!(segments > 0, "a patch has at least one segment");
    let mut builder = Builder::default();
    for patch in patches() {
        for row in 0..segments {
            for column in 0..segments {
                let at = |r, c| {
                    point(&patch, fraction(row + r, segments), fraction(column + c, segments))
                };
                builder.quadrilateral([at(0, 0), at(1, 0), at(1, 1), at(0, 1)]);
            }
        }
    }
    builder.finish()
}

fn fraction(part: u32, whole: u32) -> f64 {
    f64::from(part) / f64::from(whole)
}

fn patches() -> Vec<Patch> {
    let quarters = (0..4).flat_map(|quarter| PROFILES.map(|profile| revolved(&profile, quarter)));
    let tubes = [HANDLE, SPOUT].into_iter().flat_map(|sections| {
        [(0, 1.0), (0, -1.0), (3, 1.0), (3, -1.0)].map(|(first, side)| {
            std::array::from_fn(|row| half_section(sections[first + row], side))
        })
    });
    quarters.chain(tubes).collect()
}

/// A profile swept through the quarter of a turn around y that begins at `quarter` · 90°.
fn revolved(profile: &[(f64, f64); 4], quarter: u32) -> Patch {
    let quarter_circle = [(1.0, 0.0), (1.0, KAPPA), (KAPPA, 1.0), (0.0, 1.0)];
    profile.map(|(radius, height)| {
        quarter_circle.map(|(a, b)| {
            // Quarter turns without sines, so that the seams meet bit for bit.
            let (a, b) = (0..quarter).fold((a, b), |(a, b), _| (-b, a));
            DVec3::new(radius * a, height, -radius * b)
        })
    })
}

/// One half of a section's outline: over `side` from the first end to the second, or back over the other side.
fn half_section((one, other, half_width): Section, side: f64) -> [DVec3; 4] {
    let corner = |(x, height): (f64, f64), z: f64| DVec3::new(x, height, z);
    let z = -side * half_width;
    let (from, to) = if side > 0.0 { (one, other) } else { (other, one) };
    [corner(from, 0.0), corner(from, z), corner(to, z), corner(to, 0.0)]
}

fn point(patch: &Patch, u: f64, v: f64) -> DVec3 {
    bezier(patch.map(|row| bezier(row, v)), u)
}

/// The cubic Bézier curve at `t`, by de Casteljau's construction.
fn bezier([a, b, c, d]: [DVec3; 4], t: f64) -> DVec3 {
    let [ab, bc, cd] = [between(a, b, t), between(b, c, t), between(c, d, t)];
    between(between(ab, bc, t), between(bc, cd, t), t)
}

/// The point that divides the way from `a` to `b` at `t`: exactly `a` at 0, exactly `b` at 1, and
/// exactly both where they are one, so that poles and seams close bit for bit.
fn between(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    if t <= 0.5 { a + (b - a) * t } else { b + (a - b) * (1.0 - t) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn there_are_thirty_two_patches() {
        assert_eq!(patches().len(), 32);
    }

    #[test]
    fn seams_are_closed_and_only_the_six_open_rings_are_not() {
        for segments in [2, 4, 7] {
            let mesh = teapot(segments);
            let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
            for [a, b, c] in &mesh.indices {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *balance.entry((*from.min(to), *from.max(to))).or_default() +=
                        if from < to { 1 } else { -1 };
                }
            }
            let open: i32 = balance.values().map(|excess| excess.abs()).sum();
            // Under the lid two rings of four patches; handle and spout have two ends of two patches.
            assert_eq!(open, 16 * segments as i32);
        }
    }

    /// Middle and normal of each triangle of a tessellated teapot.
    fn facets() -> impl Iterator<Item = (DVec3, DVec3)> {
        let mesh = teapot(8);
        (0..mesh.indices.len()).map(move |triangle| {
            let middle = mesh.corners(triangle).iter().sum::<DVec3>() / 3.0;
            (middle, mesh.corner_normals(triangle)[0])
        })
    }

    #[test]
    fn the_body_looks_out() {
        let inside = DVec3::new(0.0, 1.2, 0.0);
        // Below the rim; its inner lip and the knob's underside look the other way.
        let is_body = |middle: DVec3| middle.x.abs() < 1.4 && middle.y < 2.4;
        let body: Vec<_> = facets().filter(|(middle, _)| is_body(*middle)).collect();
        assert!(body.len() > 1000);
        assert!(body.iter().all(|(middle, normal)| normal.dot(*middle - inside) > 0.0));
    }

    #[test]
    fn the_tubes_look_out() {
        // Left of the spout's lip, which is folded inwards.
        let tubes = facets().filter(|(middle, _)| !(-2.05..2.1).contains(&middle.x));
        for (middle, normal) in
            tubes.filter(|(middle, normal)| middle.x < 2.7 && normal.z.abs() > 0.5)
        {
            assert!(normal.z * middle.z > 0.0, "{middle}");
        }
    }

    #[test]
    fn it_is_as_big_as_newell_made_it() {
        let mesh = teapot(16);
        let lowest = mesh.positions.iter().copied().reduce(DVec3::min).unwrap();
        let highest = mesh.positions.iter().copied().reduce(DVec3::max).unwrap();
        assert!(lowest.abs_diff_eq(DVec3::new(-3.0, 0.0, -2.0), 1e-2), "{lowest}");
        assert!(highest.abs_diff_eq(DVec3::new(3.434, 3.15, 2.0), 1e-2), "{highest}");
    }
}
