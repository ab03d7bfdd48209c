//! A core that can only make pictures, and makes them of a function of the film: for the tests of this folder.

use super::film_mistakes::Place;
use crate::checks::fake::Fake;
use crate::checks::rendering::places;
use crate::checks::testing::try_judge;
use crate::checks::{Check, Finding};
use crate::contract::{Film, RenderSettings};
use crate::math::rng::{Seed, Stream, in_square};
use crate::scene::{Camera, SceneDescription};
use glam::{DVec2, DVec3};

/// What a ray through a point brings home: in pixels, from the top left; the second is the film's size.
pub(crate) type Radiance = fn(DVec2, DVec2) -> [f64; 3];
/// At which index the pixel of column and row is stored, in a film of this size.
pub(crate) type Index = fn([u32; 2], [u32; 2]) -> usize;

/// What is added to the count of samples.
#[derive(Clone, Copy)]
pub(crate) struct Step(pub i32);

/// A renderer of a picture that is a function of the film point; each step can be replaced by a wrong one.
pub(crate) struct FakeFilm {
    pub(crate) radiance: Box<dyn Fn(DVec2, DVec2) -> [f64; 3] + Send>,
    /// Where a sample with these random numbers lies, from the corner of its pixel.
    pub(crate) place: fn(DVec2) -> DVec2,
    /// The random numbers of a sample, by its number in its pixel.
    pub(crate) arrange: fn(u32, DVec2) -> DVec2,
    /// What becomes of the mean of a pixel.
    pub(crate) develop: fn([f64; 3], Place) -> [f64; 3],
    /// How many samples are taken where so many are asked for.
    pub(crate) samples_used: fn(u32) -> u32,
    pub(crate) index: Index,
    pub(crate) count: Step,
}

impl Default for FakeFilm {
    fn default() -> Self {
        Self {
            radiance: Box::new(|_, _| [0.0; 3]),
            place: |numbers| numbers,
            arrange: |_, numbers| numbers,
            develop: |mean, _| mean,
            samples_used: |asked| asked,
            index: |[x, y], [width, _]| (y * width + x) as usize,
            count: Step(0),
        }
    }
}

impl FakeFilm {
    /// A scene with some camera: the fake looks at nothing but the film.
    pub(crate) fn scene() -> SceneDescription {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.0, [16, 12]);
        SceneDescription { camera: Some(camera), ..SceneDescription::default() }
    }

    /// What a check says of it.
    pub(crate) fn judged_by<C: Check>(self, check: &C) -> Finding {
        try_judge(check, &mut self.core(), Some(Self::scene())).unwrap()
    }

    fn mean(&self, place: Place, stream: &mut Stream) -> [f64; 3] {
        let corner = DVec2::from(place.at.map(f64::from));
        let size = DVec2::from(place.size.map(f64::from));
        let (mut sum, used) = ([0.0; 3], (self.samples_used)(place.samples));
        for number in 0..used {
            let numbers = (self.arrange)(number, in_square(stream));
            let sample = (self.radiance)(corner + (self.place)(numbers), size);
            sum = std::array::from_fn(|c| sum[c] + sample[c]);
        }
        sum.map(|sum| sum / f64::from(used))
    }

    fn render(&self, settings: &RenderSettings, film: &mut Film) {
        let size = [settings.width, settings.height];
        let samples = settings.samples_per_pixel;
        let stream = &mut Seed(settings.integrator.seed).stream();
        for at in places(size) {
            let place = Place { at, size, samples };
            let pixel = (self.develop)(self.mean(place, stream), place);
            let index = (self.index)(at, size) % film.pixels.len();
            film.pixels[index] = pixel.map(|value| value as f32);
        }
        let Step(step) = self.count;
        film.sample_counts.fill(samples.saturating_add_signed(step));
    }

    /// The core.
    pub(crate) fn core(self) -> Fake {
        Fake {
            film: Box::new(move |settings, film| self.render(settings, film)),
            ..Fake::default()
        }
    }
}
