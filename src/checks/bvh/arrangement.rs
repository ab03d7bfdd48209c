//! Arrangements of triangles that show what a BVH does wrong, and rays at them.

use super::question::scene_of;
use crate::contract::Ray;
use crate::math::rng::{Seed, Stream, in_cube, in_square};
use crate::math::sphere::on_sphere;
use crate::scene::procedural::{Layout, pathological, soup};
use crate::scene::{Mesh, SceneDescription};
use crate::text::Count;
use glam::DVec3;
use serde::Deserialize;

/// Squares one behind the other, each of so many cells along a side.
pub(super) const LAYERS: u32 = 64;

const CELLS: u32 = 4;

/// Triangles of about this size, strewn in a box of 1 × 1 × so much.
pub(super) const TRIANGLES: u32 = 2048;

const SIZE: f64 = 0.2;

const LENGTH: f64 = 200.0;

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Arrangement {
    /// Layers behind layers, seen from both ends: what lies behind the first hit need not be tested.
    Layers,
    /// Small triangles in a long box, along each axis in turn: rays across it need few tests if nodes are divided
    /// along the length.
    LongBoxes,
}

/// A scene and rays from one side.
pub(super) struct View {
    pub(super) name: &'static str,
    pub(super) mesh: Mesh,
    pub(super) rays: Vec<Ray>,
}

pub(super) fn through_layers(count: usize, seed: Seed) -> Vec<View> {
    let view = |(name, from_above)| {
        let stream = &mut seed.child(name).stream();
        let rays = (0..count).map(|_| ray_through_layers(from_above, stream)).collect();
        View { name, mesh: layers(), rays }
    };
    [("from below", false), ("from above", true)].map(view).into()
}

/// Triangles in z = 0, 1, 2, …
pub(super) fn layers() -> Mesh {
    let mut mesh = Mesh::default();
    for layer in 0..LAYERS {
        for cell in 0..CELLS * CELLS {
            let first = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
            let corner = |dx: u32, dy: u32| {
                let at = [cell % CELLS + dx, cell / CELLS + dy].map(f64::from);
                DVec3::new(at[0], at[1], f64::from(layer))
            };
            mesh.positions.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
            mesh.indices.extend([[0, 1, 2], [0, 2, 3]].map(|face| face.map(|v| first + v)));
        }
    }
    mesh
}

/// Steeply through all of them.
fn ray_through_layers(from_above: bool, stream: &mut Stream) -> Ray {
    let mut at = |z: f64| (f64::from(CELLS) * (0.1 + 0.8 * in_square(stream))).extend(z);
    let (low, high) = (at(-3.0), at(f64::from(LAYERS) + 3.0));
    let (from, to) = if from_above { (high, low) } else { (low, high) };
    Ray::new(from, (to - from).normalize())
}

pub(super) fn across_long_boxes(count: usize, seed: Seed) -> Vec<View> {
    let view = |(axis, name)| {
        let stream = &mut seed.child(axis).stream();
        let rays = (0..count).map(|_| ray_across(axis, stream)).collect();
        View { name, mesh: long_box(axis), rays }
    };
    [(0, "along x"), (1, "along y"), (2, "along z")].map(view).into()
}

/// The same numbers for each axis.
fn long_box(axis: usize) -> Mesh {
    let stream = &mut Seed(1).stream();
    let mut mesh = Mesh::default();
    for number in 0..TRIANGLES {
        let centre = point_in_box(axis, stream);
        let corners = [(); 3].map(|()| centre + 0.5 * SIZE * on_sphere(stream));
        mesh.positions.extend(corners);
        mesh.indices.push([0, 1, 2].map(|corner| 3 * number + corner));
    }
    mesh
}

fn point_in_box(axis: usize, stream: &mut Stream) -> DVec3 {
    let mut point = in_cube(stream);
    point[axis] *= LENGTH;
    point
}

/// From outside, at right angles to the length.
fn ray_across(axis: usize, stream: &mut Stream) -> Ray {
    let target = point_in_box(axis, stream);
    let mut direction = on_sphere(stream);
    direction[axis] = 0.0;
    let direction = direction.normalize_or(DVec3::ONE);
    Ray::new(target - 3.0 * direction, direction)
}

/// Arrangements of so many triangles, and of next to none, that leave a split rule nothing to split by.
pub(super) fn without_a_split(triangles: Count) -> Vec<(&'static str, SceneDescription)> {
    let triangles = u32::try_from(triangles.0).unwrap_or(u32::MAX);
    let layouts = LAYOUTS.map(|(layout, name)| (name, pathological(layout, triangles, Seed(1))));
    let few = FEW.map(|(count, name)| (name, soup(count, Seed(1))));
    let all = layouts.into_iter().chain(few);
    all.map(|(name, mesh)| (name, scene_or_nothing(mesh))).collect()
}

const LAYOUTS: [(Layout, &str); 5] = [
    (Layout::IdenticalCentroids, IN_ONE_PLACE[0]),
    (Layout::CoincidentTriangles, IN_ONE_PLACE[1]),
    (Layout::CoplanarLine, "a line of coplanar triangles"),
    (Layout::SizeRatio, "sizes of 1 to a million"),
    (Layout::GridOnOneAxis, "a grid on one axis"),
];
/// Those that have all their centroids in one place.
pub(super) const IN_ONE_PLACE: [&str; 2] = ["identical centroids", "coincident triangles"];
const FEW: [(u32, &str); 3] = [(0, "no triangle"), (1, "one triangle"), (2, "two triangles")];

fn scene_or_nothing(mesh: Mesh) -> SceneDescription {
    if mesh.indices.is_empty() { SceneDescription::default() } else { scene_of(mesh) }
}
