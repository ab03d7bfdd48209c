//! pbrt-v4. It computes with spectra, so that a colour means something else to it than to a renderer that
//! multiplies RGB: only grey scenes are the same question.

use super::{Complaint, ExportError, Exported, Format, Request, numbers};
use crate::scene::{Camera, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface};
use glam::DVec3;
use std::fmt::Write;

/// `scene.pbrt`, which renders to `picture.exr`.
pub(super) fn export(scene: &SceneDescription, request: Request) -> Result<Exported, ExportError> {
    let complaint = Complaint { format: Format::Pbrt, scene };
    let camera = complaint.square_camera()?;
    let mut writer = Writer { text: String::new(), scene, complaint };
    writer.options(camera, request);
    for light in &scene.lights {
        writer.light(light)?;
    }
    for mesh in &scene.meshes {
        writer.shape(&mesh.name, mesh.material, &triangle_mesh(mesh), false)?;
    }
    for sphere in &scene.spheres {
        writer.sphere(sphere)?;
    }
    Ok(Exported::of_texts([("scene.pbrt", writer.text)]))
}

const WHITE: Rgb = [1.0; 3];

struct Writer<'a> {
    text: String,
    scene: &'a SceneDescription,
    complaint: Complaint<'a>,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    fn options(&mut self, camera: &Camera, request: Request) {
        let [width, height] = camera.film;
        // The field of view is that of the shorter side.
        let fov = if width < height { camera.horizontal_fov } else { camera.vertical_fov };
        let Request { last_bounce, samples, seed } = request;
        let seed = seed % (1 << 31);
        let target = camera.position - camera.camera_to_world.z_axis;
        let look_at = [camera.position, target, camera.camera_to_world.y_axis];
        self.line(&format!("Integrator \"path\" \"integer maxdepth\" [ {last_bounce} ]"));
        self.line(&format!(
            "Sampler \"independent\" \"integer pixelsamples\" [ {samples} ] \"integer seed\" [ {seed} ]"
        ));
        self.line("PixelFilter \"box\" \"float xradius\" [ 0.5 ] \"float yradius\" [ 0.5 ]");
        self.line(&format!(
            "Film \"rgb\" \"integer xresolution\" [ {width} ] \"integer yresolution\" [ {height} ] \
             \"string filename\" [ \"picture.exr\" ] \"bool savefp16\" [ false ] \
             \"float maxcomponentvalue\" [ 1e30 ]"
        ));
        // pbrt's camera space is left-handed.
        self.line("Scale -1 1 1");
        self.line(&format!("LookAt {}", numbers(look_at.iter().flat_map(|v| v.to_array()))));
        self.line(&format!("Camera \"perspective\" \"float fov\" [ {} ]", fov.to_degrees()));
        self.line("WorldBegin");
    }

    /// The one value of a grey.
    fn grey(&self, colour: Rgb, of: &str) -> Result<f64, ExportError> {
        let [red, green, blue] = colour;
        match red == green && green == blue {
            true => Ok(red),
            false => Err(self.complaint.about(format!(
                "{of} has the colour {}, which pbrt converts to a spectrum: only greys survive",
                numbers(colour)
            ))),
        }
    }

    fn light(&mut self, light: &Light) -> Result<(), ExportError> {
        let line = match *light {
            Light::Point { position, intensity } => {
                let intensity = self.grey(intensity, "a point light")?;
                let [rgb, from] = [rgb("I", intensity), point("from", position)];
                format!("LightSource \"point\" {rgb} {from}")
            }
            Light::Directional { direction, irradiance } => {
                let irradiance = self.grey(irradiance, "a directional light")?;
                let [from, to] = [point("from", -direction), point("to", DVec3::ZERO)];
                format!("LightSource \"distant\" {} {from} {to}", rgb("L", irradiance))
            }
            Light::ConstantSky { radiance } => {
                let radiance = self.grey(radiance, "the sky")?;
                format!("LightSource \"infinite\" {}", rgb("L", radiance))
            }
            Light::GradientSky { .. } => {
                return Err(self
                    .complaint
                    .about("it has a gradient environment light, for which pbrt needs an image"));
            }
            Light::Area { .. } => return Ok(()),
        };
        self.line(&line);
        Ok(())
    }

    fn sphere(&mut self, sphere: &Sphere) -> Result<(), ExportError> {
        let radius = sphere.radius;
        let shape = format!("Shape \"sphere\" \"float radius\" [ {radius} ]");
        let translated = format!("Translate {}\n{shape}", numbers(sphere.centre.to_array()));
        self.shape(&sphere.name, sphere.material, &translated, sphere.inward)
    }

    fn shape(
        &mut self,
        name: &str,
        material: u32,
        shape: &str,
        inward: bool,
    ) -> Result<(), ExportError> {
        let material = &self.scene.materials[material as usize];
        let surface = self.surface(material)?;
        self.line("AttributeBegin");
        self.line(&surface);
        if let Some(emission) = material.emission {
            if emission.cap.is_some() {
                return Err(self.complaint.about(format!("`{name}` emits on a part of a sphere")));
            }
            let radiance = self.grey(emission.radiance, &format!("the light of `{name}`"))?;
            self.line(&format!("AreaLightSource \"diffuse\" {}", rgb("L", radiance)));
        }
        if inward {
            self.line("ReverseOrientation");
        }
        self.line(shape);
        self.line("AttributeEnd");
        Ok(())
    }

    fn surface(&self, material: &Material) -> Result<String, ExportError> {
        let name = &material.name;
        match material.surface {
            Surface::Diffuse { reflectance } => {
                let reflectance = self.grey(reflectance, &format!("material `{name}`"))?;
                Ok(format!("Material \"diffuse\" {}", rgb("reflectance", reflectance)))
            }
            Surface::Glass { index, reflectance: WHITE, transmittance: WHITE } => {
                Ok(format!("Material \"dielectric\" \"float eta\" [ {index} ]"))
            }
            Surface::RoughGlass { index, roughness, reflectance: WHITE, transmittance: WHITE } => {
                Ok(format!(
                    "Material \"dielectric\" \"float eta\" [ {index} ] \"float roughness\" [ {roughness} ] \
                 \"bool remaproughness\" [ false ]"
                ))
            }
            Surface::Glass { .. } | Surface::RoughGlass { .. } => {
                Err(self.complaint.about(format!("glass `{name}` is tinted, and pbrt's is clear")))
            }
            Surface::Mirror { .. } | Surface::Conductor { .. } => {
                Err(self.complaint.about(format!(
                    "conductor `{name}` has constant reflectance, and pbrt's has a Fresnel term"
                )))
            }
        }
    }
}

fn rgb(name: &str, grey: f64) -> String {
    format!("\"rgb {name}\" [ {grey} {grey} {grey} ]")
}

fn point(name: &str, at: DVec3) -> String {
    format!("\"point3 {name}\" [ {} ]", numbers(at.to_array()))
}

fn triangle_mesh(mesh: &Mesh) -> String {
    let indices: Vec<_> = mesh.indices.iter().flatten().map(u32::to_string).collect();
    let coordinates = |vectors: &[DVec3]| numbers(vectors.iter().flat_map(|v| v.to_array()));
    let mut shape = format!(
        "Shape \"trianglemesh\" \"integer indices\" [ {} ] \"point3 P\" [ {} ]",
        indices.join(" "),
        coordinates(&mesh.positions)
    );
    if !mesh.normals.is_empty() {
        shape += &format!(" \"normal N\" [ {} ]", coordinates(&mesh.normals));
    }
    shape
}
