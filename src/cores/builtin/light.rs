//! Points on lights and directions towards them, in double precision: the geometry of a light sample cancels,
//! and surface points are double anyway.

use super::reach::Reach;
use super::trace::{Surface, clearance_of};
use crate::contract::LightSample;
use crate::scene::{self, Emission, Mesh, Rgb, SceneDescription, Shape, Sphere};
use glam::{DVec2, DVec3, dvec3};
use std::f64::consts::{FRAC_1_PI, PI, TAU};

#[derive(Clone, Debug)]
pub enum Light {
    Point {
        /// World space.
        position: DVec3,
        /// Watts per steradian.
        intensity: Rgb,
    },
    /// Shines from infinitely far away along one direction.
    Directional {
        /// Towards the light, unit.
        towards: DVec3,
        /// On a surface that faces it.
        irradiance: Rgb,
    },
    /// Shines from everywhere.
    Sky(scene::Light),
    Mesh(MeshLight),
    Sphere(SphereLight),
}

/// A direction towards a light, and where a shadow ray towards it ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// As the contract has it.
    pub(crate) sample: LightSample,
    /// In front of the point on the light, away from its surface; `None` at infinity.
    pub(crate) target: Option<DVec3>,
}

const INVALID: LightSample = LightSample { distance: f64::INFINITY, ..LightSample::NONE };

impl Light {
    pub(crate) fn new(scene: &SceneDescription, light: &scene::Light) -> Self {
        match *light {
            scene::Light::Point { position, intensity } => Self::Point { position, intensity },
            scene::Light::Directional { direction, irradiance } => {
                Self::Directional { towards: -direction, irradiance }
            }
            scene::Light::ConstantSky { .. } | scene::Light::GradientSky { .. } => {
                Self::Sky(*light)
            }
            scene::Light::Area { shape } => {
                let dark = Emission { radiance: [0.0; 3], cap: None };
                let emission = scene.material_of(shape).emission.unwrap_or(dark);
                match scene.shape(shape) {
                    Shape::Mesh(mesh) => Self::Mesh(MeshLight::new(mesh, emission.radiance)),
                    Shape::Sphere(sphere) => Self::Sphere(SphereLight::new(sphere, emission)),
                }
            }
        }
    }

    /// Whether this is a delta light, which no ray can hit.
    pub(crate) const fn is_delta(&self) -> bool {
        matches!(self, Self::Point { .. } | Self::Directional { .. })
    }

    /// Radiance of an environment light from direction `w`; zero for other lights.
    pub(crate) fn sky_radiance(&self, w: DVec3) -> Rgb {
        match self {
            Self::Sky(sky) => sky.sky_radiance(w),
            _ => [0.0; 3],
        }
    }

    /// A direction from a point in space. Environment lights are sampled uniformly over the sphere.
    pub(crate) fn aim(&self, from: DVec3, point: DVec2, lobe: f64) -> Aim {
        match self {
            Self::Point { position, intensity } => aim_at_point(from, *position, *intensity),
            Self::Directional { towards, irradiance } => {
                let radiance = *irradiance;
                let is_delta = 1;
                infinitely_far(LightSample {
                    wi: *towards,
                    radiance,
                    pdf: 1.0,
                    is_delta,
                    ..INVALID
                })
            }
            Self::Sky(sky) => {
                let wi = uniform_sphere(point);
                let radiance = sky.sky_radiance(wi);
                infinitely_far(LightSample { wi, radiance, pdf: FRAC_1_PI / 4.0, ..INVALID })
            }
            Self::Mesh(mesh) => mesh.aim(from, point, lobe),
            Self::Sphere(sphere) => sphere.aim(from, point),
        }
    }

    /// A direction from a surface. Environment lights are sampled cosine-weighted, where there is one side to it.
    pub(crate) fn aim_from_surface(
        &self,
        from: DVec3,
        reach: Reach,
        point: DVec2,
        lobe: f64,
    ) -> Aim {
        let (Self::Sky(sky), Reach::Above(normal)) = (self, reach) else {
            return self.aim(from, point, lobe);
        };
        let cosine = (1.0 - point.x).sqrt();
        let wi = around(normal, cosine, point.x.sqrt(), point.y);
        let radiance = sky.sky_radiance(wi);
        infinitely_far(LightSample { wi, radiance, pdf: cosine * FRAC_1_PI, ..INVALID })
    }

    /// The pdf with which [`Self::aim_from_surface`] samples direction `wi`, which hits this light at `there`
    /// (`None`: the environment).
    pub(crate) fn pdf(&self, from: DVec3, reach: Reach, wi: DVec3, there: Option<&Surface>) -> f64 {
        match (self, there) {
            (Self::Sky(_), None) => reach.sky_pdf(wi),
            (Self::Mesh(mesh), Some(there)) => area_pdf(mesh.area, from, wi, there),
            (Self::Sphere(sphere), Some(there)) => match sphere.visible_cone(from) {
                Some(one_minus_cosine) => 1.0 / (TAU * one_minus_cosine),
                None => area_pdf(sphere.area(), from, wi, there),
            },
            _ => 0.0,
        }
    }
}

fn area_pdf(area: f64, from: DVec3, wi: DVec3, there: &Surface) -> f64 {
    let cosine = there.geometric_normal.dot(wi).abs();
    there.position.distance_squared(from) / (cosine * area)
}

fn infinitely_far(sample: LightSample) -> Aim {
    Aim { sample: LightSample { is_valid: 1, ..sample }, target: None }
}

fn aim_at_point(from: DVec3, position: DVec3, intensity: Rgb) -> Aim {
    let offset = position - from;
    let distance = offset.length();
    let is_valid = u32::from(distance > 0.0);
    let radiance = intensity.map(|channel| channel / (distance * distance));
    let sample =
        LightSample { wi: offset / distance, distance, radiance, pdf: 1.0, is_delta: 1, is_valid };
    Aim { sample: if is_valid == 1 { sample } else { INVALID }, target: Some(position) }
}

/// Towards the point `there` with surface normal `normal` (front side), chosen uniformly among `area`.
fn aim_at_area(
    from: DVec3,
    there: DVec3,
    normal: DVec3,
    area: f64,
    emitted: Rgb,
    clearance: f64,
) -> Aim {
    let offset = there - from;
    let distance = offset.length();
    let wi = offset / distance;
    let cosine = -wi.dot(normal);
    let pdf = distance * distance / (cosine.abs() * area);
    let is_valid = u32::from(pdf.is_finite() && distance > 0.0);
    let radiance = if cosine > 0.0 { emitted } else { [0.0; 3] };
    let sample = LightSample { wi, distance, radiance, pdf, is_delta: 0, is_valid };
    let target = Some(there + normal * clearance.copysign(cosine));
    Aim { sample: if is_valid == 1 { sample } else { INVALID }, target }
}

#[derive(Clone, Debug)]
struct LightTriangle {
    corners: [DVec3; 3],
    /// Unit, on the front side; zero for a triangle without area.
    normal: DVec3,
    /// Of the mesh up to the end of this triangle.
    area_up_to: f64,
}

/// A mesh of one-sided emission. Its points are sampled uniformly by area.
#[derive(Clone, Debug)]
pub(crate) struct MeshLight {
    triangles: Vec<LightTriangle>,
    area: f64,
    radiance: Rgb,
    clearance: f64,
}

impl MeshLight {
    fn new(mesh: &Mesh, radiance: Rgb) -> Self {
        let mut area = 0.0;
        let triangle = |number| {
            let corners @ [a, b, c] = mesh.corners(number);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            area += Some(mesh.area(number)).filter(|area| area.is_finite()).unwrap_or(0.0);
            LightTriangle { corners, normal, area_up_to: area }
        };
        let triangles: Vec<_> = (0..mesh.indices.len()).map(triangle).collect();
        let clearance = clearance_of(triangles.iter().flat_map(|triangle| triangle.corners));
        Self { triangles, area, radiance, clearance }
    }

    /// `lobe` picks the triangle, in proportion to its area.
    fn aim(&self, from: DVec3, point: DVec2, lobe: f64) -> Aim {
        let is_before = |triangle: &LightTriangle| triangle.area_up_to <= lobe * self.area;
        // The product may round up to the whole area.
        let last = self.triangles.len().saturating_sub(1);
        let chosen = self.triangles.partition_point(is_before).min(last);
        let Some(triangle) = self.triangles.get(chosen).filter(|_| self.area > 0.0) else {
            return Aim { sample: INVALID, target: None };
        };
        // Uniform in a triangle (Turk 1990).
        let ([a, b, c], root) = (triangle.corners, point.x.sqrt());
        let there = a * (1.0 - root) + (b * (1.0 - point.y) + c * point.y) * root;
        aim_at_area(from, there, triangle.normal, self.area, self.radiance, self.clearance)
    }
}

/// A sphere light. From outside, directions are uniform in the cone that it subtends; from inside, and if only
/// a cap emits, points are uniform on the emissive part.
#[derive(Clone, Debug)]
pub(crate) struct SphereLight {
    centre: DVec3,
    radius: f64,
    inward: bool,
    emission: Emission,
    clearance: f64,
}

impl SphereLight {
    fn new(sphere: &Sphere, emission: Emission) -> Self {
        let Sphere { centre, radius, inward, .. } = *sphere;
        let clearance = clearance_of([centre.abs() + radius]);
        Self { centre, radius, inward, emission, clearance }
    }

    /// Axis and 1 − cosine of the half angle of the part that emits.
    fn emitting_part(&self) -> (DVec3, f64) {
        match self.emission.cap {
            Some(cap) => (cap.axis, 2.0 * (cap.half_angle / 2.0).sin().powi(2)),
            None => (DVec3::Z, 2.0),
        }
    }

    fn area(&self) -> f64 {
        TAU * self.radius * self.radius * self.emitting_part().1
    }

    /// 1 − cosine of the half angle of the cone that the sphere subtends, where directions are chosen in that cone.
    fn visible_cone(&self, from: DVec3) -> Option<f64> {
        let sine_square = self.radius * self.radius / from.distance_squared(self.centre);
        let is_outside = sine_square < 1.0 - 1e-9;
        let one_minus_cosine = sine_square / (1.0 + (1.0 - sine_square).max(0.0).sqrt());
        (is_outside && self.emission.cap.is_none()).then_some(one_minus_cosine)
    }

    fn aim(&self, from: DVec3, point: DVec2) -> Aim {
        match self.visible_cone(from) {
            Some(one_minus_cosine) => self.aim_into_cone(from, point, one_minus_cosine),
            None => self.aim_at_emitting_part(from, point),
        }
    }

    fn aim_into_cone(&self, from: DVec3, point: DVec2, widest: f64) -> Aim {
        let to_centre = self.centre - from;
        let distance_to_centre = to_centre.length();
        let one_minus_cosine = point.x * widest;
        let sine_square = one_minus_cosine * (2.0 - one_minus_cosine);
        let cosine = 1.0 - one_minus_cosine;
        let wi = around(to_centre / distance_to_centre, cosine, sine_square.sqrt(), point.y);
        let half_chord =
            (self.radius * self.radius - to_centre.length_squared() * sine_square).max(0.0).sqrt();
        let distance = distance_to_centre * cosine - half_chord;
        let outward = (from + wi * distance - self.centre).normalize();
        let radiance = if self.inward { [0.0; 3] } else { self.emission.radiance };
        let pdf = 1.0 / (TAU * widest);
        let sample = LightSample { wi, distance, radiance, pdf, is_delta: 0, is_valid: 1 };
        let target = self.centre + outward * (self.radius + self.clearance);
        Aim { sample, target: Some(target) }
    }

    fn aim_at_emitting_part(&self, from: DVec3, point: DVec2) -> Aim {
        let (axis, widest) = self.emitting_part();
        let one_minus_cosine = point.x * widest;
        let sine = (one_minus_cosine * (2.0 - one_minus_cosine)).sqrt();
        let outward = around(axis, 1.0 - one_minus_cosine, sine, point.y);
        let there = self.centre + outward * self.radius;
        let normal = if self.inward { -outward } else { outward };
        aim_at_area(from, there, normal, self.area(), self.emission.radiance, self.clearance)
    }
}

fn uniform_sphere(point: DVec2) -> DVec3 {
    let height = 1.0 - 2.0 * point.x;
    around(DVec3::Z, height, (4.0 * point.x * (1.0 - point.x)).sqrt(), point.y)
}

/// The direction at an angle (given by cosine and sine) from `axis`, `turns` of the way around it.
fn around(axis: DVec3, cosine: f64, sine: f64, turns: f64) -> DVec3 {
    let (first, second) = axis.any_orthonormal_pair();
    let (y, x) = (2.0 * PI * turns).sin_cos();
    let local = dvec3(x * sine, y * sine, cosine);
    first * local.x + second * local.y + axis * local.z
}
