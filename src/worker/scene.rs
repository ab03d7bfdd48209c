//! A scene as a request with five arrays, and back.

use super::frame::FrameError;
use super::message::{MeshHeader, Received, Request, SceneHeader, Sent};
use crate::contract::Acceleration;
use crate::scene::{Mesh, SceneDescription, Sphere};
use glam::DVec3;

/// The request to build `scene`: what the arrays do not say of it, and its long lists, one after another.
pub fn build_request(scene: &SceneDescription, acceleration: Acceleration) -> Request<'static> {
    let sphere = |s: &Sphere| [s.centre.x, s.centre.y, s.centre.z, s.radius];
    let kind = |s: &Sphere| [u32::from(s.inward), s.material];
    Request::new("build")
        .with("scene", header(scene))
        .with("acceleration", acceleration)
        .with_array(Sent::made("positions", &all(&scene.meshes, |mesh| &mesh.positions)))
        .with_array(Sent::made("normals", &all(&scene.meshes, |mesh| &mesh.normals)))
        .with_array(Sent::made("indices", &all(&scene.meshes, |mesh| &mesh.indices)))
        .with_array(Sent::made("spheres", &scene.spheres.iter().map(sphere).collect::<Vec<_>>()))
        .with_array(Sent::made("sphere-kinds", &scene.spheres.iter().map(kind).collect::<Vec<_>>()))
}

fn all<T: Clone>(meshes: &[Mesh], list: impl Fn(&Mesh) -> &Vec<T>) -> Vec<T> {
    meshes.iter().flat_map(|mesh| list(mesh).iter().cloned()).collect()
}

fn header(scene: &SceneDescription) -> SceneHeader {
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

/// The scene that was sent. Fails if the arrays are not what the header says.
pub(crate) fn decode(received: &mut Received<'_>) -> Result<SceneDescription, FrameError> {
    let header: SceneHeader = received.member("scene")?;
    let mut positions = received.take::<DVec3>("positions")?;
    let mut normals = received.take::<DVec3>("normals")?;
    let mut indices = received.take::<[u32; 3]>("indices")?;
    let spheres = received.take::<[f64; 4]>("spheres")?;
    let kinds = received.take::<[u32; 2]>("sphere-kinds")?;
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
