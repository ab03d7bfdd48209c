//! Scenes that are brighter, larger, or lit by one light alone.

use crate::scene::{Light, SceneDescription};

/// A power of two, so that doubling commutes with every rounding.
pub(super) const BRIGHTER: f64 = 2.0;

/// The scene with every light [`BRIGHTER`].
pub(super) fn brightened(scene: &SceneDescription) -> SceneDescription {
    let mut scene = scene.clone();
    let brighter = |rgb: &mut [f64; 3]| rgb.iter_mut().for_each(|value| *value *= BRIGHTER);
    for emission in scene.materials.iter_mut().filter_map(|material| material.emission.as_mut()) {
        brighter(&mut emission.radiance);
    }
    for light in &mut scene.lights {
        match light {
            Light::Point { intensity, .. } => brighter(intensity),
            Light::Directional { irradiance, .. } => brighter(irradiance),
            Light::ConstantSky { radiance } => brighter(radiance),
            Light::GradientSky { horizon, zenith, .. } => {
                brighter(horizon);
                brighter(zenith);
            }
            Light::Area { .. } => {}
        }
    }
    scene
}

/// The scene with light number `kept` alone; the shapes of the others stay, dark.
pub(super) fn only(scene: &SceneDescription, kept: usize) -> SceneDescription {
    let mut scene = scene.clone();
    let light = scene.lights[kept];
    let emissive = match light {
        Light::Area { shape } => Some(shape),
        _ => None,
    };
    for shape in 0..scene.shape_count() as u32 {
        if emissive != Some(shape) {
            darken(&mut scene, shape);
        }
    }
    scene.lights = if emissive.is_some() { Vec::new() } else { vec![light] };
    scene.with_area_lights()
}

/// The scene with this light alone, and no emission.
pub(crate) fn lit_by(scene: &SceneDescription, light: Light) -> SceneDescription {
    let mut scene = SceneDescription { lights: vec![light], ..scene.clone() };
    scene.materials.iter_mut().for_each(|material| material.emission = None);
    scene
}

/// Gives a shape a copy of its material that does not emit.
fn darken(scene: &mut SceneDescription, shape: u32) {
    let mut material = scene.material_of(shape).clone();
    if material.emission.take().is_none() {
        return;
    }
    let number = scene.materials.len() as u32;
    scene.materials.push(material);
    let shape = shape as usize;
    match shape.checked_sub(scene.meshes.len()) {
        None => scene.meshes[shape].material = number,
        Some(sphere) => scene.spheres[sphere].material = number,
    }
}

/// The scene so many times as large; a point light needs that much squared to light it as before.
pub(super) fn scaled(scene: &SceneDescription, factor: f64) -> SceneDescription {
    let mut scene = scene.clone();
    for position in scene.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *position *= factor;
    }
    for sphere in &mut scene.spheres {
        sphere.centre *= factor;
        sphere.radius *= factor;
    }
    for light in &mut scene.lights {
        if let Light::Point { position, intensity } = light {
            *position *= factor;
            intensity.iter_mut().for_each(|value| *value *= factor * factor);
        }
    }
    scene
}
