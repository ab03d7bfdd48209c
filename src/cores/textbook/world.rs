//! The scene as rays see it: primitives to hit, materials at the hits, lights.

use super::bvh::{Bvh, Form, Primitive};
use super::frame::Frame;
use super::intersect::{Crossing, Sphere, Triangle, outward_normal};
use super::light::Emitter;
use super::steps::Steps;
use super::vertex::{Vertex, View};
use crate::contract::{self, Acceleration, BuildStats, Hit, Ray, TraversalStats};
use crate::scene::{self, Emission, Light, Rgb, SceneDescription, Surface};
use glam::{DVec2, DVec3};

#[derive(Debug)]
pub(crate) struct World<'a> {
    bvh: Bvh<'a>,
    shapes: Vec<Shape>,
    lights: Vec<Emitter>,
    steps: &'a Steps,
}

/// What all primitives of a shape share.
#[derive(Debug)]
struct Shape {
    surface: Surface,
    emission: Option<Emission>,
    /// Normals of spheres point to the centre.
    inward: bool,
    /// Shading normals at the vertices of a mesh, or none.
    normals: Vec<DVec3>,
    /// The vertices of each triangle, where there are normals.
    indices: Vec<[u32; 3]>,
    light: Option<usize>,
}

impl<'a> World<'a> {
    pub(crate) fn new(
        scene: &SceneDescription,
        acceleration: Acceleration,
        steps: &'a Steps,
    ) -> Self {
        Self {
            bvh: Bvh::new(primitives(scene), acceleration, steps),
            shapes: (0..scene.shape_count() as u32).map(|n| Shape::new(scene, n)).collect(),
            lights: scene.lights.iter().map(|light| Emitter::new(light, scene)).collect(),
            steps,
        }
    }

    pub(crate) fn steps(&self) -> &'a Steps {
        self.steps
    }

    pub(crate) fn lights(&self) -> &[Emitter] {
        &self.lights
    }

    pub(crate) fn build_stats(&self) -> BuildStats {
        self.bvh.build_stats()
    }

    pub(crate) fn closest_hit(&self, ray: &Ray, stats: &mut TraversalStats) -> Option<Hit> {
        let (index, crossing) = self.bvh.closest(ray, stats)?;
        Some(self.hit(self.bvh.primitive(index), ray, crossing))
    }

    pub(crate) fn any_hit(&self, ray: &Ray, stats: &mut TraversalStats) -> bool {
        self.bvh.any(ray, stats)
    }

    pub(crate) fn look(&self, ray: &Ray) -> View<'_> {
        let direction = ray.direction.normalize();
        match self.bvh.closest(ray, &mut TraversalStats::default()) {
            None => View::Sky(direction),
            Some((index, crossing)) => {
                let primitive = self.bvh.primitive(index);
                let hit = self.hit(primitive, ray, crossing);
                View::Surface(self.vertex(primitive, ray, hit, -direction))
            }
        }
    }

    /// Radiance of all skies from `direction`.
    pub(crate) fn sky_radiance(&self, direction: DVec3) -> DVec3 {
        self.lights.iter().map(|light| DVec3::from(light.sky_radiance(direction))).sum()
    }

    fn hit(&self, primitive: &Primitive, ray: &Ray, crossing: Crossing) -> Hit {
        let shape = &self.shapes[primitive.shape as usize];
        let normal = match &primitive.form {
            Form::Triangle(triangle) => triangle.normal(),
            Form::Sphere(sphere) if shape.inward => -sphere.normal(ray, crossing.t, self.steps),
            Form::Sphere(sphere) => sphere.normal(ray, crossing.t, self.steps),
        };
        let interpolated = shape.shading_normal(primitive.number, crossing.uv, self.steps);
        let numbers = [primitive.shape, primitive.number];
        self.steps.hit(ray, crossing, numbers, [normal, interpolated.unwrap_or(normal)])
    }

    fn vertex(&self, primitive: &Primitive, ray: &Ray, hit: Hit, to_viewer: DVec3) -> Vertex<'_> {
        let shape = &self.shapes[primitive.shape as usize];
        let frame = Frame::around(self.steps.frame_normal(&shape.surface, &hit, to_viewer));
        let is_front = self.steps.emits_towards(hit.geometric_normal, to_viewer);
        let travelled = hit.t * ray.direction;
        let longest = ray.origin.abs().max(travelled.abs()).max(primitive.form.reach());
        Vertex {
            point: ray.at(hit.t),
            normal: hit.geometric_normal,
            wo: frame.to_local(to_viewer),
            frame,
            surface: &shape.surface,
            emitted: match &shape.emission {
                Some(emission) if is_front => emitted_at(emission, &primitive.form, ray.at(hit.t)),
                _ => DVec3::ZERO,
            },
            light: shape.light.map(|light| &self.lights[light]),
            clearance: self.steps.clearance(longest.max_element()),
            travelled: hit.t,
        }
    }
}

impl Shape {
    fn new(scene: &SceneDescription, number: u32) -> Self {
        let (inward, normals, indices) = match scene.shape(number) {
            scene::Shape::Sphere(sphere) => (sphere.inward, Vec::new(), Vec::new()),
            scene::Shape::Mesh(mesh) if mesh.normals.is_empty() => Default::default(),
            scene::Shape::Mesh(mesh) => (false, mesh.normals.clone(), mesh.indices.clone()),
        };
        let material = scene.material_of(number);
        let is_this = |light: &Light| *light == Light::Area { shape: number };
        Self {
            surface: material.surface,
            emission: material.emission,
            inward,
            normals,
            indices,
            light: scene.lights.iter().position(is_this),
        }
    }

    /// The normals of the vertices, weighted like their positions; `None` for flat faces and spheres.
    fn shading_normal(&self, triangle: u32, uv: DVec2, steps: &Steps) -> Option<DVec3> {
        let corners = self.indices.get(triangle as usize)?;
        steps.interpolated_normal(corners.map(|corner| self.normals[corner as usize]), uv)
    }
}

/// Surfaces emit from their front alone.
pub(crate) fn emits_towards(normal: DVec3, to_viewer: DVec3) -> bool {
    normal.dot(to_viewer) > 0.0
}

fn emitted_at(emission: &Emission, form: &Form, point: DVec3) -> DVec3 {
    let radiance: Rgb = match form {
        Form::Sphere(sphere) => emission.at_sphere_point(outward_normal(sphere, point)),
        Form::Triangle(_) => emission.radiance,
    };
    radiance.into()
}

/// Barycentric interpolation: `uv` are the weights of vertices 1 and 2.
pub(crate) fn interpolated_normal([n0, n1, n2]: [DVec3; 3], uv: DVec2) -> Option<DVec3> {
    ((1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2).try_normalize()
}

/// What is said of a hit of this shape and primitive; normals, geometric and for shading, stay on
/// their side, wherever the ray comes from.
pub(crate) fn hit(_ray: &Ray, crossing: Crossing, numbers: [u32; 2], normals: [DVec3; 2]) -> Hit {
    let ([shape, primitive], [geometric_normal, shading_normal]) = (numbers, normals);
    let Crossing { t, uv, .. } = crossing;
    Hit { t, shape, primitive, geometric_normal, shading_normal, uv }
}

/// The hit of `ray` with a single primitive that belongs to no scene.
pub(crate) fn hit_alone(primitive: &contract::Primitive, ray: &Ray, steps: &Steps) -> Option<Hit> {
    let (crossing, normal, interpolated) = match *primitive {
        contract::Primitive::Triangle { positions, normals } => {
            let triangle = Triangle::new(positions)?;
            let crossing = triangle.intersect(ray, steps)?;
            (crossing, triangle.normal(), steps.interpolated_normal(normals, crossing.uv))
        }
        contract::Primitive::Sphere { centre, radius } => {
            let sphere = Sphere::new(centre, radius)?;
            let crossing = sphere.intersect(ray, steps)?;
            (crossing, sphere.normal(ray, crossing.t, steps), None)
        }
    };
    Some(steps.hit(ray, crossing, [0, 0], [normal, interpolated.unwrap_or(normal)]))
}

/// Everything that can be hit, each with its number in its shape.
fn primitives(scene: &SceneDescription) -> Vec<Primitive> {
    let of_shape = |shape| {
        let forms = (0..).zip(forms(scene.shape(shape)));
        forms.filter_map(move |(number, form)| Some(Primitive { form: form?, shape, number }))
    };
    (0..scene.shape_count() as u32).flat_map(of_shape).collect()
}

/// The forms of a shape; `None` for triangles without area and spheres without size.
fn forms(shape: scene::Shape<'_>) -> Vec<Option<Form>> {
    match shape {
        scene::Shape::Mesh(mesh) => (0..mesh.indices.len())
            .map(|triangle| Triangle::new(mesh.corners(triangle)).map(Form::Triangle))
            .collect(),
        scene::Shape::Sphere(sphere) => {
            vec![Sphere::new(sphere.centre, sphere.radius).map(Form::Sphere)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::stage::{Stage, diffuse};
    use crate::cores::textbook::steps::LESSON;
    use crate::scene::Mesh;

    impl Stage {
        /// As rays see it.
        pub(crate) fn world(self) -> World<'static> {
            World::new(&self.scene(), Acceleration::DEFAULT, &LESSON)
        }
    }

    fn hit_from(world: &World<'_>, from: DVec3, direction: DVec3) -> Hit {
        let ray = Ray::new(from, direction);
        world.closest_hit(&ray, &mut TraversalStats::default()).expect("aimed at it")
    }

    /// The unit triangle in z = 0 after one without area, with a normal of its own at each corner.
    fn smooth_triangle() -> Mesh {
        let normal = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize();
        Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            normals: vec![normal(0.0, 0.0), normal(0.5, 0.0), normal(0.0, 0.9)],
            indices: vec![[0, 0, 1], [0, 1, 2]],
            ..Mesh::default()
        }
    }

    #[test]
    fn shading_normals_are_weighted_like_positions_and_unit() {
        let mesh = smooth_triangle();
        let world = Stage::empty().mesh(mesh.clone(), diffuse(0.5)).world();
        let hit = hit_from(&world, DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z);
        let expected = 0.5 * mesh.normals[0] + 0.2 * mesh.normals[1] + 0.3 * mesh.normals[2];
        assert!(hit.shading_normal.abs_diff_eq(expected.normalize(), 1e-15), "{hit:?}");
        assert_eq!(hit.geometric_normal, DVec3::Z);
        let alone = contract::Primitive::Triangle {
            positions: [DVec3::ZERO, DVec3::X, DVec3::Y],
            normals: [mesh.normals[0], mesh.normals[1], mesh.normals[2]],
        };
        let ray = Ray::new(DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z);
        let alone = hit_alone(&alone, &ray, &LESSON).expect("aimed at it");
        assert_eq!(alone.shading_normal, hit.shading_normal);
    }

    #[test]
    fn hits_keep_the_numbers_of_the_scene() {
        let mut above_the_floor = smooth_triangle();
        above_the_floor.positions.iter_mut().for_each(|position| *position += DVec3::Z);
        let world = Stage::empty()
            .sphere(DVec3::X * 5.0, 1.0, diffuse(0.5))
            .mesh(above_the_floor, diffuse(0.5))
            .floor()
            .sphere(DVec3::X * -5.0, 1.0, diffuse(0.5))
            .world();
        let number = |x: f64, y: f64| {
            let hit = hit_from(&world, DVec3::new(x, y, 3.0), DVec3::NEG_Z);
            (hit.shape, hit.primitive)
        };
        // The triangle without area keeps its number; the floor's second triangle is beyond its diagonal.
        assert_eq!(number(0.2, 0.2), (0, 1));
        assert_eq!((number(0.0, -4.0), number(0.0, 4.0)), ((1, 0), (1, 1)));
        assert_eq!((number(5.0, 0.0), number(-5.0, 0.0)), ((2, 0), (3, 0)));
    }

    #[test]
    fn a_room_has_its_normals_inside_wherever_it_is_seen_from() {
        let world = Stage::empty().room(1.0, diffuse(0.5)).world();
        assert_eq!(hit_from(&world, DVec3::ZERO, DVec3::X).geometric_normal, DVec3::NEG_X);
        assert_eq!(hit_from(&world, DVec3::X * 3.0, DVec3::NEG_X).geometric_normal, DVec3::NEG_X);
    }

    #[test]
    fn emission_leaves_the_front_alone() {
        let world = Stage::empty().room(1.0, diffuse(0.5).emitting(2.0)).world();
        let emitted = |from: DVec3| match world.look(&Ray::new(from, DVec3::NEG_X)) {
            View::Surface(vertex) => vertex.emitted.x,
            View::Sky(_) => f64::NAN,
        };
        assert_eq!((emitted(DVec3::ZERO), emitted(DVec3::X * 3.0)), (2.0, 0.0));
    }
}
