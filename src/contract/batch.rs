//! The elements of batches: rays, hits, samples. Plain `repr(C)` data, the same in Rust and in C.

use super::answer::{
    Answered, Asked, Form, colour, finite, finite_vector, flag, holds, not_nan, not_negative,
    touched, unit,
};
use super::crossing::elements;
use super::{Breach, BreachKind, Capabilities, Result};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A ray segment: the points `origin + t · direction` for t in (t_min, t_max).
/// 64 bytes: one cache line.
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

elements! { "ray": Ray { origin, t_min, direction, t_max }; }

impl Answered for Ray {
    const NOUN: &'static str = "ray";

    fn check(&self, _: &Asked<'_>) -> Form {
        finite_vector("origin", self.origin)?;
        unit("direction", self.direction)?;
        not_nan("t_min", self.t_min)?;
        not_nan("t_max", self.t_max)
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
    pub const fn is_hit(&self) -> bool {
        self.primitive != Self::NONE
    }
}

elements! { "hit": Hit { t, shape, primitive, geometric_normal, shading_normal, uv }; }

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

elements! { "box-hit": BoxHit { t_enter, t_exit, hit, reserved }; }

impl Answered for BoxHit {
    const NOUN: &'static str = "box hit";

    fn check(&self, _: &Asked<'_>) -> Form {
        flag("hit", self.hit)
    }
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
    /// Uniform over the hemisphere around +z: density 1/2π.
    UniformHemisphere,
    /// Proportional to the cosine with +z: density cos θ/π.
    CosineHemisphere,
}

/// A direction of the hemisphere around +z.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DirectionSample {
    /// Unit.
    pub direction: DVec3,
    /// Density per steradian at `direction`.
    pub pdf: f64,
}

elements! { "direction-sample": DirectionSample { direction, pdf }; }

impl Answered for DirectionSample {
    const NOUN: &'static str = "sample";

    fn check(&self, _: &Asked<'_>) -> Form {
        unit("direction", self.direction)?;
        not_negative("pdf", self.pdf)
    }
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

elements! { "bsdf-query": BsdfQuery { wo, wi }; }

/// What a BSDF answers for a pair of directions.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BsdfValue {
    /// Per steradian, RGB, without the cosine.
    pub f: [f64; 3],
    /// Density per steradian around `wi`, given `wo`.
    pub pdf: f64,
}

elements! { "bsdf-value": BsdfValue { f, pdf }; }

impl Answered for BsdfValue {
    const NOUN: &'static str = "value";

    fn check(&self, _: &Asked<'_>) -> Form {
        colour("f", self.f)?;
        not_negative("pdf", self.pdf)
    }
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
    /// Density per steradian; for a delta lobe the probability of having chosen it.
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

elements! { "bsdf-sample": BsdfSample { wi, f, pdf, is_delta, is_valid }; }

impl Answered for BsdfSample {
    const NOUN: &'static str = "sample";

    fn check(&self, _: &Asked<'_>) -> Form {
        flag("is_valid", self.is_valid)?;
        if self.is_valid == 0 {
            return Ok(());
        }
        flag("is_delta", self.is_delta)?;
        unit("wi", self.wi)?;
        colour("f", self.f)?;
        not_negative("pdf", self.pdf)
    }
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
    /// Density per steradian; 1 for a delta light.
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

elements! { "light-sample": LightSample { wi, distance, radiance, pdf, is_delta, is_valid }; }

impl Answered for LightSample {
    const NOUN: &'static str = "sample";

    fn check(&self, _: &Asked<'_>) -> Form {
        flag("is_valid", self.is_valid)?;
        if self.is_valid == 0 {
            return Ok(());
        }
        flag("is_delta", self.is_delta)?;
        unit("wi", self.wi)?;
        not_nan("distance", self.distance)?;
        colour("radiance", self.radiance)?;
        not_negative("pdf", self.pdf)
    }
}

/// Random numbers for one batch, all in [0, 1). `points[i]` and `lobes[i]` belong to element i; a core without
/// [`Capabilities::CALLERS_RANDOMNESS`] ignores them and seeds itself.
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

elements! { "adaptive-mean": AdaptiveMean { mean, used, reserved }; }

impl Answered for AdaptiveMean {
    const NOUN: &'static str = "mean";

    fn check(&self, _: &Asked<'_>) -> Form {
        finite("mean", self.mean)?;
        touched("used", self.used)
    }
}

/// A density.
impl Answered for f64 {
    const NOUN: &'static str = "density";

    fn check(&self, _: &Asked<'_>) -> Form {
        not_negative("pdf", *self)
    }
}

/// The radiance along a ray.
impl Answered for [f64; 3] {
    const NOUN: &'static str = "radiance";

    fn check(&self, _: &Asked<'_>) -> Form {
        colour("radiance", *self)
    }
}

/// Reads flags that cross the boundary as bytes.
///
/// # Errors
/// If one is neither 0 nor 1.
pub fn read_flags(bytes: &[u8], flags: &mut [bool]) -> Result<()> {
    for (index, (flag, byte)) in flags.iter_mut().zip(bytes).enumerate() {
        *flag = match byte {
            0 => false,
            1 => true,
            _ => {
                let breach = Breach::of("it", BreachKind::NotAFlag(u32::from(*byte)));
                let breach = breach.in_element("occluded", index, bytes.len());
                return Err(breach.into());
            }
        };
    }
    Ok(())
}

/// A picture: row-major from the top left, linear RGB radiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` values.
    pub pixels: Vec<[f32; 3]>,
    /// Camera samples spent on each pixel, `width · height` values.
    pub sample_counts: Vec<u32>,
    /// Estimated variance of each value of `pixels`, in radiance squared: of the mean that is written there, not
    /// of one sample; 0 where one sample says nothing. `width · height` values of a core with
    /// [`Capabilities::REPORTED_VARIANCE`], none of others.
    pub variances: Vec<[f32; 3]>,
}

impl Film {
    /// A film that nothing has been written to, as a core with these capabilities is handed it.
    pub fn blank(width: u32, height: u32, capabilities: Capabilities) -> Self {
        let count = width as usize * height as usize;
        let reports = capabilities.contains(Capabilities::REPORTED_VARIANCE);
        Self {
            width,
            height,
            pixels: vec![[f32::NAN; 3]; count],
            sample_counts: vec![0; count],
            variances: vec![[f32::NAN; 3]; if reports { count } else { 0 }],
        }
    }
}
