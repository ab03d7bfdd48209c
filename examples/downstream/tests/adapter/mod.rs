//! The renderer behind furnace's trait: one method a question. What is not implemented is not asked.

use furnace::contract::{
    Acceleration, BoxHit, BuildStats, Built, BuiltScene, Capabilities, Core, CoreInfo,
    DirectionSample, Hit, Primitive, Randomness, Ray, Result, Sampler, TraversalStats,
};
use furnace::glam::{DVec2, DVec3};
use furnace::scene::{Aabb, Camera, SceneDescription};
use tiny::Shape;

pub struct Tiny;

impl Core for Tiny {
    fn info(&self) -> CoreInfo {
        let capabilities = Capabilities::GENERATE_RAYS
            | Capabilities::INTERSECT_PRIMITIVE
            | Capabilities::INTERSECT_BOX
            | Capabilities::SAMPLE_DIRECTION
            | Capabilities::BUILD_SCENE
            | Capabilities::INTERSECT
            | Capabilities::OCCLUDED
            | Capabilities::CALLERS_RANDOMNESS
            | Capabilities::DETERMINISTIC;
        CoreInfo { name: "tiny".to_owned(), capabilities, ..CoreInfo::default() }
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        let camera = tiny::Camera {
            position: camera.position,
            to_world: camera.camera_to_world,
            fov: DVec2::new(camera.horizontal_fov, camera.vertical_fov),
            near: camera.near,
            far: camera.far,
        };
        for (ray, point) in rays.iter_mut().zip(film) {
            let tiny::Ray { origin, direction, min, max } = camera.ray(*point);
            *ray = Ray { origin, t_min: min, direction, t_max: max };
        }
        Ok(())
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        let (shape, normals) = match *primitive {
            Primitive::Triangle { positions, normals } => {
                (Shape::Triangle(positions), Some(normals))
            }
            Primitive::Sphere { centre, radius } => (Shape::Sphere { centre, radius }, None),
        };
        let shape = Placed { shape, normals, number: [0, 0], inward: false };
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = shape.hit(&ours(ray)).unwrap_or(Hit::MISS);
        }
        Ok(())
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            let crossing = tiny::slabs(bounds.min, bounds.max, &ours(ray));
            let (t_enter, t_exit) = crossing.unwrap_or_default();
            *hit = BoxHit { t_enter, t_exit, hit: crossing.is_some().into(), reserved: 0 };
        }
        Ok(())
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        for (sample, point) in samples.iter_mut().zip(random.points) {
            let direction = tiny::hemisphere(*point, is_cosine(sampler));
            let pdf = tiny::hemisphere_pdf(direction, is_cosine(sampler));
            *sample = DirectionSample { direction, pdf };
        }
        Ok(())
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        for (pdf, direction) in pdf.iter_mut().zip(directions) {
            *pdf = tiny::hemisphere_pdf(*direction, is_cosine(sampler));
        }
        Ok(())
    }

    fn build_scene(&mut self, scene: &SceneDescription, _: Acceleration) -> Result<Built<'_>> {
        let meshes = (0..).zip(&scene.meshes);
        let triangles = meshes.flat_map(|(shape, mesh)| {
            (0..mesh.indices.len()).map(move |number| Placed {
                shape: Shape::Triangle(mesh.corners(number)),
                normals: Some(mesh.corner_normals(number)),
                number: [shape, number as u32],
                inward: false,
            })
        });
        let spheres = (scene.meshes.len() as u32..).zip(&scene.spheres);
        let spheres = spheres.map(|(shape, sphere)| Placed {
            shape: Shape::Sphere { centre: sphere.centre, radius: sphere.radius },
            normals: None,
            number: [shape, 0],
            inward: sphere.inward,
        });
        Ok(Box::new(World(triangles.chain(spheres).collect())))
    }
}

/// A shape of a scene.
struct Placed {
    shape: Shape,
    /// Shading normals at the vertices.
    normals: Option<[DVec3; 3]>,
    /// Shape and primitive, as furnace counts them.
    number: [u32; 2],
    /// Normals point to the centre.
    inward: bool,
}

impl Placed {
    fn hit(&self, ray: &tiny::Ray) -> Option<Hit> {
        let tiny::Hit { t, normal, weights: uv } = self.shape.hit(ray)?;
        let geometric_normal = if self.inward { -normal } else { normal };
        let shading_normal = match self.normals {
            Some([a, b, c]) => ((1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c).normalize(),
            None => geometric_normal,
        };
        let [shape, primitive] = self.number;
        Some(Hit { t, shape, primitive, geometric_normal, shading_normal, uv })
    }
}

/// Every ray against every shape.
struct World(Vec<Placed>);

impl World {
    fn nearest(&self, mut ray: tiny::Ray) -> Hit {
        let mut nearest = Hit::MISS;
        for shape in &self.0 {
            if let Some(hit) = shape.hit(&ray) {
                ray.max = hit.t;
                nearest = hit;
            }
        }
        nearest
    }
}

impl BuiltScene for World {
    fn stats(&self) -> BuildStats {
        BuildStats::default()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = self.nearest(ours(ray));
        }
        Ok(TraversalStats::default())
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        for (occluded, ray) in occluded.iter_mut().zip(rays) {
            *occluded = self.0.iter().any(|shape| shape.hit(&ours(ray)).is_some());
        }
        Ok(TraversalStats::default())
    }
}

fn ours(ray: &Ray) -> tiny::Ray {
    tiny::Ray { origin: ray.origin, direction: ray.direction, min: ray.t_min, max: ray.t_max }
}

fn is_cosine(sampler: Sampler) -> bool {
    sampler == Sampler::CosineHemisphere
}
