//! Part 3: shapes that emit, as lights.
//!
//! A mesh, and a sphere that is not seen whole, are sampled uniformly over the area that emits; a sphere seen
//! from outside uniformly over the cone that it fills.

use super::frame::Frame;
use super::intersect::{Sphere, Triangle};
use super::light::towards;
use super::steps::Steps;
use crate::contract::LightSample;
use crate::scene::{self, Emission, Mesh, Rgb};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

#[derive(Clone, Debug)]
pub(crate) struct MeshLight {
    /// Those of its triangles that have area.
    triangles: Vec<Triangle>,
    /// Area of each triangle and all before it.
    cumulative_area: Vec<f64>,
    /// From the front.
    radiance: Rgb,
}

impl MeshLight {
    pub(crate) fn new(mesh: &Mesh, radiance: Rgb) -> Self {
        let corners = (0..mesh.indices.len()).map(|triangle| mesh.corners(triangle));
        let triangles: Vec<Triangle> = corners.filter_map(Triangle::new).collect();
        let mut total = 0.0;
        let cumulative_area = triangles
            .iter()
            .map(|triangle| {
                total += triangle.area();
                total
            })
            .collect();
        Self { triangles, cumulative_area, radiance }
    }

    fn area(&self) -> f64 {
        self.cumulative_area.last().copied().unwrap_or(0.0)
    }

    /// Uniform over the area of the mesh: a triangle in proportion to its area, then a point of it.
    pub(crate) fn sample(
        &self,
        from: DVec3,
        point: DVec2,
        lobe: f64,
        steps: &Steps,
    ) -> Option<LightSample> {
        let triangle = self.choose_triangle(lobe)?;
        let at = triangle.point(steps.triangle_point(point));
        let pdf = self.pdf(from, at, triangle.normal(), steps);
        let radiance = steps.mesh_radiance(self.radiance, at - from, triangle.normal());
        towards(from, at, radiance, pdf)
    }

    fn choose_triangle(&self, lobe: f64) -> Option<&Triangle> {
        let target = lobe * self.area();
        let chosen = self.cumulative_area.partition_point(|up_to_here| *up_to_here <= target);
        // The target may be rounded up to the whole area.
        self.triangles.get(chosen).or(self.triangles.last())
    }

    /// The pdf of the direction from `from` to the point `at` with this normal.
    pub(crate) fn pdf(&self, from: DVec3, at: DVec3, normal: DVec3, steps: &Steps) -> f64 {
        let area_per_steradian = per_steradian(from, at, normal, steps);
        steps.mesh_pdf(area_per_steradian, self.area(), self.triangles.len())
    }
}

/// Weights of vertices 1 and 2 of a uniform point of a triangle (Turk 1990).
pub(crate) fn triangle_point(point: DVec2) -> DVec2 {
    let root = point.x.sqrt();
    DVec2::new(root * (1.0 - point.y), root * point.y)
}

/// Per steradian, of points that are uniform over the area.
pub(crate) fn mesh_pdf(area_per_steradian: f64, area: f64, _triangles: usize) -> f64 {
    area_per_steradian / area
}

/// The same in all directions to the front.
pub(crate) fn mesh_radiance(radiance: Rgb, _to_light: DVec3, _normal: DVec3) -> Rgb {
    radiance
}

/// Area per steradian as seen from `from`; 0 from behind.
fn per_steradian(from: DVec3, at: DVec3, normal: DVec3, steps: &Steps) -> f64 {
    let to_light = at - from;
    let cosine = steps.cosine_at_light(to_light, normal);
    if cosine <= 0.0 {
        return 0.0;
    }
    steps.area_per_steradian(to_light.length_squared(), cosine)
}

/// Positive in front of the light.
pub(crate) fn cosine_at_light(to_light: DVec3, normal: DVec3) -> f64 {
    -to_light.dot(normal) / to_light.length()
}

/// What is twice as far away, or slanted to half its width, takes more area to fill a direction.
pub(crate) fn area_per_steradian(distance_squared: f64, cosine: f64) -> f64 {
    distance_squared / cosine
}

/// Per steradian, uniform over the cone of directions that meet a sphere: it cuts a cap of this height out of the unit
/// sphere, with an area of 2π times that.
pub(crate) fn cone_pdf(height: f64) -> f64 {
    FRAC_1_PI / (2.0 * height)
}

#[derive(Clone, Debug)]
pub(crate) struct SphereLight {
    sphere: Sphere,
    /// Whether it shines towards its centre.
    inward: bool,
    emission: Emission,
}

impl SphereLight {
    pub(crate) fn new(sphere: &scene::Sphere, emission: Emission) -> Self {
        let scene::Sphere { centre, radius, inward, .. } = *sphere;
        Self { sphere: Sphere { centre, radius }, inward, emission }
    }

    pub(crate) fn sample(&self, from: DVec3, point: DVec2, steps: &Steps) -> Option<LightSample> {
        if self.fills_cone(from) {
            self.sample_cone(from, point, steps)
        } else {
            self.sample_emitting_part(from, point, steps)
        }
    }

    /// The pdf of the direction from `from` to the emitting point `at` with this normal.
    pub(crate) fn pdf(&self, from: DVec3, at: DVec3, normal: DVec3, steps: &Steps) -> f64 {
        if self.fills_cone(from) {
            steps.cone_pdf(self.cone_height(from))
        } else {
            per_steradian(from, at, normal, steps) / self.emitting_area()
        }
    }

    /// Whether all that `from` sees of the sphere emits.
    fn fills_cone(&self, from: DVec3) -> bool {
        let radius_squared = self.sphere.radius * self.sphere.radius;
        let is_outside = from.distance_squared(self.sphere.centre) > radius_squared;
        is_outside && !self.inward && self.emission.cap.is_none()
    }

    /// 1 − cos of the half angle under which the sphere is seen, without subtracting nearly equal numbers.
    fn cone_height(&self, from: DVec3) -> f64 {
        let radius_squared = self.sphere.radius * self.sphere.radius;
        let sine_squared = radius_squared / from.distance_squared(self.sphere.centre);
        sine_squared / (1.0 + (1.0 - sine_squared).max(0.0).sqrt())
    }

    fn sample_cone(&self, from: DVec3, point: DVec2, steps: &Steps) -> Option<LightSample> {
        let to_centre = self.sphere.centre - from;
        let cone_height = self.cone_height(from);
        let height = point.x * cone_height;
        let axis = Frame::around(to_centre.try_normalize()?);
        let wi = axis.to_world(direction_below_tip(height, point.y));
        let at = from + self.near_distance(to_centre, height) * wi;
        towards(from, at, self.emission.radiance, steps.cone_pdf(cone_height))
    }

    /// To the near side of the sphere, in a direction whose cosine with `to_centre` is 1 − height.
    fn near_distance(&self, to_centre: DVec3, height: f64) -> f64 {
        let sine_squared = height * (2.0 - height);
        let line_to_centre_squared = to_centre.length_squared() * sine_squared;
        let half_chord_squared = self.sphere.radius * self.sphere.radius - line_to_centre_squared;
        to_centre.length() * (1.0 - height) - half_chord_squared.max(0.0).sqrt()
    }

    /// Uniform over the part of the sphere that emits: for rooms, for caps, and from inside.
    fn sample_emitting_part(
        &self,
        from: DVec3,
        point: DVec2,
        steps: &Steps,
    ) -> Option<LightSample> {
        let axis = self.emission.cap.map_or(DVec3::Z, |cap| cap.axis);
        let local = direction_below_tip(point.x * self.emitting_height(), point.y);
        let outward = Frame::around(axis).to_world(local);
        let normal = if self.inward { -outward } else { outward };
        let at = self.sphere.centre + self.sphere.radius * outward;
        towards(from, at, self.emission.radiance, self.pdf(from, at, normal, steps))
    }

    /// Height of the emitting part of a unit sphere, from the tip of its axis down.
    fn emitting_height(&self) -> f64 {
        self.emission.cap.map_or(2.0, |cap| 1.0 - cap.half_angle.cos())
    }

    /// Archimedes: a zone's area is 2πR times its height.
    fn emitting_area(&self) -> f64 {
        2.0 * PI * self.sphere.radius * self.sphere.radius * self.emitting_height()
    }
}

/// The unit vector `height` below +z, at `turn` of a full turn. Near the tip it keeps all its digits.
fn direction_below_tip(height: f64, turn: f64) -> DVec3 {
    let sine = (height * (2.0 - height)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * turn).sin_cos();
    DVec3::new(sine * cos_phi, sine * sin_phi, 1.0 - height)
}
