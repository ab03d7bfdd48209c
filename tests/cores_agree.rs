//! The two cores, written independently, have the same mean picture where nobody knows a closed form: each is the
//! other's witness, by the same screen and confirmation that compares renders with references.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::contract::validate::Validated;
use furnace::contract::{Acceleration, Core, Film, IntegratorSettings, RenderSettings};
use furnace::cores::CoreSpec;
use furnace::image::Image;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::scene::{Library, Overrides, SceneDescription};
use furnace::stats::{ImageEffort, Verdict, judge_image_pair};

/// Pixels: small, for every scene is rendered 16 times by each core.
const SIZE: [u32; 2] = [64, 48];
const SAMPLES: u32 = 16;

fn render(core: &str, scene: &SceneDescription, seed: Seed) -> Image {
    let spec: CoreSpec = core.parse().unwrap();
    let mut core = spec.make().unwrap();
    let mut core = Validated::new(core.as_mut());
    let settings = RenderSettings {
        width: SIZE[0],
        height: SIZE[1],
        samples_per_pixel: SAMPLES,
        integrator: IntegratorSettings { bounces: 0..=4, seed: seed.0, ..Default::default() },
        ..Default::default()
    };
    let mut film = Film::default();
    let mut built = core.build_scene(scene, Acceleration::DEFAULT).unwrap();
    built.render(&scene.camera.unwrap(), &settings, &mut film).unwrap();
    Image { width: SIZE[0] as usize, height: SIZE[1] as usize, pixels: film.pixels }
}

fn agree(name: &str, gain: f32) -> Verdict {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let scene = Library::new(project.scenes()).load(name, &Overrides::new()).unwrap();
    let report = judge_image_pair(&ImageEffort::new(0.03, SAMPLES), &mut |draw| {
        let seed = draw.seed(Seed(2).child(name));
        let mut textbook = render("textbook", &scene, seed.child("textbook"));
        textbook.pixels.iter_mut().flatten().for_each(|value| *value *= gain);
        Ok::<_, std::convert::Infallible>([render("builtin", &scene, seed), textbook])
    });
    report.unwrap().verdict
}

#[test]
fn the_cores_agree_on_scenes_without_a_closed_form() {
    for scene in ["cornell-diffuse-spheres", "veach-plates", "cornell-teapot", "sphereflake"] {
        assert_eq!(agree(scene, 1.0), Verdict::Pass, "{scene}");
    }
}

#[test]
fn three_per_cent_between_them_would_be_seen() {
    assert_eq!(agree("cornell-diffuse-spheres", 1.03), Verdict::Fail);
}
