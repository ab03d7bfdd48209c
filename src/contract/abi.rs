//! The C boundary as Rust sees it: a `repr(C)` mirror of `include/furnace_core.h`, field by field.
//!
//! Batches cross as they are: [`Ray`], [`Hit`] and their like have the same layout on both sides. What is written
//! here is the rest: the scene as pointers and counts, the settings, and the table of functions. `tests/abi.rs`
//! compiles the header and compares every size and offset with these. Not here: anything that calls through the
//! table (`cores::dylib`).

#![expect(missing_docs, reason = "the header documents the fields")]

use super::{
    AdaptiveMean, BoxHit, BsdfQuery, BsdfSample, BsdfValue, BuildStats, DirectionSample, Hit,
    LightSample, Ray, TraversalStats,
};
use bitflags::bitflags;
use glam::{DVec2, DVec3};
use std::ffi::{c_char, c_void};

/// The version of everything here. It changes when something existing does, not when a struct grows at its end.
pub const ABI: u32 = 1;

/// The one symbol that a core exports: a [`Entry`].
pub const ENTRY: &str = "furnace_core_entry";

/// `furnace_core_entry`: answers null if the core cannot serve a bench of that ABI.
pub type Entry = unsafe extern "C" fn(bench_abi: u32) -> *const CoreTable;

/// `furnace_status`
pub type Status = u32;

/// The request was answered.
pub const OK: Status = 0;
/// This very request is beyond the core.
pub const UNSUPPORTED: Status = 1;
/// The arguments make no sense to the core.
pub const INVALID: Status = 2;
/// Anything else.
pub const FAILED: Status = 3;

/// The numbers behind the words of the header: `numbers! { NAME = value }` documents each by its C name.
macro_rules! numbers {
    ($($name:ident = $value:literal),* $(,)?) => {
        $(#[doc = concat!("`FURNACE_", stringify!($name), "`")] pub const $name: u32 = $value;)*
        /// Every number above with its name in C, for the test that compares them.
        pub const NUMBERS: &[(&str, u32)] =
            &[$((concat!("FURNACE_", stringify!($name)), $name)),*];
    };
}

numbers! {
    UNIFORM_HEMISPHERE = 0,
    COSINE_HEMISPHERE = 1,
    DIFFUSE = 0,
    MIRROR = 1,
    GLASS = 2,
    CONDUCTOR = 3,
    ROUGH_GLASS = 4,
    POINT = 0,
    DIRECTIONAL = 1,
    CONSTANT_SKY = 2,
    GRADIENT_SKY = 3,
    AREA = 4,
    SPLIT_CORES_CHOICE = 0,
    SPLIT_MEDIAN = 1,
    SPLIT_MEAN_OF_CENTROIDS = 2,
    SPLIT_MIDPOINT = 3,
    SPLIT_SURFACE_AREA = 4,
    FALLOFF_INVERSE_SQUARE = 0,
    FALLOFF_NONE = 1,
    EMISSION_FRONT = 0,
    EMISSION_BOTH = 1,
    SMITH_SEPARABLE = 0,
    SMITH_CORRELATED = 1,
    FRESNEL_EXACT = 0,
    FRESNEL_SCHLICK = 1,
    FRESNEL_SCHLICK_OUTSIDE = 2,
    RADIANCE_SCALED = 0,
    RADIANCE_UNSCALED = 1,
}

bitflags! {
    /// `furnace_core.traits`: what no function pointer can say.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Traits: u32 {
        /// `FURNACE_BRUTE_FORCE`
        const BRUTE_FORCE = 1 << 0;
        /// `FURNACE_SPLIT_RULES`
        const SPLIT_RULES = 1 << 1;
        /// `FURNACE_HEMISPHERE_SAMPLING`
        const HEMISPHERE_SAMPLING = 1 << 2;
        /// `FURNACE_ISOLATED_BOUNCES`
        const ISOLATED_BOUNCES = 1 << 3;
        /// `FURNACE_ROULETTE`
        const ROULETTE = 1 << 4;
        /// `FURNACE_ADAPTIVE_SAMPLING`
        const ADAPTIVE_SAMPLING = 1 << 5;
        /// `FURNACE_COUNTS_TRAVERSAL`
        const COUNTS_TRAVERSAL = 1 << 6;
        /// `FURNACE_COUNTED_TESTS`
        const COUNTED_TESTS = 1 << 7;
        /// `FURNACE_CALLERS_RANDOMNESS`
        const CALLERS_RANDOMNESS = 1 << 8;
        /// `FURNACE_DETERMINISTIC`
        const DETERMINISTIC = 1 << 9;
        /// `FURNACE_SINGLE_PRECISION`
        const SINGLE_PRECISION = 1 << 10;
        /// `FURNACE_KNOWS_ROUGH_GLASS`
        const KNOWS_ROUGH_GLASS = 1 << 11;
        /// `FURNACE_REPORTED_VARIANCE`
        const REPORTED_VARIANCE = 1 << 12;
        /// `FURNACE_STRATIFIED_PIXELS`
        const STRATIFIED_PIXELS = 1 << 13;
    }
}

/// `furnace_camera`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub struct_size: u32,
    pub reserved: u32,
    pub position: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub backward: DVec3,
    pub horizontal_fov: f64,
    pub vertical_fov: f64,
    pub near_clip: f64,
    pub far_clip: f64,
    pub film_width: u32,
    pub film_height: u32,
}

/// `furnace_material`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Material {
    pub name: *const c_char,
    pub kind: u32,
    pub emits: u32,
    pub reflectance: [f64; 3],
    pub transmittance: [f64; 3],
    pub index: f64,
    pub roughness: f64,
    pub emission: [f64; 3],
    pub cap_axis: DVec3,
    pub cap_half_angle: f64,
    pub reserved: [f64; 4],
}

/// `furnace_mesh`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Mesh {
    pub name: *const c_char,
    pub positions: *const DVec3,
    pub normals: *const DVec3,
    pub indices: *const [u32; 3],
    pub vertex_count: u32,
    pub triangle_count: u32,
    pub material: u32,
    pub reserved: u32,
}

/// `furnace_sphere`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub name: *const c_char,
    pub centre: DVec3,
    pub radius: f64,
    pub inward: u32,
    pub material: u32,
}

/// `furnace_light`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Light {
    pub kind: u32,
    pub shape: u32,
    pub place: DVec3,
    pub radiance: [f64; 3],
    pub zenith: [f64; 3],
    pub reserved: [f64; 2],
}

/// `furnace_scene`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub struct_size: u32,
    pub material_count: u32,
    pub mesh_count: u32,
    pub sphere_count: u32,
    pub light_count: u32,
    pub reserved: u32,
    pub name: *const c_char,
    pub camera: *const Camera,
    pub materials: *const Material,
    pub meshes: *const Mesh,
    pub spheres: *const Sphere,
    pub lights: *const Light,
}

/// `furnace_counted_tests`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CountedTests {
    pub struct_size: u32,
    pub reserved: u32,
    pub bench: *mut c_void,
    pub primitive: unsafe extern "C" fn(
        bench: *mut c_void,
        shape: u32,
        primitive: u32,
        ray: *const Ray,
        hit: *mut Hit,
    ) -> u32,
    pub r#box: unsafe extern "C" fn(
        bench: *mut c_void,
        min: *const DVec3,
        max: *const DVec3,
        ray: *const Ray,
        hit: *mut BoxHit,
    ) -> u32,
}

/// `furnace_build`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Build {
    pub struct_size: u32,
    pub accelerate: u32,
    pub split: u32,
    pub max_leaf_size: u32,
    pub counted: *const CountedTests,
}

/// `furnace_integrator`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Integrator {
    pub struct_size: u32,
    pub samples_per_light: u32,
    pub first_bounce: u32,
    pub last_bounce: u32,
    pub by_hemisphere: u32,
    pub threads: u32,
    pub roulette_stop: f64,
    pub roulette_guaranteed: u32,
    pub reserved: u32,
    pub seed: u64,
}

/// `furnace_adaptive`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Adaptive {
    pub struct_size: u32,
    pub samples_per_batch: u32,
    pub max_tolerance: f64,
}

/// `furnace_render`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Render {
    pub struct_size: u32,
    pub width: u32,
    pub height: u32,
    pub samples_per_pixel: u32,
    pub integrator: *const Integrator,
    pub adaptive: *const Adaptive,
    pub variances: *mut [f32; 3],
    pub stratified: u32,
    pub reserved: u32,
}

/// `furnace_randomness`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Randomness {
    pub points: *const DVec2,
    pub lobes: *const f64,
    pub seed: u64,
}

/// `furnace_stream`
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    pub values: *const f64,
    pub count: u64,
}

/// `furnace_conventions`
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Conventions {
    pub point_light_falloff: u32,
    pub emission: u32,
    pub smith_term: u32,
    pub glass_fresnel: u32,
    pub glass_radiance: u32,
    pub reserved: [u32; 3],
}

/// `furnace_built`: the core's own.
#[repr(C)]
#[derive(Debug)]
pub struct Built {
    private: [u8; 0],
}

/// A function over a batch: the arguments between `self` and the count are its own.
macro_rules! functions {
    ($($(#[$meta:meta])* $name:ident ( $($argument:ident: $type:ty),* $(,)? );)*) => {
        $($(#[$meta])* pub type $name =
            unsafe extern "C" fn(this: *mut c_void, $($argument: $type),*) -> Status;)*
    };
}

functions! {
    /// `generate_rays`
    GenerateRays(camera: *const Camera, film: *const DVec2, out: *mut Ray, count: usize);
    /// `intersect_triangle`
    IntersectTriangle(
        positions: *const DVec3,
        normals: *const DVec3,
        rays: *const Ray,
        out: *mut Hit,
        count: usize,
    );
    /// `intersect_sphere`
    IntersectSphere(
        centre: *const DVec3,
        radius: f64,
        rays: *const Ray,
        out: *mut Hit,
        count: usize,
    );
    /// `intersect_box`
    IntersectBox(
        min: *const DVec3,
        max: *const DVec3,
        rays: *const Ray,
        out: *mut BoxHit,
        count: usize,
    );
    /// `sample_direction`
    SampleDirection(
        sampler: u32,
        random: *const Randomness,
        out: *mut DirectionSample,
        count: usize,
    );
    /// `direction_pdf`
    DirectionPdf(sampler: u32, directions: *const DVec3, out: *mut f64, count: usize);
    /// `eval_bsdf`
    EvalBsdf(
        material: *const Material,
        queries: *const BsdfQuery,
        out: *mut BsdfValue,
        count: usize,
    );
    /// `sample_bsdf`
    SampleBsdf(
        material: *const Material,
        wo: *const DVec3,
        random: *const Randomness,
        out: *mut BsdfSample,
        count: usize,
    );
    /// `adaptive_mean`
    AdaptiveMeans(
        settings: *const Adaptive,
        streams: *const Stream,
        out: *mut AdaptiveMean,
        count: usize,
    );
    /// `build`
    BuildScene(
        scene: *const Scene,
        settings: *const Build,
        out: *mut *mut Built,
        stats: *mut BuildStats,
    );
    /// `intersect`
    Intersect(
        built: *mut Built,
        rays: *const Ray,
        out: *mut Hit,
        count: usize,
        stats: *mut TraversalStats,
    );
    /// `occluded`
    Occluded(
        built: *mut Built,
        rays: *const Ray,
        out: *mut u8,
        count: usize,
        stats: *mut TraversalStats,
    );
    /// `sample_light`
    SampleLight(
        built: *mut Built,
        light: u32,
        from: *const DVec3,
        random: *const Randomness,
        out: *mut LightSample,
        count: usize,
    );
    /// `radiance`
    Radiance(
        built: *mut Built,
        rays: *const Ray,
        settings: *const Integrator,
        out: *mut [f64; 3],
        count: usize,
    );
    /// `render`
    RenderPicture(
        built: *mut Built,
        camera: *const Camera,
        settings: *const Render,
        pixels: *mut [f32; 3],
        sample_counts: *mut u32,
    );
}

/// `furnace_core`: who the core is, and its functions. `None` is "not supported".
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CoreTable {
    pub abi: u32,
    pub struct_size: u32,
    pub traits: u32,
    pub reserved: u32,
    pub conventions: Conventions,
    pub name: *const c_char,
    pub version: *const c_char,
    pub this: *mut c_void,
    pub last_error: Option<unsafe extern "C" fn(this: *mut c_void) -> *const c_char>,
    pub generate_rays: Option<GenerateRays>,
    pub intersect_triangle: Option<IntersectTriangle>,
    pub intersect_sphere: Option<IntersectSphere>,
    pub intersect_box: Option<IntersectBox>,
    pub sample_direction: Option<SampleDirection>,
    pub direction_pdf: Option<DirectionPdf>,
    pub eval_bsdf: Option<EvalBsdf>,
    pub sample_bsdf: Option<SampleBsdf>,
    pub adaptive_mean: Option<AdaptiveMeans>,
    pub build: Option<BuildScene>,
    pub release: Option<unsafe extern "C" fn(this: *mut c_void, built: *mut Built)>,
    pub intersect: Option<Intersect>,
    pub occluded: Option<Occluded>,
    pub sample_light: Option<SampleLight>,
    pub radiance: Option<Radiance>,
    pub render: Option<RenderPicture>,
}

// The sizes that a 64-bit C compiler gives the header; `tests/abi.rs` asks one.
const _: () = {
    assert!(size_of::<Camera>() == 144);
    assert!(size_of::<Material>() == 168);
    assert!(size_of::<Mesh>() == 48);
    assert!(size_of::<Sphere>() == 48);
    assert!(size_of::<Light>() == 96);
    assert!(size_of::<Scene>() == 72);
    assert!(size_of::<CountedTests>() == 32);
    assert!(size_of::<Build>() == 24);
    assert!(size_of::<Integrator>() == 48);
    assert!(size_of::<Adaptive>() == 16);
    assert!(size_of::<Render>() == 48);
    assert!(size_of::<Randomness>() == 24);
    assert!(size_of::<Stream>() == 16);
    assert!(size_of::<CoreTable>() == 208);
};
