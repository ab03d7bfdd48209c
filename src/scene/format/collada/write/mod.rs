//! The COLLADA that the course's program reads: its CGL profile, `<matrix>` transforms, and a camera file.
//!
//! That program makes normals of its own: it averages over what shares a vertex, and turns them round at the rim of an
//! open mesh. A flat mesh is therefore written as triangles that share nothing, wound the other way, which comes out as
//! flat faces that look the right way. Positions are read in single precision there. The front side of a light is what
//! shines; the course's own light class is given the same rectangle.

mod camera;
mod material;

use super::read::vertex_normals;
use crate::scene::format::xml::XmlWriter;
use crate::scene::format::{Complaint, ExportError, Exported, Format, matrix, numbers};
use crate::scene::{Light, Mesh, SceneDescription, Shape, Sphere};
use glam::{DAffine3, DMat3, DVec3};

/// How far the normals that the course makes of a smooth mesh may be from those of the scene.
const SAME_NORMAL: f64 = 1e-3;

/// `scene.dae` and `camera.txt`.
pub(crate) fn export(scene: &SceneDescription) -> Result<Exported, ExportError> {
    let complaint = Complaint { format: Format::Collada, scene };
    let camera = complaint.camera()?;
    let writer = Writer { scene, complaint };
    let mut xml = XmlWriter::default();
    let schema = "http://www.collada.org/2005/11/COLLADASchema";
    xml.open("COLLADA", &[("xmlns", schema), ("version", "1.4.1")]);
    xml.open("asset", &[]);
    xml.text("up_axis", &[], "Y_UP");
    xml.close();
    let nodes =
        [camera::write(&mut xml, camera), writer.lights(&mut xml)?, writer.shapes(&mut xml)?];
    xml.open("library_visual_scenes", &[]);
    xml.open("visual_scene", &[("id", "Scene"), ("name", "Scene")]);
    nodes.iter().flatten().for_each(|node| node.write(&mut xml));
    xml.close();
    xml.close();
    xml.open("scene", &[]);
    xml.leaf("instance_visual_scene", &[("url", "#Scene")]);
    let files = [("scene.dae", xml.finish()), ("camera.txt", camera::settings(camera))];
    Ok(Exported { camera: Some("camera.txt"), ..Exported::of_texts(files) })
}

struct Node {
    id: String,
    transform: DAffine3,
    /// `instance_camera`, `instance_light` or `instance_geometry`.
    instance: &'static str,
    /// Id of what is instanced.
    of: String,
    material: Option<String>,
}

impl Node {
    fn write(&self, xml: &mut XmlWriter) {
        xml.open("node", &[("id", &self.id), ("name", &self.id)]);
        xml.text("matrix", &[], &matrix(self.transform));
        let url = format!("#{}", self.of);
        match &self.material {
            None => xml.leaf(self.instance, &[("url", &url)]),
            Some(material) => {
                xml.open(self.instance, &[("url", &url)]);
                xml.open("bind_material", &[]);
                xml.open("technique_common", &[]);
                let target = format!("#{material}");
                xml.leaf("instance_material", &[("symbol", material), ("target", &target)]);
                (0..3).for_each(|_| xml.close());
            }
        }
        xml.close();
    }
}

struct Writer<'a> {
    scene: &'a SceneDescription,
    complaint: Complaint<'a>,
}

impl Writer<'_> {
    fn lights(&self, xml: &mut XmlWriter) -> Result<Vec<Node>, ExportError> {
        let mut nodes = Vec::new();
        xml.open("library_lights", &[]);
        for (number, light) in self.scene.lights.iter().enumerate() {
            let (kind, colour, transform) = self.light(light)?;
            let id = format!("light-{number}");
            let of = format!("{id}-light");
            xml.open("light", &[("id", &of), ("name", &id)]);
            xml.open("extra", &[]);
            xml.open("technique", &[("profile", "CGL")]);
            xml.open(kind, &[]);
            xml.text("color", &[], &numbers(colour));
            if kind == "point" {
                // Without these the course's program ends; it does not look at them.
                xml.text("constant_attenuation", &[], "0");
                xml.text("linear_attenuation", &[], "0");
                xml.text("quadratic_attenuation", &[], "1");
            }
            (0..4).for_each(|_| xml.close());
            let instance = "instance_light";
            nodes.push(Node { id, transform, instance, of, material: None });
        }
        xml.close();
        Ok(nodes)
    }

    /// What the course calls a light, its colour and where it stands.
    fn light(&self, light: &Light) -> Result<(&'static str, [f64; 3], DAffine3), ExportError> {
        match *light {
            Light::Point { position, intensity } => {
                Ok(("point", intensity, DAffine3::from_translation(position)))
            }
            Light::Directional { direction, irradiance } => {
                // The course takes the point (0, 0, -1) to where the light comes from.
                let x = direction.any_orthonormal_vector();
                let axes = DMat3::from_cols(x, direction.cross(x), direction);
                Ok(("directional", irradiance, DAffine3::from_mat3(axes)))
            }
            Light::Area { shape } => self.area_light(shape),
            Light::ConstantSky { .. } | Light::GradientSky { .. } => Err(self
                .complaint
                .about("it has an environment light, which the course leaves black")),
        }
    }

    fn area_light(&self, shape: u32) -> Result<(&'static str, [f64; 3], DAffine3), ExportError> {
        let emission = self.scene.material_of(shape).emission;
        let radiance = emission.map_or([0.0; 3], |emission| emission.radiance);
        let (name, rectangle) = match self.scene.shape(shape) {
            Shape::Mesh(mesh) => (&mesh.name, mesh.as_rectangle()),
            Shape::Sphere(sphere) => (&sphere.name, None),
        };
        let rectangle = rectangle.ok_or_else(|| {
            self.complaint.about(format!(
                "`{name}` emits, and the course's area lights are rectangles of two triangles"
            ))
        })?;
        let [u, v] = rectangle.sides;
        let matrix3 = DMat3::from_cols(-u, v, -rectangle.normal);
        Ok(("area", radiance, DAffine3 { matrix3, translation: rectangle.centre }))
    }

    fn shapes(&self, xml: &mut XmlWriter) -> Result<Vec<Node>, ExportError> {
        let materials = material::write_all(xml, self.scene, self.complaint)?;
        let mut nodes = Vec::new();
        xml.open("library_geometries", &[]);
        for (number, mesh) in self.scene.meshes.iter().enumerate() {
            let id = format!("mesh-{number}");
            self.mesh(xml, &id, mesh)?;
            nodes.push(shape_node(id, DAffine3::IDENTITY, &materials[mesh.material as usize]));
        }
        for (number, sphere) in self.scene.spheres.iter().enumerate() {
            let id = format!("sphere-{number}");
            self.sphere(xml, &id, sphere)?;
            // A unit sphere, for radii are read in single precision and matrices are not.
            let matrix3 = DMat3::from_diagonal(DVec3::splat(sphere.radius));
            let transform = DAffine3 { matrix3, translation: sphere.centre };
            nodes.push(shape_node(id, transform, &materials[sphere.material as usize]));
        }
        xml.close();
        Ok(nodes)
    }

    fn mesh(&self, xml: &mut XmlWriter, id: &str, mesh: &Mesh) -> Result<(), ExportError> {
        let (positions, triangles) = match mesh.normals.is_empty() {
            true => self.flat(mesh)?,
            false => self.smooth(mesh)?,
        };
        let coordinates = positions.iter().flat_map(|position| position.to_array());
        let corners: Vec<_> = triangles.iter().flatten().map(u32::to_string).collect();
        let name = |part: &str| format!("{id}-{part}");
        xml.open("geometry", &[("id", &name("geometry")), ("name", id)]);
        xml.open("mesh", &[]);
        xml.open("source", &[("id", &name("positions"))]);
        let count = (3 * positions.len()).to_string();
        let attributes = [("id", &*name("array")), ("count", &count)];
        xml.text("float_array", &attributes, &numbers(coordinates));
        xml.close();
        xml.open("vertices", &[("id", &name("vertices"))]);
        let source = format!("#{}", name("positions"));
        xml.leaf("input", &[("semantic", "POSITION"), ("source", &source)]);
        xml.close();
        xml.open("triangles", &[("count", &triangles.len().to_string())]);
        let source = format!("#{}", name("vertices"));
        xml.leaf("input", &[("semantic", "VERTEX"), ("source", &source), ("offset", "0")]);
        xml.text("p", &[], &corners.join(" "));
        (0..3).for_each(|_| xml.close());
        Ok(())
    }

    /// Triangles that share nothing, each wound the other way.
    fn flat(&self, mesh: &Mesh) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), ExportError> {
        let mut positions = Vec::new();
        for triangle in 0..mesh.indices.len() {
            let [a, b, c] = mesh.corners(triangle);
            // As the course reads them.
            let [p, q, r] = [a, b, c].map(|corner| corner.as_vec3().as_dvec3());
            if (q - p).cross(r - p).try_normalize().is_none() {
                let name = &mesh.name;
                let what = format!("triangle {triangle} of `{name}` has no area, and so no normal");
                return Err(self.complaint.about(what));
            }
            positions.extend([c, b, a]);
        }
        let triangles = (0..mesh.indices.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        Ok((positions, triangles.collect()))
    }

    /// The mesh as it is, if the course makes the same normals of it.
    fn smooth(&self, mesh: &Mesh) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), ExportError> {
        let name = &mesh.name;
        let read: Vec<_> = mesh.positions.iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let polygons: Vec<_> = mesh.indices.iter().map(|corners| corners.to_vec()).collect();
        let normals = vertex_normals(&read, &polygons)
            .map_err(|why| self.complaint.about(format!("smooth mesh `{name}` {why}")))?;
        let differs = |(made, meant): (&DVec3, &DVec3)| made.distance(*meant) > SAME_NORMAL;
        match normals.iter().zip(&mesh.normals).position(differs) {
            None => Ok((mesh.positions.clone(), mesh.indices.clone())),
            Some(vertex) => Err(self.complaint.about(format!(
                "the course computes its own normals, and a different one at vertex {vertex} of `{name}`"
            ))),
        }
    }

    fn sphere(&self, xml: &mut XmlWriter, id: &str, sphere: &Sphere) -> Result<(), ExportError> {
        if sphere.inward {
            let what = format!(
                "sphere `{}` has inward normals, and the course's have outward ones",
                sphere.name
            );
            return Err(self.complaint.about(what));
        }
        xml.open("geometry", &[("id", &format!("{id}-geometry")), ("name", id)]);
        xml.open("extra", &[]);
        xml.open("technique", &[("profile", "CGL")]);
        xml.open("sphere", &[]);
        xml.text("radius", &[], "1");
        (0..4).for_each(|_| xml.close());
        Ok(())
    }
}

fn shape_node(id: String, transform: DAffine3, material: &str) -> Node {
    let of = format!("{id}-geometry");
    Node { id, transform, instance: "instance_geometry", of, material: Some(material.to_owned()) }
}
