//! A scene taken in: what a ray or an image may be asked for.

use super::render;
use super::trace;
use super::trace::Segment;
use super::trace::Tracer;
use super::trace::{Geometry, Surface};
use super::world::World;
use crate::contract::{
    Acceleration, BuildStats, BuiltScene, CoreError, Film, Hit, IntegratorSettings, LightSample,
    Randomness, Ray, RenderSettings, Result, TraversalStats,
};
use crate::scene::{Camera, Light, Mesh, SceneDescription};
use glam::DVec3;

pub(crate) struct BuiltinScene {
    world: World,
}

impl BuiltinScene {
    /// Takes `scene` in. Refuses numbers that refer to nothing.
    pub(crate) fn new(scene: &SceneDescription, acceleration: Acceleration) -> Result<Self> {
        check_numbers(scene).map_err(CoreError::Refused)?;
        let geometry = Geometry::new(scene);
        let tree = match acceleration {
            Acceleration::BruteForce => trace::brute_force(&geometry),
            Acceleration::Bvh { split, max_leaf_size, .. } => trace::build_bvh(
                &geometry,
                trace::Plan { split, max_leaf_size: max_leaf_size as usize },
            ),
        };
        Ok(Self { world: World::new(scene, geometry, tree) })
    }

    /// Walks a batch of rays on the calling thread, so that a speed-up compares nothing but the walks.
    fn walk(
        &self,
        rays: &[Ray],
        mut one: impl FnMut(&mut Tracer<'_>, usize, &Segment),
    ) -> TraversalStats {
        let mut tracer = Tracer::new(&self.world.tree);
        for (index, ray) in rays.iter().enumerate() {
            one(&mut tracer, index, &Segment::new(ray));
        }
        TraversalStats { rays: rays.len() as u64, ..tracer.stats }
    }
}

impl BuiltScene for BuiltinScene {
    fn stats(&self) -> BuildStats {
        self.world.tree.stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let rays = &rays[..rays.len().min(hits.len())];
        Ok(self.walk(rays, |tracer, index, segment| {
            hits[index] = tracer.nearest(segment).map_or(Hit::MISS, |found| {
                hit(segment, &self.world.geometry.surface(segment, found))
            });
        }))
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let rays = &rays[..rays.len().min(occluded.len())];
        Ok(self.walk(rays, |tracer, index, segment| {
            occluded[index] = tracer.is_blocked(segment);
        }))
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let Some(light) = self.world.lights.get(light as usize) else {
            return Err(CoreError::Refused(format!("there is no light {light}")));
        };
        let numbers = random.points.iter().zip(random.lobes);
        for ((sample, &from), (&point, &lobe)) in samples.iter_mut().zip(from).zip(numbers) {
            *sample = light.aim(from, point, lobe).sample;
        }
        Ok(())
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        render::radiance(&self.world, rays, settings, radiance)
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        render::render(&self.world, camera, settings, film)
    }
}

/// What the contract calls a surface that was hit.
fn hit(segment: &Segment, surface: &Surface) -> Hit {
    Hit {
        t: segment.unscale(surface.t),
        shape: surface.shape,
        primitive: surface.primitive,
        geometric_normal: surface.geometric_normal,
        shading_normal: surface.shading_normal,
        uv: surface.uv,
    }
}

/// The first number that refers to nothing, in words.
fn check_numbers(scene: &SceneDescription) -> std::result::Result<(), String> {
    scene.meshes.iter().try_for_each(check_mesh)?;
    let mesh_materials = scene.meshes.iter().map(|mesh| (&mesh.name, mesh.material));
    let sphere_materials = scene.spheres.iter().map(|sphere| (&sphere.name, sphere.material));
    for (name, material) in mesh_materials.chain(sphere_materials) {
        if material as usize >= scene.materials.len() {
            let count = scene.materials.len();
            return Err(format!("shape `{name}` has material {material} of {count}"));
        }
    }
    let count = scene.shape_count();
    for light in &scene.lights {
        if let Light::Area { shape } = light
            && *shape as usize >= count
        {
            return Err(format!("an area light is shape {shape} of {count}"));
        }
    }
    Ok(())
}

fn check_mesh(mesh: &Mesh) -> std::result::Result<(), String> {
    let (name, count) = (&mesh.name, mesh.positions.len());
    if !mesh.normals.is_empty() && mesh.normals.len() != count {
        let normals = mesh.normals.len();
        return Err(format!("mesh `{name}` has {normals} normals for {count} vertices"));
    }
    match mesh.indices.iter().flatten().find(|&&index| index as usize >= count) {
        Some(index) => Err(format!("mesh `{name}` has a corner at vertex {index} of {count}")),
        None => Ok(()),
    }
}
