//! The law of codes, simulated: false alarms at levels at which some can be seen, and power at the
//! levels that count. The log of a run stands in `docs/simulations/codes.log`:
//!
//! ```sh
//! cargo test --lib stats::image::codes::simulation -- --ignored --nocapture
//! ```

use super::*;
use crate::image::encoding::{Curve, Rounding};
use crate::math::rng::{Seed, Stream, uniform};
use crate::stats::share_interval;
use rayon::prelude::*;
use std::convert::Infallible;

/// Right pictures that are judged.
const NULLS: u64 = 10_000;
/// Wrong pictures of each kind.
const WRONG: u64 = 40;
/// Pixels on a side of the right pictures, and of the wrong ones.
const SMALL: usize = 16;
const LARGE: usize = 128;
const GAMMA: Encoding = Encoding::of(Curve::Gamma(2.2));

/// From shadow to beyond white, in both directions.
fn scene(size: usize) -> Image {
    Image::from_fn(size, size, |x, y| {
        let [x, y] = [x, y].map(|place| place as f32 / size as f32);
        let level = 0.05 + 0.4 * x + if y < 0.2 { 0.9 } else { 0.3 * y };
        [level, 0.7 * level, 0.4 * level]
    })
}

/// The mean of so many exponential variables: relative deviation 1 a sample, all channels together.
fn noise(samples: u32, stream: &mut Stream) -> f64 {
    let product: f64 = (0..samples).map(|_| 1.0 - uniform(stream)).product();
    -product.ln() / f64::from(samples)
}

/// Judges a core whose light is `gain` times that of the scene, known exactly, and that encodes it
/// as `encoding` and says that it is [`GAMMA`].
fn judged(
    levels: Levels,
    size: usize,
    samples: u32,
    seed: u64,
    (gain, encoding): (f64, Encoding),
) -> CodeReport {
    let (mean, error) = (scene(size), Image::new(size, size, [0.0; 3]));
    let reference = CodeReference { mean: &mean, standard_error: &error, samples: None };
    let effort = ImageEffort::new(0.02, samples);
    let settings = CodeSettings { declared: GAMMA, effort };
    let mut draw = |request: ImageDraw| {
        let mut stream = request.seed(Seed(seed)).stream();
        let pixel = |light: &[f32; 3]| {
            let gain = gain * noise(samples, &mut stream);
            light.map(|light| encoding.code(gain * f64::from(light)))
        };
        let pixels = mean.pixels.iter().map(pixel).collect();
        Ok::<_, Infallible>(Codes { width: size, height: size, pixels })
    };
    let Ok(report) = judge_codes_at(levels, reference, &settings, &mut draw);
    report
}

#[test]
#[ignore = "minutes: 10 000 right pictures at relaxed levels"]
fn right_codes_fail_no_oftener_than_the_levels_say() {
    for (screen, confirm) in [(1e-3, 2e-5), (1.0, 0.05)] {
        let levels = Levels { screen, confirm };
        let judged = |seed| judged(levels, SMALL, 16, seed, (1.0, GAMMA));
        let of_report = |report: CodeReport| {
            let image = report.image.as_ref();
            let scales = image.iter().flat_map(|image| &image.scales);
            let pairs = scales.filter_map(|scale| scale.confirmations);
            let rejects: Vec<_> = pairs.map(|pair| pair[0].rejects && pair[1].rejects).collect();
            let clips = report.clipping.is_some_and(|clipping| clipping.rejects);
            (
                report.image.as_ref().is_some_and(ImageReport::suspected),
                rejects,
                clips,
                report.deciphered.is_another(),
                report.verdict,
            )
        };
        let reports: Vec<_> = (0..NULLS).into_par_iter().map(judged).map(of_report).collect();
        let count =
            |is: &dyn Fn(usize) -> bool| (0..reports.len()).filter(|i| is(*i)).count() as u64;
        let confirmed = reports.iter().flat_map(|report| &report.1).filter(|one| **one).count();
        let scales = reports.iter().map(|report| report.1.len() as u64).sum::<u64>();
        println!("screen {screen}, confirm {confirm}, of {NULLS} right pictures:");
        println!("    {} suspected", count(&|i| reports[i].0));
        println!("    {} said to be clipped too seldom", count(&|i| reports[i].2));
        println!("    {} said to be encoded otherwise", count(&|i| reports[i].3));
        if scales > 0 {
            let [low, high] = share_interval(confirmed as u64, scales, 5e-4);
            let twice = confirm * confirm;
            println!(
                "    {confirmed} of {scales} scales confirmed twice, nominal {twice:.1e} (99.9 % interval {low:.1e} to {high:.1e})"
            );
            assert!(low <= twice, "confirmed more often than {twice:.1e}");
        }
        let failed = count(&|i| reports[i].4 == Verdict::Fail);
        println!("    {failed} failed");
        assert_eq!(count(&|i| reports[i].3), 0);
        assert!(screen > 1e-3 || failed == 0);
    }
}

#[test]
#[ignore = "minutes: 40 wrong pictures of each kind"]
fn wrong_codes_fail_and_are_told_apart() {
    let kinds = [
        ("right", 1.0, GAMMA),
        ("1 % too bright", 1.01, GAMMA),
        ("1 % too dark", 0.99, GAMMA),
        ("truncated", 1.0, Encoding { rounding: Rounding::Down, ..GAMMA }),
        ("sRGB", 1.0, Encoding::of(Curve::Srgb)),
        ("no curve", 1.0, Encoding::of(Curve::Linear)),
        ("no curve, and half as bright", 0.5, Encoding::of(Curve::Linear)),
    ];
    for (name, gain, encoding) in kinds {
        let judged = |seed| judged(Levels::DEFAULT, LARGE, 64, seed, (gain, encoding));
        let reports: Vec<_> = (0..WRONG).into_par_iter().map(judged).collect();
        let count = |is: &dyn Fn(&CodeReport) -> bool| reports.iter().filter(|one| is(one)).count();
        let failed = count(&|report| report.verdict == Verdict::Fail);
        let named = count(&|report| report.deciphered.found == Some(encoding));
        let resolution = reports[0].image.as_ref().map_or(f64::NAN, |image| image.resolution);
        println!(
            "{name}: {failed} of {WRONG} failed, the encoding told in {named}; resolution {:.2} %",
            100.0 * resolution
        );
        let wrong = (gain, encoding) != (1.0, GAMMA);
        assert_eq!((failed, named), (if wrong { WRONG as usize } else { 0 }, WRONG as usize));
    }
}
