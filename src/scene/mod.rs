//! What a core is asked to render: plain data, fully resolved, with no file and no parser behind it.
//!
//! - Shapes are numbered meshes first, then spheres.
//! - Lights are numbered as [`SceneDescription::lights`] lists them: declared lights in the order of the file,
//!   then one area light for each shape that emits, in the order of shapes.
//! - Diffuse, mirror and conductor surfaces scatter on both sides; emission leaves the front side only.

mod camera;
mod error;
mod file;
pub mod format;
pub(crate) mod hash;
mod library;
mod light;
mod material;
pub mod mesh;
pub(crate) mod motion;
pub(crate) mod procedural;
pub mod reference;
mod shape;

pub use camera::Camera;
pub use error::SceneError;
pub use file::Overrides;
#[cfg(feature = "cli")]
pub(crate) use file::schema;
pub use library::{Library, load_file};
pub use light::Light;
pub use material::{Cap, Emission, Material, Surface};
pub use shape::{Aabb, Mesh, Rectangle, Sphere};

/// Linear RGB: radiance, reflectance or intensity, as the field says.
pub(crate) type Rgb = [f64; 3];

/// Everything a core needs to build a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneDescription {
    /// The scene's file name without `.toml`.
    pub name: String,
    /// Where images are taken from, if the scene says so.
    pub camera: Option<Camera>,
    /// Materials; shapes refer to them by number.
    pub materials: Vec<Material>,
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
    /// Every light, area lights included.
    pub lights: Vec<Light>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape<'a> {
    Mesh(&'a Mesh),
    Sphere(&'a Sphere),
}

impl SceneDescription {
    pub(crate) fn shape_count(&self) -> usize {
        self.meshes.len() + self.spheres.len()
    }

    /// Shape `number`: meshes first, then spheres.
    ///
    /// # Panics
    /// If there is no such shape.
    pub(crate) fn shape(&self, number: u32) -> Shape<'_> {
        let number = number as usize;
        match self.meshes.get(number) {
            Some(mesh) => Shape::Mesh(mesh),
            None => Shape::Sphere(&self.spheres[number - self.meshes.len()]),
        }
    }

    pub(crate) fn material_of(&self, number: u32) -> &Material {
        let material = match self.shape(number) {
            Shape::Mesh(mesh) => mesh.material,
            Shape::Sphere(sphere) => sphere.material,
        };
        &self.materials[material as usize]
    }

    /// Triangles and spheres together.
    pub fn primitive_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.indices.len()).sum::<usize>() + self.spheres.len()
    }

    /// Appends an area light for every shape that emits. The last step of making a scene.
    pub(crate) fn with_area_lights(mut self) -> Self {
        self.lights.retain(|light| !matches!(light, Light::Area { .. }));
        for shape in 0..self.shape_count() as u32 {
            if self.material_of(shape).emission.is_some() {
                self.lights.push(Light::Area { shape });
            }
        }
        self
    }

    /// The smallest box around everything; `None` for an empty scene.
    pub fn bounds(&self) -> Option<Aabb> {
        let points = self.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied());
        let corners = self
            .spheres
            .iter()
            .flat_map(|sphere| [sphere.centre - sphere.radius, sphere.centre + sphere.radius]);
        Aabb::around(points.chain(corners))
    }
}
