//! Light scattered once by a floor of reflectance .37 at the origin.

use crate::contract::{DirectSampling, IntegratorSettings, Ray};
use crate::cores::textbook::testing::{Estimate, Look, Stage, diffuse, grey, looks};
use crate::scene::{Light, Surface};
use glam::DVec3;
use std::f64::consts::PI;

const REFLECTANCE: f64 = 0.37;
const GLOW: f64 = 5.0;

fn one_bounce(direct: DirectSampling) -> IntegratorSettings {
    IntegratorSettings { bounces: 1..=1, direct, seed: 1, ..IntegratorSettings::default() }
}

/// Onto the origin, from a point so near that no light of these scenes lies behind it.
fn onto_origin() -> Ray {
    let direction = DVec3::new(0.4, 0.3, -1.0).normalize();
    Ray::new(-0.3 * direction, direction)
}

fn by_lights(stage: Stage, paths: usize) -> Estimate {
    Estimate::of(&stage.world(), &onto_origin(), &one_bounce(DirectSampling::Lights), paths)
}

fn by_hemisphere(stage: Stage, paths: usize) -> Estimate {
    Estimate::of(&stage.world(), &onto_origin(), &one_bounce(DirectSampling::Hemisphere), paths)
}

/// The floor, and a polygon that glows towards it.
fn floor_under(corners: &[[f64; 3]]) -> Stage {
    let mut corners: Vec<DVec3> = corners.iter().map(|corner| DVec3::from(*corner)).collect();
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if normal.dot(corners[0]) > 0.0 {
        corners.reverse();
    }
    Stage::empty().floor().polygon(&corners, diffuse(0.0).glowing(GLOW))
}

fn rectangle_above(x: [f64; 2], y: [f64; 2], height: f64) -> Stage {
    let corner = |i: usize, j: usize| [x[i], y[j], height];
    floor_under(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)])
}

fn reflected(configuration_factor: f64) -> f64 {
    REFLECTANCE * GLOW * configuration_factor
}

#[test]
fn s04_a_point_light_weakens_with_the_square_of_distance() {
    let light = |intensity| Light::Point { position: DVec3::new(0.9, 0.0, 1.5), intensity };
    let stage = Stage::empty().floor().light(light(grey(2.0)));
    let distance_squared: f64 = 1.5 * 1.5 + 0.9 * 0.9;
    let cosine = 1.5 / distance_squared.sqrt();
    let expected = REFLECTANCE / PI * 2.0 * cosine / distance_squared;
    by_lights(stage.clone(), 2).assert_is_exactly(expected);
    by_hemisphere(stage, 2).assert_is_exactly(expected);
}

#[test]
fn s04d_a_directional_light_falls_by_the_cosine() {
    let (sine, cosine) = 40.0_f64.to_radians().sin_cos();
    let direction = DVec3::new(-sine, 0.0, -cosine);
    let stage =
        Stage::empty().floor().light(Light::Directional { direction, irradiance: grey(2.0) });
    by_lights(stage, 2).assert_is_exactly(REFLECTANCE * 2.0 * cosine / PI);
}

#[test]
fn s05_a_rectangle_overhead_has_the_mean_and_the_variances_of_theory() {
    let stage = rectangle_above([-0.6, 0.6], [-0.4, 0.4], 1.5);
    let lights = by_lights(stage.clone(), 50_000);
    lights.assert_is(reflected(0.117_882_642_3), 0.001);
    let hemisphere = by_hemisphere(stage, 200_000);
    hemisphere.assert_is(reflected(0.117_882_642_3), 0.01);
    // S30, by quadrature; a sample variance of so many light tailed samples is good to a few
    // percent.
    assert!((lights.variance / 4.186_71e-4 - 1.0).abs() < 0.05, "{lights:?}");
    assert!((hemisphere.variance / 0.732_366 - 1.0).abs() < 0.05, "{hemisphere:?}");
}

#[test]
fn s05b_a_rectangle_aside() {
    let stage = rectangle_above([0.3, 1.5], [-0.2, 0.6], 1.5);
    by_lights(stage, 50_000).assert_is(reflected(0.071_565_981_71), 0.003);
}

#[test]
fn s06_a_rectangle_upright() {
    let corners = [[0.0, 0.7, 0.0], [1.1, 0.7, 0.0], [1.1, 0.7, 0.9], [0.0, 0.7, 0.9]];
    by_lights(floor_under(&corners), 100_000).assert_is(reflected(0.084_811_845_63), 0.003);
}

#[test]
fn s07_a_triangle_in_general_position() {
    let corners = [[0.3, -0.4, 1.1], [1.2, 0.5, 0.9], [-0.4, 0.8, 1.6]];
    by_lights(floor_under(&corners), 50_000).assert_is(reflected(0.132_186_511_1), 0.003);
}

#[test]
fn s08_a_triangle_through_the_horizon() {
    let corners = [[0.8, -0.5, -0.6], [0.9, 0.7, 0.9], [1.4, -0.6, 1.2]];
    by_lights(floor_under(&corners), 100_000).assert_is(reflected(0.057_677_949_9), 0.005);
}

#[test]
fn s11_and_s12_a_ball_above_and_at_the_horizon() {
    let factors =
        [(35, 0.058_250_812), (80, 0.012_685_922_8), (90, 0.004_113_341_7), (97, 9.794_383_3e-4)];
    for (degrees, factor) in factors {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let centre = 1.5 * DVec3::new(sine, 0.0, cosine);
        let stage = Stage::empty().floor().ball(centre, 0.4, diffuse(0.0).glowing(GLOW));
        by_lights(stage, 100_000).assert_is(reflected(factor), 0.01);
    }
}

#[test]
fn s14_a_uniform_sky_lights_the_floor_with_its_own_radiance() {
    let stage = Stage::empty().floor().light(Light::ConstantSky { radiance: grey(GLOW) });
    by_lights(stage.clone(), 100_000).assert_is(reflected(1.0), 0.01);
    by_hemisphere(stage, 100_000).assert_is(reflected(1.0), 0.01);
}

#[test]
fn s15_a_gradient_sky() {
    let (horizon, zenith) = (grey(0.4), grey(1.3));
    let sky = Light::GradientSky { up: DVec3::Z, horizon, zenith };
    by_lights(Stage::empty().floor().light(sky), 100_000).assert_is(REFLECTANCE, 0.01);
}

#[test]
fn light_behind_the_lamp_and_behind_the_surface_is_exactly_zero() {
    let above = [[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]];
    let glowing_up = above.map(|[x, y, z]| DVec3::new(-x, y, z));
    let below = above.map(|[x, y, _]| DVec3::new(-x, y, -1.0));
    for corners in [glowing_up, below] {
        let stage = Stage::empty().floor().polygon(&corners, diffuse(0.0).glowing(GLOW));
        for estimate in [by_lights(stage.clone(), 1000), by_hemisphere(stage, 1000)] {
            assert_eq!((estimate.mean, estimate.variance), (0.0, 0.0), "{corners:?}");
        }
    }
}

#[test]
fn an_occluder_hides_the_light_and_the_light_does_not_hide_itself() {
    let roof = [[-2.0, -2.0, 1.0], [2.0, -2.0, 1.0], [2.0, 2.0, 1.0], [-2.0, 2.0, 1.0]];
    let roof = roof.map(DVec3::from);
    let stage = rectangle_above([-0.6, 0.6], [-0.4, 0.4], 1.5).polygon(&roof, diffuse(0.5));
    assert_eq!(by_lights(stage, 1000).mean, 0.0);
}

#[test]
fn several_samples_and_several_lights_add_up_as_one_expects() {
    let rectangle = [[-0.6, -0.4, 1.5], [-0.6, 0.4, 1.5], [0.6, 0.4, 1.5], [0.6, -0.4, 1.5]];
    let stage = rectangle_above([-0.6, 0.6], [-0.4, 0.4], 1.5)
        .polygon(&rectangle.map(DVec3::from), diffuse(0.0).glowing(GLOW))
        .light(Light::Point { position: DVec3::new(0.9, 0.0, 1.5 * 0.999), intensity: grey(0.0) })
        .light(Light::Directional { direction: -DVec3::Z, irradiance: grey(0.0) });
    let settings =
        IntegratorSettings { samples_per_light: 7, ..one_bounce(DirectSampling::Lights) };
    Estimate::of(&stage.world(), &onto_origin(), &settings, 5000)
        .assert_is(2.0 * reflected(0.117_882_642_3), 0.001);
}

/// A plate of rough metal that mirrors a small bright lamp: both samplings and their combination
/// agree.
#[test]
fn glossy_surfaces_reflect_the_same_by_lights_and_by_hemisphere() {
    for roughness in [0.1, 0.3] {
        let metal = looks(Surface::Conductor { reflectance: grey(0.9), roughness });
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let plate = corners.map(|(x, y)| DVec3::new(x, y, 0.0));
        let lamps: [fn(Stage, Look) -> Stage; 3] = [
            |stage, look| stage.ball(DVec3::new(0.5, 0.4, 1.4), 0.3, look),
            |stage, look| {
                let corners = [[0.2, 0.0, 1.2], [0.2, 0.6, 1.2], [0.8, 0.6, 1.2], [0.8, 0.0, 1.2]];
                stage.polygon(&corners.map(DVec3::from), look)
            },
            |stage, _| stage.light(Light::ConstantSky { radiance: grey(GLOW) }),
        ];
        for lamp in lamps {
            let stage = lamp(Stage::empty().polygon(&plate, metal), diffuse(0.0).glowing(GLOW));
            let combined = by_lights(stage.clone(), 40_000);
            let hemisphere = by_hemisphere(stage, 400_000);
            let error = combined.standard_error.hypot(hemisphere.standard_error);
            assert!(
                (combined.mean - hemisphere.mean).abs() <= 4.5 * error,
                "{combined:?} {hemisphere:?}"
            );
            assert!(error < 0.02 * combined.mean, "too noisy: {combined:?} {hemisphere:?}");
        }
    }
}
