//! An image beside its reference, with what several metrics need of them computed once.

use super::tonemap::{decode_srgb, encode_srgb, exposure_of};
use super::{Image, ImageError, luminance};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Pixels that are summed up together. Fixed, so that sums do not depend on how many threads there
/// are.
const CHUNK: usize = 1 << 14;

/// An image and its reference, of the same size.
#[derive(Debug)]
pub struct Pair<'a> {
    pub(crate) image: &'a Image,
    /// What it is held against.
    pub(crate) reference: &'a Image,
    pub(crate) values: Values,
    shown: OnceLock<Vec<[Plane; 2]>>,
}

/// What the numbers of a pair are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Values {
    /// Linear light.
    Radiance,
    /// Codes over the largest code, as the files of 8-bit images have them and a screen takes them.
    Codes,
}

/// One number for each pixel, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plane {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<f32>,
}

impl Plane {
    /// Row `y` from the top.
    pub(crate) fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..][..self.width]
    }

    /// Means of two by two pixels; a last odd row or column is left out.
    pub(crate) fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let row = |y: usize| {
            let [upper, lower] = [self.row(2 * y), self.row(2 * y + 1)];
            let pairs = upper.chunks_exact(2).zip(lower.chunks_exact(2));
            pairs.map(|(a, b)| 0.25 * (a[0] + a[1] + b[0] + b[1]))
        };
        Self { width, height, values: (0..height).into_par_iter().flat_map_iter(row).collect() }
    }
}

impl<'a> Pair<'a> {
    /// A pair.
    ///
    /// # Errors
    /// If the images differ in size, or have no pixels.
    pub fn new(image: &'a Image, reference: &'a Image) -> Result<Self, ImageError> {
        Self::of(Values::Radiance, image, reference)
    }

    /// The same of codes over the largest code.
    pub(crate) fn of_codes(image: &'a Image, reference: &'a Image) -> Result<Self, ImageError> {
        Self::of(Values::Codes, image, reference)
    }

    fn of(values: Values, image: &'a Image, reference: &'a Image) -> Result<Self, ImageError> {
        let sizes = [image, reference].map(Image::size);
        if sizes[0] != sizes[1] {
            return Err(ImageError::DifferentSizes { sizes });
        }
        if reference.pixels.is_empty() {
            return Err(ImageError::Empty);
        }
        Ok(Self { image, reference, values, shown: OnceLock::new() })
    }

    /// Both as a screen shows them, in [0, 1]; NaN stays NaN. Of codes each channel as it is; of radiance the
    /// luminance at the exposure that suits the reference, clipped to white, sRGB.
    pub(crate) fn shown(&self) -> &[[Plane; 2]] {
        let both = [self.image, self.reference];
        self.shown.get_or_init(|| match self.values {
            Values::Codes => (0..3).map(|c| both.map(|picture| channel(picture, c))).collect(),
            Values::Radiance => {
                let gain = exposure_of(self.reference).exp2();
                vec![both.map(|picture| grey(picture, gain))]
            }
        })
    }

    /// The light that a screen sends out for a value, in [0, 1].
    pub(crate) fn displayed(&self) -> fn(f32) -> f32 {
        match self.values {
            Values::Radiance => |value| value.clamp(0.0, 1.0),
            Values::Codes => |value| decode_srgb(value.clamp(0.0, 1.0)),
        }
    }

    pub(crate) fn mean(&self, error: impl Fn([f32; 3], [f32; 3]) -> f64 + Sync) -> f64 {
        let chunks =
            self.image.pixels.par_chunks(CHUNK).zip(self.reference.pixels.par_chunks(CHUNK));
        let sum = |(image, reference): (&[[f32; 3]], &[[f32; 3]])| -> f64 {
            image.iter().zip(reference).map(|(a, b)| error(*a, *b)).sum()
        };
        let sums: Vec<f64> = chunks.map(sum).collect();
        sums.iter().sum::<f64>() / self.image.pixels.len() as f64
    }

    pub(crate) fn each(&self, error: impl Fn([f32; 3], [f32; 3]) -> f64 + Sync) -> Vec<f64> {
        let pairs = self.image.pixels.par_iter().zip(&self.reference.pixels);
        pairs.map(|(image, reference)| error(*image, *reference)).collect()
    }
}

fn channel(picture: &Image, channel: usize) -> Plane {
    let values = picture.pixels.par_iter().map(|pixel| pixel[channel]).collect();
    Plane { width: picture.width, height: picture.height, values }
}

fn grey(picture: &Image, gain: f32) -> Plane {
    #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
    let shown = |pixel: &[f32; 3]| encode_srgb(gain * luminance(*pixel) as f32);
    let values = picture.pixels.par_iter().map(shown).collect();
    Plane { width: picture.width, height: picture.height, values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_different_size_are_no_pair() {
        let (small, large) = (Image::new(2, 2, [0.0; 3]), Image::new(4, 4, [0.0; 3]));
        let message = Pair::new(&small, &large).unwrap_err().to_string();
        assert_eq!(message, "the images differ in size: 2 × 2 and 4 × 4 pixels");
        assert!(Pair::new(&Image::default(), &Image::default()).is_err());
    }

    #[test]
    fn both_are_shown_at_the_exposure_of_the_reference() {
        let (image, reference) = (Image::new(4, 4, [0.5; 3]), Image::new(4, 4, [1.0; 3]));
        let pair = Pair::new(&image, &reference).unwrap();
        let [[shown, white]] = pair.shown() else { panic!("one plane, of luminance") };
        assert!((shown.values[0] - encode_srgb(0.4)).abs() < 1e-4);
        assert!((white.values[0] - encode_srgb(0.8)).abs() < 1e-4);
    }

    #[test]
    fn a_mean_does_not_depend_on_the_number_of_threads() {
        let image = Image::from_fn(200, 200, |x, y| [(x * 7 + y) as f32 * 0.1; 3]);
        let reference = Image::new(200, 200, [0.3; 3]);
        let pair = Pair::new(&image, &reference).unwrap();
        let mean = || pair.mean(|a, b| f64::from(a[0] - b[0]));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(pool.install(mean).to_bits(), mean().to_bits());
    }
}
