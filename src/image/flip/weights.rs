//! The filters of FLIP: what the eye blurs away, and what it sees as edges and points.

use super::super::filter::gaussian;
use std::f64::consts::PI;

/// Pixels in one degree of the visual field: 3840 of them on 0.7 m, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 0.7 * (3840.0 / 0.7) * (PI / 180.0);
/// What an edge is wide, degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// Spreads of the eye's blur in square degrees for light against dark, red against green, and the
/// two terms for blue against yellow with their amplitudes (table 1 of the paper).
const LIGHTNESS_SPREAD: f64 = 0.0047;
const RED_GREEN_SPREAD: f64 = 0.0053;
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// Weights below this share of their sum change no number in single precision.
const NEGLIGIBLE: f32 = f32::EPSILON;

/// One filter of the eye's blur for each of Y, Cx, and the two terms that add up for Cz; each is
/// applied along both axes.
pub(super) struct Blur {
    pub(super) lightness: Vec<f32>,
    pub(super) red_green: Vec<f32>,
    pub(super) blue_yellow: [Vec<f32>; 2],
}

impl Blur {
    pub(super) fn new() -> Self {
        let radius = Self::radius();
        let of_spread = |spread| trimmed(gaussian(deviation(spread), radius));
        Self {
            lightness: of_spread(LIGHTNESS_SPREAD),
            red_green: of_spread(RED_GREEN_SPREAD),
            blue_yellow: blue_yellow(radius),
        }
    }

    /// Three deviations of the widest filter.
    pub(super) fn radius() -> usize {
        let [(_, spread), _] = BLUE_YELLOW;
        (3.0 * deviation(spread)).ceil() as usize
    }
}

/// exp(−π² x² / spread) over degrees is a bell; its deviation in pixels.
fn deviation(spread: f64) -> f64 {
    (spread / 2.0).sqrt() / PI * PIXELS_PER_DEGREE
}

/// Two bells whose squares, the filters of the plane, sum to one together.
#[expect(clippy::cast_possible_truncation, reason = "weights are used in single precision")]
fn blue_yellow(radius: usize) -> [Vec<f32>; 2] {
    let bell = |(amplitude, spread): (f64, f64)| -> Vec<f64> {
        let peak = (amplitude * (PI / spread).sqrt()).sqrt();
        let sigmas = |i: usize| (i as f64 - radius as f64) / deviation(spread);
        (0..=2 * radius).map(|i| peak * (-0.5 * sigmas(i).powi(2)).exp()).collect()
    };
    let bells = BLUE_YELLOW.map(bell);
    let squares: f64 = bells.iter().map(|bell| bell.iter().sum::<f64>().powi(2)).sum();
    bells.map(|bell| bell.iter().map(|weight| (weight / squares.sqrt()) as f32).collect())
}

/// The filter without what no sum would notice.
fn trimmed(weights: Vec<f32>) -> Vec<f32> {
    let ends = weights.iter().take_while(|weight| **weight < NEGLIGIBLE).count();
    weights[ends..weights.len() - ends].to_vec()
}

/// A bell and its first two derivatives. The positive and the negative weights of a derivative each
/// sum to one.
pub(super) struct Features {
    pub(super) bell: Vec<f32>,
    pub(super) edge: Vec<f32>,
    pub(super) point: Vec<f32>,
}

impl Features {
    pub(super) fn new() -> Self {
        let (deviation, radius) = (Self::deviation(), Self::radius());
        let at = |i: usize| (i as f64 - radius as f64) / deviation;
        let bell = |x: f64| (-0.5 * x * x).exp();
        let sampled = |f: &dyn Fn(f64) -> f64| (0..=2 * radius).map(|i| f(at(i))).collect();
        Self {
            bell: gaussian(deviation, radius),
            edge: balanced(sampled(&|x| -x * bell(x))),
            point: balanced(sampled(&|x| (x * x - 1.0) * bell(x))),
        }
    }

    pub(super) fn radius() -> usize {
        (3.0 * Self::deviation()).ceil() as usize
    }

    fn deviation() -> f64 {
        0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE
    }
}

/// Positive weights divided by their sum, negative ones by theirs.
fn balanced(weights: Vec<f64>) -> Vec<f32> {
    let sum = |sign: f64| weights.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let [positive, negative] = [sum(1.0), sum(-1.0)];
    let divided = |weight: &f64| weight / if *weight > 0.0 { positive } else { negative };
    #[expect(clippy::cast_possible_truncation, reason = "weights are used in single precision")]
    weights.iter().map(|weight| divided(weight) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_are_as_wide_as_the_paper_says() {
        assert!((PIXELS_PER_DEGREE - 67.0206).abs() < 1e-3);
        assert_eq!((Blur::radius(), Features::radius()), (10, 9));
    }

    #[test]
    fn a_grey_area_stays_as_it_is() {
        let blur = Blur::new();
        for weights in [&blur.lightness, &blur.red_green] {
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        }
        let squares = blur.blue_yellow.map(|bell| bell.iter().sum::<f32>().powi(2));
        assert!((squares.iter().sum::<f32>() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_flat_area_has_neither_edges_nor_points() {
        let features = Features::new();
        for weights in [&features.edge, &features.point] {
            assert!(weights.iter().sum::<f32>().abs() < 1e-5);
        }
    }

    #[test]
    fn what_is_trimmed_is_negligible() {
        let weights = trimmed(gaussian(1.0, 10));
        assert_eq!(weights.len(), 11);
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
    }
}
