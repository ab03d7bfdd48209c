//! The shapes of a scene in one numbering, and what a ray finds on them.
//!
//! Traversal decides in single precision *which* primitive is nearest. *Where* it is hit is then worked out in
//! double precision, on the primitive itself: direct light is sampled at points on their surfaces.

use super::bounds::Bounds;
use super::item::Item;
use super::segment::Segment;
use super::sphere;
use super::traverse::Candidate;
use crate::scene::{SceneDescription, Sphere};
use glam::{DVec2, DVec3, Vec3};

/// How far rays that leave a surface start away from it, relative to the largest coordinate of the primitive:
/// 2⁻¹⁸, or 64 roundings of single precision. Fewer than 10 let a plane shadow itself at grazing angles.
const CLEARANCE: f64 = 1.0 / 262_144.0;

/// Meshes and spheres of a scene. Primitives are numbered triangle by triangle, mesh by mesh, then spheres.
#[derive(Debug)]
pub struct Geometry {
    positions: Vec<DVec3>,
    normals: Vec<Vec3>,
    triangles: Vec<Triangle>,
    spheres: Vec<Sphere>,
    /// For each mesh, the number of its first triangle.
    first_triangles: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [u32; 3],
    shape: u32,
    is_smooth: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// In units of the segment's scaled direction.
    pub(crate) t: f64,
    /// On the primitive, world space.
    pub(crate) position: DVec3,
    /// Unit, on the front side.
    pub(crate) geometric_normal: DVec3,
    /// Unit, interpolated where the mesh has normals.
    pub(crate) shading_normal: DVec3,
    /// Of a triangle: barycentric weights of corners 1 and 2.
    pub(crate) uv: DVec2,
    pub(crate) shape: u32,
    /// Number of the triangle in its mesh, 0 for a sphere.
    pub(crate) primitive: u32,
    /// How far away from the surface rays must start.
    pub(crate) clearance: f64,
}

impl Geometry {
    /// Takes the shapes of `scene` in; its indices have been checked.
    pub(crate) fn new(scene: &SceneDescription) -> Self {
        let mut geometry = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
            spheres: scene.spheres.clone(),
            first_triangles: Vec::new(),
        };
        for (shape, mesh) in scene.meshes.iter().enumerate() {
            let first_vertex = geometry.positions.len() as u32;
            geometry.first_triangles.push(geometry.triangles.len() as u32);
            geometry.positions.extend(&mesh.positions);
            geometry.normals.extend(mesh.normals.iter().map(|normal| normal.as_vec3()));
            geometry.normals.resize(geometry.positions.len(), Vec3::ZERO);
            geometry.triangles.extend(mesh.indices.iter().map(|corners| Triangle {
                corners: corners.map(|corner| corner + first_vertex),
                shape: shape as u32,
                is_smooth: !mesh.normals.is_empty(),
            }));
        }
        geometry
    }

    /// A box for every primitive that can be hit: not for triangles without area, nor for anything that is
    /// not a number. Triangles come first.
    pub(crate) fn items(&self) -> Vec<Item> {
        let triangles = (0..self.triangles.len()).filter_map(|index| self.triangle_item(index));
        let spheres = self.spheres.iter().enumerate().filter_map(|(index, sphere)| {
            let bounds =
                Bounds::around([sphere.centre - sphere.radius, sphere.centre + sphere.radius]);
            let number = (self.triangles.len() + index) as u32;
            let is_solid = sphere.radius > 0.0 && bounds.extent().is_finite();
            is_solid.then_some(Item { bounds, number, is_sphere: true })
        });
        triangles.chain(spheres).collect()
    }

    fn triangle_item(&self, index: usize) -> Option<Item> {
        let corners = self.corners(index);
        let [a, b, c] = corners;
        let bounds = Bounds::around(corners);
        let is_solid = (b - a).cross(c - a).length_squared() > 0.0 && bounds.extent().is_finite();
        is_solid.then_some(Item { bounds, number: index as u32, is_sphere: false })
    }

    fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].corners.map(|corner| self.positions[corner as usize])
    }

    /// The corners of triangle `number` as traversal sees them.
    pub(crate) fn corners32(&self, number: u32) -> [Vec3; 3] {
        self.corners(number as usize).map(|corner| corner.as_vec3())
    }

    /// The sphere that is primitive `number`.
    pub(crate) fn sphere(&self, number: u32) -> &Sphere {
        &self.spheres[number as usize - self.triangles.len()]
    }

    /// From the centre of the sphere to a point on it, unit; the normal elsewhere.
    pub(crate) fn outward(&self, surface: &Surface) -> DVec3 {
        let number = (surface.shape as usize).checked_sub(self.first_triangles.len());
        match number.map(|number| &self.spheres[number]) {
            Some(sphere) if sphere.inward => -surface.geometric_normal,
            _ => surface.geometric_normal,
        }
    }

    /// What the ray finds at a candidate.
    pub(crate) fn surface(&self, segment: &Segment, candidate: Candidate) -> Surface {
        match self.triangles.get(candidate.number as usize) {
            Some(triangle) => self.triangle_surface(segment, candidate, triangle),
            None => self.sphere_surface(segment, candidate),
        }
    }

    fn triangle_surface(
        &self,
        segment: &Segment,
        candidate: Candidate,
        triangle: &Triangle,
    ) -> Surface {
        let corners = self.corners(candidate.number as usize);
        let [a, b, c] = corners;
        let (t, uv) =
            refine(segment, corners).unwrap_or((f64::from(candidate.t), DVec2::splat(1.0 / 3.0)));
        let geometric_normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
        Surface {
            t,
            position: a + (b - a) * uv.x + (c - a) * uv.y,
            geometric_normal,
            shading_normal: self.interpolated_normal(triangle, uv).unwrap_or(geometric_normal),
            uv,
            shape: triangle.shape,
            primitive: candidate.number - self.first_triangles[triangle.shape as usize],
            clearance: CLEARANCE * largest,
        }
    }

    fn interpolated_normal(&self, triangle: &Triangle, uv: DVec2) -> Option<DVec3> {
        if !triangle.is_smooth {
            return None;
        }
        let [a, b, c] = triangle.corners.map(|corner| self.normals[corner as usize].as_dvec3());
        (a * (1.0 - uv.x - uv.y) + b * uv.x + c * uv.y).try_normalize()
    }

    fn sphere_surface(&self, segment: &Segment, candidate: Candidate) -> Surface {
        let sphere = self.sphere(candidate.number);
        let t = sphere::exact_root(sphere.centre, sphere.radius, segment, candidate.t);
        let from_centre = segment.origin + segment.direction * t - sphere.centre;
        let outward = from_centre.normalize_or(DVec3::Z);
        let normal = if sphere.inward { -outward } else { outward };
        let index = candidate.number - self.triangles.len() as u32;
        Surface {
            t,
            position: sphere.centre + outward * sphere.radius,
            geometric_normal: normal,
            shading_normal: normal,
            uv: DVec2::ZERO,
            shape: self.first_triangles.len() as u32 + index,
            primitive: 0,
            clearance: CLEARANCE * (sphere.centre.abs().max_element() + sphere.radius),
        }
    }
}

/// How far rays must keep away from a shape inside `bounds`.
pub(crate) fn clearance_of(points: impl IntoIterator<Item = DVec3>) -> f64 {
    CLEARANCE
        * points.into_iter().fold(0.0, |largest: f64, point| largest.max(point.abs().max_element()))
}

/// Where the ray meets the triangle in double precision: t and barycentric weights (Möller and Trumbore 1997).
/// A ray that single precision brought in across an edge is brought to the edge. `None` if edge-on.
fn refine(segment: &Segment, [a, b, c]: [DVec3; 3]) -> Option<(f64, DVec2)> {
    let (first, second) = (b - a, c - a);
    let p = segment.direction.cross(second);
    let determinant = first.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let from_corner = segment.origin - a;
    let q = from_corner.cross(first);
    let uv = DVec2::new(from_corner.dot(p), segment.direction.dot(q)) / determinant;
    if uv.min_element() >= 0.0 && uv.element_sum() <= 1.0 {
        return Some((second.dot(q) / determinant, uv));
    }
    let clamped = uv.max(DVec2::ZERO);
    let uv = clamped / clamped.element_sum().max(1.0);
    let on_triangle = first * uv.x + second * uv.y - from_corner;
    let t = on_triangle.dot(segment.direction) / segment.direction.length_squared();
    Some((t, uv))
}
