//! Scenes, materials, cameras and settings as the C boundary wants them: flat structs and pointers.
//!
//! Meshes are not copied: the tables point into the scene they were made of. Not here: anything `unsafe`; making a
//! pointer is harmless, following it is the core's business.

use crate::contract::crossing::Element;
use crate::contract::{
    Acceleration, AdaptiveSettings, DirectSampling, IntegratorSettings, Randomness, RenderSettings,
    Roulette, Sampler, Split, abi,
};
use crate::scene::{Camera, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface};
use glam::DVec3;
use std::ffi::{CString, c_char};
use std::marker::PhantomData;
use std::ptr;

/// The size that a struct of the boundary says it has.
pub(crate) fn struct_size<T>() -> u32 {
    // Every struct of the boundary is far below 4 GiB.
    u32::try_from(size_of::<T>()).unwrap_or(u32::MAX)
}

/// The length of a table as C has it.
///
/// # Panics
/// If a scene has more than 2³² of something, which no scene that fits into memory has.
fn count(length: usize) -> u32 {
    u32::try_from(length).expect("a scene has fewer than 2^32 of everything")
}

/// A name for C: without the NUL that would end it early.
pub(crate) fn c_name(name: &str) -> CString {
    CString::new(name.replace('\0', " ")).unwrap_or_default()
}

/// A scene as C structs that point into it.
pub(crate) struct SceneTables<'a> {
    /// What every `name` points to.
    names: Vec<CString>,
    camera: Option<abi::Camera>,
    materials: Vec<abi::Material>,
    meshes: Vec<abi::Mesh>,
    spheres: Vec<abi::Sphere>,
    lights: Vec<abi::Light>,
    scene: PhantomData<&'a SceneDescription>,
}

impl<'a> SceneTables<'a> {
    pub(crate) fn new(scene: &'a SceneDescription) -> Self {
        let mut names = vec![c_name(&scene.name)];
        let mut name = |text: &str| {
            names.push(c_name(text));
            // The characters stay where they are when the list of names grows.
            names.last().map_or(ptr::null(), |name| name.as_ptr())
        };
        Self {
            camera: scene.camera.as_ref().map(camera),
            materials: scene.materials.iter().map(|m| material(m, name(&m.name))).collect(),
            meshes: scene.meshes.iter().map(|m| mesh(m, name(&m.name))).collect(),
            spheres: scene.spheres.iter().map(|s| sphere(s, name(&s.name))).collect(),
            lights: scene.lights.iter().map(light).collect(),
            names,
            scene: PhantomData,
        }
    }

    /// The struct that a core is handed; valid as long as `self`.
    pub(crate) fn as_abi(&self) -> abi::Scene {
        abi::Scene {
            struct_size: struct_size::<abi::Scene>(),
            material_count: count(self.materials.len()),
            mesh_count: count(self.meshes.len()),
            sphere_count: count(self.spheres.len()),
            light_count: count(self.lights.len()),
            reserved: 0,
            name: self.names.first().map_or(ptr::null(), |name| name.as_ptr()),
            camera: self.camera.as_ref().map_or(ptr::null(), ptr::from_ref),
            materials: self.materials.as_ptr(),
            meshes: self.meshes.as_ptr(),
            spheres: self.spheres.as_ptr(),
            lights: self.lights.as_ptr(),
        }
    }
}

/// An argument of a question as C has it.
pub trait Given {
    /// What C gets.
    type Passed;
    /// What that points to, valid as long as itself.
    type Lent;

    /// What is lent for a call about `count` elements.
    ///
    /// # Panics
    /// If it has another number of elements, for C sees only one count.
    fn lent(self, count: usize) -> Self::Lent;

    /// What is passed.
    fn passed(lent: &Self::Lent) -> Self::Passed;
}

/// A struct of the contract, by a pointer to the one that C knows.
macro_rules! structs {
    ($($type:ty => $of:path: $in_c:ty),* $(,)?) => { $(
        impl Given for $type {
            type Passed = *const $in_c;
            type Lent = $in_c;

            fn lent(self, _: usize) -> $in_c {
                $of(self)
            }

            fn passed(lent: &$in_c) -> *const $in_c {
                ptr::from_ref(lent)
            }
        }
    )* };
}
structs! {
    &Camera => camera: abi::Camera,
    &IntegratorSettings => integrator: abi::Integrator,
    AdaptiveSettings => adaptive: abi::Adaptive,
}

/// A number.
macro_rules! numbers {
    ($($type:ty => $of:path: $in_c:ty),* $(,)?) => { $(
        impl Given for $type {
            type Passed = $in_c;
            type Lent = $in_c;

            fn lent(self, _: usize) -> $in_c {
                $of(self)
            }

            fn passed(lent: &$in_c) -> $in_c {
                *lent
            }
        }
    )* };
}
numbers! { u32 => u32::from: u32, f64 => f64::from: f64, Sampler => sampler: u32 }

impl Given for &Material {
    type Passed = *const abi::Material;
    /// With the name that it points to.
    type Lent = (abi::Material, CString);

    fn lent(self, _: usize) -> Self::Lent {
        let name = c_name(&self.name);
        (material(self, name.as_ptr()), name)
    }

    fn passed(lent: &Self::Lent) -> Self::Passed {
        ptr::from_ref(&lent.0)
    }
}

impl<T: Element> Given for &[T] {
    type Passed = *const T;
    type Lent = *const T;

    fn lent(self, count: usize) -> *const T {
        assert_eq!(self.len(), count, "slices of one batch have one length");
        self.as_ptr()
    }

    fn passed(lent: &*const T) -> *const T {
        *lent
    }
}

impl Given for Randomness<'_> {
    type Passed = *const abi::Randomness;
    type Lent = abi::Randomness;

    fn lent(self, count: usize) -> abi::Randomness {
        let (points, lobes) = (self.points.lent(count), self.lobes.lent(count));
        abi::Randomness { points, lobes, seed: self.seed }
    }

    fn passed(lent: &abi::Randomness) -> *const abi::Randomness {
        ptr::from_ref(lent)
    }
}

impl Given for &[&[f64]] {
    type Passed = *const abi::Stream;
    type Lent = Vec<abi::Stream>;

    fn lent(self, count: usize) -> Vec<abi::Stream> {
        assert_eq!(self.len(), count, "slices of one batch have one length");
        let stream =
            |values: &&[f64]| abi::Stream { values: values.as_ptr(), count: values.len() as u64 };
        self.iter().map(stream).collect()
    }

    fn passed(lent: &Vec<abi::Stream>) -> *const abi::Stream {
        lent.as_ptr()
    }
}

fn camera(camera: &Camera) -> abi::Camera {
    abi::Camera {
        struct_size: struct_size::<abi::Camera>(),
        reserved: 0,
        position: camera.position,
        right: camera.camera_to_world.x_axis,
        up: camera.camera_to_world.y_axis,
        backward: camera.camera_to_world.z_axis,
        horizontal_fov: camera.horizontal_fov,
        vertical_fov: camera.vertical_fov,
        near_clip: camera.near,
        far_clip: camera.far,
        film_width: camera.film[0],
        film_height: camera.film[1],
    }
}

fn material(material: &Material, name: *const c_char) -> abi::Material {
    let (kind, reflectance) = match material.surface {
        Surface::Diffuse { reflectance } => (abi::DIFFUSE, reflectance),
        Surface::Mirror { reflectance } => (abi::MIRROR, reflectance),
        Surface::Glass { reflectance, .. } => (abi::GLASS, reflectance),
        Surface::Conductor { reflectance, .. } => (abi::CONDUCTOR, reflectance),
        Surface::RoughGlass { reflectance, .. } => (abi::ROUGH_GLASS, reflectance),
    };
    let (index, transmittance) = match material.surface {
        Surface::Glass { index, transmittance, .. }
        | Surface::RoughGlass { index, transmittance, .. } => (index, transmittance),
        _ => (0.0, [0.0; 3]),
    };
    let roughness = match material.surface {
        Surface::Conductor { roughness, .. } | Surface::RoughGlass { roughness, .. } => roughness,
        _ => 0.0,
    };
    let cap = material.emission.and_then(|emission| emission.cap);
    abi::Material {
        name,
        kind,
        emits: u32::from(material.emission.is_some()),
        reflectance,
        transmittance,
        index,
        roughness,
        emission: material.emission.map_or([0.0; 3], |emission| emission.radiance),
        cap_axis: cap.map_or(DVec3::ZERO, |cap| cap.axis),
        cap_half_angle: cap.map_or(0.0, |cap| cap.half_angle),
        reserved: [0.0; 4],
    }
}

fn mesh(mesh: &Mesh, name: *const c_char) -> abi::Mesh {
    let has_normals = !mesh.normals.is_empty();
    abi::Mesh {
        name,
        positions: mesh.positions.as_ptr(),
        normals: if has_normals { mesh.normals.as_ptr() } else { ptr::null() },
        indices: mesh.indices.as_ptr(),
        vertex_count: count(mesh.positions.len()),
        triangle_count: count(mesh.indices.len()),
        material: mesh.material,
        reserved: 0,
    }
}

fn sphere(sphere: &Sphere, name: *const c_char) -> abi::Sphere {
    abi::Sphere {
        name,
        centre: sphere.centre,
        radius: sphere.radius,
        inward: u32::from(sphere.inward),
        material: sphere.material,
    }
}

fn light(light: &Light) -> abi::Light {
    const NONE: Rgb = [0.0; 3];
    let (kind, shape, place, radiance, zenith) = match *light {
        Light::Point { position, intensity } => (abi::POINT, 0, position, intensity, NONE),
        Light::Directional { direction, irradiance } => {
            (abi::DIRECTIONAL, 0, direction, irradiance, NONE)
        }
        Light::ConstantSky { radiance } => (abi::CONSTANT_SKY, 0, DVec3::ZERO, radiance, NONE),
        Light::GradientSky { up, horizon, zenith } => (abi::GRADIENT_SKY, 0, up, horizon, zenith),
        Light::Area { shape } => (abi::AREA, shape, DVec3::ZERO, NONE, NONE),
    };
    abi::Light { kind, shape, place, radiance, zenith, reserved: [0.0; 2] }
}

fn sampler(sampler: Sampler) -> u32 {
    match sampler {
        Sampler::UniformHemisphere => abi::UNIFORM_HEMISPHERE,
        Sampler::CosineHemisphere => abi::COSINE_HEMISPHERE,
    }
}

pub(crate) fn build(
    acceleration: Acceleration,
    counted: *const abi::CountedTests,
    bench: *mut abi::Built,
) -> abi::Build {
    let (accelerate, split, max_leaf_size) = match acceleration {
        Acceleration::BruteForce => (0, abi::SPLIT_CORES_CHOICE, 0),
        Acceleration::Bvh { split, max_leaf_size, .. } => (1, split_number(split), max_leaf_size),
    };
    let struct_size = struct_size::<abi::Build>();
    abi::Build { struct_size, accelerate, split, max_leaf_size, counted, bench }
}

fn split_number(split: Split) -> u32 {
    match split {
        Split::CoresChoice => abi::SPLIT_CORES_CHOICE,
        Split::Median => abi::SPLIT_MEDIAN,
        Split::MeanOfCentroids => abi::SPLIT_MEAN_OF_CENTROIDS,
        Split::Midpoint => abi::SPLIT_MIDPOINT,
        Split::SurfaceArea => abi::SPLIT_SURFACE_AREA,
    }
}

fn integrator(settings: &IntegratorSettings) -> abi::Integrator {
    let Roulette { stop, guaranteed } =
        settings.roulette.unwrap_or(Roulette { stop: 0.0, guaranteed: 0 });
    abi::Integrator {
        struct_size: struct_size::<abi::Integrator>(),
        samples_per_light: settings.samples_per_light,
        first_bounce: *settings.bounces.start(),
        last_bounce: *settings.bounces.end(),
        by_hemisphere: u32::from(settings.direct == DirectSampling::Hemisphere),
        threads: settings.threads,
        roulette_stop: stop,
        roulette_guaranteed: guaranteed,
        by_depth: u32::from(settings.by_depth),
        seed: settings.seed,
    }
}

fn adaptive(settings: AdaptiveSettings) -> abi::Adaptive {
    abi::Adaptive {
        struct_size: struct_size::<abi::Adaptive>(),
        samples_per_batch: settings.samples_per_batch,
        max_tolerance: settings.max_tolerance,
    }
}

/// How to render; points to the two others.
pub(crate) fn render(
    settings: &RenderSettings,
    integrator: &abi::Integrator,
    adaptive: Option<&abi::Adaptive>,
) -> abi::Render {
    abi::Render {
        struct_size: struct_size::<abi::Render>(),
        width: settings.width,
        height: settings.height,
        samples_per_pixel: settings.samples_per_pixel,
        integrator: ptr::from_ref(integrator),
        adaptive: adaptive.map_or(ptr::null(), ptr::from_ref),
        variances: ptr::null_mut(),
        stratified: settings.stratified.into(),
        reserved: 0,
    }
}
