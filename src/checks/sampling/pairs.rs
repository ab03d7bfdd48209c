//! Pairs of consecutive samples, counted in cells, and how they are correlated.

use super::distribution::{Distribution, Drawn};
use crate::checks::{Context, Result};
use crate::contract::Sampler;
use crate::math::rng::Seed;
use crate::stats::{CountReport, Counts};
use glam::DVec3;
use std::f64::consts::TAU;

/// Parts of each of the three numbers that are counted.
const PARTS: usize = 8;

pub(super) const CELLS: usize = PARTS * PARTS * PARTS;

pub(super) const fn sampler_of(distribution: &Distribution) -> Option<Sampler> {
    match distribution {
        Distribution::Sampler(sampler) => Some(*sampler),
        Distribution::Bsdf { .. } => None,
    }
}

/// Height and azimuth of a direction as two numbers that are even from 0 to 1.
fn even_numbers(sampler: Option<Sampler>, direction: DVec3) -> [f64; 2] {
    let height = match sampler {
        Some(Sampler::CosineHemisphere) => direction.z * direction.z,
        _ => direction.z,
    };
    [height, (direction.y.atan2(direction.x) / TAU).rem_euclid(1.0)]
}

pub(super) fn count_pairs(
    context: &mut Context<'_>,
    distribution: &Distribution,
    seed: Seed,
    pairs: u64,
) -> Result<Counts> {
    let sampler = sampler_of(distribution);
    let part = |number: f64| ((number * PARTS as f64) as usize).min(PARTS - 1);
    let mut counts = Counts { cells: vec![0; CELLS], absorbed: 0 };
    distribution.draw(context.core, seed, 2 * pairs, |drawn: &[Drawn]| {
        for pair in drawn.chunks_exact(2) {
            let [Some(first), Some(second)] = [pair[0].direction, pair[1].direction] else {
                counts.absorbed += 1;
                continue;
            };
            let [height, azimuth] = even_numbers(sampler, first).map(part);
            let [next, _] = even_numbers(sampler, second).map(part);
            counts.cells[(height * PARTS + azimuth) * PARTS + next] += 1;
        }
    })?;
    Ok(counts)
}

/// Pearson's coefficient of two of the three numbers, from the counts.
pub(super) fn correlation(report: &CountReport, [a, b]: [usize; 2]) -> f64 {
    let place = |cell: usize| [cell / (PARTS * PARTS), cell / PARTS % PARTS, cell % PARTS];
    let total: f64 = report.observed.iter().map(|count| *count as f64).sum();
    let mean = |of: &dyn Fn([usize; 3]) -> f64| {
        let sum = report.observed.iter().enumerate();
        sum.map(|(cell, count)| *count as f64 * of(place(cell))).sum::<f64>() / total
    };
    let means = [a, b].map(|number| mean(&|place| place[number] as f64));
    let off = |place: [usize; 3], i: usize| place[[a, b][i]] as f64 - means[i];
    let product = |i, j| mean(&|place| off(place, i) * off(place, j));
    product(0, 1) / (product(0, 0) * product(1, 1)).sqrt()
}

/// The three pairs of numbers, and what relates them.
const PAIRS: [([usize; 2], &str); 3] = [
    ([0, 1], "height and azimuth of a sample"),
    ([0, 2], "the heights of consecutive samples"),
    ([1, 2], "the azimuth of a sample and the height of the next"),
];

pub(super) fn strongest(report: &CountReport) -> (f64, &'static str) {
    let all = PAIRS.map(|(pair, what)| (correlation(report, pair), what));
    all.into_iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or((0.0, ""))
}
