//! How the light of an 8-bit picture was encoded, by its codes alone.
//!
//! Tiles that are nowhere clipped are compared with the reference under every encoding there is,
//! each with the gain that suits it best: a renderer that is too bright must not be taken for one
//! that encodes differently. Only an encoding that fits where the declared one cannot is believed.

use super::CodeReference;
use super::channel::{TOO_NOISY, believed};
use super::observed::{Observed, Seen};
use crate::image::encoding::{Curve, Encoding, Rounding, WHITE};
use crate::stats::{Band, Moments};
use serde::Serialize;

/// The curves that are looked for.
const CURVES: [Curve; 3] = [Curve::Linear, Curve::Srgb, Curve::Gamma(2.2)];
/// Pixels of a side of a tile.
const TILE: usize = 8;
/// Codes near black are mostly steps, and those near white may be clipped.
const USABLE: std::ops::Range<f64> = 4.0..250.0;
/// Standard deviations that a code keeps from white.
const AWAY_FROM_WHITE: f64 = 4.0;
/// Fewer tiles say nothing.
const FEWEST_TILES: usize = 8;
/// Error of a tile's mean code that its pixels' steps may leave.
const STEPS: f64 = 0.1;
/// By how much the declared encoding has to fit worse, in squared standard errors: chance does that
/// with probability exp(−40) if tiles are independent.
const DECISIVE: f64 = 80.0;
/// Mean squared standard errors of an encoding that fits.
const FITS: f64 = 4.0;
/// Root mean square of log light between tiles below which a constant and a gain look alike.
const FEWEST_TONES: f64 = 0.2;

/// What codes say of their own encoding.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deciphered {
    /// How light is said to be encoded.
    pub(crate) declared: Encoding,
    /// The encoding that fits; none if none does, or too few tiles say anything.
    pub(crate) found: Option<Encoding>,
    /// The power of light that codes follow: 0.45 for 1/2.2, 1 without a curve.
    pub(crate) power: Option<f64>,
    /// Codes by which the picture lies above the declared encoding, with the gain that suits best:
    /// −0.5 is truncation.
    pub(crate) offset: Option<f64>,
    /// Tiles times channels that were compared.
    pub(crate) tiles: usize,
}

impl Deciphered {
    pub(crate) fn is_another(&self) -> bool {
        self.found.is_some_and(|found| found != self.declared)
    }

    /// Whether nothing but the rounding is another: half a code everywhere.
    pub(crate) fn is_rounded_otherwise(&self) -> bool {
        let is_alike = |found: Encoding| found.curve == self.declared.curve;
        self.is_another() && self.found.is_some_and(is_alike)
    }
}

/// Reads the encoding off the codes of pictures.
pub(super) fn decipher(
    reference: CodeReference<'_>,
    observed: &Observed,
    declared: Encoding,
) -> Deciphered {
    let tiles = tiles(reference, observed, declared);
    let mut deciphered =
        Deciphered { declared, found: None, power: None, offset: None, tiles: tiles.len() };
    if tiles.len() < FEWEST_TILES {
        return deciphered;
    }
    deciphered.power = Some(power(&tiles)).filter(|power| power.is_finite());
    deciphered.offset = offset(&tiles, declared).filter(|offset| offset.is_finite());
    deciphered.found = with_gain(&tiles, declared);
    if deciphered.found == Some(declared) && tones(&tiles) > FEWEST_TONES {
        deciphered.found = without_gain(&tiles, declared).or(deciphered.found);
    }
    deciphered
}

/// The encoding that fits, whatever the picture's brightness; the declared one, unless another fits
/// decisively better.
fn with_gain(tiles: &[Tile], declared: Encoding) -> Option<Encoding> {
    let misfit = |encoding: Encoding| Fit::new(encoding, tiles).misfit(tiles);
    let fits = candidates(declared).map(|encoding| (encoding, misfit(encoding)));
    match fits.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((_, best)) if misfit(declared) <= best + DECISIVE => Some(declared),
        Some((encoding, misfit)) if fits_well(misfit, tiles) => Some(encoding),
        _ => None,
    }
}

/// Another encoding that fits as it is, where the declared one does not, and fits no better with
/// a gain to help it: truncation is half a code, which a gain nearly imitates.
fn without_gain(tiles: &[Tile], declared: Encoding) -> Option<Encoding> {
    let misfit = |encoding: Encoding| Fit { encoding, log_gain: 0.0 }.misfit(tiles);
    let helped = Fit::new(declared, tiles).misfit(tiles);
    let fits = candidates(declared).map(|encoding| (encoding, misfit(encoding)));
    let (encoding, best) = fits.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let is_decisive = misfit(declared) > best + DECISIVE && best <= helped;
    (is_decisive && fits_well(best, tiles)).then_some(encoding)
}

fn fits_well(misfit: f64, tiles: &[Tile]) -> bool {
    misfit <= FITS * tiles.len() as f64
}

/// Root mean square of log light between tiles.
fn tones(tiles: &[Tile]) -> f64 {
    let logs: Moments = tiles.iter().map(|tile| tile.mean(|(light, _)| *light).ln()).collect();
    logs.variance().sqrt()
}

/// Every curve, rounded and truncated. The exposure cannot be told from the brightness.
pub(super) fn candidates(declared: Encoding) -> impl Iterator<Item = Encoding> {
    let curves = CURVES.into_iter().chain([declared.curve]);
    curves.flat_map(move |curve| {
        [Rounding::Nearest, Rounding::Down].map(|rounding| Encoding {
            curve,
            rounding,
            exposure: declared.exposure,
        })
    })
}

/// One channel of a tile.
struct Tile {
    pixels: Vec<(f64, Seen)>,
    code: f64,
    /// Of `code`.
    variance: f64,
    /// Relative error of the light.
    light_error: f64,
}

fn tiles(reference: CodeReference<'_>, observed: &Observed, declared: Encoding) -> Vec<Tile> {
    let (width, height) = (reference.mean.width, reference.mean.height);
    let corners = (0..height / TILE).flat_map(|y| (0..width / TILE).map(move |x| (x, y)));
    let places = corners.flat_map(|corner| (0..3).map(move |channel| (corner, channel)));
    let tile = |(corner, channel)| tile(reference, observed, declared, corner, channel);
    places.filter_map(tile).collect()
}

/// A tile, if it can be used: lit everywhere, and nowhere near white or lost in noise.
fn tile(
    reference: CodeReference<'_>,
    observed: &Observed,
    declared: Encoding,
    (column, row): (usize, usize),
    channel: usize,
) -> Option<Tile> {
    let count = (TILE * TILE) as f64;
    let mut tile = Tile { pixels: Vec::new(), code: 0.0, variance: 0.0, light_error: 0.0 };
    for i in 0..TILE * TILE {
        let (x, y) = (column * TILE + i % TILE, row * TILE + i / TILE);
        let pixel = y * reference.mean.width + x;
        let light = f64::from(reference.mean.pixels[pixel][channel]);
        let error = f64::from(reference.standard_error.pixels[pixel][channel]);
        let seen = observed.codes[3 * pixel + channel];
        let is_usable = light > 0.0
            && USABLE.contains(&seen.code)
            && seen.code + AWAY_FROM_WHITE * seen.deviation < WHITE
            && seen.deviation < TOO_NOISY * declared.slope(light);
        if !is_usable {
            return None;
        }
        tile.pixels.push((light, seen));
        tile.code += seen.code / count;
        tile.variance += (seen.error / count).powi(2);
        tile.light_error += (error / light / count).powi(2);
    }
    tile.light_error = tile.light_error.sqrt();
    Some(tile)
}

impl Tile {
    fn mean(&self, value: impl Fn(&(f64, Seen)) -> f64) -> f64 {
        self.pixels.iter().map(value).sum::<f64>() / self.pixels.len() as f64
    }
}

/// An encoding with the gain that suits it best.
struct Fit {
    encoding: Encoding,
    log_gain: f64,
}

impl Fit {
    fn new(encoding: Encoding, tiles: &[Tile]) -> Self {
        let mut fit = Self { encoding, log_gain: 0.0 };
        for _ in 0..8 {
            let (mut up, mut down) = (0.0, 0.0);
            for tile in tiles {
                let slope = fit.slope(tile);
                let weight = fit.variance(tile).recip();
                up += weight * slope * (tile.code - fit.code(tile));
                down += weight * slope * slope;
            }
            fit.log_gain = (fit.log_gain + up / down).clamp(-3.0, 3.0);
        }
        fit
    }

    fn misfit(&self, tiles: &[Tile]) -> f64 {
        let square = |tile: &Tile| (tile.code - self.code(tile)).powi(2) / self.variance(tile);
        let misfit = tiles.iter().map(square).sum::<f64>();
        if misfit.is_nan() { f64::INFINITY } else { misfit }
    }

    /// The mean code that a tile should have.
    fn code(&self, tile: &Tile) -> f64 {
        let gain = self.log_gain.exp();
        tile.mean(|(light, _)| self.encoding.level(gain * light)) - self.shift(tile)
    }

    /// Codes that noise takes from the mean.
    fn shift(&self, tile: &Tile) -> f64 {
        let bend = |seen: &Seen| self.encoding.curve.bend(seen.code / WHITE) / WHITE;
        tile.mean(|(_, seen)| 0.5 * bend(seen) * seen.deviation.powi(2))
    }

    /// Codes for a small relative gain.
    fn slope(&self, tile: &Tile) -> f64 {
        let gain = self.log_gain.exp();
        tile.mean(|(light, _)| self.encoding.slope(gain * light))
    }

    fn variance(&self, tile: &Tile) -> f64 {
        let noise = tile.mean(|(light, seen)| seen.deviation / self.encoding.slope(*light));
        tile.variance
            + STEPS * STEPS
            + (believed(noise) * self.shift(tile)).powi(2)
            + (self.slope(tile) * tile.light_error.max(Band::RADIANCE.relative())).powi(2)
    }
}

/// The constant that the codes lie above an encoding, fitted together with the gain.
fn offset(tiles: &[Tile], encoding: Encoding) -> Option<f64> {
    let mut fit = Fit::new(encoding, tiles);
    let mut offset = 0.0;
    for _ in 0..8 {
        // Normal equations of a constant and a gain.
        let (mut matrix, mut right) = ([0.0; 3], [0.0; 2]);
        for tile in tiles {
            let (weight, slope) = (fit.variance(tile).recip(), fit.slope(tile));
            let left = tile.code - fit.code(tile) - offset;
            matrix = [
                matrix[0] + weight,
                matrix[1] + weight * slope,
                matrix[2] + weight * slope * slope,
            ];
            right = [right[0] + weight * left, right[1] + weight * slope * left];
        }
        let determinant = matrix[0] * matrix[2] - matrix[1] * matrix[1];
        if determinant.is_nan() || determinant <= 1e-9 * matrix[0] * matrix[2] {
            // Tiles of one brightness: a constant cannot be told from a gain.
            return None;
        }
        offset += (right[0] * matrix[2] - right[1] * matrix[1]) / determinant;
        fit.log_gain += (right[1] * matrix[0] - right[0] * matrix[1]) / determinant;
        fit.log_gain = fit.log_gain.clamp(-3.0, 3.0);
    }
    Some(offset)
}

/// The slope of log code on log light.
fn power(tiles: &[Tile]) -> f64 {
    let count = tiles.len() as f64;
    let x = |tile: &Tile| tile.mean(|(light, _)| *light).ln();
    let y = |tile: &Tile| (tile.code / WHITE).ln();
    let mx = tiles.iter().map(x).sum::<f64>() / count;
    let my = tiles.iter().map(y).sum::<f64>() / count;
    let products: f64 = tiles.iter().map(|tile| (x(tile) - mx) * (y(tile) - my)).sum();
    let squares: f64 = tiles.iter().map(|tile| (x(tile) - mx).powi(2)).sum();
    products / squares
}
