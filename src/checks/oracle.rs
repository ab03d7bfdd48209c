//! What a ray meets in a scene: a loop over everything in double precision, as the third witness
//! between a core and a check.

use super::shape::{Answer, intersection};
use crate::contract::{Primitive, Ray};
use crate::scene::{SceneDescription, Shape};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Met {
    /// Number of the shape in the scene.
    pub(crate) shape: u32,
    /// Number of the triangle in its mesh, 0 for a sphere.
    pub(crate) primitive: u32,
    /// Where, and the normals there; those of an inward sphere point inward.
    pub(crate) answer: Answer,
}

pub(crate) fn nearest(scene: &SceneDescription, ray: &Ray) -> Option<Met> {
    let mut ray = *ray;
    let mut met = None;
    for (shape, primitive, geometry) in primitives(scene) {
        if let Some(answer) = intersection(&geometry, &ray) {
            ray.t_max = answer.t;
            met = Some(Met { shape, primitive, answer: facing(scene, shape, answer) });
        }
    }
    met
}

/// Every primitive with the numbers of its shape and of itself.
fn primitives(scene: &SceneDescription) -> impl Iterator<Item = (u32, u32, Primitive)> + '_ {
    (0..scene.shape_count() as u32).flat_map(move |shape| {
        let count = match scene.shape(shape) {
            Shape::Mesh(mesh) => mesh.indices.len(),
            Shape::Sphere(_) => 1,
        };
        (0..count).map(move |number| (shape, number as u32, primitive(scene, shape, number)))
    })
}

fn primitive(scene: &SceneDescription, shape: u32, number: usize) -> Primitive {
    match scene.shape(shape) {
        Shape::Mesh(mesh) => Primitive::Triangle {
            positions: mesh.corners(number),
            normals: mesh.corner_normals(number),
        },
        Shape::Sphere(sphere) => Primitive::Sphere { centre: sphere.centre, radius: sphere.radius },
    }
}

fn facing(scene: &SceneDescription, shape: u32, answer: Answer) -> Answer {
    match scene.shape(shape) {
        Shape::Sphere(sphere) if sphere.inward => answer.turned(-1.0),
        _ => answer,
    }
}
