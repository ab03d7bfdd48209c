//! Light that a picture lacks, or has once too often: a part of it that was rendered alone.

use super::normal::{Sums, estimates, solve};
use super::question::{self, Question};
use super::{Estimate, Knowledge};
use crate::image::Image;

/// What the noise of the part itself may shift the share by.
const ALLOWANCE: f64 = 0.1;

/// How often a part has to be taken from the reference to make it the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// 1 if the part is missing once, negative if it is there once too often.
    pub missing: Estimate,
    /// The share of the difference that this explains, from 0 to 1, without known noise.
    pub explains: f64,
}

/// By least squares over units of 8 by 8 pixels, each weighted against the brightness around it; none if
/// the part is black.
///
/// # Panics
///
/// If the pictures differ in size.
pub fn share_of_part(
    image: &Image,
    reference: &Image,
    part: &Image,
    knowledge: &Knowledge<'_>,
) -> Option<Share> {
    assert!(image.same_size(reference) && image.same_size(part), "three pictures of one size");
    let weights = question::weights(image, reference, knowledge);
    let question = Question { image, reference, knowledge, weights: &weights, every: 1 };
    // Sums over a unit first: there, noise is small against light.
    let units = question.fold_units([[0.0f64; 3]; 3], |sums, pixel| {
        let weight = f64::from(weights[pixel]);
        if weight > 0.0 {
            for (c, sum) in sums.iter_mut().enumerate() {
                let of = |picture: &Image| f64::from(picture.pixels[pixel][c]);
                sum[0] += weight * of(part);
                sum[1] += weight * (of(reference) - of(image));
                sum[2] += knowledge.standard_error.map_or(0.0, |e| (weight * of(e)).powi(2));
            }
        }
    });
    let sums: Vec<Sums<1>> = units
        .iter()
        .map(|unit| {
            let mut sums = Sums::NOTHING;
            unit.iter().for_each(|[part, lacks, _]| sums.add([*part], *lacks));
            sums
        })
        .collect();
    let ([share], [error]) = solve(&sums)?;
    let parts = || units.iter().flatten();
    let before: f64 = parts().map(|[_, lacks, _]| lacks * lacks).sum();
    let after: f64 = parts().map(|[part, lacks, _]| (lacks - share * part).powi(2)).sum();
    let noise = parts().map(|[_, _, noise]| noise).sum::<f64>().min(after);
    let [missing] = estimates([share], [error], [ALLOWANCE]);
    Some(Share { missing, explains: 1.0 - (after - noise) / (before - noise) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    fn picture(value: impl Fn(f64, f64) -> f64, seed: u64) -> Image {
        let mut stream = Seed(seed).stream();
        Image::from_fn(96, 64, |x, y| {
            let noise = 1.0 + 0.1 * (2.0 * uniform(&mut stream) - 1.0);
            [(noise * value(x as f64, y as f64)) as f32; 3]
        })
    }

    #[test]
    fn a_missing_part_is_measured_and_another_is_not_taken_for_it() {
        let part = |x: f64, _: f64| 0.05 + 0.001 * x;
        let other = |_: f64, y: f64| 0.3 * (0.1 * y).sin().powi(2);
        let whole = |x: f64, y: f64| 1.0 + part(x, y) + other(x, y);
        let reference = picture(whole, 1);
        let image = picture(|x, y| whole(x, y) - part(x, y), 2);
        let share =
            |part: &Image| share_of_part(&image, &reference, part, &Knowledge::default()).unwrap();
        let right = share(&picture(part, 3));
        assert!(right.missing.allows(1.0) && right.explains > 0.5, "{right:?}");
        let wrong = share(&picture(other, 4));
        assert!(!wrong.missing.allows(1.0) || wrong.explains < right.explains, "{wrong:?}");
        let black = Image::new(96, 64, [0.0; 3]);
        assert_eq!(share_of_part(&image, &reference, &black, &Knowledge::default()), None);
    }
}
