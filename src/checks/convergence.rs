//! How the error of pictures falls with the number of samples, as plots show it.

use super::series::{Convergence, OneLine, Series};
use crate::stats::ErrorLevel;

/// The errors at growing numbers of samples, of pictures whose right luminance has this mean.
pub(crate) fn series(levels: &[ErrorLevel], mean: f64, reference_noise: f64) -> Series {
    let relative = |of: &dyn Fn(&ErrorLevel) -> f64| {
        OneLine::rounded(levels.iter().map(|level| of(level) / mean))
    };
    Series::Convergence(Convergence {
        samples: levels.iter().map(|level| level.samples).collect(),
        error: relative(&|level| level.error_with_spread()[0]),
        uncertainty: relative(&|level| level.error_with_spread()[1]),
        noise: relative(&|level| level.variance.sqrt()),
        reference_noise: reference_noise / mean,
    })
}

/// Pictures of the same number of samples, put together to pictures of ever more of them: of one, two, four.
pub(crate) fn levels(runs: &[Vec<f64>], samples: u64, truth: &[f64]) -> Vec<ErrorLevel> {
    let alone = ErrorLevel::from_runs(samples, runs, truth).variance;
    let doubled = std::iter::successors(Some(1), |together| Some(2 * together));
    let sizes = doubled.take_while(|together| *together <= runs.len());
    sizes
        .map(|together| {
            let means: Vec<_> = runs.chunks_exact(together).map(mean_picture).collect();
            let level = ErrorLevel::from_runs(samples * together as u64, &means, truth);
            ErrorLevel { variance: alone / together as f64, ..level }
        })
        .collect()
}

fn mean_picture(pictures: &[Vec<f64>]) -> Vec<f64> {
    let pixel = |number: usize| pictures.iter().map(|picture| picture[number]).sum::<f64>();
    (0..pictures[0].len()).map(|number| pixel(number) / pictures.len() as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    #[test]
    fn pictures_put_together_have_the_error_of_as_many_samples() {
        let mut stream = Seed(4).stream();
        let mut picture = || (0..4096).map(|_| 2.1 * uniform(&mut stream)).collect::<Vec<_>>();
        let runs: Vec<_> = (0..16).map(|_| picture()).collect();
        let levels = levels(&runs, 8, &vec![1.0; 4096]);
        let Series::Convergence(found) = series(&levels, 1.0, 0.0) else { panic!() };
        assert_eq!(found.samples[..], [8, 16, 32, 64, 128]);
        for (level, samples) in [1.0_f64, 2.0, 4.0, 8.0, 16.0].into_iter().enumerate() {
            let noise = 2.1_f64.powi(2) / 12.0 / samples;
            assert!((found.noise[level] / noise.sqrt() - 1.0).abs() < 0.01, "{found:?}");
            let error = (noise + 0.05_f64.powi(2)).sqrt();
            assert!((found.error[level] / error - 1.0).abs() < 0.05, "{found:?}");
        }
    }
}
