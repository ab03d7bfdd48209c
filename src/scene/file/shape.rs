//! `[[shape]]`: what it is, where it stands, and what it is made of.

use super::geometry::{
    Block, BumpySphere, Geometry, Icosphere, Pathological, Quad, Soup, SphereTable, Sphereflake,
    Teapot, Triangles, from_file,
};
use super::material::Materials;
use super::{Context, exactly_one};
use crate::scene::mesh::{Format, Shading};
use crate::scene::{Material, Mesh, SceneDescription, Sphere};
use crate::text::{Angle, Diagnostic, Direction, Positive, Spanned, Vector};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::Deserialize;
use std::collections::HashSet;
use std::ops::Range;

tables! {
    pub(super) struct Entry {
        /// What messages call it; no other shape has it.
        name: Spanned<String>,
        /// The name of a material of this file.
        material: Spanned<String>,
        transform: Option<Spanned<Transform>>,
        shading: Option<Spanned<Shading>>,

        /// A parallelogram. Of this key and those below a shape has one.
        quad: Option<Spanned<Quad>>,
        /// Its six faces.
        r#box: Option<Spanned<Block>>,
        triangles: Option<Spanned<Triangles>>,
        /// A Wavefront file, named relative to the scene.
        obj: Option<Spanned<String>>,
        /// A PLY file, named relative to the scene.
        ply: Option<Spanned<String>>,
        /// An STL file, named relative to the scene.
        stl: Option<Spanned<String>>,
        sphere: Option<SphereTable>,
        /// A sphere of triangles.
        icosphere: Option<Icosphere>,
        bumpy_sphere: Option<BumpySphere>,
        sphereflake: Option<Sphereflake>,
        teapot: Option<Teapot>,
        /// Random triangles.
        soup: Option<Soup>,
        /// Triangles that BVHs find difficult.
        pathological: Option<Pathological>,
    }

    /// Applied in this order: scale, rotate, translate.
    #[derive(Default)]
    struct Transform {
        scale: Option<Positive>,
        rotate: Option<Rotation>,
        #[serde(default)] translate: Vector,
    }

    struct Rotation { axis: Direction, angle: Angle }
}

/// Appends the shapes of the file to `scene`.
pub(super) fn resolve_all(
    entries: Vec<Spanned<Entry>>,
    materials: &Materials,
    context: &Context<'_>,
    scene: &mut SceneDescription,
) -> Result<(), Diagnostic> {
    let mut names = HashSet::new();
    for entry in entries {
        let span = entry.span();
        let entry = entry.into_inner();
        if !names.insert(entry.name.get_ref().clone()) {
            let problem = format!("duplicate shape `{}`", entry.name.get_ref());
            return Err(context.wrong(entry.name.span(), problem));
        }
        entry.resolve(span, materials, context, scene)?;
    }
    Ok(())
}

impl Entry {
    fn resolve(
        mut self,
        span: Range<usize>,
        materials: &Materials,
        context: &Context<'_>,
        scene: &mut SceneDescription,
    ) -> Result<(), Diagnostic> {
        let (number, material) = materials.find(&self.material, context)?;
        let geometry = self.take_geometry(span, context)?;
        let transform = self.transform.map(Spanned::into_inner).unwrap_or_default();
        match geometry {
            Geometry::Mesh(mut mesh) => {
                transform.place_mesh(&mut mesh);
                if let Some(shading) = &self.shading {
                    shading.get_ref().apply(&mut mesh);
                }
                check_light(&mesh, material)
                    .map_err(|problem| context.wrong(self.material.span(), problem))?;
                (mesh.name, mesh.material) = (self.name.into_inner(), number);
                scene.meshes.push(mesh);
            }
            Geometry::Spheres(mut spheres) => {
                if let Some(shading) = &self.shading {
                    return Err(context.wrong(shading.span(), "`shading` is for triangles"));
                }
                name_spheres(&mut spheres, self.name.get_ref());
                for mut sphere in spheres {
                    transform.place_sphere(&mut sphere);
                    sphere.material = number;
                    scene.spheres.push(sphere);
                }
            }
        }
        Ok(())
    }

    /// The one key that makes triangles or spheres.
    fn take_geometry(
        &mut self,
        span: Range<usize>,
        context: &Context<'_>,
    ) -> Result<Geometry, Diagnostic> {
        let file = |name: Option<Spanned<String>>, format| {
            name.map(|name| from_file(name, format, context))
        };
        let kinds = [
            ("quad", checked(self.quad.take(), Geometry::quad, context)),
            ("box", checked(self.r#box.take(), Geometry::block, context)),
            ("triangles", checked(self.triangles.take(), Geometry::triangles, context)),
            ("obj", file(self.obj.take(), Format::Obj)),
            ("ply", file(self.ply.take(), Format::Ply)),
            ("stl", file(self.stl.take(), Format::Stl)),
            ("sphere", self.sphere.take().map(Geometry::sphere).map(Ok)),
            ("icosphere", self.icosphere.take().map(Geometry::icosphere).map(Ok)),
            ("bumpy-sphere", self.bumpy_sphere.take().map(Geometry::bumpy_sphere).map(Ok)),
            ("sphereflake", self.sphereflake.take().map(Geometry::sphereflake).map(Ok)),
            ("teapot", self.teapot.take().map(Geometry::teapot).map(Ok)),
            ("soup", self.soup.take().map(Geometry::soup).map(Ok)),
            ("pathological", self.pathological.take().map(Geometry::pathological).map(Ok)),
        ];
        exactly_one("a shape", kinds).map_err(|problem| context.wrong(span, problem))?
    }
}

/// A geometry that can be wrong in ways its numbers alone do not show.
fn checked<T>(
    entry: Option<Spanned<T>>,
    make: fn(T) -> Result<Geometry, String>,
    context: &Context<'_>,
) -> Option<Result<Geometry, Diagnostic>> {
    entry.map(|entry| {
        let span = entry.span();
        make(entry.into_inner()).map_err(|problem| context.wrong(span, problem))
    })
}

fn check_light(mesh: &Mesh, material: &Material) -> Result<(), String> {
    let Some(emission) = material.emission else { return Ok(()) };
    if emission.cap.is_some() {
        return Err(format!("`{}` has a `cap`, which only spheres can have", material.name));
    }
    let area: f64 = (0..mesh.indices.len()).map(|triangle| mesh.area(triangle)).sum();
    if area > 0.0 { Ok(()) } else { Err("a shape without area cannot emit".to_owned()) }
}

/// One sphere takes the shape's name, several take it with their number.
fn name_spheres(spheres: &mut [Sphere], name: &str) {
    if let [only] = spheres {
        only.name = name.to_owned();
    } else {
        for (number, sphere) in spheres.iter_mut().enumerate() {
            sphere.name = format!("{name}/{number}");
        }
    }
}

impl Transform {
    fn affine(&self) -> DAffine3 {
        let rotation = self.rotation();
        let scaled = DMat3::from_quat(rotation) * self.scale();
        DAffine3 { matrix3: scaled, translation: self.translate.0 }
    }

    fn rotation(&self) -> DQuat {
        self.rotate.as_ref().map_or(DQuat::IDENTITY, |rotation| {
            DQuat::from_axis_angle(rotation.axis.0, rotation.angle.0)
        })
    }

    fn scale(&self) -> f64 {
        self.scale.map_or(1.0, |scale| scale.0)
    }

    fn place_mesh(&self, mesh: &mut Mesh) {
        let (affine, rotation) = (self.affine(), self.rotation());
        let place = |point: &mut DVec3| *point = affine.transform_point3(*point);
        mesh.positions.iter_mut().for_each(place);
        mesh.normals.iter_mut().for_each(|normal| *normal = rotation * *normal);
    }

    fn place_sphere(&self, sphere: &mut Sphere) {
        sphere.centre = self.affine().transform_point3(sphere.centre);
        sphere.radius *= self.scale();
    }
}
