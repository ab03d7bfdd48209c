//! What X² may be where the samples of a call depend on each other.
//!
//! Nobody promises that they do not: low discrepancy, strata and antithetic pairs follow a pdf as well. X² is then a sum of
//! squares of normals of any variances, and not χ². Batches with seeds of their own are independent of each other whatever
//! goes on within them, so that their differences tell the mean and the variance of that sum, and Satterthwaite's
//! approximation its tail (Rao and Scott 1981, for samples in clusters).

use crate::stats::law::fisher_upper;

/// What X² exceeds with probability `level`, by batches of one size: for each its counts over the roots of those that
/// all of them together should have. Nothing without two pairs of them, or if all are alike.
pub(super) fn critical(level: f64, batches: &[Vec<f64>]) -> Option<f64> {
    let differences: Vec<Vec<f64>> =
        batches.chunks_exact(2).map(|pair| difference(&pair[0], &pair[1])).collect();
    let pairs = differences.len() as f64;
    let squares: f64 = differences.iter().map(|one| product(one, one)).sum();
    let crossed: f64 = differences
        .iter()
        .enumerate()
        .flat_map(|(number, one)| {
            differences[..number].iter().map(move |other| product(one, other))
        })
        .map(|product| product * product)
        .sum();
    // A difference has twice the variance of a batch, and all of them together that of each added up.
    let scale = batches.len() as f64 / 2.0;
    let mean = scale * squares / pairs;
    let half_variance = scale * scale * crossed / (pairs * (pairs - 1.0) / 2.0);
    let cells = batches.first().map_or(0, Vec::len) as f64;
    let freedom = (mean * mean / half_variance).clamp(1.0, (cells - 1.0).max(1.0));
    (pairs >= 2.0 && mean > 0.0).then(|| mean * fisher_upper(level, freedom, freedom * pairs))
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
