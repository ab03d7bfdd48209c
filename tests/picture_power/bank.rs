//! Renders to draw from, and a core that answers with them.

use super::mistake::Mistake;
use super::{LAST, SAMPLES, SCENE};
use furnace::contract::{
    Acceleration, BuildStats, BuiltScene, Capabilities, Core, CoreInfo, Film, IntegratorSettings,
    RenderSettings, Result,
};
use furnace::cores::CoreSpec;
use furnace::image::Image;
use furnace::math::rng::{Seed, uniform};
use furnace::project::Project;
use furnace::scene::{Camera, Library, Overrides, SceneDescription};
use std::sync::Arc;

/// Kinds of pictures, after those of each bounce alone.
const SINGLE: usize = LAST as usize + 1;
const WHOLE: usize = LAST as usize + 2;

/// Renders with the built-in core.
pub struct Studio {
    pub core: Box<dyn Core>,
    pub scene: Arc<SceneDescription>,
    pub camera: Camera,
}

impl Studio {
    pub fn new(project: &Project) -> Self {
        let scene = Library::new(project.scenes()).load(SCENE, &Overrides::new()).unwrap();
        let core = "builtin".parse::<CoreSpec>().unwrap().make().unwrap();
        Self { core, camera: scene.camera.unwrap(), scene }
    }

    /// `count` pictures of these bounces, with seeds of their own.
    pub fn shoot(
        &mut self,
        label: &str,
        count: usize,
        samples: u32,
        bounces: [u32; 2],
    ) -> Vec<Image> {
        let camera = self.camera;
        self.shoot_with(&camera, label, count, samples, bounces)
    }

    fn shoot_with(
        &mut self,
        camera: &Camera,
        label: &str,
        count: usize,
        samples: u32,
        bounces: [u32; 2],
    ) -> Vec<Image> {
        let mut built = self.core.build_scene(&self.scene, Acceleration::DEFAULT).unwrap();
        let [width, height] = camera.film;
        let seed = Seed::SUITE.child("picture-power").child(label);
        let shot = |run: usize| {
            let settings = RenderSettings {
                width,
                height,
                samples_per_pixel: samples,
                integrator: IntegratorSettings {
                    bounces: bounces[0]..=bounces[1],
                    seed: seed.child(run).0,
                    ..Default::default()
                },
                ..Default::default()
            };
            let mut film = Film::default();
            built.render(camera, &settings, &mut film).unwrap();
            Image { width: width as usize, height: height as usize, pixels: film.pixels }
        };
        (0..count).map(shot).collect()
    }

    /// Half a pixel to the right and down: rendered twice as fine, with the first column and row
    /// of fine pixels left out.
    fn displaced(&mut self, count: usize) -> Vec<Image> {
        let camera = Camera { film: self.camera.film.map(|side| 2 * side), ..self.camera };
        let fine = self.shoot_with(&camera, "displaced", count, SAMPLES / 4, [0, LAST]);
        fine.iter().map(half_off).collect()
    }

    /// Means of samples that are cut off at 10.
    fn clamped(&mut self, count: usize, [width, height]: [usize; 2]) -> Vec<Image> {
        let mean = |run: usize| {
            let mut sum = Image::new(width, height, [0.0; 3]);
            for single in
                self.shoot(&format!("clamped {run}"), SAMPLES as usize, 1, [0, LAST]).iter_mut()
            {
                clamp(single);
                for (sum, pixel) in sum.pixels.iter_mut().zip(&single.pixels) {
                    *sum = std::array::from_fn(|c| sum[c] + pixel[c] / SAMPLES as f32);
                }
            }
            sum
        };
        (0..count).map(mean).collect()
    }
}

pub fn clamp(single: &mut Image) {
    single.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(|value| value.min(10.0)));
}

pub fn half_off(fine: &Image) -> Image {
    Image::from_fn(fine.width / 2, fine.height / 2, |x, y| {
        let of = |dx: usize, dy: usize| {
            let (x, y) = ((2 * x + dx).min(fine.width - 1), (2 * y + dy).min(fine.height - 1));
            fine.pixels[y * fine.width + x]
        };
        let four = [of(1, 1), of(2, 1), of(1, 2), of(2, 2)];
        std::array::from_fn(|c| four.iter().map(|pixel| pixel[c]).sum::<f32>() / 4.0)
    })
}

/// What a core with the mistake renders.
pub struct Bank {
    pub runs: Vec<Image>,
    /// One sample a pixel.
    pub singles: Vec<Image>,
    /// Each bounce alone.
    pub alone: Vec<Vec<Image>>,
}

impl Bank {
    pub fn of(
        mistake: Mistake,
        studio: &mut Studio,
        right: &[Image],
        alone: &[Vec<Image>],
    ) -> Self {
        let count = right.len();
        let mut runs = match mistake {
            Mistake::HalfPixel => studio.displaced(count),
            Mistake::MissingBounce => studio.shoot("short", count, SAMPLES, [0, LAST - 1]),
            Mistake::Clamped => studio.clamped(count, [right[0].width, right[0].height]),
            _ => right.to_vec(),
        };
        runs.iter_mut().for_each(|run| mistake.spoil(run));
        let mut singles = studio.shoot("singles", 16, 1, [0, LAST]);
        for single in &mut singles {
            mistake.spoil(single);
            if mistake == Mistake::Clamped {
                clamp(single);
            }
        }
        Self { runs, singles, alone: alone.to_vec() }
    }

    /// The runs in an order of its own.
    pub fn order(&self, time: u64) -> Vec<usize> {
        let mut stream = Seed::SUITE.child("picture-power order").child(time).stream();
        let mut order: Vec<usize> = (0..self.runs.len()).collect();
        for last in (1..order.len()).rev() {
            let other = (uniform(&mut stream) * (last + 1) as f64) as usize;
            order.swap(last, other);
        }
        order
    }
}

/// A core that answers from a bank, whatever the seed.
pub struct Teller<'a> {
    pub bank: &'a Bank,
    pub info: CoreInfo,
    pub order: Vec<usize>,
}

pub struct Told<'a> {
    bank: &'a Bank,
    order: Vec<usize>,
    asked: [usize; LAST as usize + 3],
}

impl Core for Teller<'_> {
    /// Of its pictures nothing more is known than what they show.
    fn info(&self) -> CoreInfo {
        let mut info = self.info.clone();
        info.capabilities -= Capabilities::REPORTED_VARIANCE;
        info
    }

    fn build_scene(
        &mut self,
        _: &SceneDescription,
        _: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(Told {
            bank: self.bank,
            order: self.order.clone(),
            asked: [0; LAST as usize + 3],
        }))
    }
}

impl BuiltScene for Told<'_> {
    fn stats(&self) -> BuildStats {
        BuildStats::default()
    }

    fn render(&mut self, _: &Camera, settings: &RenderSettings, film: &mut Film) -> Result<()> {
        let (first, last) =
            (*settings.integrator.bounces.start(), *settings.integrator.bounces.end());
        let (kind, pictures) = match (settings.samples_per_pixel, first == last) {
            (1, _) => (SINGLE, &self.bank.singles),
            (_, true) => (last as usize, &self.bank.alone[last as usize]),
            _ => (WHOLE, &self.bank.runs),
        };
        let asked = self.asked[kind];
        self.asked[kind] += 1;
        let image = if kind == WHOLE { &pictures[self.order[asked]] } else { &pictures[asked] };
        film.width = settings.width;
        film.height = settings.height;
        film.pixels.clone_from(&image.pixels);
        film.sample_counts = vec![settings.samples_per_pixel; image.pixels.len()];
        Ok(())
    }
}
