//! The variance that a core reports of its pixels is the one that its pictures have.
//!
//! Pictures that differ in their seed alone are made in groups: the variance between the pictures of
//! a group, pixel by pixel, is what the reported one should be. No theory of the estimator is
//! needed, so that any core that reports variances can be asked.

use super::real_variance::finding;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Result, check};
use crate::contract::{Acceleration, AdaptiveSettings, BuiltScene, Capabilities};
use crate::math::rng::Seed;
use crate::scene::SceneDescription;
use crate::stats::{Band, Claim, Effort, ReportedVariance, TwoVariances, judge_means};
use crate::text::{Between, Bounces, Count, Factor, Size};

/// Pictures whose pixels are compared with each other.
const PICTURES: u32 = 8;
/// A tolerance that no noise is below.
const UNREACHED: f64 = 1e-9;

check! {
    /// Every picture comes with the variance of its pixels, and it is right within a factor of two.
    pub(crate) struct ReportsItsVariance {
        size: Size,
        bounces: Bounces,
        /// Fewer than 4 hardly know their variance.
        samples_per_pixel: Between<4, 65536>,
        /// The pictures are adaptive, in batches of so many samples, and no pixel may stop before the last one.
        batch: Option<u32>,
        /// The smallest factor, either way, that must be seen.
        detects: Factor,
        at_most: Count,
    }
    name: "reported-variance",
    summary: "the variance that comes with a picture against that between pictures",
    needs: BUILD_SCENE | RENDER | REPORTED_VARIANCE,
}

impl Check for ReportsItsVariance {
    fn validate(&self) -> Result<(), String> {
        if self.detects.0.log2() > Band::FACTOR_OF_TWO.relative() {
            return Ok(());
        }
        Err("`detects` must be above the factor of two that is forgiven".to_owned())
    }

    fn needs_besides(&self) -> Capabilities {
        match self.batch {
            Some(_) => Capabilities::ADAPTIVE_SAMPLING,
            None => Capabilities::empty(),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let picture = self.picture(&scene)?;
        let (seed, effort) = (context.seed, self.effort(context));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut groups = Vec::new();
        let claims = [Claim::reported_variance(); 3];
        let reports = judge_means(&claims, &effort, &mut |draw| {
            let count = draw.samples / self.samples_of_a_group();
            let found = take_groups(built.as_mut(), &picture, draw.seed(seed), count)?;
            let sum = |c: usize| found.iter().map(|group| group[c].log_ratio()).sum::<f64>();
            let ratios = [0, 1, 2].map(|c| sum(c) / found.len() as f64);
            groups.extend(found);
            Ok::<_, CheckError>(ratios.to_vec())
        })?;
        let of_channel = |c: usize| groups.iter().map(|group| group[c]).collect::<Vec<_>>();
        let variances = [0, 1, 2].map(|c| TwoVariances::mean_of(&of_channel(c)));
        Ok(finding(self.samples_per_pixel.0, self.batch, &reports, &variances))
    }
}

impl ReportsItsVariance {
    fn picture(&self, scene: &SceneDescription) -> Result<Rendering> {
        let n = self.samples_per_pixel.0;
        let picture = Rendering::of(scene, self.size.0, self.bounces.0, n)?;
        Ok(match self.batch {
            Some(samples_per_batch) => {
                picture.adaptive(AdaptiveSettings { samples_per_batch, max_tolerance: UNREACHED })
            }
            None => picture,
        })
    }

    fn samples_of_a_group(&self) -> u64 {
        let pixels = u64::from(self.size.0[0]) * u64::from(self.size.0[1]);
        u64::from(PICTURES) * u64::from(self.samples_per_pixel.0) * pixels
    }

    /// What is beyond the band has to be seen; the band itself is the same in every budget.
    fn effort(&self, context: &Context<'_>) -> Effort {
        let band = Band::FACTOR_OF_TWO.relative();
        let beyond = (self.detects.0.log2() - band) * context.budget.coarseness();
        let most = context.budget.samples(self.at_most.0);
        let effort = Effort { detects: band + beyond, ..context.budget.scale(Effort::new(band)) };
        effort.with_most_samples(most).with_runs(32).in_steps_of(self.samples_of_a_group())
    }
}

/// What groups of pictures say, each with seeds of its own.
fn take_groups(
    scene: &mut dyn BuiltScene,
    picture: &Rendering,
    seed: Seed,
    count: u64,
) -> Result<Vec<[TwoVariances; 3]>> {
    let group = |group: u64| {
        let mut both = ReportedVariance::default();
        for number in 0..PICTURES {
            let film = picture.film(scene, seed.child(group).child(number).0, 0)?;
            both.push(&film.pixels, &film.variances);
        }
        Ok(both.variances())
    };
    (0..count).map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{Cause, adaptive};
    use crate::checks::camera::fake::FakeFilm;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::contract::{Film, RenderSettings};
    use crate::math::rng::uniform;

    /// What is reported of samples in place of the variance of their mean.
    type Report = fn(&[f64]) -> f64;

    /// Samples are uniform between 0 and a tenth; blue is brighter by as much as is told.
    fn take(report: Report, offset: f64, settings: &RenderSettings, film: &mut Film) {
        let mut stream = Seed(settings.integrator.seed).stream();
        film.sample_counts.fill(settings.samples_per_pixel);
        for (pixel, variance) in film.pixels.iter_mut().zip(&mut film.variances) {
            for (channel, offset) in [0.0, 0.0, offset].into_iter().enumerate() {
                let mut sample = |_| offset + 0.1 * uniform(&mut stream);
                let samples: Vec<f64> = (0..settings.samples_per_pixel).map(&mut sample).collect();
                pixel[channel] = (samples.iter().sum::<f64>() / samples.len() as f64) as f32;
                variance[channel] = report(&samples) as f32;
            }
        }
    }

    fn squares(samples: &[f64]) -> f64 {
        let mean = samples.iter().sum::<f64>() / samples.len() as f64;
        samples.iter().map(|sample| (sample - mean).powi(2)).sum()
    }

    fn right(samples: &[f64]) -> f64 {
        let n = samples.len() as f64;
        squares(samples) / (n - 1.0) / n
    }

    fn in_single(samples: &[f64]) -> f64 {
        let n = samples.len() as f32;
        let sum: f32 = samples.iter().map(|sample| *sample as f32).sum();
        let squares: f32 = samples.iter().map(|sample| (*sample as f32).powi(2)).sum();
        f64::from((squares - sum * sum / n).max(0.0) / (n - 1.0) / n)
    }

    const EXPECT: &str = "[expect]\nsize = [4, 3]\nbounces = [0, 1]\nsamples-per-pixel = 8\n\
                          at-most = \"400 k\"\ndetects = 3\n";

    fn found(report: Report, offset: f64) -> Finding {
        judged(EXPECT, move |settings, film| take(report, offset, settings, film))
    }

    fn judged(expect: &str, film: impl Fn(&RenderSettings, &mut Film) + Send + 'static) -> Finding {
        let mut core = Fake::default();
        core.info.capabilities = Capabilities::all();
        core.film = Box::new(film);
        let check = check_of::<ReportsItsVariance>(expect);
        try_judge(&check, &mut core, Some(FakeFilm::scene())).unwrap()
    }

    /// Samples of batches that draw so many numbers of their own, and then the same again.
    fn take_batches(own: u32, settings: &RenderSettings, film: &mut Film) {
        let n = settings.samples_per_pixel;
        assert!(settings.adaptive.is_some_and(|adaptive| n > adaptive.samples_per_batch));
        let mut stream = Seed(settings.integrator.seed).stream();
        film.sample_counts.fill(n);
        let values = film.pixels.as_flattened_mut().iter_mut();
        for (value, variance) in values.zip(film.variances.as_flattened_mut()) {
            let numbers: Vec<f64> = (0..own).map(|_| uniform(&mut stream)).collect();
            let samples: Vec<f64> = numbers.into_iter().cycle().take(n as usize).collect();
            *value = (samples.iter().sum::<f64>() / f64::from(n)) as f32;
            *variance = right(&samples) as f32;
        }
    }

    #[test]
    fn batches_that_repeat_fail_under_their_own_name() {
        let expect = format!("{EXPECT}batch = 2\n");
        let drawing =
            |own| judged(&expect, move |settings, film| take_batches(own, settings, film));
        assert_passes(&drawing(8));
        let finding = drawing(2);
        assert_eq!(causes(&finding), [adaptive::BATCHES_REPEAT.name], "{}", finding.statement);
    }

    #[test]
    fn the_variance_of_the_mean_passes_over_n_too() {
        assert_passes(&found(right, 100.0));
        assert_passes(&found(|samples| 0.875 * right(samples), 0.0));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        let mistakes: [(Report, &Cause); 5] = [
            (|samples| 8.0 * right(samples), &adaptive::VARIANCE_OF_SAMPLE),
            (|samples| right(samples) / 8.0, &adaptive::DIVIDED_TWICE),
            (squares, &adaptive::SQUARES_REPORTED),
            (|samples| right(samples).sqrt(), &adaptive::DEVIATION_REPORTED),
            (in_single, &adaptive::SQUARES_CANCEL),
        ];
        for (report, cause) in mistakes {
            let finding = found(report, 1000.0);
            assert_eq!(causes(&finding), [cause.name], "{}", finding.statement);
        }
    }

    #[test]
    fn nothing_reported_fails_without_a_name() {
        let finding = found(|_| 0.0, 0.0);
        assert!(failure(&finding).contains("red: the reported variance is 0 times"));
        assert!(finding.clues.is_empty());
    }
}
