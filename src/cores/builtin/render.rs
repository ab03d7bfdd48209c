//! Images and lists of estimates, on as many threads as allowed. Every pixel and every ray has its own random
//! numbers and its own sum, so the answer does not depend on the threads.

use super::adaptive::{Running, luminance};
use super::camera::Pinhole;
use super::integrator::Integrator;
use super::random::Stream;
use super::world::World;
use crate::contract::{CoreError, Film, IntegratorSettings, Ray, RenderSettings, Result};
use crate::scene::Camera;
use glam::DVec2;
use rayon::prelude::*;

/// Rays or pixels that one thread takes at a time.
const PORTION: usize = 64;

pub(crate) fn radiance(
    world: &World,
    rays: &[Ray],
    settings: &IntegratorSettings,
    radiance: &mut [[f64; 3]],
) -> Result<()> {
    let estimate = |integrator: &mut Integrator<'_>, index: usize, answer: &mut [f64; 3]| {
        let stream = Stream::new(settings.seed, index as u64, 0);
        *answer = integrator.radiance(&rays[index], stream).as_dvec3().to_array();
    };
    let count = rays.len().min(radiance.len());
    for_each(world, settings, &mut radiance[..count], estimate)
}

pub(crate) fn render(
    world: &World,
    camera: &Camera,
    settings: &RenderSettings,
    film: &mut Film,
) -> Result<()> {
    let pinhole = Pinhole::new(camera);
    let mut pixels = vec![Pixel::default(); (settings.width * settings.height) as usize];
    let develop = |integrator: &mut Integrator<'_>, index: usize, pixel: &mut Pixel| {
        *pixel = develop_pixel(integrator, &pinhole, settings, index as u32);
    };
    for_each(world, &settings.integrator, &mut pixels, develop)?;
    (film.width, film.height) = (settings.width, settings.height);
    film.pixels = pixels.iter().map(|pixel| pixel.mean).collect();
    film.sample_counts = pixels.iter().map(|pixel| pixel.samples).collect();
    film.variances = pixels.iter().map(|pixel| pixel.variance).collect();
    Ok(())
}

#[derive(Clone, Copy, Default)]
struct Pixel {
    mean: [f32; 3],
    /// Of `mean`, as its samples tell it.
    variance: [f32; 3],
    samples: u32,
}

fn develop_pixel(
    integrator: &mut Integrator<'_>,
    pinhole: &Pinhole,
    settings: &RenderSettings,
    index: u32,
) -> Pixel {
    let size = [settings.width, settings.height];
    let place = [index % settings.width, index / settings.width];
    let (mut sum, mut luminances, mut used) = ([0.0; 3], Running::default(), 0);
    let mut channels = [Running::default(); 3];
    while used < settings.samples_per_pixel {
        let mut stream =
            Stream::new(settings.integrator.seed, u64::from(index), 1 + u64::from(used));
        let within = match settings.stratified {
            true => in_stratum(used, settings.samples_per_pixel, stream.point()),
            false => stream.point(),
        };
        let ray = pinhole.ray_through_pixel(place, size, within);
        let sample = integrator.radiance(&ray, stream).as_dvec3().to_array();
        // Sums in double precision: the mean of equal samples is that sample, whatever their number.
        sum = std::array::from_fn(|channel| sum[channel] + sample[channel]);
        channels.iter_mut().zip(sample).for_each(|(channel, value)| channel.add(value));
        used += 1;
        luminances.add(luminance(sample));
        if settings.adaptive.is_some_and(|adaptive| luminances.suffice(adaptive)) {
            break;
        }
    }
    let mean = sum.map(|channel| (channel / f64::from(used.max(1))) as f32);
    let variance = channels.map(|channel| channel.variance_of_mean() as f32);
    Pixel { mean, variance, samples: used }
}

/// A point of one cell of the square grid of `count` cells over the unit square, the cells row by row; of the whole
/// square if `count` is no square.
fn in_stratum(number: u32, count: u32, jitter: DVec2) -> DVec2 {
    let side = count.isqrt();
    if side * side != count {
        return jitter;
    }
    (DVec2::new(f64::from(number % side), f64::from(number / side)) + jitter) / f64::from(side)
}

/// Does `work` for each element, with its index, on the threads that `settings` allow.
fn for_each<T: Send>(
    world: &World,
    settings: &IntegratorSettings,
    elements: &mut [T],
    work: impl Fn(&mut Integrator<'_>, usize, &mut T) + Sync,
) -> Result<()> {
    let portion = |integrator: &mut Integrator<'_>, number: usize, elements: &mut [T]| {
        for (offset, element) in elements.iter_mut().enumerate() {
            work(integrator, number * PORTION + offset, element);
        }
    };
    let new_integrator = || Integrator::new(world, settings);
    let in_parallel = |elements: &mut [T]| {
        let portions = elements.par_chunks_mut(PORTION).enumerate();
        portions.for_each_init(new_integrator, |integrator, (number, elements)| {
            portion(integrator, number, elements);
        });
    };
    match settings.threads {
        0 => in_parallel(elements),
        1 => {
            let mut integrator = new_integrator();
            for (number, elements) in elements.chunks_mut(PORTION).enumerate() {
                portion(&mut integrator, number, elements);
            }
        }
        threads => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
            let pool = pool.map_err(|error| CoreError::Refused(format!("no threads: {error}")))?;
            pool.install(|| in_parallel(elements));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_gets_one_sample_and_stays_below_one() {
        // The largest number that a stream draws.
        let almost_one = DVec2::splat(1.0 - 0.5_f64.powi(32));
        let cell = |point: DVec2| (point * 3.0).floor().to_array().map(|c| c as u32);
        let mut cells: Vec<_> =
            (0..9).map(|number| cell(in_stratum(number, 9, almost_one))).collect();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), 9);
        assert!((0..9).all(|number| in_stratum(number, 9, almost_one).max_element() < 1.0));
        assert_eq!(in_stratum(3, 8, DVec2::splat(0.25)), DVec2::splat(0.25));
    }
}
