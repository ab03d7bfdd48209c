//! Screen-and-confirm, simulated: false alarms at levels at which some can be seen, and power at the levels that
//! count. With noise as skewed as this the screen suspects more than its level says, for Student's t has no such
//! tails; that costs runs, and no verdict: only confirmations on fresh runs decide, each on one number. The log of a run stands in `docs/simulations/screen-and-confirm.log`:
//!
//! ```sh
//! cargo test --lib stats::image::simulation -- --ignored --nocapture
//! ```

use super::draw::Levels;
use super::screen::judge_image_at;
use crate::image::Image;
use crate::math::rng::{Seed, Stream, uniform};
use crate::stats::{ImageDraw, ImageEffort, ImageReport, Reference, Verdict, share_interval};
use rayon::prelude::*;
use std::convert::Infallible;

/// Right pictures that are judged.
const NULLS: u64 = 10_000;
/// Wrong pictures of each kind.
const WRONG: u64 = 40;
/// Pixels on a side of the right pictures, and of the wrong ones.
const SMALL: usize = 32;
const LARGE: usize = 256;
const EFFORT: ImageEffort = ImageEffort::new(0.02, 2);

/// The mean of two exponential variables, the noise of all channels: 2 samples a pixel in each run, relative
/// deviation 1 a sample.
fn noise(stream: &mut Stream) -> f32 {
    -0.5 * ((1.0 - uniform(stream)) * (1.0 - uniform(stream))).ln() as f32
}

/// A ramp with dark and bright squares in it: shadows, and edges that a shift moves.
fn scene(size: usize, x: usize, y: usize) -> [f32; 3] {
    let ramp = 0.2 + 0.6 * x as f32 / size as f32;
    let square = (8 * x / size + 8 * y / size).is_multiple_of(2);
    let level = if square { ramp } else { 0.25 * ramp };
    [level, 0.7 * level, 0.4 * level]
}

/// Judges a core whose mean picture is `truth` against `scene`, known exactly.
fn judged(
    levels: Levels,
    effort: &ImageEffort,
    size: usize,
    seed: u64,
    truth: impl Fn(usize, usize) -> [f32; 3],
) -> ImageReport {
    let mean = Image::from_fn(size, size, |x, y| scene(size, x, y));
    let error = Image::new(size, size, [0.0; 3]);
    let mut draw = |request: ImageDraw| {
        let mut stream = request.seed(Seed(seed)).stream();
        let pixel = |x, y| {
            let gain = noise(&mut stream);
            truth(x, y).map(|value| gain * value)
        };
        Ok::<_, Infallible>(Image::from_fn(size, size, pixel))
    };
    let reference = Reference { mean: &mean, standard_error: &error };
    let Ok(report) = judge_image_at(levels, reference, effort, &mut draw);
    report
}

#[test]
#[ignore = "minutes: 10 000 right pictures at relaxed levels"]
fn right_pictures_fail_no_oftener_than_the_levels_say() {
    let usual = EFFORT.looks;
    let rows = [(1e-3, 2e-5, usual), (0.05, 0.05, usual), (1.0, 0.05, usual), (1.0, 0.2, usual)];
    // As of gross errors, which are seen in no right picture.
    let few = [EFFORT.looks[0], EFFORT.looks[1]].map(|runs| EFFORT.looks.map(|_| runs));
    let gross = few.into_iter().flat_map(|few| [(1.0, 0.05, few), (1.0, 0.2, few)]);
    for (screen, confirm, looks) in rows.into_iter().chain(gross) {
        let levels = Levels { screen, confirm };
        let effort = ImageEffort { looks, ..EFFORT };
        let reports: Vec<_> = (0..NULLS)
            .into_par_iter()
            .map(|seed| {
                let report = judged(levels, &effort, SMALL, seed, |x, y| scene(SMALL, x, y));
                let confirmations = report.scales.iter().filter_map(|scale| scale.confirmations);
                let rejects: Vec<_> =
                    confirmations.map(|pair| pair[0].rejects && pair[1].rejects).collect();
                (report.runs > 16, rejects, report.verdict == Verdict::Fail)
            })
            .collect();
        let suspected = reports.iter().filter(|(suspected, ..)| *suspected).count() as u64;
        let confirmed =
            reports.iter().flat_map(|(_, rejects, _)| rejects).filter(|r| **r).count() as u64;
        let scales = reports.iter().map(|(_, rejects, _)| rejects.len() as u64).sum::<u64>();
        let failed = reports.iter().filter(|(.., failed)| *failed).count() as u64;
        let [low, high] = share_interval(suspected, NULLS, 5e-4);
        println!(
            "screen {screen}, confirm {confirm} on twice {looks:?} runs: {suspected} of {NULLS} suspected (99.9 % interval of the rate {low:.1e} to {high:.1e})"
        );
        let twice = confirm * confirm;
        if scales > 0 {
            let [low, high] = share_interval(confirmed, scales, 5e-4);
            println!(
                "    {confirmed} of {scales} scales confirmed twice, nominal {twice:.1e} (interval {low:.1e} to {high:.1e})"
            );
            assert!(low <= twice, "confirmed more often than {twice:.1e}");
        }
        println!("    {failed} of {NULLS} pictures failed");
        assert!(screen > 1e-3 || failed == 0);
    }
}

#[test]
#[ignore = "minutes: 40 wrong pictures of each kind"]
fn wrong_pictures_fail_at_the_levels_that_count() {
    let right = |x: usize, y: usize| scene(LARGE, x, y);
    let is_shadow = |x, y| right(x, y)[0] < 0.2;
    let dead = |x: usize, y: usize| x % 53 == 7 && y % 61 == 11;
    let deads = (0..LARGE * LARGE).filter(|i| dead(i % LARGE, i / LARGE)).count();
    println!("{deads} pixels are dead in the third kind");
    type Truth<'a> = Box<dyn Fn(usize, usize) -> [f32; 3] + Sync + 'a>;
    let kinds: [(&str, Truth<'_>); 5] = [
        ("1 % everywhere", Box::new(|x, y| right(x, y).map(|v| 1.01 * v))),
        (
            "30 % in 16 columns",
            Box::new(|x, y| right(x, y).map(|v| if x < 16 { 1.3 * v } else { v })),
        ),
        ("dead pixels", Box::new(|x, y| if dead(x, y) { [0.0; 3] } else { right(x, y) })),
        ("a shift by one pixel", Box::new(|x, y| right(x.saturating_sub(1), y))),
        (
            "a tint of 3 % in shadows",
            Box::new(|x, y| {
                let [r, g, b] = right(x, y);
                if is_shadow(x, y) { [1.03 * r, g, b] } else { [r, g, b] }
            }),
        ),
    ];
    for (name, truth) in kinds {
        let fails = |seed: &u64| {
            judged(Levels::DEFAULT, &EFFORT, LARGE, *seed, &truth).verdict == Verdict::Fail
        };
        let failed = (0..WRONG).into_par_iter().filter(fails).count() as u64;
        println!("{name}: {failed} of {WRONG} failed");
        assert_eq!(failed, WRONG, "{name}");
    }
}
