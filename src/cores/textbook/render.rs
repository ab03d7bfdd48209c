//! Part 1 and 5: a picture, sample by sample.
//!
//! Every sample of every pixel has its own random numbers, so pictures do not depend on how pixels are shared out
//! among threads.

use super::adaptive::{self, Tally};
use super::camera::generate_ray;
use super::integrator::Integrator;
use super::random::Random;
use super::world::World;
use crate::contract::{CoreError, Film, RenderSettings, Result};
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
    let picture = Picture { integrator, camera, settings };
    let mut pixels = vec![(DVec3::ZERO, 0); film.pixels.len()];
    fill(settings.integrator.threads, &mut pixels, |index| picture.pixel(index))?;
    for (index, (radiance, samples)) in pixels.into_iter().enumerate() {
        film.pixels[index] = radiance.as_vec3().to_array();
        film.sample_counts[index] = samples;
    }
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

struct Picture<'a> {
    integrator: Integrator<'a>,
    camera: &'a Camera,
    settings: &'a RenderSettings,
}

impl Picture<'_> {
    /// Mean radiance of pixel number `index`, and the samples it took.
    fn pixel(&self, index: usize) -> (DVec3, u32) {
        let mut total = DVec3::ZERO;
        let tally = self.spend_samples(|sample| {
            let radiance = self.sample(index, sample);
            total += radiance;
            luminance(radiance)
        });
        (total / f64::from(tally.count()), tally.count())
    }

    fn spend_samples(&self, next: impl FnMut(u32) -> f64) -> Tally {
        let cap = self.settings.samples_per_pixel;
        match self.settings.adaptive {
            Some(adaptive) => adaptive::sample_until_converged(adaptive, cap, next),
            None => adaptive::sample_all(cap, next),
        }
    }

    /// Radiance along one ray through a uniform point of the pixel.
    fn sample(&self, index: usize, sample: u32) -> DVec3 {
        let mut random = Random::for_sample(self.settings.integrator.seed, index, sample);
        let film = self.film_point(index, random.point());
        self.integrator.radiance(&generate_ray(self.camera, film), &mut random)
    }

    /// Where on the film a point of the pixel lies. Rows run down the picture, the film runs up.
    fn film_point(&self, index: usize, within: DVec2) -> DVec2 {
        let width = self.settings.width as usize;
        let corner = DVec2::new((index % width) as f64, (index / width) as f64);
        let size = DVec2::new(f64::from(self.settings.width), f64::from(self.settings.height));
        let from_top = (corner + within) / size;
        DVec2::new(from_top.x, 1.0 - from_top.y)
    }
}

/// Of linear sRGB (Rec. 709).
fn luminance(radiance: DVec3) -> f64 {
    radiance.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}
