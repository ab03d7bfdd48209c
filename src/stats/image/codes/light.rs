//! What codes say of light, where there is one picture or a few and no more to be had.
//!
//! A code is not decoded. How far it is from the code that the reference foretells, over how fast
//! that grows with light, is how far the light is from the reference: without the darkness that
//! noise, rounding and clipping lend to a decoded picture.

use super::channel::{Channel, Standing};
use super::decipher::{Deciphered, decipher};
use super::law::PixelLaw;
use super::model::Model;
use super::observed::{Observed, Seen};
use super::{CodeReference, Codes};
use crate::image::Image;
use crate::image::encoding::{Encoding, WHITE};
use crate::stats::Moments;
use crate::stats::image::Sample;
use crate::stats::law::Spread;
use serde::Serialize;

/// Fewer pictures say too little of their noise.
const FEWEST_RUNS: usize = 4;
/// Pixels of a side of the tiles that noise is read off, where nothing else tells it.
const TILE: usize = 8;
/// Fewer pixels of a tile tell no noise.
const FEWEST_PIXELS: u64 = 16;
/// Levels of light whose codes scatter freely.
const FREE: std::ops::Range<f64> = 1.0..WHITE;

/// Where the noise of codes is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseSource {
    /// Several pictures.
    Runs,
    /// A picture of the variance.
    Variance,
    /// How the codes of one picture scatter about what is expected, within 8 by 8 pixels.
    Scatter,
}

/// The light behind codes.
#[derive(Clone, Debug)]
pub struct LightOfCodes {
    /// How the light was encoded; if otherwise than declared, nothing else here means anything.
    pub(crate) deciphered: Deciphered,
    pub(crate) noise: NoiseSource,
    /// The light, the mean of all pictures.
    pub(crate) image: Image,
    /// Its variance, if that is known.
    pub(crate) variance: Option<Image>,
    /// By how much the law may be off, the same way everywhere at worst.
    pub(crate) slack: Image,
    /// Which pixels say anything: neither clipped in most pictures nor lost in noise.
    pub(crate) compared: Vec<bool>,
}

impl LightOfCodes {
    /// As the test of a difference takes it.
    pub(in crate::stats) fn sample(&self) -> Sample<'_> {
        let (variance, rounding) = (self.variance.as_ref(), Some(&self.slack));
        Sample { image: &self.image, variance, rounding }
    }
}

/// Reads the light off the codes of pictures of one thing. `variance` is that of every value of
/// their mean, if it is known.
pub(crate) fn light_of_codes(
    reference: CodeReference<'_>,
    pictures: &[&Codes],
    variance: Option<&Image>,
    declared: Encoding,
) -> LightOfCodes {
    let size = (reference.mean.width, reference.mean.height);
    let mut spread = Spread::default();
    for picture in pictures {
        assert_eq!((picture.width, picture.height), size, "all pictures of one size");
        let codes = picture.pixels.as_flattened();
        spread.push(&codes.iter().copied().map(f64::from).collect::<Vec<_>>());
    }
    let runs = pictures.len();
    let (noise, observed) = match variance {
        Some(variance) => {
            (NoiseSource::Variance, known(reference, &spread, runs, variance, declared))
        }
        None if runs >= FEWEST_RUNS => (NoiseSource::Runs, Observed::of_runs(&spread)),
        None => (NoiseSource::Scatter, scattered(reference, &spread, runs, declared)),
    };
    let deciphered = decipher(reference, &observed, declared);
    let model = Model::new(reference, &observed, declared, None);
    let means = reference.mean.pixels.as_flattened();
    let light = |index: usize, channel: &Channel| {
        departed(f64::from(means[index]), spread.mean(index), channel, declared)
    };
    let per_code = |index: usize, channel: &Channel| match channel.slope > 0.0 {
        true => f64::from(means[index]) / channel.slope,
        false => 0.0,
    };
    let error = |index: usize| observed.codes[index].error;
    let is_known = noise != NoiseSource::Scatter;
    let squared = |index, channel: &Channel| (per_code(index, channel) * error(index)).powi(2);
    LightOfCodes {
        deciphered,
        noise,
        image: model.map(light),
        variance: is_known.then(|| model.map(squared)),
        slack: model.map(|index, channel| per_code(index, channel) * channel.slack),
        compared: model.pixels_of(Standing::Compared),
    }
}

/// The light that a code departs to from what is expected of it.
fn departed(mean: f64, code: f64, channel: &Channel, encoding: Encoding) -> f64 {
    match channel.standing {
        Standing::Compared if channel.slope > 0.0 => {
            // Codes far below would be less than darkness. What cutting that off adds is far less
            // than the slack of a pixel so noisy.
            (mean * (1.0 + (code - channel.expected) / channel.slope)).max(0.0)
        }
        // Nothing is expected there: whatever there is, is too much.
        Standing::Compared if code > 0.0 => encoding.edge(code + 0.5),
        _ => mean,
    }
}

/// Noise as a picture of variance has it.
fn known(
    reference: CodeReference<'_>,
    spread: &Spread,
    runs: usize,
    variance: &Image,
    encoding: Encoding,
) -> Observed {
    let means = reference.mean.pixels.as_flattened();
    let seen = |(index, variance): (usize, &f32)| {
        let mean = f64::from(means[index]);
        let law = |variance: f64| PixelLaw { mean, deviation: variance.sqrt() }.codes(encoding);
        let variance = f64::from(*variance);
        let deviation = law(variance * runs as f64).deviation;
        Seen { code: spread.mean(index), error: deviation / (runs as f64).sqrt(), deviation }
    };
    let codes = variance.pixels.as_flattened().iter().enumerate().map(seen).collect();
    Observed { codes, freedom: f64::INFINITY }
}

/// Noise as the scatter of the codes of a tile about their levels has it: what is off by a constant
/// does not count, what differs within a tile does.
fn scattered(
    reference: CodeReference<'_>,
    spread: &Spread,
    runs: usize,
    encoding: Encoding,
) -> Observed {
    let (width, means) = (reference.mean.width, reference.mean.pixels.as_flattened());
    let columns = width.div_ceil(TILE);
    let tile = |index: usize| {
        let (pixel, channel) = (index / 3, index % 3);
        3 * (pixel / width / TILE * columns + pixel % width / TILE) + channel
    };
    let mut tiles = vec![Moments::default(); 3 * columns * reference.mean.height.div_ceil(TILE)];
    for (index, mean) in means.iter().enumerate() {
        let level = encoding.level(f64::from(*mean));
        if FREE.contains(&level) && FREE.contains(&spread.mean(index)) {
            tiles[tile(index)].push(spread.mean(index) - level);
        }
    }
    let seen = |index: usize| {
        let moments = &tiles[tile(index)];
        let is_told = moments.count() >= FEWEST_PIXELS;
        let error = if is_told { moments.variance().sqrt() } else { 0.0 };
        Seen { code: spread.mean(index), error, deviation: error * (runs as f64).sqrt() }
    };
    let codes = (0..means.len()).map(seen).collect();
    Observed { codes, freedom: (TILE * TILE - 1) as f64 }
}
