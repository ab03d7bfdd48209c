//! A scene as the integrator sees it: surfaces with their materials, lights, and rays between them.

use super::light::Light;
use super::scatter::{Bsdf, rgb};
use super::trace::Segment;
use super::trace::Tracer;
use super::trace::Tree;
use super::trace::{Geometry, Surface};
use crate::contract::Ray;
use crate::scene::{Emission, SceneDescription};
use glam::{DVec3, Vec3};

/// Everything that stays the same while rays are traced.
pub(crate) struct World {
    pub(crate) geometry: Geometry,
    pub(crate) tree: Tree,
    /// What shines, in the order of the scene.
    pub(crate) lights: Vec<Light>,
    materials: Vec<(Bsdf, Option<Emission>)>,
    shape_materials: Vec<usize>,
    /// The area light of each shape that is one.
    shape_lights: Vec<Option<usize>>,
}

impl World {
    /// Puts a scene, whose numbers have been checked, together with the tree over its `geometry`.
    pub(crate) fn new(scene: &SceneDescription, geometry: Geometry, tree: Tree) -> Self {
        use crate::scene::Light as Declared;
        let material =
            |material: &crate::scene::Material| (Bsdf::new(&material.surface), material.emission);
        let meshes = scene.meshes.iter().map(|mesh| mesh.material as usize);
        let spheres = scene.spheres.iter().map(|sphere| sphere.material as usize);
        let mut shape_lights = vec![None; scene.shape_count()];
        for (number, light) in scene.lights.iter().enumerate() {
            if let Declared::Area { shape } = light {
                shape_lights[*shape as usize] = Some(number);
            }
        }
        Self {
            geometry,
            tree,
            lights: scene.lights.iter().map(|light| Light::new(scene, light)).collect(),
            materials: scene.materials.iter().map(material).collect(),
            shape_materials: meshes.chain(spheres).collect(),
            shape_lights,
        }
    }

    pub(crate) fn bsdf(&self, surface: &Surface) -> &Bsdf {
        &self.materials[self.shape_materials[surface.shape as usize]].0
    }

    pub(crate) fn light_of(&self, surface: &Surface) -> Option<&Light> {
        self.shape_lights[surface.shape as usize].map(|number| &self.lights[number])
    }

    /// Radiance that the surface itself emits towards `wo`: only from its front side.
    pub(crate) fn emitted(&self, surface: &Surface, wo: DVec3) -> Vec3 {
        match &self.materials[self.shape_materials[surface.shape as usize]].1 {
            Some(emission) if surface.geometric_normal.dot(wo) > 0.0 => {
                let outward = match emission.cap {
                    Some(_) => self.geometry.outward(surface),
                    None => surface.geometric_normal,
                };
                rgb(emission.at_sphere_point(outward))
            }
            _ => Vec3::ZERO,
        }
    }

    /// Radiance of all skies from direction `w`.
    pub(crate) fn sky(&self, w: DVec3) -> Vec3 {
        self.lights.iter().map(|light| rgb(light.sky_radiance(w))).sum()
    }
}

/// Rays in a world, one after the other.
pub(crate) struct RayCaster<'a> {
    pub(crate) world: &'a World,
    tracer: Tracer<'a>,
}

impl<'a> RayCaster<'a> {
    pub(crate) fn new(world: &'a World) -> Self {
        Self { world, tracer: Tracer::new(&world.tree) }
    }

    pub(crate) fn nearest(&mut self, ray: &Ray) -> Option<Surface> {
        let segment = Segment::new(ray);
        let candidate = self.tracer.nearest(&segment)?;
        Some(self.world.geometry.surface(&segment, candidate))
    }

    pub(crate) fn is_blocked(&mut self, ray: &Ray) -> bool {
        self.tracer.is_blocked(&Segment::new(ray))
    }
}
