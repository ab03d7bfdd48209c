//! Pictures that are displaced or magnified, to a hundredth of a pixel.

use super::normal::{Sums, estimates, solve};
use super::question::Question;
use super::resample::{Axis, Resampled, resampled};
use super::{Misfit, question};
use crate::image::filter::{PaddedRow, along, down};
use crate::image::pair::Plane;
use crate::image::{Image, luminance};
use rayon::prelude::*;

/// Whole pixels that are tried in each direction at every size of the search.
const REACH: isize = 3;
/// The search begins with pictures whose shortest side is about this long.
const COARSEST: usize = 24;
/// Steps of Gauss and Newton; each doubles the digits.
const STEPS: usize = 12;
/// A step shorter than this, in pixels at the border of the picture, is the last.
const CONVERGED: f64 = 1e-4;
/// Relative slope a pixel from where on an edge says no more for being sharper: what pixels make of
/// it depends on where they cut it, and no interpolation knows. Else one emitter in view would decide.
const SHARP: f64 = 0.2;
/// What interpolation is not exact to, pixels.
const ALLOWANCE: f64 = 0.01;

/// Where the picture lies: displacement to the right and down, magnification along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    displaced: [f64; 2],
    magnified: [f64; 2],
}

impl Place {
    fn axes(self, [width, height]: [usize; 2]) -> [Axis; 2] {
        [
            Axis::new(width, self.displaced[0], self.magnified[0]),
            Axis::new(height, self.displaced[1], self.magnified[1]),
        ]
    }
}

/// The reference displaced, and displaced and magnified, as fits the picture best.
pub(super) fn candidates(question: &Question<'_>, consider: &mut dyn FnMut((Misfit, Image))) {
    let size = question.image.size();
    if size[0].min(size[1]) < 2 * question::UNIT {
        return;
    }
    let [image, reference] =
        [question.image, question.reference].map(|image| smoothed(&grey(image)));
    let start = whole_pixels(&image, &reference, question.weights);
    let few = question.thin();
    let seen = Seen { question: &few, image: &image, reference: &reference };
    let Some((place, errors)) = seen.displaced(start) else { return };
    let mut consider_moved = |misfit, place: Place| {
        let moved = Resampled::new(question.reference, place.axes(size));
        if question.is_worth_a_look(|pixel| moved.pixel(pixel)) {
            consider((misfit, moved.image()));
        }
    };
    let [right, down] = estimates(place.displaced, errors, [ALLOWANCE; 2]);
    consider_moved(Misfit::Displaced { right, down }, place);
    let Some((place, errors)) = seen.magnified(place) else { return };
    let values = [place.displaced[0], place.displaced[1], place.magnified[0], place.magnified[1]];
    let allowance = [ALLOWANCE, ALLOWANCE, ALLOWANCE / size[0] as f64, ALLOWANCE / size[1] as f64];
    let [right, down, across, upright] = estimates(values, errors, allowance);
    consider_moved(Misfit::Magnified { across, upright, right, down }, place);
}

fn grey(image: &Image) -> Plane {
    #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
    let values = image.pixels.par_iter().map(|pixel| luminance(*pixel) as f32).collect();
    Plane { width: image.width, height: image.height, values }
}

/// The plane without its finest detail: what pixels cut off at their edges looks different at every
/// offset, and no interpolation makes one of the other.
fn smoothed(plane: &Plane) -> Plane {
    const WEIGHTS: [f32; 5] = [0.0625, 0.25, 0.375, 0.25, 0.0625];
    const RADIUS: usize = WEIGHTS.len() / 2;
    let (width, height) = (plane.width, plane.height);
    let mut values = vec![0.0; width * height];
    values.par_chunks_mut(width).enumerate().for_each_init(
        || PaddedRow::new(width, RADIUS),
        |padded, (y, out)| {
            // The border goes on beyond it.
            let row = |tap: usize| plane.row((y + tap).saturating_sub(RADIUS).min(height - 1));
            down(
                &WEIGHTS,
                &std::array::from_fn::<_, { WEIGHTS.len() }, _>(row),
                padded.inside_mut(),
            );
            padded.repeat_ends();
            along(&WEIGHTS, padded, out);
        },
    );
    Plane { width, height, values }
}

/// Both pictures in grey.
struct Seen<'a> {
    question: &'a Question<'a>,
    image: &'a Plane,
    reference: &'a Plane,
}

impl Seen<'_> {
    /// The best displacement near `start`, with its standard errors; none if it runs away.
    fn displaced(&self, start: [isize; 2]) -> Option<(Place, [f64; 2])> {
        let displaced = start.map(|pixels| pixels as f64);
        let mut place = Place { displaced, magnified: [1.0; 2] };
        let mut errors = [0.0; 2];
        for _ in 0..STEPS {
            let step;
            (step, errors) = solve(&self.sums(place, |[x, y], _| [x, y]))?;
            place.displaced = [place.displaced[0] + step[0], place.displaced[1] + step[1]];
            if step.iter().all(|step| step.abs() < CONVERGED) {
                break;
            }
        }
        let near = |i: usize| (place.displaced[i] - displaced[i]).abs() <= REACH as f64;
        (near(0) && near(1)).then_some((place, errors))
    }

    /// The best displacement and magnification near `start`, with their standard errors.
    fn magnified(&self, start: Place) -> Option<(Place, [f64; 4])> {
        let (mut place, mut errors) = (start, [0.0; 4]);
        let border = 0.5 * self.image.width.max(self.image.height) as f64;
        for _ in 0..STEPS {
            let scale = place.magnified;
            let slopes = |[x, y]: [f64; 2], [right, down]: [f64; 2]| {
                [x, y, x * right / scale[0], y * down / scale[1]]
            };
            let step: [f64; 4];
            (step, errors) = solve(&self.sums(place, slopes))?;
            for axis in 0..2 {
                place.displaced[axis] += step[axis];
                place.magnified[axis] += step[2 + axis];
            }
            let moved = |i: usize| step[i].abs() * if i < 2 { 1.0 } else { border };
            if (0..4).all(|i| moved(i) < CONVERGED) {
                break;
            }
        }
        let sane = |i: usize| (0.5..=2.0).contains(&place.magnified[i]);
        (sane(0) && sane(1)).then_some((place, errors))
    }

    /// The sums of every unit at a place. `slopes` makes of the two slopes of a displacement, and
    /// of how far the pixel is from the middle, the slopes of all parameters.
    fn sums<const N: usize>(
        &self,
        place: Place,
        slopes: impl Fn([f64; 2], [f64; 2]) -> [f64; N] + Sync,
    ) -> Vec<Sums<N>> {
        let (width, height) = (self.image.width, self.image.height);
        let [across, down] = place.axes([width, height]);
        let moved = resampled(self.reference, across, down);
        let middle = [0.5 * (width as f64 - 1.0), 0.5 * (height as f64 - 1.0)];
        self.question.fold_units(Sums::NOTHING, |sums, pixel| {
            let (x, y) = (pixel % width, pixel / width);
            let weight = f64::from(self.question.weights[pixel]);
            let inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            if weight > 0.0 && inside && across.is_inside(x, width) && down.is_inside(y, height) {
                let [left, right] = [moved.values[pixel - 1], moved.values[pixel + 1]];
                let [above, below] = [moved.values[pixel - width], moved.values[pixel + width]];
                // Moved to the right, a pixel shows what was to its left.
                let slope = [left - right, above - below].map(|d| 0.5 * weight * f64::from(d));
                let trust =
                    (1.0 + (slope[0].powi(2) + slope[1].powi(2)) / SHARP.powi(2)).sqrt().recip();
                let slope = slope.map(|slope| trust * slope);
                let from_middle = [
                    x as f64 - middle[0] - place.displaced[0],
                    y as f64 - middle[1] - place.displaced[1],
                ];
                let (a, b) = (self.image.values[pixel], moved.values[pixel]);
                let difference = f64::from(self.question.difference(pixel, a, b));
                sums.add(slopes(slope, from_middle), trust * difference);
            }
        })
    }
}

/// The displacement in whole pixels that fits best, from coarse pictures to the finest.
fn whole_pixels(image: &Plane, reference: &Plane, weights: &[f32]) -> [isize; 2] {
    let weights = Plane { values: weights.to_vec(), ..*image };
    let mut sizes = vec![[image.clone(), reference.clone(), weights]];
    while let Some(last) = sizes.last()
        && last[0].width.min(last[0].height) >= 2 * COARSEST
    {
        let smaller = [last[0].halved(), last[1].halved(), last[2].halved()];
        sizes.push(smaller);
    }
    let mut best = [0, 0];
    for (level, [image, reference, weights]) in sizes.iter().enumerate().rev() {
        // The finest only corrects what the one before could not see.
        let reach = if level + 1 == sizes.len() { REACH } else { 1 };
        let doubled = best.map(|pixels| if level + 1 == sizes.len() { 0 } else { 2 * pixels });
        let offsets = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y]));
        let tried: Vec<_> = offsets
            .map(|[x, y]| [doubled[0] + x, doubled[1] + y])
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|offset| (mismatch(image, reference, weights, offset), offset))
            .collect();
        let least = tried.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best = least.map_or(best, |(_, offset)| *offset);
    }
    best
}

/// The mean squared difference where both overlap, in rows enough for a search.
fn mismatch(image: &Plane, reference: &Plane, weights: &Plane, [right, down]: [isize; 2]) -> f64 {
    let (width, height) = (image.width as isize, image.height as isize);
    let (mut sum, mut count) = (0.0, 0.0);
    let every = (image.values.len() / question::ENOUGH).max(1);
    for y in (down.max(0)..(height + down).min(height)).step_by(every) {
        let row = image.row(y as usize);
        let other = reference.row((y - down) as usize);
        let weights = weights.row(y as usize);
        for x in right.max(0)..(width + right).min(width) {
            let weight = weights[x as usize];
            if weight > 0.0 {
                let difference = weight * (row[x as usize] - other[(x - right) as usize]);
                sum += f64::from(difference.clamp(-1.0, 1.0)).powi(2);
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum / count } else { f64::INFINITY }
}
