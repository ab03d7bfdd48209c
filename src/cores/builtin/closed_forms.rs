//! The whole core against closed forms. Sources: Howell's catalogue of configuration factors (parallel and
//! perpendicular rectangles, sphere), Lambert's formula for polygons, geometric series for cavities and slabs.

use super::Builtin;
use crate::contract::{
    Acceleration, Core, DirectSampling, Film, IntegratorSettings, Ray, RenderSettings, Roulette,
};
use crate::scene::{
    Camera, Cap, Emission, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface,
};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

const RHO: f64 = 0.37;
const RECEIVER: u32 = 0;

fn diffuse(reflectance: f64) -> Surface {
    Surface::Diffuse { reflectance: [reflectance; 3] }
}

fn material(surface: Surface, radiance: f64) -> Material {
    let emission = Emission { radiance: [radiance; 3], cap: None };
    let emission = (radiance > 0.0).then_some(emission);
    Material { name: "test".to_owned(), surface, emission }
}

fn mesh(corners: &[DVec3], material: u32) -> Mesh {
    let indices = (2..corners.len() as u32).map(|last| [0, last - 1, last]).collect();
    let positions = corners.to_vec();
    Mesh { name: "polygon".to_owned(), positions, indices, material, ..Mesh::default() }
}

fn sphere(centre: DVec3, radius: f64, inward: bool, material: u32) -> Sphere {
    Sphere { name: "sphere".to_owned(), centre, radius, inward, material }
}

/// A rectangle in the plane `z = height` that faces down (or up).
fn rectangle(x: [f64; 2], y: [f64; 2], height: f64, faces_up: bool, material: u32) -> Mesh {
    let mut corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| dvec3(x[i], y[j], height));
    if !faces_up {
        corners.reverse();
    }
    mesh(&corners, material)
}

/// A receiver of reflectance `RHO` in the plane z = 0 around the origin, and black lights of radiance 5.
fn over_a_plane(surface: Surface) -> SceneDescription {
    SceneDescription {
        materials: vec![material(surface, 0.0), material(diffuse(0.0), 5.0)],
        meshes: vec![rectangle([-9.0, 8.0], [-7.0, 9.0], 0.0, true, RECEIVER)],
        ..SceneDescription::default()
    }
}

/// Looks at the origin from above, at an angle from the normal of the plane.
fn towards_origin(degrees: f64) -> Ray {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let from = dvec3(-0.6 * sine, -0.8 * sine, cosine);
    Ray::new(from * 0.5, -from)
}

fn settings(bounces: RangeInclusive<u32>) -> IntegratorSettings {
    IntegratorSettings { bounces, seed: 4711, threads: 1, ..IntegratorSettings::default() }
}

fn by_hemisphere(bounces: RangeInclusive<u32>) -> IntegratorSettings {
    IntegratorSettings { direct: DirectSampling::Hemisphere, ..settings(bounces) }
}

/// Independent estimates of the radiance (first channel) along one ray.
fn estimates(
    scene: &SceneDescription,
    ray: Ray,
    settings: &IntegratorSettings,
    count: usize,
) -> Vec<f64> {
    let scene = scene.clone().with_area_lights();
    let mut core = Builtin::new();
    let mut built = core.build_scene(&scene, Acceleration::DEFAULT).expect("a scene");
    let mut radiance = vec![[f64::NAN; 3]; count];
    built.radiance(&vec![ray; count], settings, &mut radiance).expect("radiance");
    radiance.into_iter().map(|[red, ..]| red).collect()
}

fn mean_and_variance(samples: &[f64]) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
    (mean, squares / (count - 1.0))
}

/// Five standard errors: one in two million if the core is right.
#[track_caller]
fn assert_mean(samples: &[f64], expected: f64, resolution: f64) {
    let (mean, variance) = mean_and_variance(samples);
    let error = (variance / samples.len() as f64).sqrt();
    assert!(5.0 * error <= resolution * expected, "too noisy: {error} of {expected}");
    assert!((mean - expected).abs() <= 5.0 * error + 1e-5 * expected, "{mean} is not {expected}");
}

/// Every single estimate is right: deterministic.
#[track_caller]
fn assert_each(samples: &[f64], expected: f64) {
    for sample in samples {
        assert!((sample - expected).abs() <= 1e-5 * expected, "{sample} is not {expected}");
    }
}

fn furnace(reflectance: f64, emitted: f64) -> (SceneDescription, Ray) {
    let centre = dvec3(0.3, -0.2, 0.5);
    let scene = SceneDescription {
        materials: vec![material(diffuse(reflectance), emitted)],
        spheres: vec![sphere(centre, 1.25, true, 0)],
        ..SceneDescription::default()
    };
    (scene, Ray::new(centre + dvec3(0.2, 0.1, 0.4), dvec3(0.5, -0.7, 0.3)))
}

#[test]
fn each_bounce_of_a_furnace_is_a_power_of_its_reflectance() {
    let (scene, ray) = furnace(RHO, 0.7);
    for (bounce, expected) in [0.7, 0.259, 0.09583, 0.0354571].into_iter().enumerate() {
        let bounce = bounce as u32;
        assert_each(&estimates(&scene, ray, &settings(bounce..=bounce), 2000), expected);
    }
    assert_each(&estimates(&scene, ray, &settings(0..=60), 1000), 0.7 / (1.0 - RHO));
    assert_mean(&estimates(&scene, ray, &by_hemisphere(0..=3), 100_000), 1.0902871, 0.01);
}

#[test]
fn a_glowing_cap_lights_the_whole_cavity_alike() {
    let axis = dvec3(0.6, 0.0, 0.8);
    let cap = Cap { axis, half_angle: 40_f64.to_radians() };
    let (mut scene, ray) = furnace(0.6, 3.0);
    scene.materials[0].emission = Some(Emission { radiance: [3.0; 3], cap: Some(cap) });
    for (bounce, expected) in [(1, 0.21056), (2, 0.126336), (3, 0.0758016)] {
        assert_each(&estimates(&scene, ray, &settings(bounce..=bounce), 1000), expected);
    }
    assert_mean(&estimates(&scene, ray, &by_hemisphere(1..=4), 300_000), 0.45817856, 0.02);
}

#[test]
fn concentric_spheres_exchange_light() {
    let scene = SceneDescription {
        materials: vec![material(diffuse(0.7), 0.0), material(diffuse(0.4), 1.0)],
        spheres: vec![sphere(DVec3::ONE, 0.5, false, 0), sphere(DVec3::ONE, 1.0, true, 1)],
        ..SceneDescription::default()
    };
    let between = DVec3::ONE + dvec3(0.0, 0.6, 0.48);
    let inward = Ray::new(between, dvec3(0.0, -0.6, -0.48));
    let outward = Ray::new(between, dvec3(0.3, 0.6, 0.48));
    for direct in [DirectSampling::Lights, DirectSampling::Hemisphere] {
        for (ray, last, expected) in
            [(inward, 1, 0.7), (outward, 1, 1.3), (inward, 2, 0.91), (outward, 3, 1.529)]
        {
            let settings = IntegratorSettings { direct, ..settings(0..=last) };
            assert_mean(&estimates(&scene, ray, &settings, 200_000), expected, 0.03);
        }
    }
}

#[test]
fn delta_lights_are_exact() {
    let mut scene = over_a_plane(diffuse(RHO));
    scene.lights = vec![Light::Point { position: dvec3(0.9, 0.0, 1.5), intensity: [2.0; 3] }];
    for settings in [settings(0..=1), by_hemisphere(0..=1)] {
        assert_each(&estimates(&scene, towards_origin(33.0), &settings, 10), 0.066007148);
    }
    let (sine, cosine) = 40_f64.to_radians().sin_cos();
    scene.lights =
        vec![Light::Directional { direction: dvec3(sine, 0.0, -cosine), irradiance: [2.0; 3] }];
    assert_each(&estimates(&scene, towards_origin(33.0), &settings(0..=1), 10), 0.18044124);
}

/// Both estimators of direct light from shapes of material 1 over the plane.
fn assert_direct_light(scene: &SceneDescription, expected: f64) {
    let ray = towards_origin(20.0);
    assert_mean(&estimates(scene, ray, &settings(1..=1), 100_000), expected, 0.03);
    assert_mean(&estimates(scene, ray, &by_hemisphere(1..=1), 1_000_000), expected, 0.25);
}

#[test]
fn rectangles_light_a_plane_as_howell_says() {
    let mut scene = over_a_plane(diffuse(RHO));
    scene.meshes.push(rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, false, 1));
    assert_direct_light(&scene, 0.21808289);
    scene.meshes[1] = rectangle([0.3, 1.5], [-0.2, 0.6], 1.5, false, 1);
    assert_direct_light(&scene, 0.13239707);
    let upright = [(0.0, 0.0), (1.1, 0.0), (1.1, 0.9), (0.0, 0.9)];
    scene.meshes[1] = mesh(&upright.map(|(x, z)| dvec3(x, 0.7, z)), 1);
    assert_direct_light(&scene, 0.15690191);
    scene.meshes[1] = rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, true, 1);
    let away = estimates(&scene, towards_origin(20.0), &settings(1..=1), 100);
    assert!(away.iter().all(|&sample| sample == 0.0), "only the front side emits");
}

#[test]
fn variances_are_those_of_the_two_estimators() {
    let mut scene = over_a_plane(diffuse(RHO));
    scene.meshes.push(rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, false, 1));
    // By quadrature of the squares of f Le cos/pdf: uniform directions, and uniform points.
    for (settings, expected) in [(by_hemisphere(1..=1), 0.732366), (settings(1..=1), 4.18671e-4)] {
        let samples = estimates(&scene, towards_origin(20.0), &settings, 400_000);
        let (_, variance) = mean_and_variance(&samples);
        assert!((variance / expected - 1.0).abs() < 0.03, "{variance} is not {expected}");
    }
}

#[test]
fn spheres_light_a_plane_also_across_its_horizon() {
    for (degrees, expected) in
        [(35.0, 0.107764), (80.0, 0.023468957), (90.0, 0.0076096821), (97.0, 0.0018119609)]
    {
        let (sine, cosine) = f64::to_radians(degrees).sin_cos();
        let mut scene = over_a_plane(diffuse(RHO));
        // A receiver of one point's size, so that the sphere may go through the horizon without being hidden.
        scene.meshes[0] = rectangle([-0.01, 0.01], [-0.01, 0.01], 0.0, true, RECEIVER);
        scene.spheres.push(sphere(dvec3(1.5 * sine, 0.0, 1.5 * cosine), 0.4, false, 1));
        let samples = estimates(&scene, towards_origin(20.0), &settings(1..=1), 400_000);
        assert_mean(&samples, expected, 0.03);
    }
}

#[test]
fn skies_light_a_plane() {
    let mut scene = over_a_plane(diffuse(RHO));
    let ray = towards_origin(20.0);
    scene.lights = vec![Light::ConstantSky { radiance: [5.0; 3] }];
    assert_each(&estimates(&scene, ray, &settings(0..=1), 1000), 5.0 * RHO);
    assert_mean(&estimates(&scene, ray, &by_hemisphere(0..=1), 200_000), 5.0 * RHO, 0.01);
    scene.lights = vec![Light::GradientSky { up: DVec3::Z, horizon: [0.4; 3], zenith: [1.3; 3] }];
    assert_mean(&estimates(&scene, ray, &settings(0..=1), 200_000), RHO, 0.01);
    assert_mean(&estimates(&scene, ray, &by_hemisphere(0..=1), 400_000), RHO, 0.01);
    let up = Ray::new(DVec3::Z, dvec3(0.0, 0.6, 0.8));
    assert_each(&estimates(&scene, up, &settings(0..=0), 1), 0.4 + 0.9 * 0.8);
}

#[test]
fn a_mirror_shows_what_glows_one_bounce_later() {
    let mut scene = over_a_plane(Surface::Mirror { reflectance: [0.83; 3] });
    scene.meshes.push(rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, false, 1));
    let ray = towards_origin(10.0);
    assert_each(&estimates(&scene, ray, &settings(1..=1), 5), 0.83 * 5.0);
    for bounces in [0..=0, 2..=4] {
        let samples = estimates(&scene, ray, &settings(bounces), 5);
        assert!(samples.iter().all(|&sample| sample == 0.0));
    }
}

#[test]
fn a_slab_of_glass_transmits_what_its_faces_leave() {
    let glass = Surface::Glass { index: 1.5, reflectance: [1.0; 3], transmittance: [1.0; 3] };
    let far = [-900.0, 800.0];
    for (degrees, expected) in [(0.0, 0.92307692), (60.0, 0.83623246)] {
        let scene = SceneDescription {
            materials: vec![material(glass, 0.0), material(diffuse(0.0), 1.0)],
            meshes: vec![
                rectangle(far, far, 0.0, true, 0),
                rectangle(far, far, -1.0, false, 0),
                rectangle(far, far, -3.0, true, 1),
            ],
            ..SceneDescription::default()
        };
        let samples = estimates(&scene, towards_origin(degrees), &settings(0..=60), 300_000);
        assert_mean(&samples, expected, 0.01);
    }
}

#[test]
fn a_glass_sphere_in_a_uniform_sky_cannot_be_seen() {
    let glass = Surface::Glass { index: 1.5, reflectance: [1.0; 3], transmittance: [1.0; 3] };
    let mut scene = SceneDescription {
        materials: vec![material(glass, 0.0), material(diffuse(0.0), 1.0)],
        spheres: vec![sphere(DVec3::ZERO, 1.0, false, 0)],
        lights: vec![Light::ConstantSky { radiance: [1.0; 3] }],
        ..SceneDescription::default()
    };
    let ray = Ray::new(dvec3(0.6, 0.0, 3.0), -DVec3::Z);
    assert_each(&estimates(&scene, ray, &settings(0..=100), 20_000), 1.0);
    // One reflection outside, or one segment inside: 1 − (1 − F) F with F at sin θ = 0.6.
    assert_mean(&estimates(&scene, ray, &settings(0..=2), 100_000), 0.958032, 0.01);

    scene.lights.clear();
    scene.spheres.push(sphere(DVec3::ZERO, 0.3, false, 1));
    let central = Ray::new(dvec3(0.0, 0.0, 3.0), -DVec3::Z);
    assert_mean(&estimates(&scene, central, &settings(0..=1), 100_000), 0.96 / 2.25, 0.01);
}

#[test]
fn a_conductor_reflects_its_albedo_of_a_uniform_sky() {
    for (roughness, degrees, expected) in
        [(0.3, 45.0, 0.844432), (0.6, 75.0, 0.676011), (1.0, 0.0, 1.0 - 2_f64.ln())]
    {
        let mut scene = over_a_plane(Surface::Conductor { reflectance: [1.0; 3], roughness });
        scene.meshes[0] = rectangle([-1e3, 1e3], [-1e3, 1e3], 0.0, true, RECEIVER);
        scene.lights = vec![Light::ConstantSky { radiance: [1.0; 3] }];
        let ray = towards_origin(degrees);
        assert_mean(&estimates(&scene, ray, &settings(1..=1), 100_000), expected, 0.01);
        assert_mean(&estimates(&scene, ray, &by_hemisphere(1..=1), 400_000), expected, 0.02);
    }
}

#[test]
fn combined_and_hemisphere_samples_of_a_conductor_agree() {
    let mut scene = over_a_plane(Surface::Conductor { reflectance: [0.9; 3], roughness: 0.4 });
    scene.meshes.push(rectangle([0.0, 1.2], [-0.4, 0.4], 1.0, false, 1));
    scene.spheres.push(sphere(dvec3(-1.0, 0.3, 0.8), 0.3, false, 1));
    let ray = towards_origin(50.0);
    let reference = estimates(&scene, ray, &by_hemisphere(1..=1), 4_000_000);
    let (expected, variance) = mean_and_variance(&reference);
    for samples_per_light in [1, 3] {
        let settings = IntegratorSettings { samples_per_light, ..settings(1..=1) };
        let (mean, noise) = mean_and_variance(&estimates(&scene, ray, &settings, 400_000));
        let error = (variance / 4e6 + noise / 4e5).sqrt();
        assert!(5.0 * error < 0.02 * expected, "too noisy: {error} of {expected}");
        assert!((mean - expected).abs() < 5.0 * error, "{mean} is not {expected}");
    }
}

#[test]
fn roulette_changes_the_noise_and_not_the_mean() {
    let (scene, ray) = furnace(RHO, 1.0);
    for (stop, guaranteed) in [(0.35, 0), (0.7, 0), (0.35, 2)] {
        let roulette = Some(Roulette { stop, guaranteed });
        let settings = IntegratorSettings { roulette, ..settings(0..=200) };
        let samples = estimates(&scene, ray, &settings, 400_000);
        assert_mean(&samples, 1.0 / (1.0 - RHO), 0.01);
        if (stop, guaranteed) == (0.35, 0) {
            // Bounces 0 and 1 are certain, so the moments are those of a path that starts to play after one
            // bounce; geometric sums give 0.0322101.
            let (_, variance) = mean_and_variance(&samples);
            assert!((variance / 0.0322101 - 1.0).abs() < 0.02, "{variance}");
        }
    }
}

#[test]
fn single_bounces_add_up_to_all_of_them() {
    let mut scene = over_a_plane(diffuse(RHO));
    scene.meshes.push(rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, false, 1));
    scene.spheres.push(sphere(dvec3(0.5, 0.5, 0.4), 0.4, false, RECEIVER));
    let (ray, count) = (towards_origin(20.0), 200_000);
    let (mean, variance) = mean_and_variance(&estimates(&scene, ray, &settings(0..=3), count));
    let single = |bounce| estimates(&scene, ray, &settings(bounce..=bounce), count);
    let sum: f64 = (0..=3).map(|bounce| mean_and_variance(&single(bounce)).0).sum();
    let error = (2.0 * variance / count as f64).sqrt();
    assert!(5.0 * error < 0.01 * mean, "too noisy: {error} of {mean}");
    assert!((sum - mean).abs() < 5.0 * error, "{sum} is not {mean}");
}

fn grey_camera(film: [u32; 2]) -> Camera {
    Camera::look_at(dvec3(0.0, -3.0, 1.0), DVec3::Z * 0.5, DVec3::Z, 0.9, film)
}

fn picture(scene: &SceneDescription, settings: &RenderSettings) -> Film {
    let scene = scene.clone().with_area_lights();
    let mut core = Builtin::new();
    let mut built = core.build_scene(&scene, Acceleration::DEFAULT).expect("a scene");
    let mut film = Film::default();
    let camera = grey_camera([settings.width, settings.height]);
    built.render(&camera, settings, &mut film).expect("a picture");
    film
}

fn picture_settings(samples_per_pixel: u32, threads: u32) -> RenderSettings {
    let integrator = IntegratorSettings { threads, ..settings(0..=4) };
    RenderSettings { width: 24, height: 16, samples_per_pixel, integrator, ..Default::default() }
}

fn small_room(emitted: Rgb) -> SceneDescription {
    let mut scene = over_a_plane(diffuse(0.5));
    scene.materials[1].emission = Some(Emission { radiance: emitted, cap: None });
    scene.meshes.push(rectangle([-0.6, 0.6], [-0.4, 0.4], 1.5, false, 1));
    scene.spheres.push(sphere(dvec3(0.2, 0.1, 0.4), 0.4, false, RECEIVER));
    scene
}

#[test]
fn threads_do_not_change_a_bit_and_seeds_change_every_picture() {
    let scene = small_room([5.0, 3.0, 1.0]);
    let one = picture(&scene, &picture_settings(4, 1));
    for threads in [0, 1, 3] {
        assert_eq!(picture(&scene, &picture_settings(4, threads)), one, "{threads} threads");
    }
    let mut other = picture_settings(4, 1);
    other.integrator.seed += 1;
    assert_ne!(picture(&scene, &other).pixels, one.pixels);
}

#[test]
fn twice_the_light_is_twice_the_picture_bit_for_bit() {
    let single = picture(&small_room([5.0, 3.0, 1.0]), &picture_settings(4, 0));
    let double = picture(&small_room([10.0, 6.0, 2.0]), &picture_settings(4, 0));
    for (one, two) in single.pixels.iter().zip(&double.pixels) {
        assert_eq!(one.map(|channel| 2.0 * channel), *two);
    }
}

#[test]
fn a_film_of_ones_is_exactly_one() {
    let sky = Light::ConstantSky { radiance: [1.0; 3] };
    let scene = SceneDescription { lights: vec![sky], ..SceneDescription::default() };
    for samples in [1, 3, 64] {
        let film = picture(&scene, &picture_settings(samples, 0));
        assert!(film.pixels.iter().all(|&pixel| pixel == [1.0; 3]));
        assert!(film.sample_counts.iter().all(|&count| count == samples));
    }
}

#[test]
fn adaptive_pixels_stop_between_batches() {
    use crate::contract::AdaptiveSettings;
    let mut settings = picture_settings(256, 0);
    settings.adaptive = Some(AdaptiveSettings { samples_per_batch: 16, max_tolerance: 0.1 });
    let film = picture(&small_room([5.0; 3]), &settings);
    let counts = &film.sample_counts;
    assert!(counts.iter().all(|&count| count.is_multiple_of(16) && (16..=256).contains(&count)));
    assert!(counts.iter().min() < counts.iter().max(), "some pixels are harder than others");
}

#[test]
fn nothing_to_see_is_black_and_nothing_breaks() {
    let film = picture(&SceneDescription::default(), &picture_settings(2, 0));
    assert!(film.pixels.iter().all(|&pixel| pixel == [0.0; 3]));
    let unlit = over_a_plane(diffuse(RHO));
    for settings in [settings(0..=5), by_hemisphere(0..=5)] {
        assert_eq!(estimates(&unlit, towards_origin(20.0), &settings, 3), [0.0; 3]);
    }
}

#[test]
fn a_wide_plane_does_not_shadow_itself() {
    for size in [1.0, 40.0, 3e4] {
        let mut scene = over_a_plane(diffuse(1.0));
        let corners = [(-1.0, -1.0), (1.0, -0.9), (0.9, 1.0), (-1.1, 0.8)];
        let tilted = corners.map(|(x, y)| dvec3(x, y, 0.31 * x - 0.17 * y) * size);
        scene.meshes[0] = mesh(&tilted, RECEIVER);
        let normal = dvec3(-0.31, 0.17, 1.0).normalize();
        let along = dvec3(1.0, 0.0, 0.31).normalize();
        for grazing in [0.5, 1e-2, 1e-4] {
            let towards = (along + normal * grazing).normalize();
            let light = Light::Directional { direction: -towards, irradiance: [PI; 3] };
            scene.lights = vec![light];
            for step in 0..2000_u32 {
                let place = f64::from(step) / 2000.0;
                let at = dvec3(place - 0.3, 0.4 - 0.6 * place, 0.0) * size;
                let ray = Ray::new(at + normal * size, -normal);
                let seen = estimates(&scene, ray, &settings(1..=1), 1)[0];
                let expected = normal.dot(towards);
                assert!((seen / expected - 1.0).abs() < 1e-5, "{size} {grazing} {step}: {seen}");
            }
        }
    }
}
