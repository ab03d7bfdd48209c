//! Both cores of our own against closed forms, where no check stands between. Sources: Howell's catalogue of
//! configuration factors (rectangles, sphere), Lambert's formula for polygons, geometric series for cavities and slabs.

use super::stage::{Look, Stage, clear_glass, diffuse, grey, looks};
use super::{CORES, CoreKind};
use crate::contract::{Acceleration, DirectSampling, IntegratorSettings, Precision, Ray, Roulette};
use crate::scene::{Light, SceneDescription, Surface};
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;

/// Of the floor.
const RHO: f64 = 0.37;
/// Radiance of the lights over it.
const EMITTED: f64 = 5.0;

fn settings(bounces: RangeInclusive<u32>) -> IntegratorSettings {
    IntegratorSettings { bounces, seed: 4711, ..IntegratorSettings::default() }
}

fn by_hemisphere(bounces: RangeInclusive<u32>) -> IntegratorSettings {
    IntegratorSettings { direct: DirectSampling::Hemisphere, ..settings(bounces) }
}

fn both(bounces: RangeInclusive<u32>) -> [IntegratorSettings; 2] {
    [settings(bounces.clone()), by_hemisphere(bounces)]
}

/// Independent estimates of the radiance along one ray (first channel), by each core, with its name and how much it
/// rounds.
fn estimates(
    scene: &SceneDescription,
    ray: Ray,
    settings: &IntegratorSettings,
    count: usize,
) -> Vec<(&'static str, f64, Vec<f64>)> {
    let of = |kind: &CoreKind| {
        let mut core = (kind.make)();
        let single = core.info().precision == Precision::Single;
        let mut built = core.build_scene(scene, Acceleration::DEFAULT).expect("a scene");
        let mut radiance = vec![[f64::NAN; 3]; count];
        built.radiance(&vec![ray; count], settings, &mut radiance).expect("radiance");
        let red = radiance.into_iter().map(|[red, ..]| red).collect();
        (kind.name, if single { 1e-5 } else { 1e-9 }, red)
    };
    CORES.iter().map(of).collect()
}

fn mean_and_variance(samples: &[f64]) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
    (mean, squares / (count - 1.0))
}

/// Five standard errors: one in two million if the core is right. They are at most `resolution` of what is expected.
#[track_caller]
fn assert_mean(
    scene: &SceneDescription,
    ray: Ray,
    settings: &IntegratorSettings,
    (count, resolution): (usize, f64),
    expected: f64,
) {
    for (core, rounding, samples) in estimates(scene, ray, settings, count) {
        let (mean, variance) = mean_and_variance(&samples);
        let error = 5.0 * (variance / count as f64).sqrt();
        assert!(error <= resolution * expected, "{core} is too noisy: {error} of {expected}");
        let is_met = (mean - expected).abs() <= error + rounding * expected;
        assert!(is_met, "{core}: {mean} is not {expected}: {settings:?}");
    }
}

/// Every single estimate is right: deterministic.
#[track_caller]
fn assert_each(scene: &SceneDescription, ray: Ray, settings: &IntegratorSettings, expected: f64) {
    for (core, rounding, samples) in estimates(scene, ray, settings, 500) {
        let is_met = |sample: &&f64| (**sample - expected).abs() <= rounding * expected;
        let other = samples.iter().find(|sample| !is_met(sample));
        assert_eq!(other, None, "{core}: not {expected}: {settings:?}");
    }
}

#[track_caller]
fn assert_variance(
    scene: &SceneDescription,
    ray: Ray,
    settings: &IntegratorSettings,
    expected: f64,
) {
    for (core, _, samples) in estimates(scene, ray, settings, 400_000) {
        let (_, variance) = mean_and_variance(&samples);
        assert!((variance / expected - 1.0).abs() < 0.03, "{core}: {variance} is not {expected}");
    }
}

fn furnace(reflectance: f64, emitted: f64) -> SceneDescription {
    Stage::empty().room(1.25, diffuse(reflectance).emitting(emitted)).scene()
}

/// From the middle of a room, away from +z.
fn somewhere() -> Ray {
    Ray::new(dvec3(0.2, 0.1, 0.4), dvec3(0.5, -0.7, -0.9))
}

/// Onto the origin at an angle from +z, from a point so near that no light of these scenes lies behind it.
fn towards_origin(degrees: f64) -> Ray {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let from = dvec3(-0.6 * sine, -0.8 * sine, cosine);
    Ray::new(from * 0.3, -from)
}

/// The floor, and a polygon that emits towards the origin.
fn floor_under(corners: &[[f64; 3]]) -> Stage {
    let mut corners: Vec<DVec3> = corners.iter().map(|corner| DVec3::from(*corner)).collect();
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if normal.dot(corners[0]) > 0.0 {
        corners.reverse();
    }
    Stage::empty().floor().polygon(&corners, light())
}

fn light() -> Look {
    diffuse(0.0).emitting(EMITTED)
}

fn level(x: [f64; 2], y: [f64; 2], height: f64) -> [[f64; 3]; 4] {
    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| [x[i], y[j], height])
}

fn square(half: f64, height: f64) -> [DVec3; 4] {
    level([-half, half], [-half, half], height).map(DVec3::from)
}

fn overhead() -> Stage {
    floor_under(&level([-0.6, 0.6], [-0.4, 0.4], 1.5))
}

#[test]
fn each_bounce_of_a_furnace_is_a_power_of_its_reflectance() {
    let scene = furnace(RHO, 0.7);
    for bounce in 0..=5 {
        let expected = 0.7 * RHO.powi(bounce as i32);
        assert_each(&scene, somewhere(), &settings(bounce..=bounce), expected);
    }
    assert_each(&scene, somewhere(), &settings(0..=60), 0.7 / (1.0 - RHO));
    assert_mean(&scene, somewhere(), &by_hemisphere(0..=3), (100_000, 0.01), 1.0902871);
}

#[test]
fn an_emitting_cap_lights_the_whole_cavity_alike() {
    let look = diffuse(0.6).emitting_cap(3.0, 40_f64.to_radians());
    let scene = Stage::empty().room(1.25, look).scene();
    let ray = Ray::new(DVec3::ZERO, dvec3(2.2_f64.sin(), 0.0, 2.2_f64.cos()));
    for (bounces, expected) in [
        (0..=0, 0.0),
        (1..=1, 0.210_560_001_2),
        (2..=2, 0.126_336_000_7),
        (3..=3, 0.075_801_600_4),
        (0..=100, 0.526_400_003),
    ] {
        assert_each(&scene, ray, &settings(bounces), expected);
    }
    assert_mean(&scene, ray, &by_hemisphere(1..=4), (300_000, 0.02), 0.45817856);
    let half = Stage::empty().room(1.0, diffuse(0.5).emitting_cap(1.0, FRAC_PI_2)).scene();
    assert_each(&half, Ray::new(DVec3::ZERO, DVec3::NEG_Z), &settings(0..=0), 0.0);
}

#[test]
fn concentric_spheres_exchange_light() {
    let scene = Stage::empty()
        .sphere(DVec3::ZERO, 0.5, diffuse(0.7))
        .room(1.0, diffuse(0.4).emitting(1.0))
        .scene();
    let inward = Ray::new(dvec3(0.0, 0.6, 0.48), dvec3(0.0, -0.6, -0.48));
    let outward = Ray::new(dvec3(0.0, 0.6, 0.48), dvec3(0.3, 0.6, 0.48));
    for (last, of_inner, of_outer) in [(1, 0.7, 1.3), (2, 0.91, 1.46), (3, 1.022, 1.529)] {
        for settings in both(0..=last) {
            assert_mean(&scene, inward, &settings, (200_000, 0.03), of_inner);
            assert_mean(&scene, outward, &settings, (200_000, 0.03), of_outer);
        }
    }
}

#[test]
fn delta_lights_are_exact() {
    let light = Light::Point { position: dvec3(0.9, 0.0, 1.5), intensity: grey(2.0) };
    let point = Stage::empty().floor().light(light).scene();
    let (sine, cosine) = 40_f64.to_radians().sin_cos();
    let (direction, irradiance) = (dvec3(sine, 0.0, -cosine), grey(2.0));
    let sun = Stage::empty().floor().light(Light::Directional { direction, irradiance }).scene();
    let distance_squared: f64 = 1.5 * 1.5 + 0.9 * 0.9;
    let of_point = RHO / PI * 2.0 * 1.5 / distance_squared.sqrt() / distance_squared;
    for settings in both(0..=1) {
        assert_each(&point, towards_origin(33.0), &settings, of_point);
        assert_each(&sun, towards_origin(33.0), &settings, RHO * 2.0 * cosine / PI);
    }
}

#[test]
fn polygons_light_the_floor_by_their_form_factors() {
    let upright = [[0.0, 0.7, 0.0], [1.1, 0.7, 0.0], [1.1, 0.7, 0.9], [0.0, 0.7, 0.9]];
    let across_the_horizon = [[0.8, -0.5, -0.6], [0.9, 0.7, 0.9], [1.4, -0.6, 1.2]];
    for (stage, form_factor) in [
        (overhead(), 0.117_882_642_3),
        (floor_under(&level([0.3, 1.5], [-0.2, 0.6], 1.5)), 0.071_565_981_71),
        (floor_under(&upright), 0.084_811_845_63),
        (floor_under(&[[0.3, -0.4, 1.1], [1.2, 0.5, 0.9], [-0.4, 0.8, 1.6]]), 0.132_186_511_1),
        (floor_under(&across_the_horizon), 0.057_677_949_9),
    ] {
        let (scene, expected) = (stage.scene(), RHO * EMITTED * form_factor);
        assert_mean(&scene, towards_origin(20.0), &settings(1..=1), (100_000, 0.03), expected);
        assert_mean(&scene, towards_origin(20.0), &by_hemisphere(1..=1), (300_000, 0.1), expected);
    }
}

/// By quadrature of the squares of f Le cos/pdf: uniform directions, and uniform points.
#[test]
fn variances_are_those_of_the_two_estimators() {
    let scene = overhead().scene();
    assert_variance(&scene, towards_origin(20.0), &by_hemisphere(1..=1), 0.732366);
    assert_variance(&scene, towards_origin(20.0), &settings(1..=1), 4.18671e-4);
}

#[test]
fn spheres_light_the_floor_also_across_its_horizon() {
    for (degrees, form_factor) in
        [(35, 0.058_250_812), (80, 0.012_685_922_8), (90, 0.004_113_341_7), (97, 9.794_383_3e-4)]
    {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let centre = dvec3(1.5 * sine, 0.0, 1.5 * cosine);
        let scene = Stage::empty().floor().sphere(centre, 0.4, light()).scene();
        let expected = RHO * EMITTED * form_factor;
        assert_mean(&scene, towards_origin(20.0), &settings(1..=1), (400_000, 0.03), expected);
    }
}

#[test]
fn skies_light_the_floor() {
    let constant = Light::ConstantSky { radiance: grey(EMITTED) };
    let (horizon, zenith) = (grey(0.4), grey(1.3));
    let gradient = Light::GradientSky { up: DVec3::Z, horizon, zenith };
    for (sky, expected) in [(constant, EMITTED * RHO), (gradient, RHO)] {
        let scene = Stage::empty().floor().light(sky).scene();
        for settings in both(0..=1) {
            assert_mean(&scene, towards_origin(20.0), &settings, (400_000, 0.015), expected);
        }
    }
    let scene = Stage::empty().light(gradient).scene();
    let up = Ray::new(DVec3::Z, dvec3(0.0, 0.6, 0.8));
    assert_each(&scene, up, &settings(0..=0), 0.4 + 0.9 * 0.8);
}

#[test]
fn what_emits_away_or_is_hidden_adds_exactly_nothing() {
    let away = |height| Stage::empty().floor().polygon(&square(1.0, height), light());
    let hidden = overhead().polygon(&square(2.0, 1.0), diffuse(0.5));
    let dark = Stage::empty().room(1.0, diffuse(0.9));
    let nothing = [away(1.0), away(-1.0), hidden, Stage::empty().floor(), dark, Stage::empty()];
    for (number, scene) in nothing.map(Stage::scene).iter().enumerate() {
        let last = if number < 3 { 1 } else { 5 };
        for settings in both(1..=last) {
            assert_each(scene, towards_origin(20.0), &settings, 0.0);
        }
    }
}

#[test]
fn mirrors_show_emission_a_bounce_later_each() {
    let mirror = looks(Surface::Mirror { reflectance: grey(0.83) });
    let strip = |z| level([-1.0, 3.1], [-1.0, 1.0], z).map(DVec3::from);
    let end = [(-1.0, -2.0), (-1.0, 3.0), (1.0, 3.0), (1.0, -2.0)];
    let scene = Stage::empty()
        .polygon(&strip(0.0), mirror)
        .polygon(&strip(1.0), mirror)
        .polygon(&end.map(|(y, z)| dvec3(4.0, y, z)), diffuse(0.0).emitting(1.0))
        .scene();
    let ray = Ray::new(dvec3(0.0, 0.0, 0.5), dvec3(1.0, 0.0, -1.0).normalize());
    let reflected = 0.83_f64.powi(3);
    for (bounces, expected) in
        [(0..=10, reflected), (3..=3, reflected), (0..=2, 0.0), (4..=10, 0.0)]
    {
        assert_each(&scene, ray, &settings(bounces), expected);
    }
}

#[test]
fn a_slab_of_glass_transmits_what_its_faces_leave() {
    let mut under_side = square(50.0, 0.0);
    under_side.reverse();
    let scene = Stage::empty()
        .polygon(&square(50.0, 0.1), clear_glass())
        .polygon(&under_side, clear_glass())
        .polygon(&square(200.0, -2.0), diffuse(0.0).emitting(1.0))
        .scene();
    for (degrees, expected) in [(0.0, 12.0 / 13.0), (60.0, 0.836_232_462_7)] {
        let ray = towards_origin(degrees);
        let ray = Ray::new(ray.origin - 2.0 * ray.direction, ray.direction);
        assert_mean(&scene, ray, &settings(0..=60), (300_000, 0.01), expected);
    }
}

#[test]
fn a_glass_sphere_cannot_be_seen_in_a_uniform_sky_and_dims_what_it_holds() {
    let sky = Light::ConstantSky { radiance: grey(1.0) };
    let glass = Stage::empty().sphere(DVec3::ZERO, 1.0, clear_glass());
    let scene = glass.clone().light(sky).scene();
    let ray = Ray::new(dvec3(0.6, 0.0, 3.0), DVec3::NEG_Z);
    assert_each(&scene, ray, &settings(0..=100), 1.0);
    // One reflection outside, or one segment inside: 1 − (1 − F) F with F at sin θ = 0.6.
    assert_mean(&scene, ray, &settings(0..=2), (100_000, 0.01), 0.958032);
    let scene = glass.sphere(DVec3::ZERO, 0.4, diffuse(0.0).emitting(1.0)).scene();
    let central = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    assert_mean(&scene, central, &settings(0..=40), (100_000, 0.01), 0.96 / 2.25);
}

#[test]
fn mirrors_and_glass_scatter_no_light_that_was_sampled() {
    let sun = Light::Directional { direction: DVec3::NEG_Z, irradiance: grey(1.0) };
    let ray = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    for look in [looks(Surface::Mirror { reflectance: grey(1.0) }), clear_glass()] {
        let scene = Stage::empty().sphere(DVec3::ZERO, 1.0, look).light(sun).scene();
        assert_each(&scene, ray, &settings(0..=5), 0.0);
    }
}

fn metal(reflectance: f64, roughness: f64) -> Look {
    looks(Surface::Conductor { reflectance: grey(reflectance), roughness })
}

/// By quadrature, with separable masking.
#[test]
fn rough_metal_in_a_uniform_sky_shows_its_albedo() {
    let sky = Light::ConstantSky { radiance: grey(1.0) };
    for (roughness, degrees, albedo) in [
        (0.1, 75.0, 0.923_240),
        (0.3, 45.0, 0.844_432),
        (0.6, 0.0, 0.591_523),
        (0.6, 75.0, 0.676_011),
        (1.0, 0.0, 1.0 - 2_f64.ln()),
    ] {
        let scene =
            Stage::empty().polygon(&square(1e3, 0.0), metal(1.0, roughness)).light(sky).scene();
        for (settings, resolution) in both(1..=1).into_iter().zip([0.01, 0.1]) {
            let settings = IntegratorSettings { samples_per_light: 4, ..settings };
            let precision = (100_000, resolution);
            assert_mean(&scene, towards_origin(degrees), &settings, precision, albedo);
        }
    }
}

/// Under a sphere, a polygon and a sky, of which rough metal mirrors each.
#[test]
fn light_and_hemisphere_samples_of_rough_metal_agree() {
    let polygon = [[0.2, 0.0, 1.2], [0.2, 0.6, 1.2], [0.8, 0.6, 1.2], [0.8, 0.0, 1.2]];
    let sky = Light::ConstantSky { radiance: grey(EMITTED) };
    for (roughness, samples_per_light) in [(0.1, 1), (0.3, 3)] {
        let plate = Stage::empty().polygon(&square(1.0, 0.0), metal(0.9, roughness));
        for stage in [
            plate.clone().sphere(dvec3(0.5, 0.4, 1.4), 0.3, light()),
            plate.clone().polygon(&polygon.map(DVec3::from), light()),
            plate.light(sky),
        ] {
            let (scene, ray) = (stage.scene(), towards_origin(30.0));
            let combined = IntegratorSettings { samples_per_light, ..settings(1..=1) };
            let combined = estimates(&scene, ray, &combined, 40_000);
            let hemisphere = estimates(&scene, ray, &by_hemisphere(1..=1), 400_000);
            for ((core, _, one), (_, _, other)) in combined.into_iter().zip(hemisphere) {
                let [(one, noise), (other, more)] = [&one, &other].map(|it| mean_and_variance(it));
                let error = (noise / 40_000.0 + more / 400_000.0).sqrt();
                assert!(error < 0.03 * one, "{core} is too noisy: {error} of {one}");
                assert!((one - other).abs() <= 5.0 * error, "{core}: {one}, not {other} ± {error}");
            }
        }
    }
}

#[test]
fn roulette_changes_the_noise_and_not_the_mean() {
    let scene = furnace(RHO, 1.0);
    for (stop, guaranteed) in [(0.0, 0), (0.35, 0), (0.7, 0), (0.35, 2), (0.6, 1)] {
        let roulette = Some(Roulette { stop, guaranteed });
        let settings = IntegratorSettings { roulette, ..settings(0..=40) };
        assert_mean(&scene, somewhere(), &settings, (200_000, 0.01), 1.0 / (1.0 - RHO));
    }
}

/// Bounces 0 and 1 are certain, so the moments are those of a path that starts to play after one bounce: geometric
/// sums.
#[test]
fn roulette_has_the_variance_of_the_geometric_series() {
    for (reflectance, stop, variance) in [(RHO, 0.35, 0.032_210_081_75), (0.5, 0.3, 1.0 / 6.0)] {
        let roulette = Some(Roulette { stop, guaranteed: 0 });
        let settings = IntegratorSettings { roulette, ..settings(0..=200) };
        assert_variance(&furnace(reflectance, 1.0), somewhere(), &settings, variance);
    }
}

#[test]
fn guaranteed_bounces_are_never_played_for() {
    let scene = furnace(RHO, 1.0);
    for (guaranteed, bounce) in (0..3).flat_map(|g| (1..=4).map(move |bounce| (g, bounce))) {
        let roulette = Some(Roulette { stop: 0.5, guaranteed });
        let settings = IntegratorSettings { roulette, ..settings(bounce..=bounce) };
        for (core, _, samples) in estimates(&scene, somewhere(), &settings, 200) {
            let is_certain = mean_and_variance(&samples).1 < 1e-12;
            assert_eq!(is_certain, bounce <= guaranteed + 1, "{core}: {guaranteed} {bounce}");
        }
    }
}

#[test]
fn single_bounces_add_up_to_all_of_them() {
    let scene = overhead().sphere(dvec3(0.5, 0.5, 0.4), 0.4, diffuse(RHO)).scene();
    let (ray, count) = (towards_origin(20.0), 200_000);
    for direct in both(0..=3) {
        let of = |bounces| {
            estimates(&scene, ray, &IntegratorSettings { bounces, ..direct.clone() }, count)
        };
        let mut sums = [0.0; 2];
        for bounce in 0..=3 {
            for (sum, (_, _, samples)) in sums.iter_mut().zip(of(bounce..=bounce)) {
                *sum += mean_and_variance(&samples).0;
            }
        }
        for (sum, (core, _, samples)) in sums.into_iter().zip(of(0..=3)) {
            let (mean, variance) = mean_and_variance(&samples);
            let error = (2.0 * variance / count as f64).sqrt();
            assert!(5.0 * error < 0.1 * mean, "{core} is too noisy: {error} of {mean}");
            assert!((sum - mean).abs() < 5.0 * error, "{core}: {sum} is not {mean}");
        }
    }
}
