//! The scene as rays see it: primitives to hit, materials at the hits, lights.

use super::bvh::{Bvh, Form, Primitive};
use super::change::Change;
use super::frame::Frame;
use super::intersect::{Ball, Crossing, Triangle};
use super::light::Lamp;
use super::vertex::{Vertex, View, clearance, frame_normal};
use crate::contract::{self, Acceleration, BuildStats, Hit, Ray, TraversalStats};
use crate::scene::{self, Emission, Light, Rgb, SceneDescription, Surface};
use glam::{DVec2, DVec3};

/// A scene the core has taken in.
#[derive(Debug)]
pub struct World {
    bvh: Bvh,
    shapes: Vec<Shape>,
    lights: Vec<Lamp>,
    change: Change,
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
    /// The light that this shape is.
    light: Option<usize>,
}

impl World {
    /// Takes the scene in.
    pub fn new(scene: &SceneDescription, acceleration: Acceleration, change: Change) -> Self {
        let lamp = |light| Lamp::new(light, scene, change);
        Self {
            bvh: Bvh::new(primitives(scene), acceleration, change),
            shapes: (0..scene.shape_count() as u32).map(|n| Shape::new(scene, n)).collect(),
            lights: scene.lights.iter().map(lamp).collect(),
            change,
        }
    }

    /// What this copy of the core does otherwise.
    pub fn change(&self) -> Change {
        self.change
    }

    /// The lights, by number.
    pub fn lights(&self) -> &[Lamp] {
        &self.lights
    }

    /// What the build made.
    pub fn build_stats(&self) -> BuildStats {
        self.bvh.build_stats()
    }

    /// The nearest hit.
    pub fn closest_hit(&self, ray: &Ray, stats: &mut TraversalStats) -> Option<Hit> {
        let (index, crossing) = self.bvh.closest(ray, stats)?;
        Some(self.hit(self.bvh.primitive(index), ray, crossing))
    }

    /// Whether anything lies on the segment.
    pub fn any_hit(&self, ray: &Ray, stats: &mut TraversalStats) -> bool {
        self.bvh.any(ray, stats)
    }

    /// What a ray sees.
    pub fn look(&self, ray: &Ray) -> View<'_> {
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
    pub fn sky_radiance(&self, direction: DVec3) -> DVec3 {
        self.lights.iter().map(|light| DVec3::from(light.sky_radiance(direction))).sum()
    }

    fn hit(&self, primitive: &Primitive, ray: &Ray, crossing: Crossing) -> Hit {
        let shape = &self.shapes[primitive.shape as usize];
        let normal = match &primitive.form {
            Form::Triangle(triangle) => triangle.normal(),
            Form::Ball(ball) if shape.inward => {
                -ball.outward_normal(ray.at(crossing.t), self.change)
            }
            Form::Ball(ball) => ball.outward_normal(ray.at(crossing.t), self.change),
        };
        let interpolated = shape.shading_normal(primitive.number, crossing.uv, self.change);
        let hit = Hit {
            t: crossing.t,
            shape: primitive.shape,
            primitive: primitive.number,
            geometric_normal: normal,
            shading_normal: interpolated.unwrap_or(normal),
            uv: crossing.uv,
        };
        turned(hit, ray, self.change)
    }

    fn vertex(&self, primitive: &Primitive, ray: &Ray, hit: Hit, to_viewer: DVec3) -> Vertex<'_> {
        let shape = &self.shapes[primitive.shape as usize];
        let frame = Frame::around(frame_normal(&shape.surface, &hit, to_viewer));
        Vertex {
            point: ray.at(hit.t),
            normal: hit.geometric_normal,
            wo: frame.to_local(to_viewer),
            frame,
            surface: &shape.surface,
            emitted: shape.emitted(&primitive.form, &hit, ray, to_viewer, self.change),
            light: shape.light.map(|light| &self.lights[light]),
            clearance: clearance(&primitive.form, ray, hit.t, self.change),
            travelled: hit.t,
            change: self.change,
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

    /// The normals of the vertices, weighted like their positions; `None` for flat faces and
    /// spheres.
    fn shading_normal(&self, triangle: u32, uv: DVec2, change: Change) -> Option<DVec3> {
        let corners = self.indices.get(triangle as usize)?;
        interpolate_normal(corners.map(|corner| self.normals[corner as usize]), uv, change)
    }

    /// Radiance that leaves the hit towards the viewer: from the front alone.
    fn emitted(
        &self,
        form: &Form,
        hit: &Hit,
        ray: &Ray,
        to_viewer: DVec3,
        change: Change,
    ) -> DVec3 {
        let is_lit =
            is_front(hit.geometric_normal, to_viewer) || change == Change::TwoSidedEmission;
        match &self.emission {
            Some(emission) if is_lit => emitted_at(emission, form, ray.at(hit.t)).into(),
            _ => DVec3::ZERO,
        }
    }
}

fn is_front(normal: DVec3, to_viewer: DVec3) -> bool {
    normal.dot(to_viewer) > 0.0
}

fn emitted_at(emission: &Emission, form: &Form, point: DVec3) -> Rgb {
    match form {
        Form::Ball(ball) => emission.at_sphere_point(ball.outward_normal(point, Change::None)),
        Form::Triangle(_) => emission.radiance,
    }
}

/// Barycentric interpolation: `uv` are the weights of vertices 1 and 2.
fn interpolate_normal([n0, n1, n2]: [DVec3; 3], uv: DVec2, change: Change) -> Option<DVec3> {
    let normal = match change {
        Change::NormalsSwapped => (1.0 - uv.x - uv.y) * n0 + uv.y * n1 + uv.x * n2,
        _ => (1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2,
    };
    match change {
        Change::FlatShading => None,
        Change::NormalNotNormalised => Some(normal),
        _ => normal.try_normalize(),
    }
}

/// Normals stay on their side, wherever the ray comes from.
fn turned(hit: Hit, ray: &Ray, change: Change) -> Hit {
    let is_from_behind = hit.geometric_normal.dot(ray.direction) > 0.0;
    if change != Change::NormalsFaceRay || !is_from_behind {
        return hit;
    }
    Hit { geometric_normal: -hit.geometric_normal, shading_normal: -hit.shading_normal, ..hit }
}

/// The hit of `ray` with a single primitive that belongs to no scene.
pub fn hit_alone(primitive: &contract::Primitive, ray: &Ray, change: Change) -> Option<Hit> {
    let (crossing, normal, shading_normal) = match *primitive {
        contract::Primitive::Triangle { positions, normals } => {
            let triangle = Triangle::new(positions)?;
            let crossing = triangle.intersect(ray, change)?;
            (crossing, triangle.normal(), interpolate_normal(normals, crossing.uv, change))
        }
        contract::Primitive::Sphere { centre, radius } => {
            let ball = Ball::new(centre, radius)?;
            let crossing = ball.intersect(ray, change)?;
            (crossing, ball.outward_normal(ray.at(crossing.t), change), None)
        }
    };
    let hit = Hit {
        t: crossing.t,
        shape: 0,
        primitive: 0,
        geometric_normal: normal,
        shading_normal: shading_normal.unwrap_or(normal),
        uv: crossing.uv,
    };
    Some(turned(hit, ray, change))
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
            vec![Ball::new(sphere.centre, sphere.radius).map(Form::Ball)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::testing::{Stage, diffuse};
    use crate::scene::Mesh;

    fn hit(world: &World, from: DVec3, direction: DVec3) -> Hit {
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
        let hit = hit(&world, DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z);
        let expected = 0.5 * mesh.normals[0] + 0.2 * mesh.normals[1] + 0.3 * mesh.normals[2];
        assert!(hit.shading_normal.abs_diff_eq(expected.normalize(), 1e-15), "{hit:?}");
        assert_eq!(hit.geometric_normal, DVec3::Z);
        let alone = contract::Primitive::Triangle {
            positions: [DVec3::ZERO, DVec3::X, DVec3::Y],
            normals: [mesh.normals[0], mesh.normals[1], mesh.normals[2]],
        };
        let ray = Ray::new(DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z);
        let alone = hit_alone(&alone, &ray, Change::None).expect("aimed at it");
        assert_eq!(alone.shading_normal, hit.shading_normal);
    }

    #[test]
    fn hits_keep_the_numbers_of_the_scene() {
        let mut above_the_floor = smooth_triangle();
        above_the_floor.positions.iter_mut().for_each(|position| *position += DVec3::Z);
        let world = Stage::empty()
            .ball(DVec3::X * 5.0, 1.0, diffuse(0.5))
            .mesh(above_the_floor, diffuse(0.5))
            .floor()
            .ball(DVec3::X * -5.0, 1.0, diffuse(0.5))
            .world();
        let number = |x: f64, y: f64| {
            let hit = hit(&world, DVec3::new(x, y, 3.0), DVec3::NEG_Z);
            (hit.shape, hit.primitive)
        };
        // The triangle without area keeps its number; the floor's second triangle is beyond its
        // diagonal.
        assert_eq!(number(0.2, 0.2), (0, 1));
        assert_eq!((number(0.0, -4.0), number(0.0, 4.0)), ((1, 0), (1, 1)));
        assert_eq!((number(5.0, 0.0), number(-5.0, 0.0)), ((2, 0), (3, 0)));
    }

    #[test]
    fn a_room_has_its_normals_inside_wherever_it_is_seen_from() {
        let world = Stage::empty().room(1.0, diffuse(0.5)).world();
        assert_eq!(hit(&world, DVec3::ZERO, DVec3::X).geometric_normal, DVec3::NEG_X);
        assert_eq!(hit(&world, DVec3::X * 3.0, DVec3::NEG_X).geometric_normal, DVec3::NEG_X);
    }

    #[test]
    fn emission_leaves_the_front_alone() {
        let world = Stage::empty().room(1.0, diffuse(0.5).glowing(2.0)).world();
        let emitted = |from: DVec3| match world.look(&Ray::new(from, DVec3::NEG_X)) {
            View::Surface(vertex) => vertex.emitted.x,
            View::Sky(_) => f64::NAN,
        };
        assert_eq!((emitted(DVec3::ZERO), emitted(DVec3::X * 3.0)), (2.0, 0.0));
    }
}
