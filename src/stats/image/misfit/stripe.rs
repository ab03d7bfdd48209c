//! Columns or rows side by side that are brighter or darker than they should be.

use super::Misfit;
use super::normal::estimates;
use super::question::Question;
use crate::image::Image;
use serde::{Deserialize, Serialize};

/// More of a picture than this share is no stripe.
const WIDEST: f64 = 0.5;
/// Lines on either side of a stripe that have to be as they should.
const BESIDE: usize = 3;
/// No pixel counts for more, where one in a grey of the expected brightness counts for at most 3.
const MOST: f32 = 12.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Lines {
    Columns,
    Rows,
}

/// The stripe that stands out most, with its factor.
pub(super) fn candidates(question: &Question<'_>, consider: &mut dyn FnMut((Misfit, Image))) {
    let [columns, rows] = [Lines::Columns, Lines::Rows];
    let light =
        rayon::join(|| light_of_lines(question, columns), || light_of_lines(question, rows));
    for (lines, light) in [(columns, light.0), (rows, light.1)] {
        let Some([first, last]) = most_unlike(&light) else { continue };
        let stripe = &light[first..=last];
        let [image, reference] =
            [0, 1].map(|which| stripe.iter().map(|line| line[which]).sum::<f64>());
        let value = image / reference;
        let off = stripe.iter().map(|line| (line[0] - value * line[1]).powi(2)).sum::<f64>();
        if !(value > 0.0 && value.is_finite() && is_sharp(&light, [first, last], value)) {
            continue;
        }
        let [factor] = estimates([value], [off.sqrt() / reference], [0.0]);
        let picture = Image::from_fn(question.image.width, question.image.height, |x, y| {
            let line = if lines == Lines::Columns { x } else { y };
            let pixel = question.reference.pixels[y * question.image.width + x];
            let is_in = (first..=last).contains(&line);
            if is_in { pixel.map(|channel| channel * value as f32) } else { pixel }
        });
        consider((Misfit::Stripe { lines, first, last, factor }, picture));
    }
}

/// Whether all lines of a stripe are off like their mean, and those beside it are not: what is off
/// here and there for other reasons ends more softly.
fn is_sharp(light: &[[f64; 2]], [first, last]: [usize; 2], factor: f64) -> bool {
    let share = |line: &[f64; 2]| (line[0] / line[1] - 1.0) / (factor - 1.0);
    let beside = light[first.saturating_sub(BESIDE)..first]
        .iter()
        .chain(light[last + 1..].iter().take(BESIDE));
    light[first..=last].iter().all(|line| (share(line) - 1.0).abs() < 0.5)
        && beside.into_iter().all(|line| share(line).abs() < 0.5)
}

/// The weighted light of each line, in the picture and in the reference.
fn light_of_lines(question: &Question<'_>, lines: Lines) -> Vec<[f64; 2]> {
    let width = question.image.width;
    let count = if lines == Lines::Columns { width } else { question.image.height };
    let mut light = vec![[0.0; 2]; count];
    for (pixel, weight) in question.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        let line = if lines == Lines::Columns { pixel % width } else { pixel / width };
        for (sum, picture) in light[line].iter_mut().zip([question.image, question.reference]) {
            let all: f32 = picture.pixels[pixel].iter().sum();
            // One bright pixel does not make a stripe.
            *sum += f64::from((weight * all).min(MOST));
        }
    }
    light
}

/// First and last line of the stretch with the largest difference over the root of its length.
fn most_unlike(light: &[[f64; 2]]) -> Option<[usize; 2]> {
    let mut before = vec![0.0];
    for line in light {
        before.push(before[before.len() - 1] + line[0] - line[1]);
    }
    let widest = (WIDEST * light.len() as f64) as usize;
    let stretches = (0..light.len())
        .flat_map(|first| (first..light.len().min(first + widest)).map(move |last| [first, last]));
    let unlike = |[first, last]: [usize; 2]| {
        (before[last + 1] - before[first]).abs() / ((last + 1 - first) as f64).sqrt()
    };
    let mut most = (0.0, None);
    for stretch in stretches {
        let here = unlike(stretch);
        if here > most.0 {
            most = (here, Some(stretch));
        }
    }
    most.1
}
