//! One side of a comparison: a picture, and all that its files say of its noise.

use crate::cli::Failure;
use crate::image::Image;
use crate::image::encoding::{Curve, Encoding};
use crate::image::file::{Loaded, load};
use crate::image::pair::Plane;
use crate::image::png::Picture as Codes;
use crate::scene::reference::{ERROR_PREFIX, Layers};
use crate::stats::{CodeReference, LightOfCodes, Sample, light_of_codes};
use std::path::{Path, PathBuf};

/// Of white, what a pixel may have so that hardly any noise clips it.
const SAFE_FROM_CLIPPING: f32 = 0.5;
/// Fewer renders say too little of their variance.
const FEWEST_RUNS: usize = 4;

/// A picture and how well it is known.
pub(super) struct Side {
    pub image: Image,
    pub alpha: Option<Plane>,
    /// Each bounce alone, where the file holds them.
    pub bounces: Vec<Image>,
    variance: Option<Image>,
    rounding: Option<Image>,
    /// Whether it came from a file of whole numbers.
    pub is_coded: bool,
    /// The codes of every file, if all hold 8 bits.
    codes: Vec<Codes>,
}

impl Side {
    /// One picture, or the mean of several renders.
    pub fn of_runs(
        runs: &[PathBuf],
        encoding: Curve,
        variance: Option<&Path>,
    ) -> Result<Self, Failure> {
        let read = |path: &PathBuf| load(path, Some(encoding)).map_err(Failure::request);
        let mut side = match runs {
            [one] => Self::of(read(one)?),
            _ => Self::mean(&runs.iter().map(read).collect::<Result<Vec<_>, _>>()?)?,
        };
        if let Some(path) = variance {
            let variance = load(path, Some(Curve::Linear)).map_err(Failure::request)?.image;
            side.take_variance(variance, path)?;
        }
        Ok(side)
    }

    fn of(loaded: Loaded) -> Self {
        let rounding = loaded.codes.as_ref().map(|codes| rounding(&loaded, codes.largest));
        let codes = loaded.codes.and_then(|codes| codes.picture).into_iter().collect();
        let errors = loaded.extra.as_ref().and_then(|file| file.colours(ERROR_PREFIX).ok());
        let bounces = loaded.extra.map(|file| Layers::read(&file).bounces).unwrap_or_default();
        let variance = errors.map(|errors| each(&errors, |error| error * error));
        let is_coded = rounding.is_some();
        Self {
            image: loaded.image,
            alpha: loaded.alpha,
            bounces,
            variance,
            rounding,
            is_coded,
            codes,
        }
    }

    fn mean(runs: &[Loaded]) -> Result<Self, Failure> {
        let count = runs.len();
        let (width, height) = (runs[0].image.width, runs[0].image.height);
        if runs.iter().any(|run| run.image.width != width || run.image.height != height) {
            return Err(Failure::request("the renders differ in size"));
        }
        let moments = |x: usize, y: usize, c: usize| -> crate::stats::Moments {
            runs.iter().map(|run| f64::from(run.image.pixels[y * width + x][c])).collect()
        };
        let image =
            Image::from_fn(width, height, |x, y| [0, 1, 2].map(|c| moments(x, y, c).mean() as f32));
        let variance = (count >= FEWEST_RUNS).then(|| {
            Image::from_fn(width, height, |x, y| {
                [0, 1, 2].map(|c| moments(x, y, c).standard_error().powi(2) as f32)
            })
        });
        let is_coded = runs.iter().any(|run| run.codes.is_some());
        let codes = runs.iter().map(|run| run.codes.as_ref()?.picture.clone());
        let codes = codes.collect::<Option<Vec<_>>>().unwrap_or_default();
        let alpha = runs[0].alpha.clone();
        let bounces = Vec::new();
        Ok(Self { image, alpha, bounces, variance, rounding: None, is_coded, codes })
    }

    fn take_variance(&mut self, variance: Image, path: &Path) -> Result<(), Failure> {
        let is_variance = |value: &f32| *value >= 0.0 && value.is_finite();
        let fits = [variance.width, variance.height] == [self.image.width, self.image.height];
        if fits && variance.pixels.as_flattened().iter().all(is_variance) {
            self.variance = Some(variance);
            return Ok(());
        }
        let path = path.display();
        Err(Failure::request(format!(
            "`{path}` is no variance of the picture: another size, or negative"
        )))
    }

    /// The light behind the codes of this side, if it has no more than 8 bits and the other is
    /// radiance that is known with its errors: decoded, noise would look like darkness.
    pub fn light_against(
        &self,
        reference: &Self,
        encoding: Encoding,
        has_variance: bool,
    ) -> Option<LightOfCodes> {
        let errors = reference.variance.as_ref().filter(|_| !reference.is_coded)?;
        let standard_error = each(errors, f32::sqrt);
        let known = CodeReference {
            mean: &reference.image,
            standard_error: &standard_error,
            samples: None,
        };
        let codes: Vec<&Codes> = self.codes.iter().collect();
        let variance = self.variance.as_ref().filter(|_| has_variance);
        (!codes.is_empty()).then(|| light_of_codes(known, &codes, variance, encoding))
    }

    /// As the test takes it.
    pub fn sample(&self) -> Sample<'_> {
        Sample {
            image: &self.image,
            variance: self.variance.as_ref(),
            rounding: self.rounding.as_ref(),
        }
    }
}

/// As the test takes the light behind codes.
pub(super) fn sample_of(light: &LightOfCodes) -> Sample<'_> {
    Sample { image: &light.image, variance: light.variance.as_ref(), rounding: Some(&light.slack) }
}

/// Whether noise would have to be as large as the light to clip a pixel.
pub(super) fn is_safe_from_clipping(level: [f32; 3]) -> bool {
    level.iter().all(|value| *value < SAFE_FROM_CLIPPING)
}

/// Half a step of the codes, as light, at every value.
fn rounding(loaded: &Loaded, largest: u32) -> Image {
    let half = 0.5 / f64::from(largest);
    each(&loaded.image, |value| {
        let share = loaded.encoding.encode(f64::from(value));
        let light = |share: f64| loaded.encoding.decode(share.clamp(0.0, 1.0));
        #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
        let step = (light(share + half) - light(share - half)) as f32;
        0.5 * step
    })
}

fn each(image: &Image, value: impl Fn(f32) -> f32) -> Image {
    let pixels = image.pixels.iter().map(|pixel| pixel.map(&value)).collect();
    Image { pixels, ..*image }
}

/// `srgb`, `linear`, or a gamma.
pub(super) fn encoding(text: &str) -> Result<Curve, String> {
    match text {
        "srgb" => Ok(Curve::Srgb),
        "linear" => Ok(Curve::Linear),
        number => match number.parse::<f64>() {
            Ok(gamma) if gamma > 0.1 && gamma < 10.0 => Ok(Curve::Gamma(gamma)),
            _ => Err("`srgb`, `linear`, or a gamma between 0.1 and 10".to_owned()),
        },
    }
}
