//! Meshes that BVHs stumble over: soups, and arrangements that leave a split rule nothing to split by.

use crate::math::rng::{Seed, Stream, in_cube};
use crate::scene::Mesh;
use glam::DVec3;
use serde::Deserialize;

/// An arrangement of triangles that is hard on some split rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Triangles side by side in one plane: boxes without volume.
    CoplanarLine,
    /// Triangles along x only, upright: two axes on which nothing can be told apart.
    GridOnOneAxis,
    /// Triangles of all sizes and directions around one point: every centroid the same.
    IdenticalCentroids,
    /// The same triangle again and again.
    CoincidentTriangles,
    /// A soup whose triangles differ in size by a factor of a million.
    SizeRatio,
}

/// `triangles` random triangles in the unit cube: centres uniform, corners within ±½ of n^(−1/3)
/// around them, so that the share of space they take does not depend on n.
pub fn soup(triangles: u32, seed: Seed) -> Mesh {
    let stream = &mut seed.stream();
    let size = f64::from(triangles.max(1)).cbrt().recip();
    triangles_from((0..triangles).map(|_| {
        let centre = in_cube(stream);
        std::array::from_fn(|_| centre + size * (in_cube(stream) - 0.5))
    }))
}

/// `triangles` triangles in the unit cube, arranged as `layout` says. `seed` matters where chance does.
pub(crate) fn pathological(layout: Layout, triangles: u32, seed: Seed) -> Mesh {
    let stream = &mut seed.stream();
    let step = f64::from(triangles.max(1)).recip();
    let along = |k: u32| f64::from(k) * step;
    match layout {
        Layout::CoplanarLine => triangles_from((0..triangles).map(|k| {
            let corner = DVec3::new(along(k), 0.0, 0.0);
            [corner, corner + step * DVec3::X, corner + DVec3::Y]
        })),
        Layout::GridOnOneAxis => triangles_from((0..triangles).map(|k| {
            let corner = DVec3::new(along(k), 0.0, 0.0);
            [corner, corner + DVec3::Y, corner + DVec3::Z]
        })),
        Layout::IdenticalCentroids => {
            triangles_from((0..triangles).map(|_| centred_triangle(stream)))
        }
        Layout::CoincidentTriangles => {
            triangles_from((0..triangles).map(|_| [DVec3::ZERO, DVec3::X, DVec3::Y]))
        }
        Layout::SizeRatio => triangles_from((0..triangles).map(|k| {
            let size = 1e-6f64.powf(along(k));
            let corner = in_cube(stream);
            std::array::from_fn(|_| corner + size * (in_cube(stream) - 0.5))
        })),
    }
}

/// A triangle around the middle of the unit cube: along every axis its corners are at −h, 0 and h, in another order, so
/// that the mean of its corners and the centre of its box are the same for every h.
fn centred_triangle(stream: &mut Stream) -> [DVec3; 3] {
    let half = in_cube(stream) * 0.5;
    [DVec3::new(-1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, -1.0), DVec3::new(1.0, -1.0, 0.0)]
        .map(|order| order * half + 0.5)
}

/// Triangles that share no vertex.
fn triangles_from(triangles: impl Iterator<Item = [DVec3; 3]>) -> Mesh {
    let positions: Vec<DVec3> = triangles.flatten().collect();
    let indices = (0..positions.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Mesh { positions, indices, ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Aabb;

    const LAYOUTS: [Layout; 5] = [
        Layout::CoplanarLine,
        Layout::GridOnOneAxis,
        Layout::IdenticalCentroids,
        Layout::CoincidentTriangles,
        Layout::SizeRatio,
    ];

    fn boxes(mesh: &Mesh) -> impl Iterator<Item = Aabb> {
        (0..mesh.indices.len()).filter_map(|triangle| Aabb::around(mesh.corners(triangle)))
    }

    #[test]
    fn every_layout_has_as_many_triangles_as_asked_none_without_area_and_none_far_away() {
        for layout in LAYOUTS {
            let mesh = pathological(layout, 100, Seed(1));
            assert_eq!(mesh.indices.len(), 100, "{layout:?}");
            assert!((0..100).all(|triangle| mesh.area(triangle) > 0.0), "{layout:?}");
            assert!(mesh.positions.iter().all(|p| p.abs().max_element() <= 1.5), "{layout:?}");
        }
    }

    #[test]
    fn identical_centroids_are_identical_by_corners_and_by_box() {
        let mesh = pathological(Layout::IdenticalCentroids, 100, Seed(1));
        for (triangle, bounds) in boxes(&mesh).enumerate() {
            let centroid = mesh.corners(triangle).iter().sum::<DVec3>() / 3.0;
            assert!(centroid.abs_diff_eq(DVec3::splat(0.5), 1e-15));
            assert!(((bounds.min + bounds.max) / 2.0).abs_diff_eq(DVec3::splat(0.5), 1e-15));
        }
    }

    #[test]
    fn sizes_differ_a_millionfold() {
        let mesh = pathological(Layout::SizeRatio, 1000, Seed(1));
        let sizes: Vec<f64> = boxes(&mesh).map(|bounds| bounds.diagonal()).collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let smallest = sizes.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(largest / smallest > 3e5, "{largest} / {smallest}");
    }

    #[test]
    fn a_soup_is_as_dense_at_every_size_and_the_same_for_the_same_seed() {
        let per_area = |n: u32| {
            let mesh = soup(n, Seed(7));
            boxes(&mesh).map(|b| (b.max - b.min).element_product()).sum::<f64>()
        };
        assert!((per_area(1_000) / per_area(30_000) - 1.0).abs() < 0.1);
        assert_eq!(soup(50, Seed(7)), soup(50, Seed(7)));
        assert_ne!(soup(50, Seed(7)), soup(50, Seed(8)));
    }
}
