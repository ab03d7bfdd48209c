//! The variance that a core reports of its pixels is the one that its pictures have.
//!
//! Pictures that differ in their seed alone are made in groups: the variance between the pictures of
//! a group, pixel by pixel, is what the reported one should be. No theory of the estimator is
//! needed, so that any core that reports variances can be asked.

use crate::cause::{Cause, adaptive};
use crate::checks::phrase::figure;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, BuiltScene};
use crate::image::CHANNELS;
use crate::math::rng::Seed;
use crate::stats::{
    Band, Claim, Effort, MeanReport, ReportedVariance, TwoVariances, Verdict, judge_means,
};
use crate::text::{Between, Bounces, Count, Factor, Size};

/// Pictures whose pixels are compared with each other.
const PICTURES: u32 = 8;

check! {
    /// Every picture comes with the variance of its pixels, and it is right within a factor of two.
    pub(crate) struct ReportsItsVariance {
        size: Size,
        bounces: Bounces,
        /// Fewer than 4 hardly know their variance.
        samples_per_pixel: Between<4, 65536>,
        /// The smallest factor, either way, that must be seen.
        detects: Factor,
        /// Past this the verdict is inconclusive, never a pass.
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

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let rendering =
            Rendering::of(&scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?;
        let (seed, effort) = (context.seed, self.effort(context));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut groups = Vec::new();
        let claims = [Claim::reported_variance(); 3];
        let reports = judge_means(&claims, &effort, &mut |draw| {
            let count = draw.samples / self.samples_of_a_group();
            let found = take_groups(built.as_mut(), &rendering, draw.seed(seed), count)?;
            let ratios = [0, 1, 2].map(|c| mean(found.iter().map(|group| group[c].log_ratio())));
            groups.extend(found);
            Ok::<_, CheckError>(ratios.to_vec())
        })?;
        let variances = [0, 1, 2].map(|c| {
            TwoVariances::mean_of(&groups.iter().map(|group| group[c]).collect::<Vec<_>>())
        });
        Ok(self.finding(&reports, &variances))
    }
}

impl ReportsItsVariance {
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

    fn finding(&self, reports: &[MeanReport], variances: &[TwoVariances; 3]) -> Finding {
        let measures: Vec<_> =
            (0..3).map(|c| measure(&reports[c], &variances[c]).of_channel(CHANNELS[c])).collect();
        let weakest = reports.iter().map(|report| report.resolution).fold(0.0, f64::max);
        let resolution = format!(
            "would have caught a variance that is wrong by a factor of {}",
            figure(weakest.exp2())
        );
        let failed = measures.iter().position(Measure::failed);
        let statement = match failed {
            None => "reported variances are those between pictures".to_owned(),
            Some(channel) => format!(
                "{}: the reported variance is {} times what it is between pictures: {} instead of {}",
                CHANNELS[channel],
                figure(variances[channel].reported / variances[channel].measured),
                figure(variances[channel].reported),
                figure(variances[channel].measured),
            ),
        };
        Finding::of(statement, resolution, measures)
            .because_of(failed.and_then(|_| self.mistake(variances)))
    }

    /// The one mistake that predicts the three channels, if there is one.
    fn mistake(&self, variances: &[TwoVariances; 3]) -> Option<(&'static Cause, String)> {
        let n = f64::from(self.samples_per_pixel.0);
        let predicts = |prediction: &dyn Fn(f64) -> f64| {
            let close =
                |v: &TwoVariances| (v.reported / prediction(v.measured)).log2().abs() < NEAR;
            variances.iter().all(close)
        };
        let candidates: [(&'static Cause, &dyn Fn(f64) -> f64); 4] = [
            (&adaptive::VARIANCE_OF_SAMPLE, &|real| n * real),
            (&adaptive::DIVIDED_TWICE, &|real| real / n),
            (&adaptive::SQUARES_REPORTED, &|real| n * (n - 1.0) * real),
            (&adaptive::DEVIATION_REPORTED, &f64::sqrt),
        ];
        let found = candidates.into_iter().find(|(_, prediction)| predicts(prediction));
        let cancels = || variances.iter().all(|v| is_right(v) != drowns(v, n));
        match found {
            Some((cause, _)) => Some((cause, every_channel(variances))),
            None => cancels().then(|| (&adaptive::SQUARES_CANCEL, bright_channels(variances))),
        }
    }
}

/// How far from what a mistake predicts, in powers of two, the variance may be that it explains.
const NEAR: f64 = 0.4;

/// Whether a variance is what it should be.
fn is_right(v: &TwoVariances) -> bool {
    v.log_ratio().abs() <= Band::FACTOR_OF_TWO.relative()
}

/// Whether the variance of `n` samples is less than what sums of squares in single precision lose.
fn drowns(v: &TwoVariances, n: f64) -> bool {
    f64::from(f32::EPSILON) * v.mean * v.mean > v.measured * n
}

fn every_channel(variances: &[TwoVariances; 3]) -> String {
    let ratios = variances.map(|v| figure(v.reported / v.measured));
    format!("predicts all three channels: {} times what is real", ratios.join(", "))
}

fn bright_channels(variances: &[TwoVariances; 3]) -> String {
    let brightness = variances.map(|v| figure(v.mean / v.measured.sqrt()));
    format!(
        "wrong just where single precision has no digits left: light is {} times its noise",
        brightness.join(", ")
    )
}

/// A measure in powers of two. Where pictures have no noise at all, nothing was tested.
fn measure(report: &MeanReport, variances: &TwoVariances) -> Measure {
    let silent = variances.measured == 0.0 && report.verdict == Verdict::Pass;
    Measure {
        resolution: Some(report.resolution.exp2() - 1.0)
            .filter(|resolution| resolution.is_finite()),
        verdict: if silent { Verdict::Inconclusive } else { report.verdict },
        ..Measure::of("reported over real variance", report).in_unit("powers of two")
    }
}

/// What groups of pictures say, each with seeds of its own.
fn take_groups(
    scene: &mut dyn BuiltScene,
    rendering: &Rendering,
    seed: Seed,
    count: u64,
) -> Result<Vec<[TwoVariances; 3]>, CheckError> {
    let mut group = |number: u64| {
        let mut both = ReportedVariance::default();
        for picture in 0..PICTURES {
            let film = rendering.film(scene, seed.child(number).child(picture).0, 0)?;
            both.push(&film.pixels, &film.variances);
        }
        Ok(both.variances())
    };
    (0..count).map(&mut group).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::camera::fake::FakeFilm;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::contract::{Capabilities, Film, RenderSettings};
    use crate::math::rng::uniform;
    use crate::scene::SceneDescription;

    /// What is reported of samples in place of the variance of their mean.
    type Report = fn(&[f64]) -> f64;

    /// Samples are uniform between 0 and a tenth; blue is brighter by as much as is told.
    fn take(report: Report, glow: f64, settings: &RenderSettings, film: &mut Film) {
        let mut stream = Seed(settings.integrator.seed).stream();
        film.sample_counts.fill(settings.samples_per_pixel);
        for (pixel, variance) in film.pixels.iter_mut().zip(&mut film.variances) {
            for (channel, glow) in [0.0, 0.0, glow].into_iter().enumerate() {
                let mut sample = |_| glow + 0.1 * uniform(&mut stream);
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

    fn found(report: Report, glow: f64) -> Finding {
        let check = check_of::<ReportsItsVariance>(
            "[expect]\nsize = [4, 3]\nbounces = [0, 1]\nsamples-per-pixel = 8\n\
             at-most = \"400 k\"\ndetects = 3",
        );
        let camera = Some(FakeFilm::camera());
        let scene = SceneDescription { camera, ..SceneDescription::default() };
        let mut core = Fake::default();
        core.info.capabilities = Capabilities::all();
        core.film = Box::new(move |settings, film| take(report, glow, settings, film));
        try_judge(&check, &mut core, Some(scene)).unwrap()
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
            failure(&finding);
            let causes: Vec<_> = finding.clues.iter().map(|clue| clue.cause.as_str()).collect();
            assert_eq!(causes, [cause.name], "{}", finding.statement);
        }
    }

    #[test]
    fn nothing_reported_fails_without_a_name() {
        let finding = found(|_| 0.0, 0.0);
        assert!(failure(&finding).contains("red: the reported variance is 0 times"));
        assert!(finding.clues.is_empty());
    }
}
