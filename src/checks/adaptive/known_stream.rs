//! A stream that repeats, where it has to stop, and where mistakes would.

use super::rule::{Rule, Sums, stops};
use crate::cause::{Cause, adaptive, image};
use crate::text::{Percent, Several};
use serde::Deserialize;

/// What a core would answer to a stream: the samples used, and their mean.
pub(super) type Answer = (u32, f64);

/// A stream of luminances that repeats, and where it has to stop.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct KnownStream {
    pub(super) name: String,
    pub(super) repeats: Several<f64>,
    pub(super) batch: u32,
    pub(super) tolerance: Percent,
    pub(super) cap: u32,
    pub(super) stops_at: u32,
}

/// What a mistake makes of a stream.
pub(super) type Mistaken = fn(&KnownStream) -> Answer;

/// The mistakes that students make beside those in the rule itself.
pub(super) const MISTAKES: &[(&Cause, Mistaken)] = &[
    (&adaptive::LOOKS_AFTER_EVERY_SAMPLE, |stream| stream.prefix(stream.count(stops, 1))),
    (&adaptive::BATCH_IGNORED, |stream| stream.prefix(stream.count(stops, 32))),
    (&adaptive::REST_OF_BATCH_DROPPED, |stream| {
        let whole_batches = stream.cap - stream.cap % stream.batch;
        stream.prefix(stream.count(stops, stream.batch).min(whole_batches))
    }),
    (&adaptive::DIVIDED_BY_CAP, |stream| stream.scaled(|used, cap| used / cap)),
    (&image::DIVIDED_BY_ONE_MORE, |stream| stream.scaled(|used, _| used / (used + 1.0))),
    (&adaptive::DIVIDED_BY_ONE_LESS, |stream| stream.scaled(|used, _| used / (used - 1.0))),
    (&image::NOT_DIVIDED, |stream| stream.scaled(|used, _| used)),
    (&adaptive::COUNTS_ARE_CAP, |stream| stream.reported(stream.cap)),
    (&adaptive::LAST_BATCH_NOT_COUNTED, |stream| {
        stream.reported(stream.stops_at.saturating_sub(stream.batch))
    }),
];

impl KnownStream {
    pub(super) fn validate(&self) -> Result<(), String> {
        let name = &self.name;
        let is_finite = self.repeats.iter().all(|value| value.is_finite());
        if !is_finite || self.batch < 2 || self.cap < self.batch {
            return Err(format!(
                "stream `{name}` needs values, a batch of 2 or more and a cap not below it"
            ));
        }
        match self.count(stops, self.batch) {
            right if right == self.stops_at => Ok(()),
            right => Err(format!("stream `{name}` stops at {right} by the rule")),
        }
    }

    /// As long as the cap.
    pub(super) fn samples(&self) -> Vec<f64> {
        self.repeats.iter().copied().cycle().take(self.cap as usize).collect()
    }

    /// Where a rule stops, looking every `step` samples.
    pub(super) fn count(&self, rule: Rule, step: u32) -> u32 {
        let samples = self.samples();
        let mut looks = (1..).map(|look| look * step).take_while(|n| *n < self.cap);
        let stops_at =
            |n: &u32| *n > 1 && rule(&Sums::of(&samples[..*n as usize]), self.tolerance.0);
        looks.find(stops_at).unwrap_or(self.cap)
    }

    /// So many samples, and their mean.
    pub(super) fn prefix(&self, used: u32) -> Answer {
        let samples = self.samples();
        (used, Sums::of(&samples[..(used as usize).clamp(1, samples.len())]).mean())
    }

    /// A rule that is looked at after every batch, and right otherwise.
    pub(super) fn by(&self, rule: Rule) -> Answer {
        self.prefix(self.count(rule, self.batch))
    }

    /// The right count, with a mean that is this share of the right one.
    fn scaled(&self, share: fn(f64, f64) -> f64) -> Answer {
        let (used, mean) = self.prefix(self.stops_at);
        (used, mean * share(f64::from(used), f64::from(self.cap)))
    }

    /// The right mean, with another count beside it.
    fn reported(&self, count: u32) -> Answer {
        (count, self.prefix(self.stops_at).1)
    }
}
