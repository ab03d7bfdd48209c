//! The C boundary as Rust sees it: a `repr(C)` mirror of `include/furnace_core.h`, field by field.
//!
//! Batches cross as they are: [`Ray`], [`Hit`] and their like have the same layout on both sides. What is written
//! here is the rest: the scene as pointers and counts, the settings, and the table of functions. `tests/abi.rs`
//! compiles the header and compares every size and offset with these. Not here: anything that calls through the
//! table (`cores::dylib`).

#![expect(missing_docs, reason = "the header documents the fields")]

pub(crate) mod given;
mod table;
pub(crate) mod taken;

pub use table::{CORE, CoreTable};

use super::crossing::Layout;
use super::{BoxHit, Hit, Ray};
use bitflags::bitflags;
use glam::{DVec2, DVec3};
use std::ffi::{c_char, c_void};

/// The version of everything here. It changes when something existing does, not when a struct grows at its end.
pub(crate) const ABI: u32 = 1;

/// The one symbol that a core exports: a [`Entry`].
pub(crate) const ENTRY: &str = "furnace_core_entry";

/// `furnace_core_entry`: answers null if the core cannot serve a bench of that ABI.
pub(crate) type Entry = unsafe extern "C" fn(bench_abi: u32) -> *const CoreTable;

/// `furnace_status`
pub type Status = u32;

/// The request was answered.
pub(crate) const OK: Status = 0;
/// This very request is beyond the core.
pub(crate) const UNSUPPORTED: Status = 1;
/// The arguments make no sense to the core.
pub(crate) const INVALID: Status = 2;
/// Anything else.
pub(crate) const FAILED: Status = 3;

/// The numbers behind the words of the header: `numbers! { NAME = value }` documents each by its C name.
macro_rules! numbers {
    ($($name:ident = $value:literal),* $(,)?) => {
        $(#[doc = concat!("`FURNACE_", stringify!($name), "`")] pub(crate) const $name: u32 = $value;)*
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
    /// `furnace_core.traits`, where each name begins with `FURNACE_`: what no function pointer can say.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Traits: u32 {
        const BRUTE_FORCE = 1 << 0;
        const SPLIT_RULES = 1 << 1;
        const HEMISPHERE_SAMPLING = 1 << 2;
        const ISOLATED_BOUNCES = 1 << 3;
        const ROULETTE = 1 << 4;
        const ADAPTIVE_SAMPLING = 1 << 5;
        const COUNTS_TRAVERSAL = 1 << 6;
        const COUNTED_TESTS = 1 << 7;
        const CALLERS_RANDOMNESS = 1 << 8;
        const DETERMINISTIC = 1 << 9;
        const SINGLE_PRECISION = 1 << 10;
        const KNOWS_ROUGH_GLASS = 1 << 11;
        const REPORTED_VARIANCE = 1 << 12;
        const STRATIFIED_PIXELS = 1 << 13;
        const INDEPENDENT_PIXELS = 1 << 14;
        const INDEPENDENT_SAMPLES = 1 << 15;
        const PLAIN_ESTIMATORS = 1 << 16;
        const DEPTH_LIMIT = 1 << 17;
        const OWN_TESTS = 1 << 18;
    }
}

/// The structs of the header, and how they lie, for the test that compares them.
macro_rules! structs {
    ($($(#[$meta:meta])* $name:ident = $c:literal { $($field:ident: $type:ty),* $(,)? })*) => {
        $(
            #[doc = concat!("`", $c, "`")]
            $(#[$meta])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug)]
            pub struct $name {
                $(pub $field: $type),*
            }
        )*
        /// Every struct above by its name in C.
        pub const STRUCTS: &[Layout] = &[$(Layout {
            name: $c,
            size: size_of::<$name>(),
            fields: &[$((stringify!($field), std::mem::offset_of!($name, $field))),*],
        }),*];
    };
}

structs! {
    Camera = "furnace_camera" {
        struct_size: u32,
        reserved: u32,
        position: DVec3,
        right: DVec3,
        up: DVec3,
        backward: DVec3,
        horizontal_fov: f64,
        vertical_fov: f64,
        near_clip: f64,
        far_clip: f64,
        film_width: u32,
        film_height: u32,
    }
    Material = "furnace_material" {
        name: *const c_char,
        kind: u32,
        emits: u32,
        reflectance: [f64; 3],
        transmittance: [f64; 3],
        index: f64,
        roughness: f64,
        emission: [f64; 3],
        cap_axis: DVec3,
        cap_half_angle: f64,
        reserved: [f64; 4],
    }
    Mesh = "furnace_mesh" {
        name: *const c_char,
        positions: *const DVec3,
        normals: *const DVec3,
        indices: *const [u32; 3],
        vertex_count: u32,
        triangle_count: u32,
        material: u32,
        reserved: u32,
    }
    Sphere = "furnace_sphere" {
        name: *const c_char,
        centre: DVec3,
        radius: f64,
        inward: u32,
        material: u32,
    }
    Light = "furnace_light" {
        kind: u32,
        shape: u32,
        place: DVec3,
        radiance: [f64; 3],
        zenith: [f64; 3],
        reserved: [f64; 2],
    }
    Scene = "furnace_scene" {
        struct_size: u32,
        material_count: u32,
        mesh_count: u32,
        sphere_count: u32,
        light_count: u32,
        reserved: u32,
        name: *const c_char,
        camera: *const Camera,
        materials: *const Material,
        meshes: *const Mesh,
        spheres: *const Sphere,
        lights: *const Light,
    }
    CountedTests = "furnace_counted_tests" {
        struct_size: u32,
        reserved: u32,
        bench: *mut c_void,
        primitive: unsafe extern "C" fn(
        bench: *mut c_void,
        shape: u32,
        primitive: u32,
        ray: *const Ray,
        hit: *mut Hit,
    ) -> u32,
        r#box: unsafe extern "C" fn(
        bench: *mut c_void,
        min: *const DVec3,
        max: *const DVec3,
        ray: *const Ray,
        hit: *mut BoxHit,
    ) -> u32,
    }
    Build = "furnace_build" {
        struct_size: u32,
        accelerate: u32,
        split: u32,
        max_leaf_size: u32,
        counted: *const CountedTests,
        bench: *mut Built,
    }
    Taken = "furnace_components" {
        struct_size: u32,
        taken: u32,
        bench: *const CoreTable,
    }
    Integrator = "furnace_integrator" {
        struct_size: u32,
        samples_per_light: u32,
        first_bounce: u32,
        last_bounce: u32,
        by_hemisphere: u32,
        threads: u32,
        roulette_stop: f64,
        roulette_guaranteed: u32,
        by_depth: u32,
        seed: u64,
    }
    Adaptive = "furnace_adaptive" {
        struct_size: u32,
        samples_per_batch: u32,
        max_tolerance: f64,
    }
    Render = "furnace_render" {
        struct_size: u32,
        width: u32,
        height: u32,
        samples_per_pixel: u32,
        integrator: *const Integrator,
        adaptive: *const Adaptive,
        variances: *mut [f32; 3],
        stratified: u32,
        reserved: u32,
    }
    Randomness = "furnace_randomness" {
        points: *const DVec2,
        lobes: *const f64,
        seed: u64,
    }
    Stream = "furnace_stream" {
        values: *const f64,
        count: u64,
    }
    #[derive(Default)]
    Conventions = "furnace_conventions" {
        point_light_falloff: u32,
        emission: u32,
        smith_term: u32,
        glass_fresnel: u32,
        glass_radiance: u32,
        reserved: [u32; 3],
    }
}

/// `furnace_built`: the core's own.
#[repr(C)]
#[derive(Debug)]
pub struct Built {
    private: [u8; 0],
}
