//! FLIP of one exposure: both images blurred and searched for features row by row, then compared
//! pixel by pixel.
//!
//! Filters are separable, and their halves may come in either order: down the columns first, then
//! along the row, so that a thread works on one row of everything at a time.

use super::super::filter::{PaddedRow, along, down};
use super::approximate::power;
use super::colour::{ColourError, grey, opponent};
use super::weights::{Blur, Features};
use crate::image::Image;
use crate::image::pair::{Pair, Plane};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;

/// Rows that a thread takes at a time.
const ROWS: usize = 16;

/// Raises every pixel of `map` to its FLIP, if that is more. `shown` is what becomes of a channel
/// before it is seen: in [0, 1].
pub(super) fn raise(map: &mut Plane, pair: &Pair<'_>, shown: &(impl Fn(f32) -> f32 + Sync)) {
    let pictures = [pair.image, pair.reference].map(|picture| Seen::new(picture, shown));
    let (width, filters) = (map.width, Filters::new());
    let chunks = map.values.par_chunks_mut(ROWS * width).enumerate();
    chunks.for_each_init(
        || [Scratch::new(width), Scratch::new(width)],
        |[image, reference], (chunk, rows)| {
            for (row, errors) in rows.chunks_mut(width).enumerate() {
                let y = chunk * ROWS + row;
                image.filter(&pictures[0], &filters, y);
                reference.filter(&pictures[1], &filters, y);
                raise_row(errors, image, reference, filters.colour);
            }
        },
    );
    mark_bad_pixels(map, pair);
}

/// A pixel that is not finite is as wrong as can be.
fn mark_bad_pixels(map: &mut Plane, pair: &Pair<'_>) {
    let bad = |pixel: &[f32; 3]| !pixel.iter().all(|value| value.is_finite());
    let pixels = pair.image.pixels.iter().zip(&pair.reference.pixels);
    for (error, (image, reference)) in map.values.iter_mut().zip(pixels) {
        if bad(image) || bad(reference) {
            *error = 1.0;
        }
    }
}

/// An image in the colours it is blurred in, and its grey: planes of their own, so that filters
/// read neighbours from neighbouring memory.
struct Seen {
    colours: [Plane; 3],
    grey: Plane,
}

impl Seen {
    fn new(picture: &Image, shown: &(impl Fn(f32) -> f32 + Sync)) -> Self {
        let (width, height) = (picture.width, picture.height);
        let plane = || Plane { width, height, values: vec![0.0; width * height] };
        let mut seen = Self { colours: [plane(), plane(), plane()], grey: plane() };
        let [y, cx, cz] = &mut seen.colours;
        let rows = picture.pixels.par_chunks(width);
        let rows = rows.zip(y.values.par_chunks_mut(width));
        let rows = rows.zip(cx.values.par_chunks_mut(width));
        let rows = rows.zip(cz.values.par_chunks_mut(width));
        let rows = rows.zip(seen.grey.values.par_chunks_mut(width));
        rows.for_each(|((((pixels, y), cx), cz), greys)| {
            for (x, pixel) in pixels.iter().enumerate() {
                let finite = pixel.map(|value| if value.is_finite() { value } else { 0.0 });
                [y[x], cx[x], cz[x]] = opponent(finite.map(shown));
                greys[x] = grey(y[x]);
            }
        });
        seen
    }
}

struct Filters {
    blur: Blur,
    features: Features,
    colour: ColourError,
}

impl Filters {
    fn new() -> Self {
        Self { blur: Blur::new(), features: Features::new(), colour: ColourError::new() }
    }
}

/// One row of one image after all filters, and the room to get there.
struct Scratch {
    wide: PaddedRow,
    term: Vec<f32>,
    /// Y, Cx, Cz as the eye blurs them.
    blurred: [Vec<f32>; 3],
    /// How strong edges and points are.
    edges: Vec<f32>,
    points: Vec<f32>,
}

impl Scratch {
    fn new(width: usize) -> Self {
        let row = || vec![0.0; width];
        Self {
            wide: PaddedRow::new(width, Blur::radius().max(Features::radius())),
            term: row(),
            blurred: [row(), row(), row()],
            edges: row(),
            points: row(),
        }
    }

    fn filter(&mut self, seen: &Seen, filters: &Filters, y: usize) {
        let Filters { blur, features, .. } = filters;
        let [lightness, red_green, blue_yellow] = &seen.colours;
        let [blurred_lightness, blurred_red_green, blurred_blue_yellow] = &mut self.blurred;
        let wide = &mut self.wide;
        both_ways(wide, lightness, y, &blur.lightness, blurred_lightness);
        both_ways(wide, red_green, y, &blur.red_green, blurred_red_green);
        let [first, second] = &blur.blue_yellow;
        both_ways(wide, blue_yellow, y, first, blurred_blue_yellow);
        both_ways(wide, blue_yellow, y, second, &mut self.term);
        add(&self.term, blurred_blue_yellow);
        self.find_features(&seen.grey, features, y);
    }

    fn result(&self, width: usize) -> Filtered<'_> {
        let [y, cx, cz] = &self.blurred;
        Filtered {
            blurred: [&y[..width], &cx[..width], &cz[..width]],
            edges: &self.edges[..width],
            points: &self.points[..width],
        }
    }

    /// The lengths of the gradient and of the second derivatives along the axes.
    fn find_features(&mut self, grey: &Plane, features: &Features, y: usize) {
        let Features { bell, edge, point } = features;
        let Self { wide, term, edges, points, .. } = self;
        columns(wide, grey, y, bell);
        along(edge, wide, edges);
        along(point, wide, points);
        for (derivative, lengths) in [(edge, edges), (point, points)] {
            columns(wide, grey, y, derivative);
            along(bell, wide, term);
            for (length, down) in lengths.iter_mut().zip(&*term) {
                *length = (*length * *length + down * down).sqrt();
            }
        }
    }
}

/// Row `y` of a plane after the same filter down its columns and along its rows.
fn both_ways(wide: &mut PaddedRow, plane: &Plane, y: usize, weights: &[f32], out: &mut [f32]) {
    columns(wide, plane, y, weights);
    along(weights, wide, out);
}

/// Row `y` of a plane after a filter down its columns.
fn columns(wide: &mut PaddedRow, plane: &Plane, y: usize, weights: &[f32]) {
    let radius = weights.len() / 2;
    let neighbour = |i: usize| (y + i).saturating_sub(radius).min(plane.height - 1);
    let rows: Vec<&[f32]> = (0..weights.len()).map(|i| plane.row(neighbour(i))).collect();
    down(weights, &rows, wide.inside_mut());
    wide.repeat_ends();
}

fn add(term: &[f32], sums: &mut [f32]) {
    sums.iter_mut().zip(term).for_each(|(sum, term)| *sum += term);
}

/// The error of every pixel of a row, if it is more than what is there.
fn raise_row(errors: &mut [f32], image: &Scratch, reference: &Scratch, colour: ColourError) {
    let width = errors.len();
    let [image, reference] = [image, reference].map(|scratch| scratch.result(width));
    for (x, error) in errors.iter_mut().enumerate() {
        let of_colour = colour.between(image.colour(x), reference.colour(x));
        let edge = (image.edges[x] - reference.edges[x]).abs();
        let point = (image.points[x] - reference.points[x]).abs();
        let of_features = (FRAC_1_SQRT_2 * edge.max(point)).sqrt();
        let found = power(of_colour, 1.0 - of_features);
        *error = if found > *error { found } else { *error };
    }
}

/// A filtered row, all slices of one length, so that a loop over it needs no checks.
struct Filtered<'a> {
    blurred: [&'a [f32]; 3],
    edges: &'a [f32],
    points: &'a [f32],
}

impl Filtered<'_> {
    #[inline(always)]
    fn colour(&self, x: usize) -> [f32; 3] {
        [self.blurred[0][x], self.blurred[1][x], self.blurred[2][x]]
    }
}
