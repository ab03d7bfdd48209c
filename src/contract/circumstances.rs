//! What a core was asked with: what is in the scenes that it built, and the settings of its integrator. Where a core fails
//! says what is wrong, where other circumstances pass.

use super::names::by_names;
use super::{DirectSampling, IntegratorSettings, RenderSettings};
use crate::scene::{Light, Material, SceneDescription, Shape, Surface};
use bitflags::bitflags;

bitflags! {
    /// What there was at least once.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Circumstances: u32 {
        /// An area light of triangles.
        const MESH_LIGHT = 1 << 0;
        /// A sphere that emits.
        const SPHERE_LIGHT = 1 << 1;
        /// A point light.
        const POINT_LIGHT = 1 << 2;
        /// A directional light.
        const DIRECTIONAL_LIGHT = 1 << 3;
        /// An environment of one radiance.
        const CONSTANT_SKY = 1 << 4;
        /// An environment that changes with height.
        const GRADIENT_SKY = 1 << 5;
        /// More than one light.
        const SEVERAL_LIGHTS = 1 << 6;
        /// A cap of a sphere that emits.
        const CAP = 1 << 7;
        /// A mirror.
        const MIRROR = 1 << 8;
        /// Smooth glass.
        const GLASS = 1 << 9;
        /// Rough metal.
        const METAL = 1 << 10;
        /// Rough glass.
        const ROUGH_GLASS = 1 << 11;
        /// A mesh with normals of its vertices.
        const SMOOTH_NORMALS = 1 << 12;
        /// A sphere.
        const SPHERE = 1 << 13;
        /// More than one shape.
        const SEVERAL_SHAPES = 1 << 14;
        /// More than one sample of a light.
        const SEVERAL_SAMPLES = 1 << 15;
        /// Direct light by directions of the hemisphere.
        const HEMISPHERE_SAMPLING = 1 << 16;
        /// Paths that end by Russian roulette.
        const ROULETTE = 1 << 17;
        /// Bounces without those before them.
        const ISOLATED_BOUNCES = 1 << 18;
        /// Light that is scattered twice or more.
        const INDIRECT_LIGHT = 1 << 19;
        /// Pixels that stop when they are known.
        const ADAPTIVE = 1 << 20;
        /// More than one sample of a pixel.
        const SEVERAL_PIXEL_SAMPLES = 1 << 21;
        /// A picture, pixel by pixel.
        const PICTURE = 1 << 22;
        /// A diffuse surface.
        const DIFFUSE = 1 << 23;
        /// Radiance along rays, or of pixels.
        const RADIANCE = 1 << 24;
    }
}
by_names! { Circumstances, "circumstance" }

impl Circumstances {
    /// One of them, as it goes on after `with`: `several lights`.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::MESH_LIGHT => "mesh lights",
            Self::SPHERE_LIGHT => "sphere lights",
            Self::POINT_LIGHT => "point lights",
            Self::DIRECTIONAL_LIGHT => "directional lights",
            Self::CONSTANT_SKY => "a constant environment",
            Self::GRADIENT_SKY => "an environment of several radiances",
            Self::SEVERAL_LIGHTS => "several lights",
            Self::CAP => "sphere lights of which a cap emits",
            Self::MIRROR => "mirrors",
            Self::GLASS => "smooth glass",
            Self::METAL => "rough metal",
            Self::ROUGH_GLASS => "rough glass",
            Self::SMOOTH_NORMALS => "interpolated normals",
            Self::SPHERE => "spheres",
            Self::SEVERAL_SHAPES => "several shapes",
            Self::SEVERAL_SAMPLES => "several samples a light",
            Self::HEMISPHERE_SAMPLING => "hemisphere sampling",
            Self::ROULETTE => "Russian roulette",
            Self::ISOLATED_BOUNCES => "isolated bounces",
            Self::INDIRECT_LIGHT => "light of two bounces or more",
            Self::ADAPTIVE => "adaptive sampling",
            Self::SEVERAL_PIXEL_SAMPLES => "several samples a pixel",
            Self::PICTURE => "rendered images",
            Self::RADIANCE => "radiance",
            _ => "diffuse surfaces",
        }
    }

    pub(super) fn of_scene(scene: &SceneDescription) -> Self {
        let surfaces = scene.materials.iter().map(of_surface);
        let is_there = |light: &&Light| match light {
            Light::Area { shape } => (*shape as usize) < scene.shape_count(),
            _ => true,
        };
        let lights = scene.lights.iter().filter(is_there).map(|light| of_light(scene, light));
        let several = [
            (scene.meshes.iter().any(|mesh| !mesh.normals.is_empty()), Self::SMOOTH_NORMALS),
            (!scene.spheres.is_empty(), Self::SPHERE),
            (scene.shape_count() > 1, Self::SEVERAL_SHAPES),
            (scene.lights.len() > 1, Self::SEVERAL_LIGHTS),
        ];
        surfaces.chain(lights).chain(those(several)).collect()
    }

    pub(super) fn of_path(settings: &IntegratorSettings) -> Self {
        let those_of_path = [
            (true, Self::RADIANCE),
            (settings.samples_per_light > 1, Self::SEVERAL_SAMPLES),
            (settings.direct == DirectSampling::Hemisphere, Self::HEMISPHERE_SAMPLING),
            (settings.roulette.is_some(), Self::ROULETTE),
            (*settings.bounces.start() > 0, Self::ISOLATED_BOUNCES),
            (*settings.bounces.end() > 1, Self::INDIRECT_LIGHT),
        ];
        those(those_of_path).collect()
    }

    pub(super) fn of_picture(settings: &RenderSettings) -> Self {
        let of_pixels = [
            (true, Self::PICTURE),
            (settings.adaptive.is_some(), Self::ADAPTIVE),
            (settings.samples_per_pixel > 1, Self::SEVERAL_PIXEL_SAMPLES),
        ];
        Self::of_path(&settings.integrator) | those(of_pixels).collect()
    }
}

fn those<const N: usize>(all: [(bool, Circumstances); N]) -> impl Iterator<Item = Circumstances> {
    all.into_iter().filter(|(is_so, _)| *is_so).map(|(_, one)| one)
}

fn of_surface(material: &Material) -> Circumstances {
    let is_cap = material.emission.is_some_and(|emission| emission.cap.is_some());
    let scatters = match material.surface {
        Surface::Diffuse { .. } => Circumstances::DIFFUSE,
        Surface::Mirror { .. } => Circumstances::MIRROR,
        Surface::Glass { .. } => Circumstances::GLASS,
        Surface::Conductor { .. } => Circumstances::METAL,
        Surface::RoughGlass { .. } => Circumstances::ROUGH_GLASS,
    };
    if is_cap { scatters | Circumstances::CAP } else { scatters }
}

fn of_light(scene: &SceneDescription, light: &Light) -> Circumstances {
    match light {
        Light::Point { .. } => Circumstances::POINT_LIGHT,
        Light::Directional { .. } => Circumstances::DIRECTIONAL_LIGHT,
        Light::ConstantSky { .. } => Circumstances::CONSTANT_SKY,
        Light::GradientSky { .. } => Circumstances::GRADIENT_SKY,
        Light::Area { shape } => match scene.shape(*shape) {
            Shape::Mesh(_) => Circumstances::MESH_LIGHT,
            Shape::Sphere(_) => Circumstances::SPHERE_LIGHT,
        },
    }
}
