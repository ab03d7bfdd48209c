//! The variance that is reported of pictures against that between pictures, and the mistakes that tell them apart.

use crate::cause::{Cause, adaptive};
use crate::checks::phrase::figure;
use crate::checks::{Finding, Measure};
use crate::image::CHANNELS;
use crate::stats::{Band, MeanReport, TwoVariances, Verdict};

/// What reports of `n` samples a pixel, taken in batches or at once, are worth.
pub(super) fn finding(
    n: u32,
    batch: Option<u32>,
    reports: &[MeanReport],
    variances: &[TwoVariances; 3],
) -> Finding {
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
        .because_of(failed.and_then(|_| mistake(n.into(), batch.map(f64::from), variances)))
}

/// The one mistake that predicts the three channels, if there is one.
fn mistake(
    n: f64,
    batch: Option<f64>,
    variances: &[TwoVariances; 3],
) -> Option<(&'static Cause, String)> {
    let predicts = |prediction: &dyn Fn(f64) -> f64| {
        let close = |v: &TwoVariances| (v.reported / prediction(v.measured)).log2().abs() < NEAR;
        variances.iter().all(close)
    };
    let candidates: [(&'static Cause, &dyn Fn(f64) -> f64); 5] = [
        (&adaptive::BATCHES_REPEAT, &|real| {
            batch.map_or(f64::NAN, |batch| real * (batch - 1.0) / (n - 1.0))
        }),
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
