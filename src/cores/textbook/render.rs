//! Part 1 and 5: a picture, sample by sample.
//!
//! Every sample of every pixel has its own random numbers, so pictures do not depend on how pixels
//! are shared out among threads.

use super::adaptive::{self, Tally};
use super::camera::generate_ray;
use super::integrator::Integrator;
use super::random::Random;
use super::spread::Spread;
use super::steps::Steps;
use super::world::World;
use crate::contract::{AdaptiveSettings, CoreError, Film, RenderSettings, Result};
use crate::scene::Camera;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub(crate) fn render(
    world: &World<'_>,
    camera: &Camera,
    settings: &RenderSettings,
    film: &mut Film,
) -> Result<()> {
    if settings.samples_per_pixel == 0 {
        return Err(CoreError::Refused("samples_per_pixel is 0: nothing to average".to_owned()));
    }
    let integrator = Integrator::new(world, &settings.integrator);
    let picture = Picture { integrator, camera, settings, steps: world.steps() };
    let mut pixels = vec![Pixel::default(); film.pixels.len()];
    fill(settings.integrator.threads, &mut pixels, |index| picture.pixel(index))?;
    film.pixels = pixels.iter().map(|pixel| pixel.mean.as_vec3().to_array()).collect();
    film.sample_counts = pixels.iter().map(|pixel| pixel.samples).collect();
    film.variances = pixels.iter().map(|pixel| pixel.variance.as_vec3().to_array()).collect();
    Ok(())
}

/// Fills `out[index]` with `value(index)`, on as many threads as are allowed; 0 means all.
pub(crate) fn fill<T: Send>(
    threads: u32,
    out: &mut [T],
    value: impl Fn(usize) -> T + Sync,
) -> Result<()> {
    let one = |(index, slot): (usize, &mut T)| *slot = value(index);
    match threads {
        0 => out.par_iter_mut().enumerate().for_each(one),
        1 => out.iter_mut().enumerate().for_each(one),
        threads => rayon::ThreadPoolBuilder::new()
            .num_threads(threads as usize)
            .build()
            .map_err(|error| CoreError::Refused(format!("no {threads} threads: {error}")))?
            .install(|| out.par_iter_mut().enumerate().for_each(one)),
    }
    Ok(())
}

/// What is written of a pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    mean: DVec3,
    /// Of `mean`.
    variance: DVec3,
    samples: u32,
}

struct Picture<'a> {
    integrator: Integrator<'a>,
    camera: &'a Camera,
    settings: &'a RenderSettings,
    steps: &'a Steps,
}

impl Picture<'_> {
    fn pixel(&self, index: usize) -> Pixel {
        let (mut total, mut spread) = (DVec3::ZERO, Spread::default());
        let tally = self.spend_samples(|sample| {
            let radiance = self.sample(index, sample);
            total += radiance;
            self.steps.add(&mut spread, radiance);
            luminance(radiance)
        });
        let cap = self.settings.samples_per_pixel;
        let batch = self.settings.adaptive.map(|adaptive| adaptive.samples_per_batch);
        Pixel {
            mean: self.steps.pixel_mean(total, self.steps.divisor(tally.count, cap)),
            variance: spread.variance_of_mean(self.steps),
            samples: self.steps.reported_count(tally.count, cap, batch),
        }
    }

    fn spend_samples(&self, next: impl FnMut(u32) -> f64) -> Tally {
        let cap = self.settings.samples_per_pixel;
        match self.steps.adaptive_settings(self.settings) {
            Some(adaptive) => adaptive::sample_until_converged(adaptive, cap, self.steps, next),
            None => adaptive::sample_all(cap, self.steps, next),
        }
    }

    /// Radiance along one ray through a uniform point of the pixel.
    fn sample(&self, index: usize, sample: u32) -> DVec3 {
        let seed = self.steps.seed(self.settings.integrator.seed);
        let mut random = self.steps.sample_stream(seed, index, sample).drawn_by(self.steps);
        let within = self.within_pixel(&mut random, seed, index, sample);
        let film = self.steps.film_point(self.settings, index, within);
        self.integrator.radiance(&generate_ray(self.camera, film, self.steps), &mut random)
    }

    /// A uniform point of the unit square, or of the sample's own cell of it.
    fn within_pixel(&self, random: &mut Random<'_>, seed: u64, index: usize, sample: u32) -> DVec2 {
        let grid = f64::from(self.settings.samples_per_pixel).sqrt();
        if self.settings.stratified && grid.fract() == 0.0 {
            return self.steps.stratum(sample, grid as u32, random.point());
        }
        self.steps.pixel_point(random, seed, index, sample)
    }
}

pub(crate) fn pixel_mean(total: DVec3, samples: f64) -> DVec3 {
    total / samples
}

/// Samples are adaptive where that is asked for.
pub(crate) fn adaptive_settings(settings: &RenderSettings) -> Option<AdaptiveSettings> {
    settings.adaptive
}

/// Where in the unit square sample number `sample` of a pixel lies.
pub(crate) fn pixel_point(
    random: &mut Random<'_>,
    _seed: u64,
    _pixel: usize,
    _sample: u32,
) -> DVec2 {
    random.point()
}

/// A point of cell number `sample` of a grid of `side` by `side` over the unit square.
pub(crate) fn stratum(sample: u32, side: u32, jitter: DVec2) -> DVec2 {
    let (column, row) = (sample % side, sample / side);
    (DVec2::new(f64::from(column), f64::from(row)) + jitter) / f64::from(side)
}

/// Where on the film a point of a pixel lies. Rows run down the picture, the film runs up.
pub(crate) fn film_point(settings: &RenderSettings, pixel: usize, within: DVec2) -> DVec2 {
    let from_top = from_top(settings, pixel, within);
    DVec2::new(from_top.x, 1.0 - from_top.y)
}

/// Where in the picture a point of a pixel lies: (0, 0) top left, (1, 1) bottom right.
pub(crate) fn from_top(settings: &RenderSettings, pixel: usize, within: DVec2) -> DVec2 {
    let width = settings.width as usize;
    let corner = DVec2::new((pixel % width) as f64, (pixel / width) as f64);
    let size = DVec2::new(f64::from(settings.width), f64::from(settings.height));
    (corner + within) / size
}

/// Of linear sRGB (Rec. 709).
fn luminance(radiance: DVec3) -> f64 {
    radiance.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{AdaptiveSettings, Capabilities, IntegratorSettings};
    use crate::cores::stage::{Stage, diffuse};

    const WIDTH: u32 = 20;
    const HEIGHT: u32 = 14;

    fn settings(samples_per_pixel: u32) -> RenderSettings {
        let integrator = IntegratorSettings { bounces: 0..=2, seed: 4, ..Default::default() };
        let (width, height, adaptive) = (WIDTH, HEIGHT, None);
        RenderSettings { width, height, samples_per_pixel, integrator, adaptive, stratified: false }
    }

    fn camera() -> Camera {
        let fov = 50.0_f64.to_radians();
        Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, fov, [WIDTH, HEIGHT])
    }

    fn film(world: &World<'_>, settings: &RenderSettings) -> Film {
        let mut film = Film::blank(WIDTH, HEIGHT, Capabilities::all());
        render(world, &camera(), settings, &mut film).expect("it renders");
        film
    }

    /// A frontal rectangle at distance 4 that emits with radiance 1.
    fn emissive_rectangle(x: [f64; 2], y: [f64; 2]) -> Stage {
        let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
        let corners = corners.map(|(x, y)| DVec3::new(x, y, -4.0));
        Stage::empty().polygon(&corners, diffuse(0.3).emitting(1.0))
    }

    fn mean(film: &Film) -> f64 {
        film.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / film.pixels.len() as f64
    }

    /// A lit scene with noise in every pixel.
    fn noisy() -> World<'static> {
        emissive_rectangle([-0.5, 0.5], [-0.3, 0.8])
            .room(6.0, diffuse(0.5))
            .sphere(DVec3::new(0.3, -0.4, -3.0), 0.4, diffuse(0.7))
            .world()
    }

    #[test]
    fn pictures_do_not_depend_on_threads_but_on_the_seed() {
        let world = noisy();
        let adaptive = Some(AdaptiveSettings { samples_per_batch: 8, max_tolerance: 0.2 });
        let picture = |threads, seed| {
            let mut settings = RenderSettings { adaptive, ..settings(64) };
            settings.integrator.threads = threads;
            settings.integrator.seed = seed;
            film(&world, &settings)
        };
        let alone = picture(1, 4);
        assert_eq!(alone, picture(0, 4));
        assert_eq!(alone, picture(3, 4));
        assert_ne!(alone, picture(1, 5));
    }

    #[test]
    fn counts_say_what_was_spent() {
        let fixed = film(&noisy(), &settings(5));
        assert!(fixed.sample_counts.iter().all(|count| *count == 5));
        let adaptive = Some(AdaptiveSettings { samples_per_batch: 8, max_tolerance: 0.1 });
        let counts = film(&noisy(), &RenderSettings { adaptive, ..settings(100) }).sample_counts;
        assert!(counts.iter().all(|count| *count == 100 || count.is_multiple_of(8)));
        assert!(counts.contains(&100) && counts.iter().any(|count| *count < 100), "{counts:?}");
    }

    #[test]
    fn an_early_stop_divides_by_the_samples_that_were_taken() {
        let adaptive = Some(AdaptiveSettings { samples_per_batch: 8, max_tolerance: 0.05 });
        let world = Stage::empty().room(1.0, diffuse(0.37).emitting(0.7)).world();
        let film = film(&world, &RenderSettings { adaptive, ..settings(100) });
        assert!(film.sample_counts.iter().all(|count| *count == 8));
        let expected = 0.7 * (1.0 + 0.37 + 0.37 * 0.37);
        assert!((mean(&film) - expected).abs() < 1e-6, "{}", mean(&film));
    }

    #[test]
    fn no_samples_are_refused() {
        let (world, mut film) = (noisy(), Film::default());
        let refused = render(&world, &camera(), &settings(0), &mut film);
        assert!(matches!(refused, Err(CoreError::Refused(_))), "{refused:?}");
    }
}
