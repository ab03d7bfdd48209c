//! What each rule says of a comparison.

use super::bank::Bank;
use super::{DETECTS, SAMPLES, SCREEN_RUNS};
use furnace::image::metric::METRICS;
use furnace::image::pair::Pair;
use furnace::image::{Image, luminance};
use furnace::scene::reference::Reference;
use furnace::stats::{self, ImageEffort, Verdict, judge_image, normal_upper};

/// What each rule says of one comparison.
pub struct Scores {
    pub fails: bool,
    pub mitsuba: bool,
    pub metrics: Vec<f64>,
}

pub fn scores(
    bank: &Bank,
    order: &[usize],
    reference: &Reference,
    deviations: &[f64],
    with_metrics: bool,
) -> Scores {
    let question =
        stats::Reference { mean: &reference.mean, standard_error: &reference.standard_error };
    let mut drawn = 0;
    let report = judge_image(question, &ImageEffort::new(DETECTS, SAMPLES), &mut |_| {
        drawn += 1;
        Ok::<_, ()>(bank.runs[order[drawn - 1]].clone())
    })
    .unwrap();
    let mean = mean_of(order[..SCREEN_RUNS].iter().map(|run| &bank.runs[*run]));
    let pair = Pair::new(&mean, &reference.mean).unwrap();
    let metrics = METRICS.iter().filter(|_| with_metrics).map(|metric| metric.measure(&pair));
    Scores {
        fails: report.verdict == Verdict::Fail,
        mitsuba: mitsuba_fails(&mean, deviations, reference),
        metrics: metrics.collect(),
    }
}

pub fn mean_of<'a>(runs: impl Iterator<Item = &'a Image>) -> Image {
    let mut sum: Option<Image> = None;
    let mut count = 0.0;
    for run in runs {
        count += 1.0;
        let sum = sum.get_or_insert_with(|| Image::new(run.width, run.height, [0.0; 3]));
        for (sum, pixel) in sum.pixels.iter_mut().zip(&run.pixels) {
            *sum = std::array::from_fn(|c| sum[c] + pixel[c]);
        }
    }
    let mut sum = sum.unwrap();
    sum.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(|value| value / count));
    sum
}

/// The standard deviation of each pixel's luminance between runs.
pub fn deviations(runs: &[Image]) -> Vec<f64> {
    let of_pixel = |i: usize| {
        let grey = runs.iter().map(|run| luminance(run.pixels[i]));
        let moments: stats::Moments = grey.collect();
        moments.standard_error() * (runs.len() as f64).sqrt()
    };
    (0..runs[0].pixels.len()).map(of_pixel).collect()
}

/// The rule of Mitsuba's render tests: each pixel's luminance by its z, at 1 % after Šidák; a
/// picture passes if 99.75 % of its pixels do. The deviations are here measured over the whole
/// bank of right pictures: better than Mitsuba knows them.
pub fn mitsuba_fails(mean: &Image, deviations: &[f64], reference: &Reference) -> bool {
    let pixels = mean.pixels.len() as f64;
    let level = 1.0 - (1.0 - 0.01f64).powf(1.0 / pixels);
    let critical = normal_upper(level / 2.0);
    let pairs = mean.pixels.iter().zip(&reference.mean.pixels).zip(deviations);
    let passes = |((pixel, expected), deviation): &((&[f32; 3], &[f32; 3]), &f64)| {
        let error = (*deviation / (SCREEN_RUNS as f64).sqrt()).max(1e-4);
        ((luminance(**pixel) - luminance(**expected)) / error).abs() <= critical
    };
    let outside = pairs.filter(|pixel| !passes(pixel)).count();
    outside as f64 > 0.0025 * pixels
}

pub fn energy(pictures: &[Image]) -> f64 {
    let of = |image: &Image| image.pixels.iter().map(|p| luminance(*p)).sum::<f64>();
    pictures.iter().map(of).sum::<f64>() / pictures.len() as f64
}
