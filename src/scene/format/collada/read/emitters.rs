//! From lights that are declared and surfaces that emit to lights that are both.

use super::Reading;
use super::light::{DeclaredLight, Kind};
use super::node::File;
use crate::scene::{Aabb, Emission, Light, Material, Mesh, SceneDescription, Surface};
use glam::DVec3;

/// A light this near to an emissive mesh, in diagonals of the mesh, lies in it.
const WITHIN: f64 = 0.01;

pub(super) fn resolve(name: &str, file: File, film: [u32; 2]) -> Reading {
    let mut scene = SceneDescription {
        name: name.to_owned(),
        camera: None,
        materials: file.materials,
        meshes: file.meshes,
        spheres: file.spheres,
        lights: Vec::new(),
    };
    // The course puts the box around the objects of the file, before there are lights.
    scene.camera = scene.bounds().map(|bounds| file.lens.place(&bounds, film));
    let mut differences = file.differences;
    for light in file.lights {
        differences.extend(add(&mut scene, light));
    }
    Reading { scene: scene.with_area_lights(), differences }
}

/// Adds a light, and says what is different about it.
fn add(scene: &mut SceneDescription, light: DeclaredLight) -> Option<String> {
    let DeclaredLight { name, colour, kind } = light;
    let at = match kind {
        Kind::Area { centre, .. } => Some(centre),
        Kind::Point { position } => Some(position),
        Kind::Directional { .. } | Kind::Ambient | Kind::Spot => None,
    };
    if let Some(mesh) = at.and_then(|position| emissive_mesh_at(scene, position)) {
        if let Kind::Area { direction, .. } = kind {
            face(mesh, direction);
        }
        let mesh = &mesh.name;
        return Some(format!(
            "light `{name}` lies in `{mesh}`: the emitter is `{mesh}`, as it is visible"
        ));
    }
    match kind {
        Kind::Area { centre, direction, sides } => {
            let material = scene.materials.len() as u32;
            scene.materials.push(emissive(&name, colour));
            scene.meshes.push(rectangle(&name, centre, direction, sides, material));
            Some(format!("light `{name}` has no surface in the course; here it is visible"))
        }
        Kind::Point { position } => {
            scene.lights.push(Light::Point { position, intensity: colour });
            None
        }
        Kind::Directional { direction } => {
            scene.lights.push(Light::Directional { direction, irradiance: colour });
            None
        }
        Kind::Ambient => Some(format!(
            "light `{name}` is a hemisphere light, which illuminates without being visible: left out"
        )),
        Kind::Spot => {
            Some(format!("light `{name}` is a spotlight, which the course leaves black: left out"))
        }
    }
}

fn emissive_mesh_at(scene: &mut SceneDescription, position: DVec3) -> Option<&mut Mesh> {
    let materials = &scene.materials;
    let emits = |mesh: &&mut Mesh| materials[mesh.material as usize].emission.is_some();
    scene.meshes.iter_mut().filter(emits).find(|mesh| {
        Aabb::around(mesh.positions.iter().copied()).is_some_and(|bounds| {
            let nearest = position.clamp(bounds.min, bounds.max);
            nearest.distance(position) <= WITHIN * bounds.diagonal()
        })
    })
}

/// Turns a mesh so that its front is where its light shines. Seen from both sides, as emissive surfaces of the course
/// are, it is the same mesh.
fn face(mesh: &mut Mesh, direction: DVec3) {
    let corners = |[a, b, c]: [u32; 3]| [a, b, c].map(|corner| mesh.positions[corner as usize]);
    let areas = mesh.indices.iter().map(|triangle| {
        let [a, b, c] = corners(*triangle);
        (b - a).cross(c - a)
    });
    if areas.sum::<DVec3>().dot(direction) < 0.0 {
        mesh.indices.iter_mut().for_each(|triangle| triangle.reverse());
        mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
    }
}

fn emissive(name: &str, radiance: [f64; 3]) -> Material {
    let surface = Surface::Diffuse { reflectance: [0.0; 3] };
    Material { name: name.to_owned(), surface, emission: Some(Emission { radiance, cap: None }) }
}

/// A rectangle of two triangles whose front is the side of `direction`.
fn rectangle(
    name: &str,
    centre: DVec3,
    direction: DVec3,
    sides: [DVec3; 2],
    material: u32,
) -> Mesh {
    let [mut x, mut y] = sides.map(|side| side / 2.0);
    if x.cross(y).dot(direction) < 0.0 {
        (x, y) = (y, x);
    }
    Mesh {
        name: name.to_owned(),
        positions: vec![centre - x - y, centre + x - y, centre + x + y, centre - x + y],
        normals: Vec::new(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        material,
    }
}
