//! Units of 8 by 8 pixels: what each says of the difference, and to which stage it belongs.

use super::{STAGES, Sample};
use crate::image::{Image, luminance};
use crate::stats::Band;
use crate::stats::image::cells::{COMPONENTS, components};
use crate::stats::law::upper_median;
use rayon::prelude::*;

/// Width and height of a unit, pixels.
pub(super) const SIDE: usize = 8;
/// What is measured of a unit: the components of the difference, and how far the luminance follows
/// the slopes of the reference to the right and down.
pub(super) const MEASURES: usize = COMPONENTS + 2;
/// Units with fewer pixels that count say nothing.
const FEWEST_PIXELS: usize = SIDE * SIDE / 2;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    pub(super) column: usize,
    pub(super) row: usize,
    /// Sums of the weighted difference, by measure.
    pub(super) sums: [f64; MEASURES],
    /// How large the sums may be without being wrong.
    pub(super) bands: [f64; MEASURES],
    /// What relative differences are relative to.
    pub(super) scales: [f64; MEASURES],
    /// The variances that the known noise gives the sums.
    pub(super) variances: [f64; MEASURES],
}

impl Unit {
    /// The diagonals take turns.
    pub(super) fn stage(&self) -> usize {
        (self.column + self.row) % STAGES
    }
}

pub(super) struct Units {
    pub(super) all: Vec<Unit>,
}

/// What is known of a pixel.
struct Seen<'a> {
    picture: Sample<'a>,
    reference: Sample<'a>,
    counted: Option<&'a [bool]>,
    width: usize,
    height: usize,
}

impl Units {
    pub(super) fn new(
        picture: Sample<'_>,
        reference: Sample<'_>,
        counted: Option<&[bool]>,
    ) -> Self {
        let (width, height) = (reference.image.width, reference.image.height);
        let (columns, rows) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let seen = Seen { picture, reference, counted, width, height };
        let levels = Levels::new(&seen, columns, rows);
        let places: Vec<_> =
            (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))).collect();
        let unit = |(column, row)| seen.unit(column, row, levels.weight(column, row));
        let all = places.into_par_iter().filter_map(unit).collect();
        Self { all }
    }

    /// Luminance of the picture over that of the reference, both as they are weighted.
    pub(super) fn ratio(&self) -> f64 {
        let sum = |of: &dyn Fn(&Unit) -> f64| self.all.iter().map(of).sum::<f64>();
        let luminance = COMPONENTS - 1;
        1.0 + sum(&|unit| unit.sums[luminance]) / sum(&|unit| unit.scales[luminance])
    }
}

/// How bright the reference is around each unit, without the unit itself: weights that know nothing
/// of the noise they weigh.
struct Levels {
    means: Vec<f64>,
    columns: usize,
    rows: usize,
    typical: f64,
}

impl Levels {
    fn new(seen: &Seen<'_>, columns: usize, rows: usize) -> Self {
        let mean = |unit: usize| {
            let (mut sum, mut count) = (0.0, 0.0);
            for pixel in seen.pixels(unit % columns, unit / columns) {
                sum += luminance(seen.reference.image.pixels[pixel]);
                count += 1.0;
            }
            if count > 0.0 { sum / count } else { f64::NAN }
        };
        let means: Vec<f64> = (0..columns * rows).into_par_iter().map(mean).collect();
        let lit = means.iter().copied().filter(|mean| *mean > 0.0);
        let typical = upper_median(lit).unwrap_or(1.0);
        Self { means, columns, rows, typical }
    }

    fn weight(&self, column: usize, row: usize) -> f64 {
        let around = |centre: usize, end: usize| centre.saturating_sub(1)..(centre + 2).min(end);
        let (mut sum, mut count) = (0.0, 0.0);
        for y in around(row, self.rows) {
            for x in around(column, self.columns) {
                let mean = self.means[y * self.columns + x];
                if (x, y) != (column, row) && !mean.is_nan() {
                    sum += mean.max(0.0);
                    count += 1.0;
                }
            }
        }
        let level = if count > 0.0 { sum / count } else { self.typical };
        self.typical / (level + self.typical)
    }
}

impl Seen<'_> {
    /// The pixels of a unit that count.
    fn pixels(&self, column: usize, row: usize) -> impl Iterator<Item = usize> {
        let columns = column * SIDE..((column + 1) * SIDE).min(self.width);
        let rows = row * SIDE..((row + 1) * SIDE).min(self.height);
        let pixels = rows.flat_map(move |y| columns.clone().map(move |x| y * self.width + x));
        pixels.filter(|pixel| self.counts(*pixel))
    }

    fn counts(&self, pixel: usize) -> bool {
        let finite = |image: &Image| image.pixels[pixel].iter().all(|value| value.is_finite());
        let wanted = self.counted.is_none_or(|counted| counted[pixel]);
        wanted && finite(self.picture.image) && finite(self.reference.image)
    }

    /// What a unit says; none if too few of its pixels count.
    fn unit(&self, column: usize, row: usize, weight: f64) -> Option<Unit> {
        let [sums, bands, scales, variances] = [[0.0; MEASURES]; 4];
        let mut unit = Unit { column, row, sums, bands, scales, variances };
        let mut pixels = 0;
        for pixel in self.pixels(column, row) {
            self.add(&mut unit, pixel, weight);
            pixels += 1;
        }
        (pixels >= FEWEST_PIXELS.min(self.width * self.height)).then_some(unit)
    }

    fn add(&self, unit: &mut Unit, pixel: usize, weight: f64) {
        let of = |image: &Image| components(image.pixels[pixel]);
        let [picture, reference] = [self.picture.image, self.reference.image].map(of);
        let steps = self.sum_of(pixel, |sample| sample.rounding);
        let variance = variances(self.sum_of(pixel, |sample| sample.variance));
        let tolerance = Band::RADIANCE.relative();
        for c in 0..COMPONENTS {
            unit.sums[c] += weight * (picture[c] - reference[c]);
            unit.scales[c] += weight * reference[c];
            unit.bands[c] += weight * (tolerance * reference[c].abs() + steps[c]);
            unit.variances[c] += weight * weight * variance[c];
        }
        let luminance = COMPONENTS - 1;
        let difference = weight * (picture[luminance] - reference[luminance]);
        for (i, slope) in self.slopes(pixel).into_iter().enumerate() {
            let (measure, slope) = (COMPONENTS + i, weight * slope);
            unit.sums[measure] += slope * difference;
            unit.scales[measure] += slope * slope;
            unit.bands[measure] += slope.abs() * weight * steps[luminance]
                + Band::ALIGNMENT.relative() * slope * slope;
            unit.variances[measure] += (slope * weight).powi(2) * variance[luminance];
        }
    }

    /// What both samples say of a pixel, added up; 0 where they say nothing.
    fn sum_of<'b>(
        &'b self,
        pixel: usize,
        of: impl Fn(&Sample<'b>) -> Option<&'b Image>,
    ) -> [f64; COMPONENTS] {
        let value = |sample: &Sample<'b>| {
            of(sample).map_or([0.0; COMPONENTS], |image| components(image.pixels[pixel]))
        };
        let [a, b] = [&self.picture, &self.reference].map(value);
        std::array::from_fn(|c| a[c] + b[c])
    }

    /// How the luminance of the reference changes if it is moved a pixel to the right, and down; 0
    /// at the border. The pixel's own noise is not in it.
    fn slopes(&self, pixel: usize) -> [f64; 2] {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let inside = x > 0 && y > 0 && x + 1 < self.width && y + 1 < self.height;
        let slope = |step: usize| {
            let [before, after] = [pixel - step, pixel + step];
            if !(self.counts(before) && self.counts(after)) {
                return 0.0;
            }
            let level = |pixel: usize| luminance(self.reference.image.pixels[pixel]);
            0.5 * (level(before) - level(after))
        };
        if inside { [slope(1), slope(self.width)] } else { [0.0; 2] }
    }
}

/// Of the luminance, the largest that the channels allow: how their noise hangs together is not
/// known.
fn variances(sum: [f64; COMPONENTS]) -> [f64; COMPONENTS] {
    let [red, green, blue, _] = sum;
    let deviation = 0.2126 * red.sqrt() + 0.7152 * green.sqrt() + 0.0722 * blue.sqrt();
    [red, green, blue, deviation * deviation]
}
