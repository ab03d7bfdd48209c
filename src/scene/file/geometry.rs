//! What a shape can be: the keys of `[[shape]]` that make triangles or spheres.

use super::Context;
use super::exactly_one;
use crate::math::rng::Seed;
use crate::scene::mesh::{self, Format, MeshError};
use crate::scene::procedural::{self, Layout};
use crate::scene::{Mesh, Sphere};
use crate::text::{Between, Diagnostic, Direction, Positive, Spanned, Vector};
use glam::DVec3;
use serde::Deserialize;

/// Triangles or spheres, not yet placed and without name or material.
pub(super) enum Geometry {
    Mesh(Mesh),
    Spheres(Vec<Sphere>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Quad {
    corner: Option<Vector>,
    centre: Option<Vector>,
    edges: [Vector; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Block {
    min: Vector,
    max: Vector,
    #[serde(default)]
    inward: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Triangles {
    positions: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    #[serde(default)]
    normals: Vec<Direction>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Ball {
    #[serde(default)]
    centre: Vector,
    radius: Positive,
    #[serde(default)]
    inward: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Icosphere {
    #[serde(default)]
    centre: Vector,
    radius: Positive,
    subdivisions: Between<0, 9>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct BumpySphere {
    subdivisions: Between<0, 9>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Sphereflake {
    depth: Between<0, 6>,
    /// Icospheres of so many subdivisions instead of spheres.
    subdivisions: Option<Between<0, 4>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Teapot {
    segments: Between<1, 256>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Soup {
    triangles: Between<1, 10_000_000>,
    #[serde(default)]
    seed: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Pathological {
    layout: Layout,
    triangles: Between<1, 10_000_000>,
    #[serde(default)]
    seed: u32,
}

impl Quad {
    pub(crate) fn make(self) -> Result<Geometry, String> {
        let edges = self.edges.map(|edge| edge.0);
        if edges[0].cross(edges[1]) == DVec3::ZERO {
            return Err(
                "invalid quad: its edges must not be parallel, nor of zero length".to_owned()
            );
        }
        let from_centre = self.centre.map(|centre| centre.0 - (edges[0] + edges[1]) / 2.0);
        let corner = exactly_one(
            "the place of a quad",
            [("corner", self.corner.map(|corner| corner.0)), ("centre", from_centre)],
        )?;
        Ok(Geometry::Mesh(procedural::parallelogram(corner, edges)))
    }
}

impl Block {
    pub(crate) fn make(self) -> Result<Geometry, String> {
        let (min, max) = (self.min.0, self.max.0);
        if min.cmplt(max).all() {
            Ok(Geometry::Mesh(procedural::block(min, max, self.inward)))
        } else {
            Err("invalid box: every coordinate of `min` must be below that of `max`".to_owned())
        }
    }
}

impl Triangles {
    pub(crate) fn make(self) -> Result<Geometry, String> {
        let mesh = Mesh {
            positions: self.positions.into_iter().map(|position| position.0).collect(),
            normals: self.normals.into_iter().map(|normal| normal.0).collect(),
            indices: self.indices,
            ..Mesh::default()
        };
        mesh::check(&mesh).map_err(|problem: MeshError| problem.to_string())?;
        Ok(Geometry::Mesh(mesh))
    }
}

impl Ball {
    pub(crate) fn make(self) -> Geometry {
        Geometry::Spheres(vec![sphere(self.centre.0, self.radius.0, self.inward)])
    }
}

fn sphere(centre: DVec3, radius: f64, inward: bool) -> Sphere {
    Sphere { name: String::new(), centre, radius, inward, material: 0 }
}

impl Icosphere {
    pub(crate) fn make(self) -> Geometry {
        let mut mesh = procedural::icosphere(self.subdivisions.0);
        for position in &mut mesh.positions {
            *position = self.centre.0 + self.radius.0 * *position;
        }
        Geometry::Mesh(mesh)
    }
}

impl BumpySphere {
    pub(crate) fn make(self) -> Geometry {
        Geometry::Mesh(procedural::bumpy_sphere(self.subdivisions.0))
    }
}

impl Sphereflake {
    pub(crate) fn make(self) -> Geometry {
        match self.subdivisions {
            Some(Between(subdivisions)) => {
                Geometry::Mesh(procedural::sphereflake(self.depth.0, subdivisions))
            }
            None => {
                let spheres = procedural::sphereflake_spheres(self.depth.0);
                let place = |(centre, radius)| sphere(centre, radius, false);
                Geometry::Spheres(spheres.into_iter().map(place).collect())
            }
        }
    }
}

impl Teapot {
    pub(crate) fn make(self) -> Geometry {
        Geometry::Mesh(procedural::teapot(self.segments.0))
    }
}

impl Soup {
    pub(crate) fn make(self) -> Geometry {
        Geometry::Mesh(procedural::soup(self.triangles.0, seed(self.seed)))
    }
}

impl Pathological {
    pub(crate) fn make(self) -> Geometry {
        let mesh = procedural::pathological(self.layout, self.triangles.0, seed(self.seed));
        Geometry::Mesh(mesh)
    }
}

/// Seeds of scenes are their own: the suite's version does not move a triangle.
fn seed(number: u32) -> Seed {
    Seed(u64::from(number)).child("scene")
}

/// The mesh in a file named by the scene, relative to it.
pub(super) fn from_file(
    file: Spanned<String>,
    format: Format,
    context: &Context<'_>,
) -> Result<Geometry, Diagnostic> {
    let path = context.folder.join(file.get_ref());
    mesh::load(&path, format)
        .map(Geometry::Mesh)
        .map_err(|problem| context.wrong(file.span(), format!("`{}` {problem}", path.display())))
}
