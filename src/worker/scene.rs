//! A scene as a header and five arrays, and back.

use super::frame::FrameError;
use super::message::{MeshHeader, SceneHeader, Sent};
use super::serve::Arrays;
use crate::scene::{Mesh, SceneDescription, Sphere};
use glam::DVec3;

/// The long lists of a scene, one after another.
#[derive(Debug, Default)]
pub struct SceneArrays {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    indices: Vec<[u32; 3]>,
    spheres: Vec<[f64; 4]>,
    sphere_kinds: Vec<[u32; 2]>,
}

impl SceneArrays {
    /// Of `scene`.
    pub fn new(scene: &SceneDescription) -> Self {
        let sphere = |s: &Sphere| [s.centre.x, s.centre.y, s.centre.z, s.radius];
        let kind = |s: &Sphere| [u32::from(s.inward), s.material];
        Self {
            positions: scene.meshes.iter().flat_map(|mesh| mesh.positions.clone()).collect(),
            normals: scene.meshes.iter().flat_map(|mesh| mesh.normals.clone()).collect(),
            indices: scene.meshes.iter().flat_map(|mesh| mesh.indices.clone()).collect(),
            spheres: scene.spheres.iter().map(sphere).collect(),
            sphere_kinds: scene.spheres.iter().map(kind).collect(),
        }
    }

    /// As they are sent.
    pub fn sent(&self) -> [Sent<'_>; 5] {
        [
            Sent::new("positions", &self.positions),
            Sent::new("normals", &self.normals),
            Sent::new("indices", &self.indices),
            Sent::new("spheres", &self.spheres),
            Sent::new("sphere-kinds", &self.sphere_kinds),
        ]
    }
}

/// What the arrays do not say of `scene`.
pub fn header(scene: &SceneDescription) -> SceneHeader {
    let mesh = |mesh: &Mesh| MeshHeader {
        name: mesh.name.clone(),
        material: mesh.material,
        vertices: mesh.positions.len() as u64,
        smooth: !mesh.normals.is_empty(),
        triangles: mesh.indices.len() as u64,
    };
    SceneHeader {
        name: scene.name.clone(),
        camera: scene.camera,
        materials: scene.materials.clone(),
        meshes: scene.meshes.iter().map(mesh).collect(),
        spheres: scene.spheres.iter().map(|sphere| sphere.name.clone()).collect(),
        lights: scene.lights.clone(),
    }
}

/// The scene that was sent.
///
/// # Errors
/// If the arrays are not what the header says.
pub fn decode(
    header: SceneHeader,
    arrays: &mut Arrays<'_>,
) -> Result<SceneDescription, FrameError> {
    let mut positions = arrays.take::<DVec3>("positions")?;
    let mut normals = arrays.take::<DVec3>("normals")?;
    let mut indices = arrays.take::<[u32; 3]>("indices")?;
    let spheres = arrays.take::<[f64; 4]>("spheres")?;
    let kinds = arrays.take::<[u32; 2]>("sphere-kinds")?;
    let mesh = |mesh: MeshHeader| {
        Ok(Mesh {
            name: mesh.name,
            positions: split(&mut positions, mesh.vertices)?,
            normals: split(&mut normals, if mesh.smooth { mesh.vertices } else { 0 })?,
            indices: split(&mut indices, mesh.triangles)?,
            material: mesh.material,
        })
    };
    let meshes = header.meshes.into_iter().map(mesh).collect::<Result<_, FrameError>>()?;
    let names = header.spheres.into_iter().zip(spheres).zip(kinds);
    let sphere = |((name, shape), kind): ((String, &[f64; 4]), &[u32; 2])| Sphere {
        name,
        centre: DVec3::new(shape[0], shape[1], shape[2]),
        radius: shape[3],
        inward: kind[0] == 1,
        material: kind[1],
    };
    Ok(SceneDescription {
        name: header.name,
        camera: header.camera,
        materials: header.materials,
        meshes,
        spheres: names.map(sphere).collect(),
        lights: header.lights,
    })
}

/// The next `count` elements of a list that holds those of all meshes.
fn split<T: Clone>(elements: &mut &[T], count: u64) -> Result<Vec<T>, FrameError> {
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    let too_few = || FrameError::Malformed("a mesh has more than its arrays hold".to_owned());
    let (first, rest) = elements.split_at_checked(count).ok_or_else(too_few)?;
    *elements = rest;
    Ok(first.to_vec())
}
