//! From the images of figures to PNG files for people: all of one scene with one exposure.

use super::store::{FIGURES, Figure, Store};
use super::{Row, WriteupError};
use crate::image::encoding::{Curve, Encoding};
use crate::image::heatmap::{Scale, heatmap};
use crate::image::png::{self, Picture};
use crate::image::tonemap::tonemap;
use crate::image::{Image, exr, luminance};
use crate::render::{SAMPLES, Shot};
use std::collections::BTreeMap;

/// What the median of an image's light is brought to: a light source in view is few pixels, and no matter how bright.
const MIDDLE_GREY: f64 = 0.18;

/// An image as people see it.
pub(super) struct Developed {
    /// Beside the page.
    pub(super) address: String,
    pub(super) png: Vec<u8>,
}

/// What a figure's image has in its file.
struct Read {
    image: Image,
    samples: Option<Vec<f32>>,
}

/// Brightening of the images of each scene, powers of two.
pub(super) type Exposures = BTreeMap<String, f32>;

pub(super) fn exposures<'a>(
    store: &Store,
    rows: impl Iterator<Item = &'a Row<Figure>>,
) -> Exposures {
    let mut best: BTreeMap<String, (u64, &Figure)> = BTreeMap::new();
    for row in rows {
        let (Some(shot), Ok(figure)) = (&row.shot, &row.result) else { continue };
        let weight = brightness_rank(shot);
        let old = best.get(&shot.scene).map_or(0, |(rank, _)| *rank);
        if weight > old {
            best.insert(shot.scene.clone(), (weight, figure));
        }
    }
    let stops = |figure: &Figure| read(store, figure).map_or(0.0, |read| half_stops(&read.image));
    best.into_iter().map(|(scene, (_, figure))| (scene, stops(figure))).collect()
}

/// The image with the most bounces, and then the most samples, says how bright a scene is; normals say nothing.
fn brightness_rank(shot: &Shot) -> u64 {
    let bounces = shot.bounces.as_ref().filter(|bounces| *bounces.start() == 0);
    let last = bounces.map_or(0, |bounces| 1 + u64::from(*bounces.end()));
    if shot.normals { 0 } else { (last << 32) + u64::from(shot.spp) }
}

/// The exposure that shows the median of what is lit as middle grey.
#[expect(clippy::cast_possible_truncation, reason = "half stops are exact")]
fn half_stops(image: &Image) -> f32 {
    let mut lit: Vec<_> = image.pixels.iter().map(|pixel| luminance(*pixel)).collect();
    lit.retain(|light| light.is_finite() && *light > 0.0);
    if lit.is_empty() {
        return 0.0;
    }
    let middle = lit.len() / 2;
    let (_, median, _) = lit.select_nth_unstable_by(middle, f64::total_cmp);
    ((MIDDLE_GREY / *median).log2() * 2.0).round() as f32 / 2.0
}

fn read(store: &Store, figure: &Figure) -> Option<Read> {
    let file = exr::read(&store.path(&figure.file)).ok()?;
    let samples = file.channel(SAMPLES).ok().map(|channel| channel.values.clone());
    Some(Read { image: file.image().ok()?, samples })
}

/// The images of a figure: itself, and of adaptive sampling the samples of each pixel.
///
/// # Errors
/// If they cannot be read or written.
pub(super) fn developed(
    store: &Store,
    figure: &Figure,
    shot: &Shot,
    stops: f32,
) -> Result<Vec<Developed>, WriteupError> {
    let path = store.path(&figure.file);
    let Some(name) = figure.file.strip_suffix(".exr") else {
        return Ok(vec![as_it_is(store, figure)?]);
    };
    let Some(read) = read(store, figure) else {
        return Err(WriteupError::new(&path, &"it is no image; --fresh makes it again"));
    };
    let picture = if shot.normals { linear(&read.image) } else { tonemap(&read.image, stops) };
    let mut images = vec![develop(store, &format!("{name}.png"), &picture)?];
    if let Some(samples) = &read.samples {
        let most = f64::from(shot.spp);
        let values: Vec<_> = samples.iter().map(|samples| f64::from(*samples)).collect();
        let rates = heatmap(&values, read.image.width, Scale::Magnitude { limit: most }, 1);
        images.push(develop(store, &format!("{name}-rate.png"), &rates)?);
    }
    Ok(images)
}

/// Values as codes, without a curve.
fn linear(image: &Image) -> Picture {
    Encoding::of(Curve::Linear).picture(image)
}

fn develop(store: &Store, file: &str, picture: &Picture) -> Result<Developed, WriteupError> {
    let path = store.path(file);
    let png = png::encode(picture).map_err(|error| WriteupError::new(&path, &error))?;
    crate::disk::replace(&path, &png).map_err(|error| WriteupError::new(&path, &error))?;
    let address = format!("{FIGURES}/{file}");
    Ok(Developed { address, png })
}

/// 8 bits, as the core has written them.
fn as_it_is(store: &Store, figure: &Figure) -> Result<Developed, WriteupError> {
    let path = store.path(&figure.file);
    let png = std::fs::read(&path).map_err(|error| WriteupError::new(&path, &error))?;
    let address = format!("{FIGURES}/{}", figure.file);
    Ok(Developed { address, png })
}
