//! Pictures, and shadows at grazing angles.

use super::Builtin;
use crate::contract::{
    Acceleration, AdaptiveSettings, Core, Film, IntegratorSettings, Ray, RenderSettings,
};
use crate::cores::stage::{Stage, diffuse};
use crate::scene::{Camera, Emission, Light, Rgb, SceneDescription};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

fn grey_camera(film: [u32; 2]) -> Camera {
    Camera::look_at(dvec3(0.0, -3.0, 1.0), DVec3::Z * 0.5, DVec3::Z, 0.9, film)
}

fn picture(scene: &SceneDescription, settings: &RenderSettings) -> Film {
    let mut core = Builtin::new();
    let mut built = core.build_scene(scene, Acceleration::DEFAULT).expect("a scene");
    let mut film = Film::default();
    let camera = grey_camera([settings.width, settings.height]);
    built.render(&camera, settings, &mut film).expect("a picture");
    film
}

fn picture_settings(samples_per_pixel: u32, threads: u32) -> RenderSettings {
    let integrator =
        IntegratorSettings { bounces: 0..=4, seed: 4711, threads, ..Default::default() };
    RenderSettings { width: 24, height: 16, samples_per_pixel, integrator, ..Default::default() }
}

fn small_room(radiance: Rgb) -> SceneDescription {
    let light = [(-0.6, -0.4), (-0.6, 0.4), (0.6, 0.4), (0.6, -0.4)];
    let mut scene = Stage::empty()
        .floor()
        .polygon(&light.map(|(x, y)| dvec3(x, y, 1.5)), diffuse(0.0).emitting(1.0))
        .sphere(dvec3(0.2, 0.1, 0.4), 0.4, diffuse(0.5))
        .scene();
    scene.materials[1].emission = Some(Emission { radiance, cap: None });
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
    let mut settings = picture_settings(256, 0);
    settings.adaptive = Some(AdaptiveSettings { samples_per_batch: 16, max_tolerance: 0.1 });
    let film = picture(&small_room([5.0; 3]), &settings);
    let counts = &film.sample_counts;
    assert!(counts.iter().all(|&count| count.is_multiple_of(16) && (16..=256).contains(&count)));
    assert!(counts.iter().min() < counts.iter().max(), "some pixels are harder than others");
}

#[test]
fn nothing_to_see_is_black() {
    let film = picture(&SceneDescription::default(), &picture_settings(2, 0));
    assert!(film.pixels.iter().all(|&pixel| pixel == [0.0; 3]));
}

#[test]
fn a_wide_plane_does_not_shadow_itself() {
    for size in [1.0, 40.0, 3e4] {
        let corners = [(-1.0, -1.0), (1.0, -0.9), (0.9, 1.0), (-1.1, 0.8)];
        let tilted = corners.map(|(x, y)| dvec3(x, y, 0.31 * x - 0.17 * y) * size);
        let plane = Stage::empty().polygon(&tilted, diffuse(1.0));
        let normal = dvec3(-0.31, 0.17, 1.0).normalize();
        let along = dvec3(1.0, 0.0, 0.31).normalize();
        for grazing in [0.5, 1e-2, 1e-4] {
            let towards = (along + normal * grazing).normalize();
            let light = Light::Directional { direction: -towards, irradiance: [PI; 3] };
            let scene = plane.clone().light(light).scene();
            let rays: Vec<_> = (0..2000)
                .map(|step| f64::from(step) / 2000.0)
                .map(|place| dvec3(place - 0.3, 0.4 - 0.6 * place, 0.0) * size)
                .map(|at| Ray::new(at + normal * size, -normal))
                .collect();
            let mut radiance = vec![[f64::NAN; 3]; rays.len()];
            let settings = IntegratorSettings { bounces: 1..=1, ..Default::default() };
            let mut core = Builtin::new();
            let mut built = core.build_scene(&scene, Acceleration::DEFAULT).expect("a scene");
            built.radiance(&rays, &settings, &mut radiance).expect("radiance");
            let expected = normal.dot(towards);
            for (ray, [seen, ..]) in rays.iter().zip(radiance) {
                assert!((seen / expected - 1.0).abs() < 1e-5, "{size} {grazing} {ray:?}: {seen}");
            }
        }
    }
}
