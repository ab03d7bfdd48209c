//! Single pixels: values that no picture has, and, where variances are known, pixels that are
//! darker than noise makes them.

use super::{OddPixels, Sample};
use crate::image::Image;
use crate::stats::{Band, Impossible, normal_upper};

/// Probability that any pixel of two pictures of the same thing stands out.
const PIXEL_LEVEL: f64 = 1e-9;
/// A pixel's variance is no smaller than the mean over neighbours this far away: of few samples, a
/// pixel that happened to be dark happened to vary little, too.
const REACH: usize = 2;

/// The first impossible value among the pixels that count, and how many there are.
pub(super) fn impossible(image: &Image, counted: Option<&[bool]>) -> Option<OddPixels> {
    let counts = |pixel: usize| counted.is_none_or(|counted| counted[pixel]);
    let (kind, [x, y], pixels) = Impossible::first_in(image, counts)?;
    Some(OddPixels { impossible: Some(kind), x, y, pixels, sigmas: None })
}

/// Pixels that are darker than the known noise of both allows in any of them. Light is never
/// negative, so its noise has a shorter tail towards darkness than a normal law; towards brightness
/// it has a longer one, and single bright pixels prove nothing.
pub(super) fn outliers(
    picture: Sample<'_>,
    reference: Sample<'_>,
    counted: Option<&[bool]>,
) -> Option<OddPixels> {
    let variances = [picture.variance?, reference.variance?];
    let [image, expected] = [picture.image, reference.image];
    let critical = normal_upper(PIXEL_LEVEL / (3 * image.pixels.len()) as f64);
    let around = variances.map(neighbourhood);
    let sigmas = |pixel: usize| {
        let of_channel = |c: usize| {
            let noise = |i: usize| around[i].pixels[pixel][c].max(variances[i].pixels[pixel][c]);
            let steps = [picture, reference]
                .map(|sample| sample.rounding.map_or(0.0, |steps| steps.pixels[pixel][c]));
            let level = f64::from(expected.pixels[pixel][c]);
            let band = Band::RADIANCE.relative() * level + f64::from(steps[0] + steps[1]);
            let difference = f64::from(image.pixels[pixel][c]) - level;
            let outside = (difference + band).min(0.0);
            let error = f64::from(noise(0) + noise(1)).sqrt();
            if outside == 0.0 { 0.0 } else { outside / error }
        };
        (0..3).map(of_channel).fold(0.0, f64::min)
    };
    let counts = |pixel: usize| counted.is_none_or(|counted| counted[pixel]);
    let all = (0..image.pixels.len()).filter(|pixel| counts(*pixel));
    let odd: Vec<_> = all.map(|i| (i, sigmas(i))).filter(|(_, s)| *s < -critical).collect();
    let (worst, sigmas) = odd.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (x, y) = (worst % image.width, worst / image.width);
    let sigmas = Some(sigmas.clamp(-1e9, 1e9));
    Some(OddPixels { impossible: None, x, y, pixels: odd.len(), sigmas })
}

/// The mean over the neighbours of each pixel.
fn neighbourhood(image: &Image) -> Image {
    Image::from_fn(image.width, image.height, |x, y| {
        let around = |at: usize, end: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(end);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for row in around(y, image.height) {
            for pixel in &image.pixels[row * image.width..][around(x, image.width)] {
                sum = std::array::from_fn(|c| sum[c] + pixel[c]);
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    })
}
