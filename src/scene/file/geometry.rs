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

tables! {
    pub(super) struct Quad {
        /// Where both edges begin; or `centre`.
        corner: Option<Vector>,
        centre: Option<Vector>,
        /// The normal is their cross product.
        edges: [Vector; 2],
    }
    pub(super) struct Block {
        min: Vector,
        max: Vector,
        /// Whether normals point into it.
        #[serde(default)] inward: bool,
    }
    pub(super) struct Triangles {
        positions: Vec<Vector>,
        /// The vertices of each triangle, counterclockwise where its normal faces the viewer.
        indices: Vec<[u32; 3]>,
        /// One for each vertex.
        #[serde(default)] normals: Vec<Direction>,
    }
    pub(super) struct SphereTable {
        #[serde(default)] centre: Vector,
        radius: Positive,
        /// Whether normals point into it.
        #[serde(default)] inward: bool,
    }
    pub(super) struct Icosphere {
        #[serde(default)] centre: Vector,
        radius: Positive,
        subdivisions: Between<0, 9>,
    }
    pub(super) struct BumpySphere { subdivisions: Between<0, 9> }
    pub(super) struct Sphereflake {
        depth: Between<0, 6>,
        /// Icospheres of so many subdivisions instead of spheres.
        subdivisions: Option<Between<0, 4>>,
    }
    pub(super) struct Teapot {
        /// Of each patch along either side.
        segments: Between<1, 256>,
    }
    pub(super) struct Soup { triangles: Between<1, 10_000_000>, #[serde(default)] seed: u32 }
    pub(super) struct Pathological {
        layout: Layout,
        triangles: Between<1, 10_000_000>,
        #[serde(default)] seed: u32,
    }
}

impl Geometry {
    pub(super) fn quad(Quad { corner, centre, edges }: Quad) -> Result<Self, String> {
        let edges = edges.map(|edge| edge.0);
        if edges[0].cross(edges[1]) == DVec3::ZERO {
            return Err(
                "invalid quad: its edges must not be parallel, nor of zero length".to_owned()
            );
        }
        let from_centre = centre.map(|centre| centre.0 - (edges[0] + edges[1]) / 2.0);
        let places = [("corner", corner.map(|corner| corner.0)), ("centre", from_centre)];
        let corner = exactly_one("the place of a quad", places)?;
        Ok(Self::Mesh(procedural::parallelogram(corner, edges)))
    }

    pub(super) fn block(Block { min, max, inward }: Block) -> Result<Self, String> {
        if min.0.cmplt(max.0).all() {
            Ok(Self::Mesh(procedural::block(min.0, max.0, inward)))
        } else {
            Err("invalid box: every coordinate of `min` must be below that of `max`".to_owned())
        }
    }

    pub(super) fn triangles(triangles: Triangles) -> Result<Self, String> {
        let mesh = Mesh {
            positions: triangles.positions.into_iter().map(|position| position.0).collect(),
            normals: triangles.normals.into_iter().map(|normal| normal.0).collect(),
            indices: triangles.indices,
            ..Mesh::default()
        };
        mesh::check(&mesh).map_err(|problem: MeshError| problem.to_string())?;
        Ok(Self::Mesh(mesh))
    }

    pub(super) fn sphere(SphereTable { centre, radius, inward }: SphereTable) -> Self {
        Self::Spheres(vec![sphere(centre.0, radius.0, inward)])
    }

    pub(super) fn icosphere(Icosphere { centre, radius, subdivisions }: Icosphere) -> Self {
        let mut mesh = procedural::icosphere(subdivisions.0);
        for position in &mut mesh.positions {
            *position = centre.0 + radius.0 * *position;
        }
        Self::Mesh(mesh)
    }

    pub(super) fn bumpy_sphere(BumpySphere { subdivisions }: BumpySphere) -> Self {
        Self::Mesh(procedural::bumpy_sphere(subdivisions.0))
    }

    pub(super) fn sphereflake(Sphereflake { depth, subdivisions }: Sphereflake) -> Self {
        if let Some(Between(subdivisions)) = subdivisions {
            return Self::Mesh(procedural::sphereflake(depth.0, subdivisions));
        }
        let spheres = procedural::sphereflake_spheres(depth.0).into_iter();
        Self::Spheres(spheres.map(|(centre, radius)| sphere(centre, radius, false)).collect())
    }

    pub(super) fn teapot(Teapot { segments }: Teapot) -> Self {
        Self::Mesh(procedural::teapot(segments.0))
    }

    pub(super) fn soup(soup: Soup) -> Self {
        Self::Mesh(procedural::soup(soup.triangles.0, seed(soup.seed)))
    }

    pub(super) fn pathological(mesh: Pathological) -> Self {
        Self::Mesh(procedural::pathological(mesh.layout, mesh.triangles.0, seed(mesh.seed)))
    }
}

fn sphere(centre: DVec3, radius: f64, inward: bool) -> Sphere {
    Sphere { name: String::new(), centre, radius, inward, material: 0 }
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
