//! Part 1 and 5: a picture, sample by sample.
//!
//! Every sample of every pixel has its own random numbers, so pictures do not depend on how pixels
//! are shared out among threads.

use super::adaptive::{self, Tally};
use super::camera::{generate_ray, half_pixel};
use super::change::Change;
use super::integrator::Integrator;
use super::random::{self, Random};
use super::spread::Spread;
use super::world::World;
use crate::contract::{AdaptiveSettings, CoreError, Film, RenderSettings, Result};
use crate::scene::Camera;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Renders `world` into `film`.
pub fn render(
    world: &World,
    camera: &Camera,
    settings: &RenderSettings,
    film: &mut Film,
) -> Result<()> {
    if settings.samples_per_pixel == 0 {
        return Err(CoreError::Refused("samples_per_pixel is 0: nothing to average".to_owned()));
    }
    let integrator = Integrator::new(world, &settings.integrator);
    let change = world.change();
    let picture = Picture { integrator, camera, settings, change };
    let mut pixels = vec![Pixel::default(); film.pixels.len()];
    fill(settings.integrator.threads, &mut pixels, |index| picture.pixel(index))?;
    film.pixels = pixels.iter().map(|pixel| pixel.mean.as_vec3().to_array()).collect();
    film.sample_counts = pixels.iter().map(|pixel| pixel.samples).collect();
    film.variances = pixels.iter().map(|pixel| pixel.variance.as_vec3().to_array()).collect();
    Ok(())
}

/// Fills `out[index]` with `value(index)`, on as many threads as are allowed; 0 means all.
pub fn fill<T: Send>(threads: u32, out: &mut [T], value: impl Fn(usize) -> T + Sync) -> Result<()> {
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

/// What [`Change::AdaptiveAlways`] does where it is not asked for.
const ADAPTIVE_DEFAULT: AdaptiveSettings =
    AdaptiveSettings { samples_per_batch: 32, max_tolerance: 0.05 };

/// Steps that fill the unit square evenly (Roberts 2018, the R2 sequence).
const EVEN_STEPS: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_2);

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
    change: Change,
}

impl Picture<'_> {
    /// Pixel number `index`.
    fn pixel(&self, index: usize) -> Pixel {
        let (mut total, mut spread) = (DVec3::ZERO, Spread::default());
        let tally = self.spend_samples(|sample| {
            let radiance = self.sample(index, sample);
            total += radiance;
            spread.add(radiance, self.change);
            luminance(radiance)
        });
        let cap = self.settings.samples_per_pixel;
        let mean = match self.change {
            Change::SamplesNotDivided => total,
            _ => total / adaptive::divisor(tally.count(), cap, self.change),
        };
        let batch = self.settings.adaptive.map(|adaptive| adaptive.samples_per_batch);
        let samples = adaptive::reported(tally.count(), cap, batch, self.change);
        Pixel { mean, variance: spread.variance_of_mean(self.change), samples }
    }

    fn spend_samples(&self, next: impl FnMut(u32) -> f64) -> Tally {
        let cap = self.settings.samples_per_pixel;
        let adaptive = match self.change {
            Change::AdaptiveAlways => Some(self.settings.adaptive.unwrap_or(ADAPTIVE_DEFAULT)),
            _ => self.settings.adaptive,
        };
        match adaptive {
            Some(adaptive) => adaptive::sample_until_converged(adaptive, cap, self.change, next),
            None => adaptive::sample_all(cap, next),
        }
    }

    /// Radiance along one ray through a uniform point of the pixel.
    fn sample(&self, index: usize, sample: u32) -> DVec3 {
        let seed = random::seed(self.settings.integrator.seed, self.change);
        let mut random = match self.change {
            Change::SamePixelNoise => Random::for_sample(seed, 0, sample),
            Change::SampleRepeated => Random::for_sample(seed, index, 0),
            _ => Random::for_sample(seed, index, sample),
        }
        .changed(self.change);
        let film = self.film_point(index, self.within_pixel(seed, index, sample, &mut random));
        self.integrator.radiance(&generate_ray(self.camera, film, self.change), &mut random)
    }

    /// A uniform point of the unit square.
    fn within_pixel(&self, seed: u64, index: usize, sample: u32, random: &mut Random) -> DVec2 {
        let point = random.point();
        let grid = f64::from(self.settings.samples_per_pixel).sqrt();
        if self.settings.stratified && grid.fract() == 0.0 {
            return stratum(sample, grid as u32, point, self.change);
        }
        match self.change {
            Change::PixelCorner => DVec2::ZERO,
            Change::HalfPixelAdded => point + 0.5,
            Change::StratifiedPixels => {
                let start = Random::for_sample(seed, index, u32::MAX).point();
                (start + f64::from(sample) * EVEN_STEPS).fract()
            }
            _ => point,
        }
    }

    /// Where on the film a point of the pixel lies. Rows run down the picture, the film runs up.
    fn film_point(&self, index: usize, within: DVec2) -> DVec2 {
        let width = self.settings.width as usize;
        let corner = DVec2::new((index % width) as f64, (index / width) as f64);
        let size = DVec2::new(f64::from(self.settings.width), f64::from(self.settings.height));
        let from_top = (corner + within) / size;
        let film = DVec2::new(from_top.x, 1.0 - from_top.y);
        match self.change {
            Change::PictureUpsideDown => from_top,
            Change::HalfPixelBothWays => film - half_pixel(self.camera.film),
            _ => film,
        }
    }
}

/// A point of cell number `sample` of a grid of `side` by `side` over the unit square.
fn stratum(sample: u32, side: u32, jitter: DVec2, change: Change) -> DVec2 {
    let (column, row) = match change {
        Change::StrataOnDiagonal => (sample % side, sample % side),
        _ => (sample % side, sample / side),
    };
    let within = match change {
        Change::StratumCentre => DVec2::splat(0.5),
        Change::StratumHalf => 0.5 * jitter,
        Change::StrataIgnored => return jitter,
        _ => jitter,
    };
    (DVec2::new(f64::from(column), f64::from(row)) + within) / f64::from(side)
}

/// Of linear sRGB (Rec. 709).
fn luminance(radiance: DVec3) -> f64 {
    radiance.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{AdaptiveSettings, Capabilities, IntegratorSettings};
    use crate::cores::textbook::testing::{Stage, diffuse};

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

    fn film(world: &World, settings: &RenderSettings) -> Film {
        let mut film = Film::blank(WIDTH, HEIGHT, Capabilities::all());
        render(world, &camera(), settings, &mut film).expect("it renders");
        film
    }

    /// A frontal rectangle at distance 4 that glows with radiance 1.
    fn glowing_rectangle(x: [f64; 2], y: [f64; 2]) -> Stage {
        let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
        let corners = corners.map(|(x, y)| DVec3::new(x, y, -4.0));
        Stage::empty().polygon(&corners, diffuse(0.3).glowing(1.0))
    }

    fn mean(film: &Film) -> f64 {
        film.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / film.pixels.len() as f64
    }

    #[test]
    fn s18_a_rectangle_covers_its_share_of_the_picture() {
        let world = glowing_rectangle([-0.9, 0.5], [-0.3, 0.8]).world();
        let share: f64 = 0.158_087_53;
        // Only pixels that an edge crosses are noisy: about one in eight, so that the binomial
        // error of all samples is some three standard errors.
        let error = (share * (1.0 - share) / (280.0 * 256.0)).sqrt();
        let mean = mean(&film(&world, &settings(256)));
        assert!((mean - share).abs() < 1.5 * error, "{mean} {share} ± {error}");
    }

    #[test]
    fn up_is_up_and_right_is_right() {
        let top_right = glowing_rectangle([0.5, 3.0], [0.5, 3.0]).world();
        let film = film(&top_right, &settings(4));
        let is_bright = |x: usize, y: usize| film.pixels[y * WIDTH as usize + x][0] == 1.0;
        assert!(is_bright(19, 0));
        assert!(!is_bright(0, 0) && !is_bright(19, 13) && !is_bright(0, 13));
    }

    /// A lit scene with noise in every pixel.
    fn noisy() -> World {
        glowing_rectangle([-0.5, 0.5], [-0.3, 0.8])
            .room(6.0, diffuse(0.5))
            .ball(DVec3::new(0.3, -0.4, -3.0), 0.4, diffuse(0.7))
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
        let world = Stage::empty().room(1.0, diffuse(0.37).glowing(0.7)).world();
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
