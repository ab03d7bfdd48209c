//! Scenes of a few lines, for the tests of cores.

use crate::scene::{Cap, Emission, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface};
use glam::DVec3;

#[derive(Clone, Debug, Default)]
pub(crate) struct Stage(SceneDescription);

impl Stage {
    pub(crate) fn empty() -> Self {
        Self::default()
    }

    /// A polygon, fanned from its first corner; counter-clockwise from the front.
    pub(crate) fn polygon(mut self, corners: &[DVec3], look: Look) -> Self {
        let material = self.add(look);
        let indices = (2..corners.len() as u32).map(|last| [0, last - 1, last]).collect();
        let mesh = Mesh { positions: corners.to_vec(), indices, material, ..Mesh::default() };
        self.0.meshes.push(mesh);
        self
    }

    pub(crate) fn mesh(mut self, mut mesh: Mesh, look: Look) -> Self {
        mesh.material = self.add(look);
        self.0.meshes.push(mesh);
        self
    }

    /// The plane z = 0 from −10 to 10, facing up, with reflectance .37.
    pub(crate) fn floor(self) -> Self {
        let corners = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];
        self.polygon(&corners.map(|(x, y)| DVec3::new(x, y, 0.0)), diffuse(0.37))
    }

    /// A sphere, with its front outside.
    pub(crate) fn sphere(self, centre: DVec3, radius: f64, look: Look) -> Self {
        self.add_sphere(centre, radius, false, look)
    }

    /// A room, with its front inside.
    pub(crate) fn room(self, radius: f64, look: Look) -> Self {
        self.add_sphere(DVec3::ZERO, radius, true, look)
    }

    fn add_sphere(mut self, centre: DVec3, radius: f64, inward: bool, look: Look) -> Self {
        let material = self.add(look);
        self.0.spheres.push(Sphere { name: String::new(), centre, radius, inward, material });
        self
    }

    pub(crate) fn light(mut self, light: Light) -> Self {
        self.0.lights.push(light);
        self
    }

    fn add(&mut self, look: Look) -> u32 {
        let Look { surface, emission } = look;
        self.0.materials.push(Material { name: String::new(), surface, emission });
        self.0.materials.len() as u32 - 1
    }

    pub(crate) fn scene(self) -> SceneDescription {
        self.0.with_area_lights()
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) surface: Surface,
    pub(crate) emission: Option<Emission>,
}

impl Look {
    pub(crate) fn emitting(self, radiance: f64) -> Self {
        Self { emission: Some(Emission { radiance: grey(radiance), cap: None }), ..self }
    }

    /// And emits within `half_angle` of +z.
    pub(crate) fn emitting_cap(self, radiance: f64, half_angle: f64) -> Self {
        let cap = Some(Cap { axis: DVec3::Z, half_angle });
        Self { emission: Some(Emission { radiance: grey(radiance), cap }), ..self }
    }
}

pub(crate) fn grey(value: f64) -> Rgb {
    [value; 3]
}

pub(crate) fn diffuse(reflectance: f64) -> Look {
    looks(Surface::Diffuse { reflectance: grey(reflectance) })
}

/// A surface that does not emit.
pub(crate) fn looks(surface: Surface) -> Look {
    Look { surface, emission: None }
}

/// Glass of index 1.5 that absorbs nothing.
pub(crate) fn clear_glass() -> Look {
    let (reflectance, transmittance) = (grey(1.0), grey(1.0));
    looks(Surface::Glass { index: 1.5, reflectance, transmittance })
}
