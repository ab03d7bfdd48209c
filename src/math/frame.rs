//! The local frame of a surface, and spherical coordinates in it.

use glam::DVec3;

/// An orthonormal, right-handed frame whose third axis is the normal; its axes in world space.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) tangent: DVec3,
    pub(crate) bitangent: DVec3,
    pub(crate) normal: DVec3,
}

#[cfg(test)]
impl Frame {
    /// Some frame around a unit normal. Duff et al., "Building an Orthonormal Basis, Revisited",
    /// JCGT 2017.
    pub(crate) fn around(normal: DVec3) -> Self {
        let sign = 1f64.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    pub(crate) fn to_local(&self, world: DVec3) -> DVec3 {
        DVec3::new(world.dot(self.tangent), world.dot(self.bitangent), world.dot(self.normal))
    }

    pub(crate) fn to_world(&self, local: DVec3) -> DVec3 {
        local.x * self.tangent + local.y * self.bitangent + local.z * self.normal
    }
}

/// The unit direction at polar angle `theta` from +z and azimuth `phi` from +x, radians.
pub(crate) fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_orthonormal_and_right_handed() {
        for normal in [DVec3::Z, -DVec3::Z, direction(3.0, 0.4), direction(1.2, -2.0)] {
            let frame = Frame::around(normal);
            assert!(frame.tangent.cross(frame.bitangent).distance(normal) < 1e-12, "{normal}");
            assert!((frame.tangent.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn there_and_back_is_the_same_direction() {
        let frame = Frame::around(direction(2.1, 0.3));
        let world = direction(0.7, 4.0);
        assert!(frame.to_world(frame.to_local(world)).distance(world) < 1e-14);
        assert!(frame.to_local(frame.normal).distance(DVec3::Z) < 1e-14);
    }
}
