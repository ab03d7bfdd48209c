//! A point where a path scatters: its surface seen from the side that the path came from.

use super::reach::Reach;
use super::scatter::Bsdf;
use super::trace::Surface;
use crate::contract::Ray;
use glam::{DVec3, Vec3, vec3};

pub(crate) struct Vertex<'a> {
    pub(crate) position: DVec3,
    pub(crate) bsdf: &'a Bsdf,
    /// Towards where the path came from, local frame.
    pub(crate) wo: Vec3,
    /// Unit; for reflecting surfaces on the side of `wo`.
    pub(crate) normal: DVec3,
    /// Tangents of the local frame, and its normal.
    frame: [Vec3; 3],
    /// Unit, on the side of `wo`.
    geometric_normal: DVec3,
    clearance: f64,
}

impl<'a> Vertex<'a> {
    /// The surface seen from direction `wo` (unit, world space).
    pub(crate) fn new(surface: &Surface, bsdf: &'a Bsdf, wo: DVec3) -> Self {
        let is_front = surface.geometric_normal.dot(wo) >= 0.0;
        let side = if is_front { 1.0 } else { -1.0 };
        let geometric_normal = surface.geometric_normal * side;
        let shading_normal = surface.shading_normal * side;
        // An interpolated normal may turn away from the viewer; the surface itself does not.
        let seen = if shading_normal.dot(wo) > 0.0 { shading_normal } else { geometric_normal };
        // Glass must know its inside; for the others the side of `wo` is up.
        let normal = if bsdf.is_interface() { seen * side } else { seen };
        let up = normal.as_vec3();
        let (first, second) = up.any_orthonormal_pair();
        let frame = [first, second, up];
        let wo = to_local(&frame, wo.as_vec3());
        let (position, clearance) = (surface.position, surface.clearance);
        Self { position, bsdf, wo, normal, frame, geometric_normal, clearance }
    }

    /// Where light comes from that it scatters to its viewer.
    pub(crate) fn light_reach(&self) -> Reach {
        if self.bsdf.is_interface() { Reach::Everywhere } else { Reach::Above(self.normal) }
    }

    pub(crate) fn to_world(&self, w: Vec3) -> DVec3 {
        let [first, second, up] = self.frame;
        (first * w.x + second * w.y + up * w.z).as_dvec3()
    }

    pub(crate) fn to_local(&self, w: DVec3) -> Vec3 {
        to_local(&self.frame, w.as_vec3())
    }

    /// Cosine of a world direction with the normal; 0 for one that does not reach the surface.
    pub(crate) fn cosine(&self, wi: DVec3) -> f64 {
        let cosine = wi.dot(self.normal);
        if self.bsdf.is_interface() { cosine.abs() } else { cosine.max(0.0) }
    }

    /// Whether `wi` leaves the surface on the side where the shading frame thinks it does. Interpolated normals
    /// may point light through a surface that reflects; such light is not carried.
    pub(crate) fn is_consistent(&self, wi: DVec3, local: Vec3) -> bool {
        (self.geometric_normal.dot(wi) > 0.0) == (local.z * self.wo.z > 0.0)
    }

    /// The whole ray from here along `wi`.
    pub(crate) fn leave(&self, wi: DVec3) -> Ray {
        Ray::new(self.start(wi), wi)
    }

    /// The segment from here to `target`.
    pub(crate) fn reach(&self, wi: DVec3, target: DVec3) -> Ray {
        let origin = self.start(wi);
        Ray { t_max: 1.0, ..Ray::new(origin, target - origin) }
    }

    fn start(&self, wi: DVec3) -> DVec3 {
        let side = self.clearance.copysign(self.geometric_normal.dot(wi));
        self.position + self.geometric_normal * side
    }
}

fn to_local(frame: &[Vec3; 3], w: Vec3) -> Vec3 {
    let [first, second, up] = frame;
    vec3(first.dot(w), second.dot(w), up.dot(w))
}
