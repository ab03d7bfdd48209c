//! TEMPORARY: samples to a verdict, ladder against bets.
use super::betting::Wager;
use super::*;
use crate::math::rng::{Seed, Stream, uniform};
use std::convert::Infallible;
use std::f64::consts::{FRAC_1_PI, TAU};

struct Law {
    name: &'static str,
    mean: f64,
    largest: Option<f64>,
    sample: fn(&mut Stream) -> f64,
}

fn hemisphere(stream: &mut Stream) -> f64 {
    let cos = 1.0 - uniform(stream);
    let (azimuth, tan) = (TAU * uniform(stream), (1.0 - cos * cos).sqrt() / cos);
    let (x, y) = (1.5 * tan * azimuth.cos(), 1.5 * tan * azimuth.sin());
    if x.abs() < 0.6 && y.abs() < 0.4 { 3.7 * cos } else { 0.0 }
}

const LAWS: [Law; 4] = [
    Law { name: "rectangle by hemisphere, bound known", mean: 0.218_082_888_2, largest: Some(3.7), sample: hemisphere },
    Law { name: "rectangle by hemisphere, no bound", mean: 0.218_082_888_2, largest: None, sample: hemisphere },
    Law { name: "exponential, no bound", mean: 1.0, largest: None, sample: |s| -(1.0 - uniform(s)).ln() },
    Law { name: "uniform 0..2, bound known", mean: 1.0, largest: Some(2.0), sample: |s| 2.0 * uniform(s) },
];

fn claim(law: &Law) -> Claim {
    let claim = Claim::value(law.mean, Band::RADIANCE);
    match law.largest {
        Some(largest) => claim.with_samples_up_to(largest),
        None => claim.with_support(Support::NotNegative),
    }
}

fn ladder(law: &Law, ratio: f64, early: bool, seed: Seed) -> (Verdict, u64, u64) {
    let effort = if early { Effort::new(0.02).deciding_early() } else { Effort::new(0.02) };
    let mut calls = 0;
    let Ok(reports) = judge_means(&[claim(law)], &effort, &mut |draw: Draw| {
        calls += 1;
        let mut stream = draw.seed(seed).stream();
        let sum: f64 = (0..draw.samples).map(|_| ratio * (law.sample)(&mut stream)).sum();
        Ok::<_, Infallible>(vec![sum / draw.samples as f64])
    });
    (reports[0].verdict, reports[0].samples, calls)
}

fn bets(law: &Law, ratio: f64, seed: Seed) -> (Option<Verdict>, u64) {
    let mut wager = Wager::on(&claim(law), 0.02);
    let mut stream = seed.stream();
    for n in 1..=1_000_000 {
        wager.take(ratio * (law.sample)(&mut stream), 1);
        if (n < 5000 || n % 64 == 0) && let Some(v) = wager.verdict() {
            return (Some(v), n);
        }
    }
    (None, 1_000_000)
}

fn median(mut v: Vec<u64>) -> u64 {
    v.sort_unstable();
    v[v.len() / 2]
}

#[test]
#[ignore = "measures"]
fn engines() {
    for law in &LAWS {
        println!("{}", law.name);
        for ratio in [FRAC_1_PI, 0.5, 2.0 / 3.0, 1.0 / 1.1, 0.98, 1.0, 1.02, 1.1, 1.5, 2.0, std::f64::consts::PI] {
            let seeds = || (0..7).map(|s| Seed(s).child(ratio).child(law.name));
            let plain: Vec<_> = seeds().map(|s| ladder(law, ratio, false, s)).collect();
            let early: Vec<_> = seeds().map(|s| ladder(law, ratio, true, s)).collect();
            let alone: Vec<_> = seeds().map(|s| bets(law, ratio, s)).collect();
            println!(
                "  {ratio:.3}: ladder {:?} {} samples {} calls | hurry {:?} {} samples {} calls | bets alone {:?} {}",
                plain[0].0, median(plain.iter().map(|p| p.1).collect()), median(plain.iter().map(|p| p.2).collect()),
                early[0].0, median(early.iter().map(|p| p.1).collect()), median(early.iter().map(|p| p.2).collect()),
                alone[0].0, median(alone.iter().map(|p| p.1).collect()),
            );
        }
    }
}
