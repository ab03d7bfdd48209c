//! What is traced: meshes from a thousand to a million triangles, and the rays.

use crate::contract::Ray;
use crate::math::rng::{Seed, Stream, uniform};
use crate::scene::procedural::{bumpy_sphere, soup, sphereflake, teapot};
use crate::scene::{
    Aabb, Camera, Library, Material, Mesh, Overrides, SceneDescription, SceneError, Surface,
};
use glam::{DVec2, DVec3, dvec3};
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

/// Rays of one pass.
const RAYS: usize = 16_384;

/// Meshes and the rays through them.
#[derive(Clone, Debug)]
pub struct Subject {
    /// What the table calls it.
    pub name: String,
    /// The meshes alone.
    pub scene: SceneDescription,
    /// Camera rays and chords in turn.
    pub rays: Vec<Ray>,
}

/// What makes a mesh.
type Maker = fn() -> Mesh;

/// Small ones first: shape and size.
const MADE_HERE: [(&str, Maker); 7] = [
    ("teapot-1k", || teapot(4)),
    ("bumpy-sphere-5k", || bumpy_sphere(4)),
    ("teapot-16k", || teapot(16)),
    ("soup-32k", || soup(32_768, Seed(1))),
    ("bumpy-sphere-82k", || bumpy_sphere(6)),
    ("sphereflake-262k", || sphereflake(3, 2)),
    ("bumpy-sphere-1.3M", || bumpy_sphere(8)),
];

/// Of the course: those whose speed-ups students show.
pub(crate) const FOUNDING: [&str; 5] = ["cow", "teapot", "beetle", "maxplanck", "bunny"];

/// What subjects that need no file are called.
pub(crate) fn names() -> Vec<&'static str> {
    MADE_HERE.iter().map(|(name, _)| *name).collect()
}

/// Subjects that need no file, of which `wanted` takes some by their names.
pub fn made_here(wanted: impl Fn(&str) -> bool) -> impl Iterator<Item = Subject> {
    let those = MADE_HERE.iter().filter(move |(name, _)| wanted(name));
    those.filter_map(|(name, make)| Subject::of(name, vec![make()]))
}

/// The course's meshes that lie in a folder or below it, as `.dae` files.
pub(crate) fn in_folder(
    folder: &Path,
    library: &Library,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<Subject>, SceneError> {
    let names = FOUNDING.iter().filter(|name| wanted(name));
    let files = names.filter_map(|name| Some((*name, file(folder, name)?)));
    let subjects = files.map(|(name, file)| {
        let scene = library.load(&file.to_string_lossy(), &Overrides::new())?;
        Ok(Subject::of(name, scene.meshes.clone()))
    });
    subjects.filter_map(Result::transpose).collect()
}

fn file(folder: &Path, name: &str) -> Option<PathBuf> {
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter().flatten();
    let is_it = |path: &PathBuf| {
        path.extension().is_some_and(|ending| ending == "dae")
            && path.file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case(name))
    };
    entries.map(walkdir::DirEntry::into_path).find(is_it)
}

impl Subject {
    /// The rays are the same every time. None of nothing.
    fn of(name: &str, meshes: Vec<Mesh>) -> Option<Self> {
        let surface = Surface::Diffuse { reflectance: [0.5; 3] };
        let grey = Material { name: "grey".to_owned(), surface, emission: None };
        let meshes = meshes.into_iter().map(|mesh| Mesh { material: 0, ..mesh }).collect();
        let scene =
            SceneDescription { meshes, materials: vec![grey], ..SceneDescription::default() };
        let rays = rays(&scene.bounds()?);
        Some(Self { name: name.to_owned(), scene, rays })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subjects_are_the_same_every_time_and_are_taken_by_name() {
        let small = |name: &str| name.ends_with("-1k") || name.ends_with("-5k");
        let [first, second] = [(); 2].map(|()| made_here(small).collect::<Vec<_>>());
        assert_eq!(first.len(), 2);
        assert_eq!(first[0].rays, second[0].rays);
        assert_eq!(first[1].scene.primitive_count(), 5120);
    }
}
