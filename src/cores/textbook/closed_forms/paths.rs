//! Light scattered many times: furnaces, cavities, mirrors and glass.

use crate::contract::{DirectSampling, IntegratorSettings, Ray, Roulette};
use crate::cores::textbook::steps::LESSON;
use crate::cores::textbook::testing::{Estimate, Stage, clear_glass, diffuse, grey, looks};
use crate::cores::textbook::world::World;
use crate::scene::{Light, Surface};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

const BOTH: [DirectSampling; 2] = [DirectSampling::Lights, DirectSampling::Hemisphere];

fn settings(bounces: RangeInclusive<u32>, direct: DirectSampling) -> IntegratorSettings {
    IntegratorSettings { bounces, direct, seed: 2, ..IntegratorSettings::default() }
}

fn by_lights(world: &World<'_>, ray: &Ray, bounces: RangeInclusive<u32>, paths: usize) -> Estimate {
    Estimate::of(world, ray, &settings(bounces, DirectSampling::Lights), paths)
}

fn somewhere() -> Ray {
    Ray::new(DVec3::ZERO, DVec3::new(0.3, 0.2, 0.9).normalize())
}

fn furnace(glow: f64, reflectance: f64) -> World<'static> {
    Stage::empty().room(1.0, diffuse(reflectance).glowing(glow)).world()
}

#[test]
fn s01_each_bounce_of_a_furnace_is_the_last_times_the_reflectance() {
    let world = furnace(0.7, 0.37);
    for bounce in 0..=5 {
        let expected = 0.7 * 0.37_f64.powi(bounce as i32);
        by_lights(&world, &somewhere(), bounce..=bounce, 50).assert_is_exactly(expected);
        let hemisphere = settings(bounce..=bounce, DirectSampling::Hemisphere);
        Estimate::of(&world, &somewhere(), &hemisphere, 20_000).assert_is(expected, 0.005);
    }
}

#[test]
fn s01_all_bounces_of_a_furnace_sum_to_the_series() {
    by_lights(&furnace(0.7, 0.37), &somewhere(), 0..=60, 50).assert_is_exactly(0.7 / 0.63);
}

#[test]
fn s02_a_cap_lights_the_rest_of_its_cavity_evenly() {
    let look = diffuse(0.6).glowing_cap(3.0, 40.0_f64.to_radians());
    let world = Stage::empty().room(1.0, look).world();
    let away_from_the_cap = Ray::new(DVec3::ZERO, DVec3::new(2.2_f64.sin(), 0.0, 2.2_f64.cos()));
    for (bounces, expected) in [(0..=0, 0.0), (1..=1, 0.210_560_001_2), (2..=2, 0.126_336_000_7)] {
        by_lights(&world, &away_from_the_cap, bounces, 50).assert_is_exactly(expected);
    }
    by_lights(&world, &away_from_the_cap, 0..=100, 50).assert_is_exactly(0.526_400_003);
    let hemisphere = settings(2..=2, DirectSampling::Hemisphere);
    Estimate::of(&world, &away_from_the_cap, &hemisphere, 200_000).assert_is(0.126_336_000_7, 0.01);
}

#[test]
fn s03_concentric_spheres_of_unequal_reflectance() {
    let world = Stage::empty()
        .room(1.0, diffuse(0.4).glowing(1.0))
        .ball(DVec3::ZERO, 0.5, diffuse(0.7))
        .world();
    let between = DVec3::new(0.0, 0.0, 0.75);
    let inner = Ray::new(between, DVec3::new(0.05, 0.02, -1.0).normalize());
    let outer = Ray::new(between, DVec3::new(0.05, 0.02, 1.0).normalize());
    let up_to = [(1, 0.7, 1.3), (2, 0.91, 1.46), (3, 1.022, 1.529), (20, 1.0 / 0.9, 1.0 / 0.63)];
    for (bounce, of_inner, of_outer) in up_to {
        by_lights(&world, &inner, 0..=bounce, 40_000).assert_is(of_inner, 0.015);
        by_lights(&world, &outer, 0..=bounce, 40_000).assert_is(of_outer, 0.015);
    }
}

#[test]
fn isolated_bounces_add_up_to_the_accumulated_picture() {
    let world = furnace(0.7, 0.37);
    for direct in BOTH {
        let mean = |bounces| Estimate::of(&world, &somewhere(), &settings(bounces, direct), 20_000);
        let isolated: f64 = (0..=3).map(|bounce| mean(bounce..=bounce).mean).sum();
        let accumulated = mean(0..=3);
        let error = (isolated - accumulated.mean).abs();
        assert!(
            error <= 4.5 * 2.0 * accumulated.standard_error + 1e-12,
            "{isolated} {accumulated:?}"
        );
    }
}

#[test]
fn roulette_changes_the_noise_and_never_the_mean() {
    let world = furnace(1.0, 0.37);
    for guaranteed in [0, 1, 3] {
        for stop in [0.0, 0.1, 0.35, 0.6] {
            let roulette = Some(Roulette { stop, guaranteed });
            let settings = IntegratorSettings { roulette, ..settings(0..=30, BOTH[0]) };
            let estimate = Estimate::of(&world, &somewhere(), &settings, 10_000);
            estimate.assert_is(1.0 / 0.63, 0.005);
        }
    }
}

/// S29 with paths of which bounces 0 to 1 + guaranteed are certain: closed form of `rr_moments` for
/// `start` = 1, which is no guaranteed continuation at all, because light of bounce 1 needs none.
#[test]
fn s29_roulette_has_the_variance_of_the_geometric_series() {
    let cases = [(0.37, 0.35, 0.032_210_081_75), (0.5, 0.3, 0.166_666_666_7)];
    for (reflectance, stop, variance) in cases {
        let roulette = Some(Roulette { stop, guaranteed: 0 });
        let settings = IntegratorSettings { roulette, ..settings(0..=200, BOTH[0]) };
        let world = furnace(1.0, reflectance);
        let estimate = Estimate::of(&world, &somewhere(), &settings, 200_000);
        assert!((estimate.variance / variance - 1.0).abs() < 0.03, "{estimate:?}");
    }
}

#[test]
fn guaranteed_continuations_are_never_gambled_with() {
    let world = furnace(1.0, 0.37);
    for guaranteed in 0..3 {
        let roulette = Some(Roulette { stop: 0.5, guaranteed });
        for bounce in 1..=4 {
            let settings = IntegratorSettings { roulette, ..settings(bounce..=bounce, BOTH[0]) };
            let estimate = Estimate::of(&world, &somewhere(), &settings, 200);
            let is_certain = estimate.variance < 1e-20;
            assert_eq!(is_certain, bounce <= guaranteed + 1, "{guaranteed} {bounce} {estimate:?}");
        }
    }
}

/// A ray between two mirrors at z = 0 and z = 1 that meets a lamp after three reflections.
#[test]
fn s20_each_mirror_takes_its_share_and_is_one_bounce() {
    let mirror = looks(Surface::Mirror { reflectance: grey(0.83) });
    let strip = |z: f64| {
        [(-1.0, -1.0), (3.1, -1.0), (3.1, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z))
    };
    let lamp =
        [(-1.0, -2.0), (-1.0, 3.0), (1.0, 3.0), (1.0, -2.0)].map(|(y, z)| DVec3::new(4.0, y, z));
    let world = Stage::empty()
        .polygon(&strip(0.0), mirror)
        .polygon(&strip(1.0), mirror)
        .polygon(&lamp, diffuse(0.0).glowing(1.0))
        .world();
    let ray = Ray::new(DVec3::new(0.0, 0.0, 0.5), DVec3::new(1.0, 0.0, -1.0).normalize());
    let reflected = 0.83_f64.powi(3);
    by_lights(&world, &ray, 0..=10, 2).assert_is_exactly(reflected);
    by_lights(&world, &ray, 3..=3, 2).assert_is_exactly(reflected);
    by_lights(&world, &ray, 0..=2, 2).assert_is_exactly(0.0);
    by_lights(&world, &ray, 4..=10, 2).assert_is_exactly(0.0);
}

/// A closed slab of glass between z = 0 and z = .1, far wider than light strays in it, over a
/// glowing floor.
fn slab_over_a_lamp() -> World<'static> {
    let face = |z: f64, size: f64| {
        [(-size, -size), (size, -size), (size, size), (-size, size)]
            .map(|(x, y)| DVec3::new(x, y, z))
    };
    let mut under_side = face(0.0, 50.0);
    under_side.reverse();
    Stage::empty()
        .polygon(&face(0.1, 50.0), clear_glass())
        .polygon(&under_side, clear_glass())
        .polygon(&face(-2.0, 200.0), diffuse(0.0).glowing(1.0))
        .world()
}

#[test]
fn s21_a_slab_of_glass_lets_through_what_the_series_says() {
    let world = slab_over_a_lamp();
    for (degrees, transmitted) in [(0, 12.0 / 13.0), (60, 0.836_232_462_7)] {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let ray = Ray::new(DVec3::Z * 2.0, DVec3::new(sine, 0.0, -cosine));
        by_lights(&world, &ray, 0..=60, 100_000).assert_is(transmitted, 0.002);
    }
}

#[test]
fn s22_a_lamp_in_glass_is_dimmed_by_the_index_squared() {
    let world = Stage::empty()
        .ball(DVec3::ZERO, 1.0, clear_glass())
        .ball(DVec3::ZERO, 0.5, diffuse(0.0).glowing(1.0))
        .world();
    let ray = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    by_lights(&world, &ray, 0..=40, 50_000).assert_is(0.96 / 2.25, 0.002);
}

#[test]
fn s23_a_clear_ball_vanishes_in_a_uniform_sky() {
    let sky = Light::ConstantSky { radiance: grey(1.0) };
    let world = Stage::empty().ball(DVec3::ZERO, 1.0, clear_glass()).light(sky).world();
    let ray = Ray::new(DVec3::new(0.0, 0.6, 3.0), DVec3::NEG_Z);
    by_lights(&world, &ray, 0..=100, 1000).assert_is_exactly(1.0);
    // Reflected at once, or straight through: one inner segment.
    by_lights(&world, &ray, 0..=2, 100_000).assert_is(0.958_032, 0.001);
}

#[test]
fn mirrors_and_glass_scatter_no_light_that_was_sampled() {
    let sun = Light::Directional { direction: DVec3::NEG_Z, irradiance: grey(1.0) };
    let ray = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    for look in [looks(Surface::Mirror { reflectance: grey(1.0) }), clear_glass()] {
        let world = Stage::empty().ball(DVec3::ZERO, 1.0, look).light(sun).world();
        by_lights(&world, &ray, 0..=5, 100).assert_is_exactly(0.0);
    }
}

/// Metal under a sky of radiance 1 shows its albedo (S24, by quadrature; separable Smith).
#[test]
fn s24_rough_metal_shows_its_albedo() {
    let sky = Light::ConstantSky { radiance: grey(1.0) };
    for (roughness, degrees, albedo) in
        [(0.1, 75.0, 0.923_240), (0.3, 45.0, 0.844_432), (0.6, 0.0, 0.591_523)]
    {
        let metal = looks(Surface::Conductor { reflectance: grey(1.0), roughness });
        let plate = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0));
        let world = Stage::empty().polygon(&plate, metal).light(sky).world();
        let (sine, cosine) = f64::to_radians(degrees).sin_cos();
        let ray = Ray::new(DVec3::new(-sine, 0.0, cosine), DVec3::new(sine, 0.0, -cosine));
        for direct in BOTH {
            let settings = IntegratorSettings { samples_per_light: 4, ..settings(1..=1, direct) };
            let (paths, resolution) =
                if direct == BOTH[0] { (20_000, 0.003) } else { (100_000, 0.02) };
            Estimate::of(&world, &ray, &settings, paths).assert_is(albedo, resolution);
        }
    }
}

#[test]
fn colours_keep_to_their_channels() {
    let reflectance = [0.37, 0.53, 0.71];
    let mut scene = Stage::empty().room(1.0, diffuse(0.0).glowing(0.0)).scene();
    scene.materials[0].surface = Surface::Diffuse { reflectance };
    scene.materials[0].emission.as_mut().expect("it glows").radiance = [0.7, 0.5, 0.3];
    let world = World::new(&scene, crate::contract::Acceleration::DEFAULT, &LESSON);
    let settings = settings(2..=2, BOTH[0]);
    let integrator = crate::cores::textbook::integrator::Integrator::new(&world, &settings);
    let mut random = crate::cores::textbook::random::Random::for_ray(0, 0);
    let radiance = integrator.radiance(&somewhere(), &mut random);
    let expected = DVec3::new(0.7 * 0.37 * 0.37, 0.5 * 0.53 * 0.53, 0.3 * 0.71 * 0.71);
    assert!(radiance.abs_diff_eq(expected, 1e-12), "{radiance} {expected}");
}

#[test]
fn empty_and_dark_scenes_are_black() {
    for direct in BOTH {
        let settings = settings(0..=5, direct);
        let nothing = Stage::empty().world();
        Estimate::of(&nothing, &somewhere(), &settings, 10).assert_is_exactly(0.0);
        let dark = Stage::empty().room(1.0, diffuse(0.9)).world();
        Estimate::of(&dark, &somewhere(), &settings, 10).assert_is_exactly(0.0);
    }
    let half_turn = Stage::empty().room(1.0, diffuse(0.5).glowing_cap(1.0, FRAC_PI_2)).world();
    let towards_the_dark_half = Ray::new(DVec3::ZERO, DVec3::NEG_Z);
    by_lights(&half_turn, &towards_the_dark_half, 0..=0, 10).assert_is_exactly(0.0);
}
