//! An adaptive picture stops its pixels where the rule stops the core's own samples.
//!
//! Known streams show the rule; they do not show what a picture hands to it: which luminance, which samples, from which
//! one on. So the bench asks for samples one by one, applies the rule, and compares the counts with those of pictures.
//! How noisy samples are is the core's affair, and so the tolerance is one that stops its own between the first look and the last: with a fixed one the
//! pixels of one core all stop at the first look and those of another never, whatever the rule looks at.
//! What the samples are does not matter, as long as one says nothing of the next: a lattice over a pixel stops elsewhere, and
//! rightly. A core that tells the variance of its pixels has no such lattice.

use super::looks_before_the_end;
use super::rule::{Rule, Sums};
use crate::checks::phrase::{figure, percent};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, camera_of, check};
use crate::contract::{Acceleration, AdaptiveSettings, BuiltScene, IntegratorSettings, Ray};
use crate::image::luminance;
use crate::math::rng::{Seed, in_square};
use crate::scene::Camera;
use crate::stats::{Band, Claim, judge_means};
use crate::text::{Bounces, Count, Percent, Size};
use glam::DVec2;

/// Pixels of the estimate that relative errors are relative to.
const SCALE_PIXELS: u64 = 1024;
/// Samples from which the tolerance follows.
const NOISE_SAMPLES: u64 = 4096;
/// The part of the most samples after which pixels are to stop: far from the first look and from the last, so that counts
/// may err to either side.
const STOPPING_AT: f64 = 0.3;
/// The tolerance of samples without noise, which all stop at the first look.
const OF_NO_NOISE: f64 = 0.01;

check! {
    /// Pixels that look alike: the camera sees a small part of a smooth surface.
    pub(crate) struct PictureCounts {
        size: Size,
        bounces: Bounces,
        /// The most samples a pixel may take.
        cap: u32,
        /// Samples between two looks.
        batch: u32,
        /// The smallest error of the mean count that must be seen.
        detects: Percent,
        at_most: Count,
    }
    name: "picture-counts",
    summary: "sample counts of adaptive pictures against the rule on the core's own samples",
    needs: BUILD_SCENE | RENDER | RADIANCE | ADAPTIVE_SAMPLING | INDEPENDENT_SAMPLES | REPORTED_VARIANCE,
}

impl Check for PictureCounts {
    fn validate(&self) -> Result<(), String> {
        looks_before_the_end(self.batch, self.cap)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let pixels = u64::from(self.size.0[0]) * u64::from(self.size.0[1]);
        let effort = context.effort(self.detects, self.at_most).with_runs(32);
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let everywhere: Vec<_> = (0..NOISE_SAMPLES).collect();
        let noise = self.samples(built.as_mut(), &camera, seed.child("noise"), &everywhere, 1)?;
        let settings = self.settings(&Sums::of(&noise));
        let tolerance = settings.max_tolerance;
        let picture =
            Rendering::of(&scene, self.size.0, self.bounces.0, self.cap)?.adaptive(settings);
        let own_count = |built: &mut dyn BuiltScene, seed: Seed, pixels: u64| {
            self.own_count(built, &camera, seed, pixels, tolerance)
        };
        let scale = own_count(built.as_mut(), seed.child("scale"), SCALE_PIXELS)?;
        let of_picture = (pixels as f64 * scale).ceil() as u64;
        let effort = effort.in_steps_of(of_picture);
        let mut taken = (0.0, 0);
        let claim = Claim::difference(scale, Band::RADIANCE);
        let reports = judge_means(&[claim], &effort, &mut |draw| {
            let seed = draw.seed(seed);
            let pictures = draw.samples / of_picture;
            let seen = pictures * pixels;
            let own = own_count(built.as_mut(), seed.child("own"), seen)?;
            let count = mean_count(built.as_mut(), &picture, seed, pictures)?;
            taken = (taken.0 + count * seen as f64, taken.1 + seen);
            Ok::<_, CheckError>(vec![count - own])
        })?;
        let measure = Measure {
            unit: "samples".to_owned(),
            ..Measure::of("count of the picture less that of the rule", &reports[0])
        };
        let statement = statement(&measure, taken.0 / taken.1 as f64);
        Ok(Finding::measured(statement, [measure]))
    }
}

impl PictureCounts {
    /// Those that stop pixels of samples such as these between the first look and the last.
    fn settings(&self, samples: &Sums) -> AdaptiveSettings {
        let count = STOPPING_AT * f64::from(self.cap);
        let tolerance = Rule::tolerance_to_stop_after(count, samples);
        let is_noisy = tolerance.is_finite() && tolerance > 0.0;
        let max_tolerance = if is_noisy { tolerance } else { OF_NO_NOISE };
        AdaptiveSettings { samples_per_batch: self.batch, max_tolerance }
    }

    /// The mean number of samples after which the rule stops the core's own, of so many pixels.
    fn own_count(
        &self,
        scene: &mut dyn BuiltScene,
        camera: &Camera,
        seed: Seed,
        pixels: u64,
        tolerance: f64,
    ) -> Result<f64> {
        let mut going: Vec<_> = (0..pixels).map(|pixel| (pixel, Sums::default())).collect();
        let (mut count, mut sum) = (0, 0);
        while !going.is_empty() {
            let batch = self.batch.min(self.cap - count);
            let pixels: Vec<_> = going.iter().map(|(pixel, _)| *pixel).collect();
            let samples = self.samples(scene, camera, seed.child(count), &pixels, batch)?;
            for ((_, sums), samples) in going.iter_mut().zip(samples.chunks(batch as usize)) {
                samples.iter().for_each(|sample| sums.push(*sample));
            }
            count += batch;
            let before = going.len();
            if count < self.cap {
                going.retain(|(_, sums)| !Rule::RIGHT.stops(sums, tolerance));
            } else {
                going.clear();
            }
            sum += u64::from(count) * (before - going.len()) as u64;
        }
        Ok(sum as f64 / pixels as f64)
    }

    /// Luminances of rays through random points of pixels, `batch` of them for each. Pixels are counted row by row, and from
    /// the first one again after the last: what is noisier in a part of the picture is so in the same part of the pixels.
    fn samples(
        &self,
        scene: &mut dyn BuiltScene,
        camera: &Camera,
        seed: Seed,
        pixels: &[u64],
        batch: u32,
    ) -> Result<Vec<f64>> {
        let mut points = seed.child("film").stream();
        let [width, height] = self.size.0.map(u64::from);
        let mut ray = |pixel: u64| {
            let corner = DVec2::new((pixel % width) as f64, (pixel / width % height) as f64);
            let film = DVec2::new(width as f64, height as f64);
            let point = (corner + in_square(&mut points)) / film;
            Ray::new(camera.position, camera.towards(point))
        };
        let of_pixel = |pixel: &u64| std::iter::repeat_n(*pixel, batch as usize);
        let rays: Vec<_> = pixels.iter().flat_map(of_pixel).map(&mut ray).collect();
        let [first, last] = self.bounces.0;
        let settings =
            IntegratorSettings { bounces: first..=last, seed: seed.0, ..Default::default() };
        let mut radiance = vec![[0.0; 3]; rays.len()];
        scene.radiance(&rays, &settings, &mut radiance)?;
        Ok(radiance.iter().map(|value| luminance(value.map(|channel| channel as f32))).collect())
    }
}

/// The mean sample count of the pixels of so many pictures.
fn mean_count(
    scene: &mut dyn BuiltScene,
    picture: &Rendering,
    seed: Seed,
    pictures: u64,
) -> Result<f64> {
    let (mut sum, mut pixels) = (0, 0);
    for number in 0..pictures {
        let film = picture.film(scene, seed.child(number).0, 0)?;
        sum += film.sample_counts.iter().map(|count| u64::from(*count)).sum::<u64>();
        pixels += film.sample_counts.len();
    }
    Ok(sum as f64 / pixels as f64)
}

fn statement(difference: &Measure, count: f64) -> String {
    let (is, should) = (figure(count), figure(count - difference.measured));
    if difference.failed() {
        let off = percent(difference.measured / (count - difference.measured));
        return format!(
            "pixels take {is} samples on average where the rule stops the same samples after {should}, off by {off}"
        );
    }
    format!(
        "pixels take {is} samples on average, and the rule stops the same samples after {should}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::camera::fake::FakeFilm;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::contract::{Film, RenderSettings};
    use crate::math::rng::{Stream, uniform};

    const EXPECT: &str = "[expect]\nsize = [4, 3]\nbounces = [0, 1]\ncap = 90\nbatch = 8\n\
                          detects = \"5 %\"\nat-most = \"2 M\"\n";

    /// What a picture does with the sums of a pixel before it looks at the next one.
    type Ends = fn(&mut Sums);

    fn take(sample: fn(&mut Stream) -> f64, ends: Ends, settings: &RenderSettings, to: &mut Film) {
        let adaptive = settings.adaptive.unwrap();
        let mut stream = Seed(settings.integrator.seed).stream();
        let mut sums = Sums::default();
        to.pixels.fill([0.5; 3]);
        for count in &mut to.sample_counts {
            *count = 0;
            while *count < settings.samples_per_pixel {
                sums.push(sample(&mut stream));
                *count += 1;
                let looks = count.is_multiple_of(adaptive.samples_per_batch);
                if looks && Rule::RIGHT.stops(&sums, adaptive.max_tolerance) {
                    break;
                }
            }
            ends(&mut sums);
        }
    }

    fn found(sample: fn(&mut Stream) -> f64, ends: Ends) -> Finding {
        let mut core = Fake::drawing(|stream, _| uniform(stream));
        core.film = Box::new(move |settings, film| take(sample, ends, settings, film));
        let check = check_of::<PictureCounts>(EXPECT);
        try_judge(&check, &mut core, Some(FakeFilm::scene())).unwrap()
    }

    fn begins_anew(sums: &mut Sums) {
        *sums = Sums::default();
    }

    #[test]
    fn pictures_that_stop_by_the_rule_pass() {
        assert_passes(&found(uniform, begins_anew));
    }

    #[test]
    fn sums_that_are_kept_from_pixel_to_pixel_are_seen() {
        let finding = found(uniform, |_| ());
        assert!(failure(&finding).contains("samples on average where the rule"), "{finding:?}");
    }

    #[test]
    fn a_rule_that_looks_at_other_samples_is_seen() {
        let finding = found(|stream| 0.2 + uniform(stream), begins_anew);
        assert!(failure(&finding).contains(", off by -"), "{finding:?}");
    }
}
