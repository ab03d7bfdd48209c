//! Scenes that are pictures: areas of the film that emit, before a background that does too. What is painted in a
//! pixel is read from its mean: sums of radiances are whole numbers, whose digits count samples.

use crate::checks::camera::projection;
use crate::checks::rendering;
use crate::scene::{Camera, Emission, Material, Mesh, SceneDescription, Surface};
use glam::{DVec2, DVec3};

/// Columns and rows of the film; odd, so that every second pixel of every second row has neighbours on all sides.
pub(crate) const FILM: [u32; 2] = [17, 13];
/// Between the border of a pixel, or of a part of it, and what is painted there, in pixels: no rounding carries a
/// sample across.
pub(crate) const MARGIN: f64 = 0.002;
/// How far from a whole number a sum may be: roundings of single precision make a tenth of that.
const WHOLE: f64 = 0.25;

/// Two opposite corners, top left and bottom right: film points in pixels from the top left.
pub(crate) type Area = [DVec2; 2];

/// A picture before a camera that stands and looks in no special way.
pub(crate) struct Painting {
    camera: Camera,
    scene: SceneDescription,
}

impl Painting {
    pub(crate) fn new(name: &str, background: [f64; 3]) -> Self {
        let camera = Camera::look_at(
            DVec3::new(1.3, -2.1, 0.7),
            DVec3::new(-0.4, 0.2, 1.9),
            DVec3::new(0.1, 0.2, 1.0),
            50f64.to_radians(),
            FILM,
        );
        let name = name.to_owned();
        let scene = SceneDescription { name, camera: Some(camera), ..Default::default() };
        let mut painting = Self { camera, scene };
        // Behind everything, beyond the film on every side.
        let area = [DVec2::splat(-4.0), DVec2::from(FILM.map(f64::from)) + 4.0];
        painting.paint_at(1.01, "background".to_owned(), background, [area].into_iter());
        painting
    }

    /// Adds areas of this radiance.
    pub(crate) fn paint(
        &mut self,
        name: String,
        radiance: [f64; 3],
        areas: impl Iterator<Item = Area>,
    ) {
        self.paint_at(1.0, name, radiance, areas);
    }

    /// At a depth, facing the camera.
    fn paint_at(
        &mut self,
        depth: f64,
        name: String,
        radiance: [f64; 3],
        areas: impl Iterator<Item = Area>,
    ) {
        let material = self.scene.materials.len() as u32;
        let mut mesh = Mesh { material, ..Mesh::default() };
        for [top_left, bottom_right] in areas {
            let first = mesh.positions.len() as u32;
            let bottom_left = DVec2::new(top_left.x, bottom_right.y);
            let top_right = DVec2::new(bottom_right.x, top_left.y);
            let around = [top_left, bottom_left, bottom_right, top_right];
            mesh.positions.extend(around.map(|point| seen_at(&self.camera, point, depth)));
            mesh.indices.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|c| first + c)));
        }
        self.scene.meshes.push(mesh);
        let surface = Surface::Diffuse { reflectance: [0.0; 3] };
        let emission = Some(Emission { radiance, cap: None });
        self.scene.materials.push(Material { name, surface, emission });
    }

    pub(crate) fn scene(self) -> SceneDescription {
        self.scene.with_area_lights()
    }
}

/// The point at this depth that is seen at a film point in pixels from the top left.
fn seen_at(camera: &Camera, point: DVec2, depth: f64) -> DVec3 {
    let from_top = point / DVec2::from(FILM.map(f64::from));
    let film = DVec2::new(from_top.x, 1.0 - from_top.y);
    camera.position + depth * projection(camera, film)
}

pub(crate) fn places() -> impl Iterator<Item = [u32; 2]> {
    rendering::places(FILM)
}

/// The top left corner of a pixel.
pub(crate) fn corner(at: [u32; 2]) -> DVec2 {
    DVec2::from(at.map(f64::from))
}

/// The sum of so many samples in one channel of a pixel; none if it is no whole number below `end`.
pub(crate) fn sum(mean: f32, samples: u32, end: u32) -> Option<u32> {
    let sum = f64::from(mean) * f64::from(samples);
    let whole = sum.round();
    let is_sum = (sum - whole).abs() <= WHOLE && (0.0..f64::from(end)).contains(&whole);
    is_sum.then_some(whole as u32)
}

/// A digit of a number, counted from the lowest.
pub(crate) const fn digit(number: u32, base: u32, place: usize) -> u32 {
    number / base.pow(place as u32) % base
}

/// The radiance of a channel that counts as one in this digit.
pub(crate) fn one(base: u32, place: usize) -> f64 {
    f64::from(base).powi(place as i32)
}

/// Asserts that the scene shows what `radiance_at` says of film points in pixels.
#[cfg(test)]
pub(crate) fn assert_shows(scene: &SceneDescription, radiance_at: fn(DVec2) -> [f64; 3]) {
    use crate::math::rng::{Seed, in_square};
    let (camera, mut stream) = (scene.camera.unwrap(), Seed(1).stream());
    for _ in 0..300 {
        let pixels = in_square(&mut stream) * DVec2::from(FILM.map(f64::from));
        let direction = (seen_at(&camera, pixels, 1.0) - camera.position).normalize();
        let ray = crate::contract::Ray::new(camera.position, direction);
        let met = crate::checks::oracle::nearest(scene, &ray).unwrap();
        assert!(met.answer.geometric_normal.dot(direction) < 0.0, "seen from behind");
        let emission = scene.material_of(met.shape).emission.unwrap();
        assert_eq!(emission.radiance, radiance_at(pixels), "{pixels}");
    }
}
