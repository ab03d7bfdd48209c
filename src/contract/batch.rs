//! The elements of batches: rays, hits, samples. Plain `repr(C)` data, the same in Rust and in C.

use super::answer::{
    Answered, Asked, Form, Meaning, colour, finite, finite_vector, flag, holds, not_nan,
    not_negative, touched, unit,
};
use super::crossing::elements;
use super::{Breach, BreachKind};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A ray segment: the points `origin + t · direction` for t in (t_min, t_max), where t_min is not
/// negative: Embree takes no other segments. 64 bytes: one cache line.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Ray {
    /// Where `t = 0`, in world space.
    pub origin: DVec3,
    /// Open lower end of the segment, in units of `|direction|`.
    pub t_min: f64,
    /// World space; of any length but zero, unit where a camera made it.
    pub direction: DVec3,
    /// Open upper end of the segment; may be infinite.
    pub t_max: f64,
}

impl Ray {
    /// The whole half-line from `origin`.
    pub const fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, t_min: 0.0, direction, t_max: f64::INFINITY }
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// The nearest intersection, or a miss.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Hit {
    /// Ray parameter in units of `|direction|`.
    pub t: f64,
    /// Number of the shape in the scene: meshes first, then spheres.
    pub shape: u32,
    /// Number of the triangle in its mesh, 0 for a sphere, [`Hit::NONE`] for a miss.
    pub primitive: u32,
    /// Unit; on the side the winding order says (outward for a sphere, inward if the scene says so);
    /// not flipped towards the ray.
    pub geometric_normal: DVec3,
    /// Unit; interpolated from vertex normals where there are any.
    pub shading_normal: DVec3,
    /// Triangle: barycentric weights of vertices 1 and 2. Sphere: whatever the core likes.
    pub uv: DVec2,
}

impl Hit {
    /// What `primitive` is when nothing was hit; no other field is read then.
    pub const NONE: u32 = u32::MAX;

    /// A ray that hit nothing.
    pub const MISS: Hit = Hit {
        t: f64::INFINITY,
        shape: Self::NONE,
        primitive: Self::NONE,
        geometric_normal: DVec3::ZERO,
        shading_normal: DVec3::ZERO,
        uv: DVec2::ZERO,
    };

    /// Whether anything was hit.
    pub(crate) const fn is_hit(&self) -> bool {
        self.primitive != Self::NONE
    }
}

/// Where a ray segment meets a box.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BoxHit {
    /// Where the line enters the box, in units of `|direction|`; read only where `hit` is 1.
    pub t_enter: f64,
    /// Where it leaves.
    pub t_exit: f64,
    /// 1: the closed box meets the segment [t_min, t_max]; 0: it does not.
    pub hit: u32,
    /// Always 0.
    pub reserved: u32,
}

/// A single shape, tested without any scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// Three vertices and the shading normals at them (unit).
    Triangle {
        /// World space, counter-clockwise seen from the front.
        positions: [DVec3; 3],
        /// Unit shading normals at the vertices.
        normals: [DVec3; 3],
    },
    /// A sphere whose normals point outward.
    Sphere {
        /// World space.
        centre: DVec3,
        /// Scene units, positive.
        radius: f64,
    },
}

/// Work done by one batch, summed over its rays.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct TraversalStats {
    /// Rays in the batch.
    pub rays: u64,
    /// Bounding boxes tested (each child of a wide node counts as one).
    pub box_tests: u64,
    /// Triangles and spheres tested.
    pub primitive_tests: u64,
}

impl std::ops::AddAssign for TraversalStats {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.box_tests += other.box_tests;
        self.primitive_tests += other.primitive_tests;
    }
}

/// The samplers of directions that a course asks for, apart from any BSDF.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Uniform over the hemisphere around +z: pdf 1/2π.
    UniformHemisphere,
    /// Proportional to the cosine with +z: pdf cos θ/π.
    CosineHemisphere,
}

/// A direction of the hemisphere around +z.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DirectionSample {
    /// Unit.
    pub direction: DVec3,
    /// Pdf per steradian at `direction`.
    pub pdf: f64,
}

/// A pair of directions to evaluate a BSDF for.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BsdfQuery {
    /// Towards the viewer, local frame, unit.
    pub wo: DVec3,
    /// Towards the light, local frame, unit.
    pub wi: DVec3,
}

/// What a BSDF answers for a pair of directions.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BsdfValue {
    /// Per steradian, RGB, without the cosine.
    pub f: [f64; 3],
    /// Pdf per steradian around `wi`, given `wo`.
    pub pdf: f64,
}

/// A sampled incident direction.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BsdfSample {
    /// Towards the light, local frame, unit.
    pub wi: DVec3,
    /// Per steradian, RGB, without the cosine. For a delta lobe: such that `f · |cos θi| / pdf` is the
    /// weight of the path.
    pub f: [f64; 3],
    /// Pdf per steradian; for a delta lobe the probability of having chosen it.
    pub pdf: f64,
    /// 1: the only direction of a delta lobe (mirror, glass).
    pub is_delta: u32,
    /// 0: sampling failed, count the sample as zero.
    pub is_valid: u32,
}

impl BsdfSample {
    /// A sample that failed.
    pub const NONE: Self = Self { wi: DVec3::Z, f: [0.0; 3], pdf: 0.0, is_delta: 0, is_valid: 0 };
}

/// A sampled direction towards a light.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightSample {
    /// Towards the light, world space, unit.
    pub wi: DVec3,
    /// To the point on the light; infinite for skies and directional lights.
    pub distance: f64,
    /// Arriving along `wi` if nothing is in between. Of a delta light: such that
    /// `radiance · f · cos` is the reflected radiance (irradiance at normal incidence).
    pub radiance: [f64; 3],
    /// Pdf per steradian; 1 for a delta light.
    pub pdf: f64,
    /// 1: a point or directional light.
    pub is_delta: u32,
    /// 0: sampling failed, count the sample as zero.
    pub is_valid: u32,
}

impl LightSample {
    /// A sample that failed.
    pub const NONE: Self = Self {
        wi: DVec3::Z,
        distance: 0.0,
        radiance: [0.0; 3],
        pdf: 0.0,
        is_delta: 0,
        is_valid: 0,
    };
}

/// Random numbers for one batch, all in [0, 1). `points[i]` and `lobes[i]` belong to element i; a core without
/// [`super::Capabilities::CALLERS_RANDOMNESS`] ignores them and seeds itself.
#[derive(Clone, Copy, Debug)]
pub struct Randomness<'a> {
    /// Two numbers an element: the direction or the point on the light.
    pub points: &'a [DVec2],
    /// One number an element: which lobe, or which triangle of a mesh light.
    pub lobes: &'a [f64],
    /// For cores that draw their own.
    pub seed: u64,
}

/// What the adaptive stopping rule made of one stream.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct AdaptiveMean {
    /// Mean of the samples used.
    pub mean: f64,
    /// Samples used.
    pub used: u32,
    /// Always 0.
    pub reserved: u32,
}

elements! {
    "ray": Ray { origin, t_min, direction, t_max };
    "hit": Hit { t, shape, primitive, geometric_normal, shading_normal, uv };
    "box-hit": BoxHit { t_enter, t_exit, hit, reserved };
    "direction-sample": DirectionSample { direction, pdf };
    "bsdf-query": BsdfQuery { wo, wi };
    "bsdf-value": BsdfValue { f, pdf };
    "bsdf-sample": BsdfSample { wi, f, pdf, is_delta, is_valid };
    "light-sample": LightSample { wi, distance, radiance, pdf, is_delta, is_valid };
    "adaptive-mean": AdaptiveMean { mean, used, reserved };
}

/// What each field has to be; `if` a flag, only where that is set.
macro_rules! answered {
    ($($noun:literal: $type:ty $(, if $valid:ident)? { $($field:ident: $form:ident),* };)*) => { $(
        impl Answered for $type {
            const NOUN: &'static str = $noun;

            fn check(&self, _: &Asked<'_>) -> Form {
                $(flag(stringify!($valid), self.$valid)?;
                if self.$valid == 0 {
                    return Ok(());
                })?
                $($form(stringify!($field), self.$field)?;)*
                Ok(())
            }

            fn mend(&mut self, breach: &Breach) -> bool {
                match breach.field.as_ref() {
                    $(stringify!($field) => self.$field.meant(&breach.kind),)*
                    _ => false,
                }
            }
        }
    )* };
}
answered! {
    "ray": Ray { origin: finite_vector, direction: unit, t_min: not_nan, t_max: not_nan };
    "box hit": BoxHit { hit: flag };
    "sample": DirectionSample { direction: unit, pdf: not_negative };
    "value": BsdfValue { f: colour, pdf: not_negative };
    "sample": BsdfSample, if is_valid { is_delta: flag, wi: unit, f: colour, pdf: not_negative };
    "sample": LightSample, if is_valid {
        is_delta: flag, wi: unit, distance: not_nan, radiance: colour, pdf: not_negative
    };
    "mean": AdaptiveMean { mean: finite, used: touched };
}

impl Answered for Hit {
    const NOUN: &'static str = "hit";

    fn check(&self, asked: &Asked<'_>) -> Form {
        if !self.is_hit() {
            return Ok(());
        }
        touched("primitive", self.primitive)?;
        let &Self { shape, primitive, .. } = self;
        let primitives = asked.primitives_of_shape.get(shape as usize).copied().unwrap_or(0);
        let ghost = || BreachKind::NoSuchPrimitive { shape, primitive };
        holds((primitive as usize) < primitives, "primitive", ghost)?;
        finite("t", self.t)?;
        unit("geometric_normal", self.geometric_normal)?;
        unit("shading_normal", self.shading_normal)
    }

    fn mend(&mut self, breach: &Breach) -> bool {
        match breach.field.as_ref() {
            "geometric_normal" => self.geometric_normal.meant(&breach.kind),
            "shading_normal" => self.shading_normal.meant(&breach.kind),
            _ => false,
        }
    }
}

/// The pdf of a direction.
impl Answered for f64 {
    const NOUN: &'static str = "direction";

    fn check(&self, _: &Asked<'_>) -> Form {
        not_negative("pdf", *self)
    }
}

/// The radiance along a ray, as estimated: below 0, an estimate may still be right on average (control variates).
impl Answered for [f64; 3] {
    const NOUN: &'static str = "radiance";

    fn check(&self, _: &Asked<'_>) -> Form {
        (0..).zip(self).try_for_each(|(channel, value)| {
            let breach = |breach| Breach { channel: Some(channel), ..breach };
            finite("radiance", *value).map_err(breach)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_of_radiance_may_be_below_0_and_has_to_be_a_number() {
        let asked = Asked {
            size: [1, 1],
            capabilities: super::super::Capabilities::empty(),
            primitives_of_shape: &[],
            unformed: crate::contract::answer::Unformed::Refused,
        };
        assert!([-0.25, 0.5, 0.0].check(&asked).is_ok());
        assert!([0.0, f64::INFINITY, 0.0].check(&asked).is_err());
    }
}
