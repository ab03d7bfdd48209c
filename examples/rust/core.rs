//! A renderer in Rust behind `furnace_core.h`: rays and spheres, and no crate beside it.
//!
//!     rustc --edition 2024 -O --crate-type cdylib core.rs -o libcore.so      # macOS: libcore.dylib
//!     furnace run 1 --core ./libcore.so
//!
//! The first half is yours: functions of one ray at a time. The second half is the table of
//! `furnace_core.h`, by which the bench finds them; a function that is `None` is skipped, never failed.
//! With furnace as a dependency, `furnace::export_core!(Mine)` stands in its place.

use std::ffi::{c_char, c_void};
use std::ops::{Add, Mul, Sub};
use std::slice::{from_raw_parts, from_raw_parts_mut};

// ---- what a renderer knows ----------------------------------------------------------------------

/// The unit direction through a point of the film, whose corners are (0, 0) below left and (1, 1).
fn direction(camera: &Camera, film: Vec2) -> Vec3 {
    let x = (2.0 * film.x - 1.0) * (camera.horizontal_fov / 2.0).tan();
    let y = (2.0 * film.y - 1.0) * (camera.vertical_fov / 2.0).tan();
    unit(camera.right * x + camera.up * y - camera.backward)
}

/// The nearest hit of a sphere strictly between `t_min` and `t_max`.
fn intersect(centre: Vec3, radius: f64, ray: &Ray) -> Option<Hit> {
    // In units of the ray's own length, around the point that is nearest to the centre: nothing
    // cancels there, however far the sphere is.
    let squared = dot(ray.direction, ray.direction);
    let nearest = dot(centre - ray.origin, ray.direction) / squared;
    let off = ray.origin + ray.direction * nearest - centre;
    let left = radius * radius - dot(off, off);
    if left < 0.0 {
        return None;
    }
    let half = (left / squared).sqrt();
    let ahead = |t: &f64| ray.t_min < *t && *t < ray.t_max;
    let t = [nearest - half, nearest + half].into_iter().find(ahead)?;
    let normal = unit(ray.origin + ray.direction * t - centre);
    Some(Hit { t, primitive: 0, geometric_normal: normal, shading_normal: normal, ..Hit::NONE })
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / dot(v, v).sqrt())
}

impl Add for Vec3 {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + b * -1.0
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }
}

// ---- what the bench calls -----------------------------------------------------------------------

const OK: u32 = 0;
/// FURNACE_DETERMINISTIC
const TRAITS: u32 = 1 << 9;

unsafe extern "C" fn generate_rays(
    _: *mut c_void,
    camera: *const Camera,
    film: *const Vec2,
    out: *mut Ray,
    count: usize,
) -> u32 {
    // SAFETY: the bench hands over `count` of each.
    let (camera, film, out) =
        unsafe { (&*camera, from_raw_parts(film, count), from_raw_parts_mut(out, count)) };
    for (ray, film) in out.iter_mut().zip(film) {
        *ray = Ray {
            origin: camera.position,
            t_min: camera.near_clip,
            direction: direction(camera, *film),
            t_max: camera.far_clip,
        };
    }
    OK
}

unsafe extern "C" fn intersect_sphere(
    _: *mut c_void,
    centre: *const Vec3,
    radius: f64,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> u32 {
    // SAFETY: the bench hands over `count` of each.
    let (centre, rays, out) =
        unsafe { (*centre, from_raw_parts(rays, count), from_raw_parts_mut(out, count)) };
    for (hit, ray) in out.iter_mut().zip(rays) {
        *hit = intersect(centre, radius, ray).unwrap_or(Hit::NONE);
    }
    OK
}

unsafe extern "C" fn last_error(_: *mut c_void) -> *const c_char {
    c"".as_ptr()
}

/// Asked once, when the library is opened.
#[unsafe(no_mangle)]
pub extern "C" fn furnace_core_entry(_bench_abi: u32) -> *const Core {
    static CORE: Core = Core {
        abi: 1,
        struct_size: size_of::<Core>() as u32,
        traits: TRAITS,
        components: 0,
        conventions: [0; 8],
        name: c"mine in Rust".as_ptr(),
        version: c"0.1".as_ptr(),
        this: std::ptr::null_mut(),
        last_error,
        generate_rays: Some(generate_rays),
        intersect_triangle: None,
        intersect_sphere: Some(intersect_sphere),
        intersect_box: None,
        sample_direction: None,
        direction_pdf: None,
        eval_bsdf: None,
        sample_bsdf: None,
        adaptive_mean: None,
        build: None,
        release: None,
        intersect: None,
        occluded: None,
        sample_light: None,
        radiance: None,
        render: None,
        take_components: None,
    };
    &CORE
}

// ---- furnace_core.h, as far as it is used here --------------------------------------------------

#[repr(C)]
#[derive(Clone, Copy)]
pub struct Vec2 {
    x: f64,
    y: f64,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct Vec3 {
    x: f64,
    y: f64,
    z: f64,
}

#[repr(C)]
pub struct Ray {
    origin: Vec3,
    t_min: f64,
    direction: Vec3,
    t_max: f64,
}

#[repr(C)]
pub struct Hit {
    t: f64,
    shape: u32,
    primitive: u32,
    geometric_normal: Vec3,
    shading_normal: Vec3,
    uv: Vec2,
}

impl Hit {
    /// FURNACE_NONE in `primitive` is a miss.
    const NONE: Hit = {
        let zero = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        let uv = Vec2 { x: 0.0, y: 0.0 };
        Hit { t: 0.0, shape: 0, primitive: !0, geometric_normal: zero, shading_normal: zero, uv }
    };
}

#[repr(C)]
pub struct Camera {
    struct_size: u32,
    reserved: u32,
    position: Vec3,
    right: Vec3,
    up: Vec3,
    backward: Vec3,
    horizontal_fov: f64,
    vertical_fov: f64,
    near_clip: f64,
    far_clip: f64,
    film: [u32; 2],
}

type GenerateRays =
    unsafe extern "C" fn(*mut c_void, *const Camera, *const Vec2, *mut Ray, usize) -> u32;
type IntersectSphere =
    unsafe extern "C" fn(*mut c_void, *const Vec3, f64, *const Ray, *mut Hit, usize) -> u32;
/// One that is not written yet: give it its parameters from `furnace_core.h` when it is.
type Unwritten = Option<unsafe extern "C" fn()>;

#[repr(C)]
pub struct Core {
    abi: u32,
    struct_size: u32,
    traits: u32,
    components: u32,
    conventions: [u32; 8],
    name: *const c_char,
    version: *const c_char,
    this: *mut c_void,
    last_error: unsafe extern "C" fn(*mut c_void) -> *const c_char,
    generate_rays: Option<GenerateRays>,
    intersect_triangle: Unwritten,
    intersect_sphere: Option<IntersectSphere>,
    intersect_box: Unwritten,
    sample_direction: Unwritten,
    direction_pdf: Unwritten,
    eval_bsdf: Unwritten,
    sample_bsdf: Unwritten,
    adaptive_mean: Unwritten,
    build: Unwritten,
    release: Unwritten,
    intersect: Unwritten,
    occluded: Unwritten,
    sample_light: Unwritten,
    radiance: Unwritten,
    render: Unwritten,
    take_components: Unwritten,
}

// SAFETY: nothing in it ever changes.
unsafe impl Sync for Core {}
