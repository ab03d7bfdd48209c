//! A scene taken elsewhere as a whole: turned, its parts in another order and without their names. Radiance does not
//! notice.
//!
//! Turns are about the vertical by right angles, so that no number is rounded: a ray that runs along an edge runs along
//! it afterwards. Up stays up, since mistakes are known by it: directions about the world's z in place of the normal.
//! Lengths stay, for mistakes are known by their size: a pdf without the square of the distance.

use super::{Camera, Cap, Emission, Light, Material, Mesh, SceneDescription, Sphere};
use crate::math::rng::{Seed, below, shuffle};
use glam::{DMat3, DVec3};
use std::fmt;
use std::ops::Range;

/// Where scenes are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    turn: Turn,
    order: Seed,
}

/// By so many right angles about the vertical, from x to y.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Turn {
    Quarter,
    Half,
    ThreeQuarters,
}

/// What became of a scene's parts: for each number afterwards the number before.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Labels {
    shapes: Vec<u32>,
    /// Of each shape afterwards.
    primitives: Vec<Vec<u32>>,
    lights: Vec<u32>,
}

impl Motion {
    /// One of all there are but standing still.
    pub(crate) fn drawn(seed: Seed) -> Self {
        let turns = [Turn::Quarter, Turn::Half, Turn::ThreeQuarters];
        Self { turn: turns[below(3, &mut seed.stream())], order: seed.child("order") }
    }

    /// Where a point or a direction is afterwards.
    pub(crate) fn there(&self, vector: DVec3) -> DVec3 {
        self.turn.there(vector)
    }

    /// Undoes [`Self::there`].
    pub(crate) fn back(&self, vector: DVec3) -> DVec3 {
        self.turn.back(vector)
    }

    pub(crate) fn camera(&self, camera: &Camera) -> Camera {
        let frame = camera.camera_to_world;
        let [right, up, backward] =
            [frame.x_axis, frame.y_axis, frame.z_axis].map(|axis| self.there(axis));
        Camera {
            position: self.there(camera.position),
            camera_to_world: DMat3::from_cols(right, up, backward),
            ..*camera
        }
    }

    /// The scene afterwards.
    pub(crate) fn scene(&self, scene: &SceneDescription) -> (SceneDescription, Labels) {
        let labels = Labels::drawn(scene, self.order);
        let (meshes, spheres) = labels.shapes.split_at(scene.meshes.len());
        let mesh = |(number, old)| self.mesh(&scene.meshes[old as usize], number, &labels);
        let sphere = |(number, old): (usize, u32)| {
            self.sphere(&scene.spheres[old as usize - scene.meshes.len()], number)
        };
        let light = |old: &u32| self.light(&scene.lights[*old as usize], &labels);
        let moved = SceneDescription {
            name: "scene".to_owned(),
            camera: scene.camera.map(|camera| self.camera(&camera)),
            materials: (0..).zip(&scene.materials).map(|it| self.material(it)).collect(),
            meshes: (0..).zip(meshes.iter().copied()).map(mesh).collect(),
            spheres: (0..).zip(spheres.iter().copied()).map(sphere).collect(),
            lights: labels.lights.iter().map(light).collect(),
        };
        (moved, labels)
    }

    fn material(&self, (number, material): (usize, &Material)) -> Material {
        let turned = |cap: Cap| Cap { axis: self.there(cap.axis), ..cap };
        let emission = material.emission.map(|it| Emission { cap: it.cap.map(turned), ..it });
        Material { name: format!("material-{number}"), emission, ..*material }
    }

    fn mesh(&self, mesh: &Mesh, number: usize, labels: &Labels) -> Mesh {
        let order = labels.primitives[number].iter();
        Mesh {
            name: format!("mesh-{number}"),
            positions: mesh.positions.iter().map(|point| self.there(*point)).collect(),
            normals: mesh.normals.iter().map(|normal| self.there(*normal)).collect(),
            indices: order.map(|old| mesh.indices[*old as usize]).collect(),
            material: mesh.material,
        }
    }

    fn sphere(&self, sphere: &Sphere, number: usize) -> Sphere {
        Sphere { name: format!("sphere-{number}"), centre: self.there(sphere.centre), ..*sphere }
    }

    fn light(&self, light: &Light, labels: &Labels) -> Light {
        match *light {
            Light::Point { position, intensity } => {
                Light::Point { position: self.there(position), intensity }
            }
            Light::Directional { direction, irradiance } => {
                Light::Directional { direction: self.there(direction), irradiance }
            }
            Light::ConstantSky { radiance } => Light::ConstantSky { radiance },
            Light::GradientSky { up, horizon, zenith } => {
                Light::GradientSky { up: self.there(up), horizon, zenith }
            }
            Light::Area { shape } => Light::Area { shape: after(&labels.shapes, shape) },
        }
    }
}

/// Each coordinate afterwards in those before.
impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.turn {
            Turn::Quarter => "[-y, x, z]",
            Turn::Half => "[-x, -y, z]",
            Turn::ThreeQuarters => "[y, -x, z]",
        })
    }
}

impl Turn {
    fn there(self, DVec3 { x, y, z }: DVec3) -> DVec3 {
        match self {
            Self::Quarter => DVec3::new(negative(y), x, z),
            Self::Half => DVec3::new(negative(x), negative(y), z),
            Self::ThreeQuarters => DVec3::new(y, negative(x), z),
        }
    }

    fn back(self, after: DVec3) -> DVec3 {
        let inverse = match self {
            Self::Quarter => Self::ThreeQuarters,
            Self::Half => Self::Half,
            Self::ThreeQuarters => Self::Quarter,
        };
        inverse.there(after)
    }
}

/// A zero keeps its sign, which a case may be about, and a NaN its bits.
fn negative(value: f64) -> f64 {
    if value == 0.0 || value.is_nan() { value } else { -value }
}

impl Labels {
    /// Meshes stay before spheres, and declared lights before those of shapes, which follow their shapes.
    fn drawn(scene: &SceneDescription, seed: Seed) -> Self {
        let [meshes, all] = [scene.meshes.len(), scene.shape_count()].map(|count| count as u32);
        let mut shapes = shuffled(0..meshes, seed.child("meshes"));
        shapes.extend(shuffled(meshes..all, seed.child("spheres")));
        let triangles =
            |shape: u32| scene.meshes.get(shape as usize).map_or(1, |mesh| mesh.indices.len());
        let of_shape = |shape: &u32| {
            shuffled(0..triangles(*shape) as u32, seed.child("triangles").child(shape))
        };
        let mut lights = shuffled(0..scene.lights.len() as u32, seed.child("lights"));
        lights.sort_by_key(|light| match scene.lights[*light as usize] {
            Light::Area { shape } => 1 + after(&shapes, shape),
            _ => 0,
        });
        Self { primitives: shapes.iter().map(of_shape).collect(), shapes, lights }
    }

    /// The number afterwards of a light; one that does not exist keeps its number.
    pub(crate) fn light(&self, light: u32) -> u32 {
        after(&self.lights, light)
    }

    /// The numbers before of a shape and one of its primitives; what does not exist keeps its numbers.
    pub(crate) fn primitive_back(&self, shape: u32, primitive: u32) -> (u32, u32) {
        let primitives = self.primitives.get(shape as usize).map_or(&[][..], Vec::as_slice);
        (before(&self.shapes, shape), before(primitives, primitive))
    }
}

fn before(numbers: &[u32], after: u32) -> u32 {
    numbers.get(after as usize).copied().unwrap_or(after)
}

fn after(numbers: &[u32], before: u32) -> u32 {
    let mut all = (0..).zip(numbers);
    all.find(|(_, number)| **number == before).map_or(before, |(place, _)| place)
}

fn shuffled(numbers: Range<u32>, seed: Seed) -> Vec<u32> {
    let mut numbers: Vec<_> = numbers.collect();
    shuffle(&mut numbers, &mut seed.stream());
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Surface;

    /// Two meshes, a sphere with a cap that emits, a point light.
    fn scene() -> SceneDescription {
        let mesh = |x: f64, count: u32| Mesh {
            name: "wall".to_owned(),
            positions: vec![DVec3::new(x, 0.0, 0.1), DVec3::new(x, 1.0, 0.0), DVec3::Z],
            indices: (0..count).map(|_| [0, 1, 2]).collect(),
            ..Mesh::default()
        };
        let cap = Some(Cap { axis: DVec3::X, half_angle: 1.0 });
        let emission = Some(Emission { radiance: [1.0; 3], cap });
        let surface = Surface::Diffuse { reflectance: [0.5; 3] };
        let sphere = Sphere {
            name: "globe".to_owned(),
            centre: DVec3::new(0.1, 0.2, 0.3),
            radius: 0.7,
            inward: false,
            material: 1,
        };
        let material = |emission| Material { name: "clay".to_owned(), surface, emission };
        let light = Light::Point { position: DVec3::Y, intensity: [3.0; 3] };
        SceneDescription {
            name: "published".to_owned(),
            materials: vec![material(None), material(emission)],
            meshes: vec![mesh(0.3, 5), mesh(0.6, 7)],
            spheres: vec![sphere],
            lights: vec![light],
            ..SceneDescription::default()
        }
        .with_area_lights()
    }

    fn motions() -> impl Iterator<Item = Motion> {
        (0..200).map(|seed| Motion::drawn(Seed(seed)))
    }

    #[test]
    fn no_scene_stays_where_it_is_and_none_becomes_its_mirror_image() {
        let there: std::collections::BTreeSet<_> = motions()
            .map(|motion| format!("{:?}", motion.there(DVec3::new(1.0, 2.0, 3.0))))
            .collect();
        assert_eq!(there.len(), 3);
        assert!(motions().all(|motion| motion.there(DVec3::Z) == DVec3::Z));
    }

    #[test]
    fn what_goes_there_comes_back_to_the_last_bit() {
        let direction = DVec3::new(0.1, -0.0, f64::NAN);
        for motion in motions() {
            let back = motion.back(motion.there(direction));
            assert_eq!(back.to_array().map(f64::to_bits), direction.to_array().map(f64::to_bits));
        }
    }

    #[test]
    fn a_motion_says_what_became_of_the_axes() {
        for motion in motions() {
            let numbers = motion.there(DVec3::new(1.0, 2.0, 3.0)).to_string();
            let names = numbers.replace('1', "x").replace('2', "y").replace('3', "z");
            assert_eq!(names, motion.to_string());
        }
    }

    #[test]
    fn all_of_a_scene_turns_together() {
        let before = scene();
        for motion in motions() {
            let (after, _) = motion.scene(&before);
            let Light::Point { position, intensity } = after.lights[0] else { panic!("it moved") };
            let distance = position.distance(after.spheres[0].centre);
            let was = DVec3::Y.distance(before.spheres[0].centre);
            assert!((distance / was - 1.0).abs() < 1e-12);
            assert_eq!(intensity, [3.0; 3]);
            let axis = after.materials[1].emission.and_then(|it| it.cap).map(|cap| cap.axis);
            assert_eq!(axis, Some(motion.there(DVec3::X)));
        }
    }

    #[test]
    fn parts_are_found_again_by_their_labels() {
        let before = scene();
        for motion in motions() {
            let (after, labels) = motion.scene(&before);
            assert_eq!(after.lights[labels.light(1) as usize], Light::Area { shape: 2 });
            assert_eq!(labels.light(9), 9);
            for shape in 0..2 {
                let (old, _) = labels.primitive_back(shape, 0);
                let [old, new] = [&before.meshes[old as usize], &after.meshes[shape as usize]];
                assert_eq!(old.indices.len(), new.indices.len());
                assert_eq!(motion.there(old.positions[0]), new.positions[0]);
            }
            assert_eq!(labels.primitive_back(2, 0), (2, 0));
            assert_eq!(labels.primitive_back(7, u32::MAX), (7, u32::MAX));
        }
    }

    #[test]
    fn nothing_is_called_what_its_file_calls_it() {
        let (scene, _) = Motion::drawn(Seed(1)).scene(&scene());
        let text = format!("{scene:?}");
        for name in ["published", "wall", "globe", "clay"] {
            assert!(!text.contains(name), "{text}");
        }
    }
}
