//! Axis-aligned boxes in single precision, made so that they never lose what they enclose.

use glam::{DVec3, Vec3A};

/// How much larger than its contents a box is, relative to the largest coordinate in it: two units in the
/// last place. Covers the rounding of double precision corners, and keeps flat boxes from being flat.
const MARGIN: f32 = f32::EPSILON * 2.0;

/// A closed box, two vector registers wide. The empty box has `min = +∞` and `max = −∞`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) min: Vec3A,
    pub(crate) max: Vec3A,
}

impl Bounds {
    pub(crate) const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    /// The box around points that are exact in single precision or within rounding of it, with a margin.
    pub(crate) fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        let tight =
            points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.with(point.as_vec3a()));
        let margin = MARGIN * tight.min.abs().max(tight.max.abs()).max_element();
        Self { min: tight.min - margin, max: tight.max + margin }
    }

    pub(crate) fn with(self, point: Vec3A) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    pub(crate) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// From corner to corner; negative infinite for the empty box.
    pub(crate) fn extent(self) -> Vec3A {
        self.max - self.min
    }

    /// Half the surface area, which is all that the surface area heuristic needs; 0 for the empty box.
    pub(crate) fn half_area(self) -> f32 {
        let size = self.extent().max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    pub(crate) fn centre(self) -> Vec3A {
        0.5 * (self.min + self.max)
    }

    pub(crate) fn longest_axis(self) -> usize {
        self.extent().max_position()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_box_contains_points_that_rounding_moved() {
        let third = DVec3::splat(1.0 / 3.0);
        let bounds = Bounds::around([third]);
        assert!(
            bounds.min.as_dvec3().cmplt(third).all() && bounds.max.as_dvec3().cmpgt(third).all()
        );
    }

    #[test]
    fn a_flat_box_has_a_little_thickness() {
        let bounds = Bounds::around([dvec3(0.0, 0.0, 0.0), dvec3(0.0, 1.0, 1.0)]);
        assert!(bounds.extent().x > 0.0 && bounds.extent().x < 1e-6);
        assert_eq!(bounds.longest_axis(), 1);
    }

    #[test]
    fn the_empty_box_has_no_area() {
        assert_eq!(Bounds::EMPTY.half_area(), 0.0);
    }
}
