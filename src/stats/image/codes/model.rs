//! What every code of a picture should be.

use super::channel::{Channel, Noise, Standing, deviation_behind};
use super::observed::Observed;
use super::{CodeReference, Codes};
use crate::image::Image;
use crate::image::encoding::Encoding;
use crate::stats::image::cells::Cells;
use crate::stats::image::target::Target;
use crate::stats::law::upper_median;
use rayon::prelude::*;

/// The channels of all pixels.
pub(super) struct Model {
    size: (usize, usize),
    pub(super) channels: Vec<Channel>,
}

impl Model {
    /// `samples` a pixel are behind each picture, if that is known.
    pub(super) fn new(
        reference: CodeReference<'_>,
        observed: &Observed,
        encoding: Encoding,
        samples: Option<u32>,
    ) -> Self {
        let means = reference.mean.pixels.as_flattened();
        let errors = reference.standard_error.pixels.as_flattened();
        let level = |index: usize| (f64::from(means[index]), f64::from(errors[index]));
        let own = |index: usize| {
            let (mean, codes) = (level(index).0, observed.codes[index].deviation);
            if mean > 0.0 && codes > 0.0 { deviation_behind(mean, codes, encoding) } else { 0.0 }
        };
        let own: Vec<f64> = (0..means.len()).into_par_iter().map(own).collect();
        let relative_to = |to: &[f32]| median_ratio(&own, to);
        let share = reference.noise_share(samples).max(relative_to(errors));
        let typical = relative_to(means);
        let channel = |index: usize| {
            let (mean, error) = level(index);
            let noise = Noise {
                codes: observed.codes[index].deviation,
                own: own[index],
                freedom: observed.freedom,
                foretold: share * error,
                typical,
            };
            Channel::new(mean, error, noise, encoding)
        };
        let channels = (0..means.len()).into_par_iter().map(channel).collect();
        Self { size: (reference.mean.width, reference.mean.height), channels }
    }

    /// A picture of a property of the channels.
    pub(super) fn image(&self, value: impl Fn(&Channel) -> f64) -> Image {
        self.map(|_, channel| value(channel))
    }

    /// A picture of something of every channel and its number.
    pub(super) fn map(&self, value: impl Fn(usize, &Channel) -> f64) -> Image {
        let (width, height) = self.size;
        Image::from_fn(width, height, |x, y| {
            let first = 3 * (y * width + x);
            // Single precision holds a code to 1e-5.
            [first, first + 1, first + 2].map(|index| value(index, &self.channels[index]) as f32)
        })
    }

    /// Which pixels stand so in all their channels.
    pub(super) fn pixels_of(&self, standing: Standing) -> Vec<bool> {
        let (pixels, _) = self.channels.as_chunks::<3>();
        let stands = |channel: &Channel| channel.standing == standing;
        pixels.iter().map(|pixel| pixel.iter().all(stands)).collect()
    }

    /// The codes that are compared, 0 elsewhere.
    pub(super) fn compared(&self, codes: impl Fn(usize) -> f64) -> Image {
        self.map(|index, channel| match channel.standing {
            Standing::Compared => codes(index),
            _ => 0.0,
        })
    }

    /// The codes of a picture.
    pub(super) fn codes_of<'a>(&self, picture: &'a Codes) -> &'a [u8] {
        assert_eq!((picture.width, picture.height), self.size, "all pictures of one size");
        picture.pixels.as_flattened()
    }

    pub(super) fn target(&self) -> Target {
        let expected = self.image(|channel| channel.expected);
        let cells = Cells::new(&expected);
        let values = cells.values(&expected);
        let slopes = cells.values(&self.image(|channel| channel.slope));
        let slack = cells.values(&self.image(|channel| channel.slack));
        let errors = cells.standard_errors(&self.image(|channel| channel.error));
        Target::new(cells, values, slopes, &errors).with_slack(&slack)
    }

    /// Share of the channels that are compared.
    pub(super) fn share_compared(&self) -> f64 {
        let is_compared = |channel: &&Channel| channel.standing == Standing::Compared;
        let compared = self.channels.iter().filter(is_compared).count();
        compared as f64 / self.channels.len() as f64
    }
}

/// The median of one over the other, where both are positive; 0 where none are.
fn median_ratio(values: &[f64], others: &[f32]) -> f64 {
    let pairs = values.iter().zip(others).filter(|(value, other)| **value > 0.0 && **other > 0.0);
    upper_median(pairs.map(|(value, other)| value / f64::from(*other))).unwrap_or(0.0)
}
