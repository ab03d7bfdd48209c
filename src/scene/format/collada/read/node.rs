//! The tree of nodes: what stands in the scene, and where.

use super::camera::Lens;
use super::light::DeclaredLight;
use super::xml::{Element, Instance, Reader, Result, children, first_child};
use super::{geometry, light, material};
use crate::scene::{Material, Mesh, Sphere};
use glam::DMat4;
use std::collections::BTreeMap;

/// How deep nodes may be nested. The course's files do not nest at all.
const DEEPEST: usize = 32;

/// All that a file holds, in world space.
#[derive(Default)]
pub(super) struct File {
    pub(super) lens: Lens,
    pub(super) materials: Vec<Material>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) spheres: Vec<Sphere>,
    pub(super) lights: Vec<DeclaredLight>,
    pub(super) differences: Vec<String>,
}

struct Walk<'r, 'a> {
    reader: &'r Reader<'a>,
    file: File,
    /// Numbers of materials, by id; "" is the one of surfaces without material.
    materials: BTreeMap<&'a str, u32>,
}

/// Reads the scene that the file instances.
pub(super) fn read(reader: &Reader<'_>) -> Result<File> {
    let root = reader.root;
    if root.tag_name().name() != "COLLADA" {
        return Err(reader.wrong(root, "is not a COLLADA file"));
    }
    let up = up_axis(reader)?;
    let scene = reader.need(root, "scene/instance_visual_scene")?;
    let mut walk = Walk { reader, file: File::default(), materials: BTreeMap::new() };
    for node in children(scene, "node") {
        walk.visit(node, &up, 0)?;
    }
    Ok(walk.file)
}

/// From the file's axes to the world's, where y is up.
fn up_axis(reader: &Reader<'_>) -> Result<DMat4> {
    let element = reader.need(reader.root, "asset/up_axis")?;
    let rows = match element.text() {
        Some("Y_UP") => return Ok(DMat4::IDENTITY),
        Some("Z_UP") => [[-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
        Some("X_UP") => [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]],
        _ => {
            let message = "the course understands no other axis than X_UP, Y_UP and Z_UP";
            return Err(reader.wrong(element, message));
        }
    };
    let [x, y, z] = rows;
    Ok(DMat4::from_cols_array_2d(&[x, y, z, [0.0, 0.0, 0.0, 1.0]]).transpose())
}

impl<'a> Walk<'_, 'a> {
    fn visit(&mut self, node: Element<'a>, parent: &DMat4, depth: usize) -> Result<()> {
        let reader = self.reader;
        let name = reader.name_of(node)?;
        if depth == DEEPEST {
            return Err(reader.wrong(node, "nodes are nested too deeply"));
        }
        let transform = *parent * matrix(reader, node)?;
        for child in children(node, "node") {
            self.check_nesting(child, &transform)?;
            self.visit(child, &transform, depth + 1)?;
        }
        self.instance(node, |element| Instance { name, element, transform })
    }

    /// With AVX the course's program multiplies by the *transposed* transform of the parent, without
    /// AVX by the transform itself. Only where both are the same is there one right reading.
    fn check_nesting(&self, child: Element<'_>, parent: &DMat4) -> Result<()> {
        if *parent == parent.transpose() {
            return Ok(());
        }
        let message = "the course's program places nested nodes wrongly on most machines";
        Err(self.reader.wrong(child, message).with_hint(
            "take the node out of its parent, and put the product of both matrices into it",
        ))
    }

    fn instance(
        &mut self,
        node: Element<'a>,
        instance: impl Fn(Element<'a>) -> Instance<'a>,
    ) -> Result<()> {
        let reader = self.reader;
        if let Some(camera) = reader.find(node, "instance_camera")? {
            self.file.lens = Lens::read(reader, &instance(camera))?;
        } else if let Some(light) = reader.find(node, "instance_light")? {
            self.file.lights.push(light::read(reader, &instance(light))?);
        } else if let Some(geometry) = reader.find(node, "instance_geometry")? {
            self.geometry(node, &instance(geometry))?;
        } else {
            let message = "this node instances nothing, and the course's program crashes on that";
            return Err(reader.wrong(node, message).with_hint(
                "give the node an `instance_geometry`, `instance_light` or `instance_camera`",
            ));
        }
        Ok(())
    }

    fn geometry(&mut self, node: Element<'a>, geometry: &Instance<'a>) -> Result<()> {
        let material = self.material(node)?;
        if first_child(geometry.element, "mesh").is_some() {
            let read = geometry::read_mesh(self.reader, geometry)?;
            self.file.meshes.push(Mesh { material, ..read.mesh });
            self.file.differences.extend(read.differences);
        } else {
            let sphere = geometry::read_sphere(self.reader, geometry)?;
            self.file.spheres.push(Sphere { material, ..sphere });
        }
        Ok(())
    }

    /// The number of the first material that is bound to the node's geometry.
    fn material(&mut self, node: Element<'a>) -> Result<u32> {
        let path = ["instance_geometry", "bind_material", "technique_common", "instance_material"];
        let bound = path.into_iter().try_fold(node, first_child);
        let element = bound.map(|bound| self.reader.follow(bound, "target")).transpose()?;
        let id = element.and_then(|element| element.attribute("id")).unwrap_or_default();
        if let Some(number) = self.materials.get(id) {
            return Ok(*number);
        }
        let material = match element {
            Some(element) => material::read(self.reader, element)?,
            None => material::default_material(),
        };
        self.file.materials.push(material);
        let number = self.materials.len() as u32;
        self.materials.insert(id, number);
        Ok(number)
    }
}

/// The node's own transform. Numbers that are missing at the end are zeros, as in the course.
fn matrix<'a>(reader: &Reader<'a>, node: Element<'a>) -> Result<DMat4> {
    if let Some(element) = first_child(node, "matrix") {
        let mut rows = [0.0; 16];
        let numbers: Vec<f64> = reader.numbers(element)?;
        for (row, number) in rows.iter_mut().zip(numbers) {
            *row = number;
        }
        return Ok(DMat4::from_cols_array(&rows).transpose());
    }
    match ["translate", "rotate", "scale"].into_iter().find_map(|name| first_child(node, name)) {
        None => Ok(DMat4::IDENTITY),
        Some(element) => Err(reader
            .wrong(element, "the course's program multiplies by zero here: the object vanishes")
            .with_hint("write the whole transform as one `matrix`")),
    }
}
