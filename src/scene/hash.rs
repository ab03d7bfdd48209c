//! The content hash that references are pinned to: a change of anything that changes the image changes it, and nothing
//! else does. Names, comments, the order of materials and materials without use do not count.

use super::{Camera, Cap, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface};
use crate::text::hexadecimal;
use glam::DVec3;
use sha2::{Digest, Sha256};

/// Says how the bytes below are laid out; a new layout gets a new number.
const LAYOUT: &[u8] = b"furnace scene 1";

/// SHA-256 of a scene in a canonical form, in hexadecimal.
///
/// Numbers count as single precision, and as zero below 2⁻⁴⁰: sine and cosine may differ between
/// machines in their last bit, and an image does not show it.
pub(crate) fn content_hash(scene: &SceneDescription) -> String {
    let mut content = Content(Sha256::new_with_prefix(LAYOUT));
    content.camera(scene.camera.as_ref());
    content.count(scene.meshes.len());
    for mesh in &scene.meshes {
        content.mesh(mesh);
        content.material(&scene.materials[mesh.material as usize]);
    }
    content.count(scene.spheres.len());
    for sphere in &scene.spheres {
        content.sphere(sphere);
        content.material(&scene.materials[sphere.material as usize]);
    }
    content.count(scene.lights.len());
    scene.lights.iter().for_each(|light| content.light(light));
    hexadecimal(content.0)
}

/// Takes in values one after another. Every list is preceded by its length and every choice by its
/// number, so that no two scenes have the same bytes.
struct Content(Sha256);

impl Content {
    fn number(&mut self, number: f64) {
        let tiny = number.abs() < 1.0 / (1u64 << 40) as f64;
        #[expect(clippy::cast_possible_truncation, reason = "meant: see content_hash")]
        let single = if tiny { 0.0 } else { number as f32 };
        self.0.update(single.to_le_bytes());
    }

    fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        numbers.into_iter().for_each(|number| self.number(number));
    }

    fn count(&mut self, count: usize) {
        self.0.update((count as u64).to_le_bytes());
    }

    fn choice(&mut self, choice: u8) {
        self.0.update([choice]);
    }

    fn points(&mut self, points: &[DVec3]) {
        self.count(points.len());
        points.iter().for_each(|point| self.numbers(point.to_array()));
    }

    fn camera(&mut self, camera: Option<&Camera>) {
        self.choice(u8::from(camera.is_some()));
        let Some(camera) = camera else { return };
        self.numbers(camera.position.to_array());
        self.numbers(camera.camera_to_world.to_cols_array());
        self.numbers([camera.horizontal_fov, camera.vertical_fov, camera.near, camera.far]);
        camera.film.iter().for_each(|pixels| self.0.update(pixels.to_le_bytes()));
    }

    fn mesh(&mut self, mesh: &Mesh) {
        self.points(&mesh.positions);
        self.points(&mesh.normals);
        self.count(mesh.indices.len());
        mesh.indices.as_flattened().iter().for_each(|index| self.0.update(index.to_le_bytes()));
    }

    fn sphere(&mut self, sphere: &Sphere) {
        self.numbers(sphere.centre.to_array());
        self.number(sphere.radius);
        self.choice(u8::from(sphere.inward));
    }

    fn material(&mut self, material: &Material) {
        match material.surface {
            Surface::Diffuse { reflectance } => self.choice_of_colours(0, [reflectance]),
            Surface::Mirror { reflectance } => self.choice_of_colours(1, [reflectance]),
            Surface::Glass { index, reflectance, transmittance } => {
                self.choice_of_colours(2, [reflectance, transmittance]);
                self.number(index);
            }
            Surface::Conductor { reflectance, roughness } => {
                self.choice_of_colours(3, [reflectance]);
                self.number(roughness);
            }
            Surface::RoughGlass { index, roughness, reflectance, transmittance } => {
                self.choice_of_colours(4, [reflectance, transmittance]);
                self.numbers([index, roughness]);
            }
        }
        self.choice(u8::from(material.emission.is_some()));
        if let Some(emission) = material.emission {
            self.numbers(emission.radiance);
            self.cap(emission.cap);
        }
    }

    fn choice_of_colours<const N: usize>(&mut self, choice: u8, colours: [Rgb; N]) {
        self.choice(choice);
        colours.into_iter().for_each(|colour| self.numbers(colour));
    }

    fn cap(&mut self, cap: Option<Cap>) {
        self.choice(u8::from(cap.is_some()));
        if let Some(Cap { axis, half_angle }) = cap {
            self.numbers(axis.to_array());
            self.number(half_angle);
        }
    }

    fn light(&mut self, light: &Light) {
        match *light {
            Light::Point { position, intensity } => {
                self.choice_of_colours(0, [position.to_array(), intensity]);
            }
            Light::Directional { direction, irradiance } => {
                self.choice_of_colours(1, [direction.to_array(), irradiance]);
            }
            Light::ConstantSky { radiance } => self.choice_of_colours(2, [radiance]),
            Light::GradientSky { up, horizon, zenith } => {
                self.choice_of_colours(3, [up.to_array(), horizon, zenith]);
            }
            Light::Area { shape } => {
                self.choice(4);
                self.0.update(shape.to_le_bytes());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Emission, procedural};

    fn scene() -> SceneDescription {
        let material =
            |name: &str, surface, emission| Material { name: name.to_owned(), surface, emission };
        let cap = Some(Cap { axis: DVec3::Z, half_angle: 0.5 });
        let emission = Some(Emission { radiance: [1.0; 3], cap });
        let grey = Surface::Diffuse { reflectance: [0.5; 3] };
        let rough = Surface::Conductor { reflectance: [0.9; 3], roughness: 0.2 };
        let sphere = Sphere {
            name: "ball".to_owned(),
            centre: DVec3::X,
            radius: 1.0,
            inward: false,
            material: 0,
        };
        SceneDescription {
            name: "scene".to_owned(),
            camera: Some(Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0, [32, 32])),
            materials: vec![material("glow", grey, emission), material("rough", rough, None)],
            meshes: vec![Mesh { material: 1, ..procedural::icosphere(0) }],
            spheres: vec![sphere],
            lights: vec![Light::ConstantSky { radiance: [1.0; 3] }],
        }
        .with_area_lights()
    }

    fn hash_after(change: fn(&mut SceneDescription)) -> String {
        let mut changed = scene();
        change(&mut changed);
        content_hash(&changed)
    }

    #[test]
    fn everything_that_shows_counts() {
        const fn frosted(roughness: f64, transmittance: f64) -> Surface {
            let (index, reflectance, transmittance) = (1.5, [0.9; 3], [transmittance; 3]);
            Surface::RoughGlass { index, roughness, reflectance, transmittance }
        }
        let changes: [fn(&mut SceneDescription); 19] = [
            |scene| scene.camera = None,
            |scene| scene.camera.as_mut().unwrap().position.x = 1e-6,
            |scene| scene.camera.as_mut().unwrap().horizontal_fov = 0.9,
            |scene| scene.camera.as_mut().unwrap().film[1] = 33,
            |scene| scene.meshes[0].positions[3].y += 1e-6,
            |scene| scene.meshes[0].indices.swap(0, 1),
            |scene| scene.meshes[0].normals = procedural::icosphere(0).positions,
            |scene| scene.meshes[0].material = 0,
            |scene| scene.spheres[0].inward = true,
            |scene| scene.spheres[0].radius = 1.000_001,
            |scene| scene.materials[0].surface = Surface::Mirror { reflectance: [0.5; 3] },
            |scene| scene.materials[0].emission.as_mut().unwrap().radiance[2] = 1.1,
            |scene| scene.materials[0].emission.as_mut().unwrap().cap = None,
            |scene| {
                scene.materials[1].surface =
                    Surface::Conductor { reflectance: [0.9; 3], roughness: 0.21 };
            },
            |scene| scene.materials[1].surface = frosted(0.2, 0.9),
            |scene| scene.materials[1].surface = frosted(0.21, 0.9),
            |scene| scene.materials[1].surface = frosted(0.2, 0.8),
            |scene| scene.lights[0] = Light::ConstantSky { radiance: [1.0, 1.0, 1.1] },
            |scene| scene.lights.clear(),
        ];
        let mut hashes: Vec<String> = changes.into_iter().map(hash_after).collect();
        hashes.push(content_hash(&scene()));
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), changes.len() + 1);
    }

    #[test]
    fn names_and_numbering_do_not_count() {
        let changes: [fn(&mut SceneDescription); 4] = [
            |scene| scene.name = "another".to_owned(),
            |scene| scene.spheres[0].name = "another".to_owned(),
            |scene| scene.materials.push(scene.materials[0].clone()),
            |scene| {
                scene.materials.swap(0, 1);
                (scene.meshes[0].material, scene.spheres[0].material) = (0, 1);
            },
        ];
        for change in changes {
            assert_eq!(hash_after(change), content_hash(&scene()));
        }
    }

    #[test]
    fn the_last_bit_of_a_double_does_not_count() {
        let nudged = hash_after(|scene| scene.spheres[0].centre = DVec3::new(1.0, 1e-16, -0.0));
        assert_eq!(nudged, content_hash(&scene()));
    }

    #[test]
    fn the_layout_is_pinned() {
        // `printf 'furnace scene 1' | cat - 25-zero-bytes | sha256sum`. Every stored reference
        // carries such a hash: if this changes, so must LAYOUT.
        let empty = content_hash(&SceneDescription::default());
        assert_eq!(empty, "97d166d917b8faaca5242cd92ae116681def66a034d5b687fd03f790c17579c8");
    }
}
