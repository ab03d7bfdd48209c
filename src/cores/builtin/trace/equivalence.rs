//! The tree finds what brute force finds, bit for bit, by every rule and with every kernel.

use super::{Geometry, Plan, Segment, Tracer, Tree, brute_force, build_bvh};
use crate::contract::{Ray, Split};
use crate::cores::builtin::random::Stream;
use crate::scene::{Mesh, SceneDescription, Sphere};
use glam::{DVec3, dvec3};

const PLANS: [Plan; 6] = [
    Plan { split: Split::CoresChoice, max_leaf_size: 4 },
    Plan { split: Split::SurfaceArea, max_leaf_size: 16 },
    Plan { split: Split::Median, max_leaf_size: 4 },
    Plan { split: Split::MeanOfCentroids, max_leaf_size: 4 },
    Plan { split: Split::Midpoint, max_leaf_size: 1 },
    Plan { split: Split::Median, max_leaf_size: 1_000_000 },
];

fn point(stream: &mut Stream) -> DVec3 {
    DVec3::from((stream.point(), stream.unit())) * 2.0 - 1.0
}

fn scene_of(triangles: Vec<[DVec3; 3]>, spheres: Vec<Sphere>) -> SceneDescription {
    let count = triangles.len() as u32;
    let mesh = Mesh {
        positions: triangles.into_iter().flatten().collect(),
        indices: (0..count).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect(),
        ..Mesh::default()
    };
    SceneDescription { meshes: vec![mesh], spheres, ..SceneDescription::default() }
}

fn sphere(centre: DVec3, radius: f64) -> Sphere {
    Sphere { name: String::new(), centre, radius, inward: false, material: 0 }
}

fn soup(count: u32, size: f64, stream: &mut Stream) -> Vec<[DVec3; 3]> {
    let triangle = |_| {
        let at = point(stream);
        [at, at + size * point(stream), at + size * point(stream)]
    };
    (0..count).map(triangle).collect()
}

/// Rays from in and around the unit cube; every fourth parallel to an axis, every fifth of limited length.
fn rays(count: u32, stream: &mut Stream) -> Vec<Ray> {
    let ray = |index: u32| {
        let mut ray = Ray::new(1.5 * point(stream), point(stream));
        if index.is_multiple_of(4) {
            ray.direction = DVec3::AXES[(index / 4 % 3) as usize] * (stream.unit() - 0.5).signum();
            ray.origin = (ray.origin * 8.0).round() / 8.0;
        }
        if index.is_multiple_of(5) {
            ray.t_min = stream.unit();
            ray.t_max = ray.t_min + stream.unit();
        }
        ray
    };
    (0..count).map(ray).collect()
}

fn found(tracer: &mut Tracer<'_>, rays: &[Ray]) -> Vec<Option<(u32, u32)>> {
    let nearest = |ray: &Ray| {
        let segment = Segment::new(ray);
        let nearest = tracer.nearest(&segment);
        assert_eq!(tracer.is_blocked(&segment), nearest.is_some(), "any hit of {ray:?}");
        nearest.map(|candidate| (candidate.t.to_bits(), candidate.number))
    };
    rays.iter().map(nearest).collect()
}

fn check(scene: &SceneDescription, ray_count: u32) {
    let geometry = Geometry::new(scene);
    let rays = rays(ray_count, &mut Stream::new(5, 6, 7));
    let all = brute_force(&geometry);
    let expected = found(&mut Tracer::portable(&all), &rays);
    assert_eq!(found(&mut Tracer::new(&all), &rays), expected, "brute force, by kernel");
    for plan in PLANS {
        let tree = build_bvh(&geometry, plan);
        assert!(tree.depth <= 100, "{plan:?}: depth {}", tree.depth);
        for mut tracer in [Tracer::new(&tree), Tracer::portable(&tree)] {
            assert_eq!(found(&mut tracer, &rays), expected, "{plan:?}");
        }
    }
}

#[test]
fn random_soups_of_triangles_and_spheres() {
    let mut stream = Stream::new(1, 0, 0);
    for (count, size) in [(0, 0.1), (1, 1.0), (2, 1.0), (50, 0.5), (3000, 0.1), (3000, 1.0)] {
        let spheres = (0..count / 8).map(|_| sphere(point(&mut stream), 0.1)).collect();
        check(&scene_of(soup(count, size, &mut stream), spheres), 1000);
    }
}

#[test]
fn heaps_of_equal_and_of_concentric_primitives() {
    let mut stream = Stream::new(2, 0, 0);
    let one = soup(1, 1.0, &mut stream)[0];
    check(&scene_of(vec![one; 5000], vec![]), 200);
    let grown = |index: u32| one.map(|corner| corner * (1.0 + f64::from(index) * 1e-3));
    check(&scene_of((0..2000).map(grown).collect(), vec![]), 200);
    check(&scene_of(vec![], vec![sphere(DVec3::ZERO, 0.5); 500]), 200);
}

#[test]
fn a_grid_and_rays_along_its_lines() {
    let cell = |index: u32| {
        let corner =
            |i: u32, j: u32| dvec3(f64::from(i) / 8.0 - 1.0, f64::from(j) / 8.0 - 1.0, 0.25);
        let (i, j) = (index % 16, index / 16);
        [
            [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)],
            [corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)],
        ]
    };
    check(&scene_of((0..256).flat_map(cell).collect(), vec![]), 4000);
}

#[test]
fn sizes_a_million_times_apart() {
    let mut stream = Stream::new(3, 0, 0);
    let mut triangles = soup(2000, 1e-3, &mut stream);
    triangles.extend(soup(20, 1e3, &mut stream));
    check(
        &scene_of(triangles, vec![sphere(DVec3::ZERO, 1e-4), sphere(DVec3::X * 50.0, 49.0)]),
        1000,
    );
}

#[test]
fn what_is_not_solid_is_not_hit() {
    let mut stream = Stream::new(4, 0, 0);
    let [a, b, c] = soup(1, 1.0, &mut stream)[0];
    let bad =
        vec![[a, a, a], [a, b, b], [a, b, a + 2.0 * (b - a)], [a, b, DVec3::NAN], [a, b, c / 0.0]];
    let scene = scene_of(bad, vec![sphere(a, 0.0), sphere(a, -1.0), sphere(a, f64::NAN)]);
    assert_eq!(brute_force(&Geometry::new(&scene)).roots, []);
    check(&scene, 100);
}

/// A closed surface seen from inside, with rays also at its very vertices and edges.
#[test]
fn no_ray_escapes_between_triangles() {
    let (rows, columns) = (40_u32, 60_u32);
    let vertex = |row: u32, column: u32| {
        let theta = std::f64::consts::PI * f64::from(row) / f64::from(rows);
        let phi = std::f64::consts::TAU * f64::from(column % columns) / f64::from(columns);
        let bump = 1.0 + 0.2 * (5.0 * phi).sin() * theta.sin() * (3.0 * theta).cos();
        // The poles must be single points.
        let sine = if row.is_multiple_of(rows) { 0.0 } else { theta.sin() };
        bump * dvec3(sine * phi.cos(), sine * phi.sin(), theta.cos()) + 3.0
    };
    let patch = |index: u32| {
        let (row, column) = (index / columns, index % columns);
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| vertex(row + i, column + j));
        [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    };
    let scene = scene_of((0..rows * columns).flat_map(patch).collect(), vec![]);
    let tree: Tree = build_bvh(&Geometry::new(&scene), PLANS[0]);
    let mut tracer = Tracer::new(&tree);
    let mut stream = Stream::new(8, 0, 0);
    for index in 0..200_000_u32 {
        let origin = DVec3::splat(3.0) + 0.2 * point(&mut stream);
        let (row, column) = (index / columns % rows, index % columns);
        let along_edge = stream.unit();
        let target = match index % 4 {
            0 => vertex(row, column),
            1 => vertex(row, column).lerp(vertex(row + 1, column), along_edge),
            _ => origin + point(&mut stream),
        };
        let segment = Segment::new(&Ray::new(origin, target - origin));
        assert!(tracer.nearest(&segment).is_some(), "ray {index} escaped");
    }
}
