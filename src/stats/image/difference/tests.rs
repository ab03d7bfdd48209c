//! Pictures of one scene are told apart by their light, and by nothing else.

use super::*;
use crate::math::rng::{Seed, uniform};

const SIDE: usize = 256;

/// Light with edges, bright and dark.
fn scene(x: usize, y: usize) -> f64 {
    let (x, y) = (x as f64, y as f64);
    let is_disc = (x - 90.0).hypot(y - 120.0) < 50.0;
    let stripe = if (x + 0.4 * y).rem_euclid(60.0) < 25.0 { 0.4 } else { 1.0 };
    if is_disc { 1.7 } else { stripe * (0.2 + 0.003 * y) }
}

/// A render of the scene: noise as skewed as light is, of a relative deviation of `amount`.
fn render(amount: f64, seed: u64, change: impl Fn(usize, usize, f64) -> f64) -> Image {
    let mut stream = Seed(seed).stream();
    Image::from_fn(SIDE, SIDE, |x, y| {
        let noise = 1.0 + amount * (-(1.0 - uniform(&mut stream)).ln() - 1.0);
        let value = change(x, y, scene(x, y)) * noise;
        [value as f32, 0.7 * value as f32, 0.4 * value as f32]
    })
}

fn right(_: usize, _: usize, value: f64) -> f64 {
    value
}

fn judged(image: &Image, reference: &Image) -> DifferenceReport {
    judge_difference(Sample::of(image), Sample::of(reference), None)
}

fn rejecting(report: &DifferenceReport, pattern: Pattern) -> &PatternReport {
    let found = report.patterns.iter().find(|found| found.pattern == pattern).unwrap();
    assert!(found.rejects, "{report:#?}");
    found
}

#[test]
fn two_renders_of_one_scene_are_not_told_apart() {
    for seed in 0..40 {
        let report = judged(&render(0.3, seed, right), &render(0.1, 1000 + seed, right));
        assert_eq!(report.verdict, Verdict::Pass, "{report:#?}");
        assert!(report.resolution < 0.03, "{}", report.resolution);
    }
}

/// At a level of 5 % for each confirmation, a pattern rejects one right picture in 400.
#[test]
#[ignore = "some minutes: cargo test --lib stats::image::difference -- --ignored --nocapture"]
fn false_alarms_are_no_more_than_the_levels_say() {
    let mut rejected = [0; Pattern::ALL.len()];
    let pictures = 2000;
    for seed in 0..pictures {
        let [image, reference] = [render(0.5, seed, right), render(0.2, 1 << 32 | seed, right)];
        let report = judge_at(Sample::of(&image), Sample::of(&reference), None, 0.05);
        for (count, pattern) in rejected.iter_mut().zip(&report.patterns) {
            *count += u64::from(pattern.rejects);
        }
    }
    println!("rejected of {pictures}: {rejected:?}, expected at most {}", pictures / 400);
    assert!(rejected.iter().all(|count| *count <= 14), "{rejected:?}");
}

#[test]
fn what_is_wrong_is_found_where_it_is() {
    let reference = render(0.05, 1, right);
    let brighter = render(0.2, 2, |_, _, value| 1.02 * value);
    assert_eq!(judged(&brighter, &reference).verdict, Verdict::Fail);
    let columns = |x: usize, _: usize, v: f64| if (96..112).contains(&x) { 1.3 * v } else { v };
    let report = judged(&render(0.2, 3, columns), &reference);
    let columns = rejecting(&report, Pattern::Columns);
    for extent in [columns.worst.unwrap(), columns.odd[0].extent] {
        assert!(extent.x <= 96 && extent.x + extent.width >= 112, "{extent:?}");
    }
    assert!(columns.odd.iter().all(|odd| odd.extent == columns.odd[0].extent && odd.p < 1e-3));
}

#[test]
fn a_displacement_by_half_a_pixel_is_found_at_the_edges() {
    let reference = render(0.02, 1, right);
    let moved = |x: usize, y: usize, _: f64| 0.5 * (scene(x, y) + scene(x.saturating_sub(1), y));
    rejecting(&judged(&render(0.1, 2, moved), &reference), Pattern::Edges);
}

#[test]
fn what_no_picture_holds_fails_without_statistics() {
    let reference = render(0.1, 1, right);
    let mut broken = reference.clone();
    broken.pixels[700] = [f32::NAN; 3];
    let report = judged(&broken, &reference);
    assert_eq!(report.verdict, Verdict::Fail);
    assert_eq!(report.impossible.unwrap().pixels, 1);
    let mut counted = vec![true; SIDE * SIDE];
    counted[700] = false;
    let masked = judge_difference(Sample::of(&broken), Sample::of(&reference), Some(&counted));
    assert_eq!(masked.verdict, Verdict::Pass, "{masked:#?}");
}

#[test]
fn single_pixels_are_found_where_the_noise_is_known() {
    let variance = |amount: f64| {
        Image::from_fn(SIDE, SIDE, |x, y| {
            let deviation = amount * scene(x, y);
            [1.0, 0.7, 0.4].map(|share| ((share * deviation).powi(2)) as f32)
        })
    };
    let known = [variance(0.05), variance(0.02)];
    let reference = render(0.02, 1, right);
    let sample = |image, variance| Sample { image, variance: Some(variance), rounding: None };
    let good = render(0.05, 2, right);
    let report = judge_difference(sample(&good, &known[0]), sample(&reference, &known[1]), None);
    assert_eq!(report.outliers, None, "bright pixels are left to skewed noise");
    let mut dead = good.clone();
    for pixel in 0..20 {
        dead.pixels[pixel * 3001] = [0.0; 3];
    }
    let report = judge_difference(sample(&dead, &known[0]), sample(&reference, &known[1]), None);
    // One beside a bright edge may pass for noise of its neighbours.
    let found = report.outliers.unwrap().pixels;
    assert!(report.verdict == Verdict::Fail && (18..=20).contains(&found), "{found}");
}

#[test]
fn pictures_that_are_too_small_prove_nothing_and_equal_ones_are_equal() {
    let [a, b] = [Image::new(4, 4, [0.5; 3]), Image::new(4, 4, [0.6; 3])];
    assert_eq!(judged(&a, &b).verdict, Verdict::Inconclusive);
    assert!(judged(&a, &a).equal);
}
