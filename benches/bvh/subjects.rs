//! What is traced: meshes from a thousand to a million triangles, and the rays.

use furnace::contract::Ray;
use furnace::math::rng::{Seed, Stream, uniform};
use furnace::scene::procedural::{bumpy_sphere, soup, sphereflake, teapot};
use furnace::scene::{Aabb, Camera, Material, Mesh, SceneDescription, Surface};
use glam::{DVec2, DVec3, dvec3};

/// Rays of one pass.
const RAYS: usize = 16_384;

/// A mesh and the rays through it.
pub struct Subject {
    pub name: &'static str,
    /// The mesh alone.
    pub scene: SceneDescription,
    /// Camera rays and chords in turn.
    pub rays: Vec<Ray>,
}

/// What makes a mesh.
pub type Maker = fn() -> Mesh;

/// All subjects, small ones first: shape and size, and what makes the mesh.
pub const ALL: [(&str, Maker); 7] = [
    ("teapot-1k", || teapot(4)),
    ("bumpy-sphere-5k", || bumpy_sphere(4)),
    ("teapot-16k", || teapot(16)),
    ("soup-32k", || soup(32_768, Seed(1))),
    ("bumpy-sphere-82k", || bumpy_sphere(6)),
    ("sphereflake-262k", || sphereflake(3, 2)),
    ("bumpy-sphere-1.3M", || bumpy_sphere(8)),
];

impl Subject {
    /// The rays are the same every time.
    pub fn new(name: &'static str, mesh: Mesh) -> Self {
        let surface = Surface::Diffuse { reflectance: [0.5; 3] };
        let material = Material { name: "grey".to_owned(), surface, emission: None };
        let (meshes, materials) = (vec![mesh], vec![material]);
        let scene = SceneDescription { meshes, materials, ..SceneDescription::default() };
        let bounds = scene.bounds().expect("a subject has triangles");
        Self { name, scene, rays: rays(&bounds) }
    }
}

/// Coherent and incoherent rays in turn: those of a camera that sees the whole mesh, and chords between a point
/// around it and a point in its box.
fn rays(bounds: &Aabb) -> Vec<Ray> {
    let mut stream = Seed::SUITE.child("benches/bvh").stream();
    let camera = camera(bounds);
    let side = (RAYS as f64 / 2.0).sqrt();
    let ray = |index: usize| {
        let cell = (index / 2) as f64;
        let film = DVec2::new((cell / side).fract(), cell / side / side);
        if index.is_multiple_of(2) { through(&camera, film) } else { chord(bounds, &mut stream) }
    };
    (0..RAYS).map(ray).collect()
}

fn camera(bounds: &Aabb) -> Camera {
    let centre = 0.5 * (bounds.min + bounds.max);
    let from = centre + dvec3(0.5, 0.4, 1.0).normalize() * 1.2 * bounds.diagonal();
    Camera::look_at(from, centre, DVec3::Y, 0.8, [1, 1])
}

fn through(camera: &Camera, film: DVec2) -> Ray {
    let half = (camera.horizontal_fov / 2.0).tan();
    let local = ((2.0 * film - 1.0) * half).extend(-1.0);
    Ray::new(camera.position, (camera.camera_to_world * local).normalize())
}

fn chord(bounds: &Aabb, stream: &mut Stream) -> Ray {
    let mut point = || dvec3(uniform(stream), uniform(stream), uniform(stream));
    let inside = bounds.min + (bounds.max - bounds.min) * point();
    let around = 0.5 * (bounds.min + bounds.max) + (2.0 * point() - 1.0) * bounds.diagonal();
    Ray::new(around, (inside - around).normalize())
}
