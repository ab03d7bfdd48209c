//! FLIP: how different two images look when one flips between them (Andersson et al., "FLIP: A
//! Difference Evaluator for Alternating Images", 2020; "Visualizing Errors in Rendered High Dynamic
//! Range Images", 2021).
//!
//! Both images are blurred as the eye blurs them at 0.7 m from a screen of 3840 pixels and 0.7 m;
//! their colours are compared in a space of even steps; and what differs in edges or points weighs
//! more. The numbers agree with NVIDIA's implementation to 10⁻⁴ in every pixel
//! (tests/fixtures/flip), with one exception on purpose: a pixel that is not finite in one of the
//! images counts as the largest error, 1, and as black for its neighbours.

mod approximate;
mod colour;
mod difference;
mod exposure;
mod weights;

#[cfg(test)]
mod tests;

use super::pair::{Pair, Plane};

/// Mean FLIP of the images as displayed: radiance clipped to [0, 1], codes as those of an sRGB image; from 0 to 1.
pub(super) fn mean_flip(pair: &Pair<'_>) -> f64 {
    mean(&flip(pair))
}

/// Mean FLIP at the exposures from the one that shows the brightest to the one that shows half of
/// the reference, the worst of them for every pixel; from 0 to 1.
pub(super) fn mean_high_dynamic_range_flip(pair: &Pair<'_>) -> f64 {
    mean(&high_dynamic_range_flip(pair))
}

/// FLIP of every pixel, the images as displayed.
pub(crate) fn flip(pair: &Pair<'_>) -> Plane {
    let mut map = blank(pair);
    difference::raise(&mut map, pair, &pair.displayed());
    map
}

/// The largest FLIP of every pixel over the exposures that the reference asks for.
pub(crate) fn high_dynamic_range_flip(pair: &Pair<'_>) -> Plane {
    let mut map = blank(pair);
    for stops in exposure::exposures(pair.reference) {
        let gain = stops.exp2();
        difference::raise(&mut map, pair, &|value| exposure::tone_map(gain * value));
    }
    map
}

fn blank(pair: &Pair<'_>) -> Plane {
    let (width, height) = (pair.image.width, pair.image.height);
    Plane { width, height, values: vec![0.0; width * height] }
}

fn mean(map: &Plane) -> f64 {
    map.values.iter().copied().map(f64::from).sum::<f64>() / map.values.len() as f64
}
