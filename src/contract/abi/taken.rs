//! Structs of the boundary as the contract has them, where a core in Rust is asked through C.
//!
//! Not here: anything `unsafe`; who has followed the pointer hands over what it found.

use crate::contract::abi;
use crate::contract::{
    Acceleration, AdaptiveSettings, DirectSampling, IntegratorSettings, RenderSettings, Roulette,
    Sampler, Split,
};
use crate::scene::{Camera, Cap, Emission, Light, Material, Sphere, Surface};
use glam::DMat3;

/// A camera.
pub(crate) fn camera(camera: &abi::Camera) -> Camera {
    Camera {
        position: camera.position,
        camera_to_world: DMat3::from_cols(camera.right, camera.up, camera.backward),
        horizontal_fov: camera.horizontal_fov,
        vertical_fov: camera.vertical_fov,
        near: camera.near_clip,
        far: camera.far_clip,
        film: [camera.film_width, camera.film_height],
    }
}

/// A material; its name is the scene's business. None for a kind that nobody knows.
pub(crate) fn material(material: &abi::Material) -> Option<Material> {
    let abi::Material { reflectance, transmittance, index, roughness, .. } = *material;
    let surface = match material.kind {
        abi::DIFFUSE => Surface::Diffuse { reflectance },
        abi::MIRROR => Surface::Mirror { reflectance },
        abi::GLASS => Surface::Glass { index, reflectance, transmittance },
        abi::CONDUCTOR => Surface::Conductor { reflectance, roughness },
        abi::ROUGH_GLASS => Surface::RoughGlass { index, roughness, reflectance, transmittance },
        _ => return None,
    };
    let has_cap = material.cap_half_angle != 0.0;
    let cap = Cap { axis: material.cap_axis, half_angle: material.cap_half_angle };
    let emission = Emission { radiance: material.emission, cap: has_cap.then_some(cap) };
    let emission = (material.emits != 0).then_some(emission);
    Some(Material { name: String::new(), surface, emission })
}

/// A sphere without its name.
pub(crate) const fn sphere(sphere: &abi::Sphere) -> Sphere {
    let abi::Sphere { centre, radius, inward, material, .. } = *sphere;
    Sphere { name: String::new(), centre, radius, inward: inward != 0, material }
}

/// A light; none for a kind that nobody knows.
pub(crate) const fn light(light: &abi::Light) -> Option<Light> {
    let abi::Light { kind, shape, place, radiance, zenith, .. } = *light;
    Some(match kind {
        abi::POINT => Light::Point { position: place, intensity: radiance },
        abi::DIRECTIONAL => Light::Directional { direction: place, irradiance: radiance },
        abi::CONSTANT_SKY => Light::ConstantSky { radiance },
        abi::GRADIENT_SKY => Light::GradientSky { up: place, horizon: radiance, zenith },
        abi::AREA => Light::Area { shape },
        _ => return None,
    })
}

/// What is to be built; none for a rule that nobody knows.
pub(crate) const fn acceleration(settings: &abi::Build) -> Option<Acceleration> {
    if settings.accelerate == 0 {
        return Some(Acceleration::BruteForce);
    }
    let split = match settings.split {
        abi::SPLIT_CORES_CHOICE => Split::CoresChoice,
        abi::SPLIT_MEDIAN => Split::Median,
        abi::SPLIT_MEAN_OF_CENTROIDS => Split::MeanOfCentroids,
        abi::SPLIT_MIDPOINT => Split::Midpoint,
        abi::SPLIT_SURFACE_AREA => Split::SurfaceArea,
        _ => return None,
    };
    let (max_leaf_size, counted) = (settings.max_leaf_size, !settings.counted.is_null());
    Some(Acceleration::Bvh { split, max_leaf_size, counted })
}

/// How to render, with the two structs that it points to.
pub(crate) fn render(
    settings: &abi::Render,
    integrated: &abi::Integrator,
    adapted: Option<&abi::Adaptive>,
) -> RenderSettings {
    RenderSettings {
        width: settings.width,
        height: settings.height,
        samples_per_pixel: settings.samples_per_pixel,
        integrator: integrator(integrated),
        adaptive: adapted.map(adaptive),
        stratified: settings.stratified != 0,
    }
}

/// Which sampler of directions; none for a number that has no name.
pub(crate) fn sampler(number: u32) -> Option<Sampler> {
    match number {
        abi::UNIFORM_HEMISPHERE => Some(Sampler::UniformHemisphere),
        abi::COSINE_HEMISPHERE => Some(Sampler::CosineHemisphere),
        _ => None,
    }
}

/// How a path is traced.
pub(crate) fn integrator(settings: &abi::Integrator) -> IntegratorSettings {
    let roulette =
        Roulette { stop: settings.roulette_stop, guaranteed: settings.roulette_guaranteed };
    IntegratorSettings {
        samples_per_light: settings.samples_per_light,
        bounces: settings.first_bounce..=settings.last_bounce,
        by_depth: settings.by_depth != 0,
        direct: match settings.by_hemisphere {
            0 => DirectSampling::Lights,
            _ => DirectSampling::Hemisphere,
        },
        roulette: (roulette.stop > 0.0).then_some(roulette),
        seed: settings.seed,
        threads: settings.threads,
    }
}

/// When a pixel has enough samples.
pub(crate) const fn adaptive(settings: &abi::Adaptive) -> AdaptiveSettings {
    AdaptiveSettings {
        samples_per_batch: settings.samples_per_batch,
        max_tolerance: settings.max_tolerance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::abi::given::Given;
    use glam::DVec3;

    #[test]
    fn what_is_given_comes_back() {
        let there = Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::Z, 1.0, [20, 14]);
        assert_eq!(camera(&(&there).lent(1)), there);
        let settings = IntegratorSettings {
            bounces: 1..=4,
            by_depth: true,
            direct: DirectSampling::Hemisphere,
            roulette: Some(Roulette { stop: 0.25, guaranteed: 2 }),
            seed: 7,
            ..Default::default()
        };
        assert_eq!(integrator(&(&settings).lent(1)), settings);
        assert_eq!(adaptive(&AdaptiveSettings::default().lent(1)), AdaptiveSettings::default());
        let (reflectance, transmittance) = ([0.1, 0.2, 0.3], [0.4, 0.5, 0.6]);
        let glass = Surface::RoughGlass { index: 1.5, roughness: 0.3, reflectance, transmittance };
        let frosted = Material { name: String::new(), surface: glass, emission: None };
        let (in_c, _name) = (&frosted).lent(1);
        assert_eq!(material(&in_c), Some(frosted));
        assert_eq!(material(&abi::Material { kind: 99, ..in_c }), None);
    }
}
