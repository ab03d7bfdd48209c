//! Structural similarity at several sizes (Wang, Simoncelli, Bovik, "Multi-Scale Structural
//! Similarity for Image Quality Assessment", 2003): contrast and pattern at every size, brightness
//! at the coarsest.

use super::pair::{Pair, Plane};
use super::ssim::{RADIUS, mean_of_planes, similarity};

/// Weights of the sizes, from the finest to the coarsest: table 1 of the paper.
const WEIGHTS: [f64; 5] = [0.0448, 0.2856, 0.3001, 0.2363, 0.1333];

/// SSIM as seen from farther and farther away: the weighted geometric mean over five sizes, each half of the one
/// before; over fewer, where the image has no room for five.
pub(super) fn multi_scale_similarity(pair: &Pair<'_>) -> f64 {
    mean_of_planes(pair, |image, reference| multi_scale(image.clone(), reference.clone()))
}

fn multi_scale(mut image: Plane, mut reference: Plane) -> f64 {
    let weights = weights(image.width.min(image.height));
    let mut product = 1.0;
    for (scale, weight) in weights.iter().enumerate() {
        if scale > 0 {
            (image, reference) = (image.halved(), reference.halved());
        }
        let found = similarity(&image, &reference);
        let likeness = if scale + 1 == weights.len() { found.whole } else { found.pattern };
        // Opposite patterns have a negative likeness, which has no power; not `max`, which would
        // lose a NaN.
        product *= if likeness < 0.0 { 0.0 } else { likeness.powf(*weight) };
    }
    product
}

/// The weights of as many sizes as have room for a window, summing to one.
fn weights(shortest_side: usize) -> Vec<f64> {
    let has_room = |scale: &usize| shortest_side >> scale > 2 * RADIUS;
    let scales = (0..WEIGHTS.len()).take_while(has_room).count().max(1);
    let sum: f64 = WEIGHTS[..scales].iter().sum();
    WEIGHTS[..scales].iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::super::ssim::tests::plane;
    use super::*;

    #[test]
    fn it_is_what_scikit_image_gives_size_by_size() {
        // Written by tests/fixtures/ssim/make.py: five sizes and three.
        for (width, height, expected) in [(200, 180, 0.979_957_234), (64, 48, 0.973_790_057)] {
            let found = multi_scale(plane(width, height, 1.0), plane(width, height, 0.0));
            assert!((found - expected).abs() < 1e-5, "{found}, {expected}");
        }
    }

    fn wave(shift: f32) -> Plane {
        let values = (0..200 * 180).map(|i| {
            let (x, y) = ((i % 200) as f32, (i / 200) as f32);
            0.5 + 0.3 * ((x + shift) / 9.0).sin() * (y / 11.0).cos()
        });
        Plane { width: 200, height: 180, values: values.collect() }
    }

    #[test]
    fn there_are_as_many_sizes_as_have_room() {
        for (side, scales) in [(5, 1), (11, 1), (22, 2), (176, 5), (1080, 5)] {
            let weights = weights(side);
            assert_eq!(weights.len(), scales, "{side}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn fine_noise_counts_less_than_at_one_size() {
        let reference = wave(0.0);
        let mut image = reference.clone();
        image.values.iter_mut().enumerate().for_each(|(i, value)| {
            *value += if (i / 200 + i % 200) % 2 == 0 { 0.05 } else { -0.05 };
        });
        let single = similarity(&image, &reference).whole;
        let multiple = multi_scale(image, reference);
        assert!(single < 0.8 && multiple > 0.9, "{single}, {multiple}");
    }

    #[test]
    fn opposite_patterns_are_not_alike_at_all() {
        let reference = wave(0.0);
        let mut image = reference.clone();
        image.values.iter_mut().for_each(|value| *value = 1.0 - *value);
        assert_eq!(multi_scale(image, reference), 0.0);
    }
}
