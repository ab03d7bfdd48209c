//! From the world to the surface and back: the local frame has the normal as +z.

use glam::DVec3;

/// An orthonormal frame around a normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    tangent: DVec3,
    bitangent: DVec3,
    normal: DVec3,
}

impl Frame {
    /// A frame whose +z is `normal` (unit, world space). Which way x and y point does not matter:
    /// no BSDF here depends on it.
    pub(crate) fn around(normal: DVec3) -> Self {
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        Self { tangent, bitangent, normal }
    }

    /// A world direction as the surface sees it.
    pub(crate) fn to_local(self, world: DVec3) -> DVec3 {
        DVec3::new(world.dot(self.tangent), world.dot(self.bitangent), world.dot(self.normal))
    }

    /// A local direction out in the world.
    pub(crate) fn to_world(self, local: DVec3) -> DVec3 {
        local.x * self.tangent + local.y * self.bitangent + local.z * self.normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORMALS: [DVec3; 4] =
        [DVec3::Z, DVec3::NEG_Z, DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.48, -0.64, 0.6)];

    #[test]
    fn the_normal_is_local_z_and_there_and_back_is_the_identity() {
        let direction = DVec3::new(0.36, 0.48, -0.8);
        for normal in NORMALS {
            let frame = Frame::around(normal);
            assert!(frame.to_local(normal).abs_diff_eq(DVec3::Z, 1e-15));
            let back = frame.to_world(frame.to_local(direction));
            assert!(back.abs_diff_eq(direction, 1e-15), "{normal}: {back}");
        }
    }
}
