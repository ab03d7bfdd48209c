//! Pictures between their pixels: Catmull and Rom's cubic through the four nearest, along each axis.

use crate::image::Image;
use crate::image::pair::Plane;
use rayon::prelude::*;

/// The first of four pixels around a place, and their weights.
type Taps = (isize, [f32; 4]);

/// Which place of the reference is seen at each pixel of an axis: `slope` · pixel + `start`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(super) start: f64,
    pub(super) slope: f64,
}

impl Axis {
    /// An axis of `length` pixels that is magnified about its middle, then displaced.
    pub(super) fn new(length: usize, displaced: f64, magnified: f64) -> Self {
        let middle = 0.5 * (length as f64 - 1.0);
        Self { start: middle - (middle + displaced) / magnified, slope: 1.0 / magnified }
    }

    fn taps(self, pixel: usize) -> Taps {
        let place = self.slope * pixel as f64 + self.start;
        let cell = place.floor();
        #[expect(clippy::cast_possible_truncation, reason = "places are near the picture")]
        let (first, t) = (cell as isize - 1, (place - cell) as f32);
        (first, cubic(t))
    }

    /// Whether the place is in the picture.
    pub(super) fn is_inside(self, pixel: usize, length: usize) -> bool {
        let place = self.slope * pixel as f64 + self.start;
        (0.0..=length as f64 - 1.0).contains(&place)
    }
}

/// Weights of the pixels at −1, 0, 1 and 2 for a place between 0 and 1.
fn cubic(t: f32) -> [f32; 4] {
    let (square, cube) = (t * t, t * t * t);
    [
        0.5 * (-cube + 2.0 * square - t),
        0.5 * (3.0 * cube - 5.0 * square + 2.0),
        0.5 * (-3.0 * cube + 4.0 * square + t),
        0.5 * (cube - square),
    ]
}

/// The plane as seen through both axes; its border goes on beyond it.
pub(super) fn resampled(plane: &Plane, across: Axis, down: Axis) -> Plane {
    let along_rows = Plane { values: resample_rows(plane, across), ..*plane };
    Plane { values: resample_columns(&along_rows, down), ..*plane }
}

/// A picture as seen through both axes; its border goes on beyond it.
pub(super) struct Resampled<'a> {
    image: &'a Image,
    across: Vec<Taps>,
    down: Vec<Taps>,
}

impl<'a> Resampled<'a> {
    pub(super) fn new(image: &'a Image, [across, down]: [Axis; 2]) -> Self {
        let across = (0..image.width).map(|x| across.taps(x)).collect();
        let down = (0..image.height).map(|y| down.taps(y)).collect();
        Self { image, across, down }
    }

    /// What is seen at a pixel.
    pub(super) fn pixel(&self, pixel: usize) -> [f32; 3] {
        let (width, height) = (self.image.width, self.image.height);
        let (left, across) = self.across[pixel % width];
        let (top, down) = self.down[pixel / width];
        let mut seen = [0.0; 3];
        for (y, of_row) in (top..).zip(down) {
            let row = &self.image.pixels[within(y, height) * width..][..width];
            for (x, of_column) in (left..).zip(across) {
                let weight = of_row * of_column;
                let values = row[within(x, width)];
                seen = std::array::from_fn(|c| seen[c] + weight * values[c]);
            }
        }
        seen
    }

    pub(super) fn image(&self) -> Image {
        let pixels = (0..self.image.pixels.len()).into_par_iter();
        Image { pixels: pixels.map(|pixel| self.pixel(pixel)).collect(), ..*self.image }
    }
}

fn resample_rows(plane: &Plane, axis: Axis) -> Vec<f32> {
    let width = plane.width;
    let taps: Vec<_> = (0..width).map(|x| axis.taps(x)).collect();
    let mut out = vec![0.0; plane.values.len()];
    out.par_chunks_mut(width).zip(plane.values.par_chunks(width)).for_each(|(out, row)| {
        for (out, (first, [a, b, c, d])) in out.iter_mut().zip(&taps) {
            let value = |i: isize| row[within(first + i, width)];
            *out = a * value(0) + b * value(1) + c * value(2) + d * value(3);
        }
    });
    out
}

fn resample_columns(plane: &Plane, axis: Axis) -> Vec<f32> {
    let mut out = vec![0.0; plane.values.len()];
    out.par_chunks_mut(plane.width).enumerate().for_each(|(y, out)| {
        let (first, weights) = axis.taps(y);
        for (i, weight) in (0..).zip(weights) {
            let row = plane.row(within(first + i, plane.height));
            out.iter_mut().zip(row).for_each(|(out, value)| *out += weight * value);
        }
    });
    out
}

/// The nearest pixel of the picture.
fn within(place: isize, length: usize) -> usize {
    place.clamp(0, length as isize - 1) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Plane {
        let values = (0..12 * 9).map(|i| (i % 12) as f32 + 100.0 * (i / 12) as f32).collect();
        Plane { width: 12, height: 9, values }
    }

    #[test]
    fn an_axis_that_is_as_it_was_changes_nothing() {
        let (across, down) = (Axis::new(12, 0.0, 1.0), Axis::new(9, 0.0, 1.0));
        assert_eq!(resampled(&ramp(), across, down), ramp());
    }

    #[test]
    fn a_displaced_ramp_is_displaced() {
        let (across, down) = (Axis::new(12, 0.25, 1.0), Axis::new(9, -1.0, 1.0));
        let moved = resampled(&ramp(), across, down);
        assert!((moved.row(3)[6] - (5.75 + 400.0)).abs() < 1e-3);
        assert!(!across.is_inside(0, 12) && across.is_inside(1, 12));
    }

    #[test]
    fn magnification_keeps_the_middle() {
        let across = Axis::new(12, 0.0, 2.0);
        let moved = resampled(&ramp(), across, Axis::new(9, 0.0, 1.0));
        assert!((moved.row(0)[5] - 5.25).abs() < 1e-4 && (moved.row(0)[7] - 6.25).abs() < 1e-4);
    }
}
