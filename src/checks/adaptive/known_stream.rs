//! A stream that repeats, where it has to stop, and where mistakes would.

use super::rule::{InRule, Rule, Sums, WRONG_RULES};
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

/// What a core does with a stream, step by step.
#[derive(Clone, Copy)]
pub(super) struct Procedure {
    pub(super) rule: Rule,
    /// After how many samples it looks again, of the batch asked for.
    step: fn(u32) -> u32,
    /// How many samples it takes at most, of the cap and the batch.
    limit: fn(u32, u32) -> u32,
    /// What the sum is divided by, of the samples used and the cap.
    divisor: fn(f64, f64) -> f64,
    /// What it says it has used, of the samples used, the cap and the batch.
    reported: fn(u32, u32, u32) -> u32,
    /// Whether rounding may make the variance of equal samples negative, so that they stop late.
    pub(super) is_late_on_equal_samples: bool,
}

impl Procedure {
    pub(super) const RIGHT: Self = Self {
        rule: Rule::RIGHT,
        step: |batch| batch,
        limit: |cap, _| cap,
        divisor: |used, _| used,
        reported: |used, _, _| used,
        is_late_on_equal_samples: false,
    };

    /// Where it stops.
    pub(super) fn count(&self, stream: &KnownStream) -> u32 {
        let count = stream.count(self.rule, (self.step)(stream.batch));
        count.min((self.limit)(stream.cap, stream.batch))
    }

    /// What it says of a stream, of which it has used so many samples.
    pub(super) fn answer(&self, stream: &KnownStream, used: u32) -> Answer {
        let (_, mean) = stream.prefix(used);
        let (n, cap) = (f64::from(used), f64::from(stream.cap));
        let reported = (self.reported)(used, stream.cap, stream.batch);
        (reported, mean * n / (self.divisor)(n, cap))
    }
}

/// A mistake that students make, and what it makes of a procedure.
pub(super) struct Mistake {
    pub(super) cause: &'static Cause,
    made: Made,
}

enum Made {
    InTheRule(InRule),
    Elsewhere(InProcedure),
}

/// What a mistake makes of a procedure.
type InProcedure = fn(Procedure) -> Procedure;

impl Mistake {
    pub(super) fn made_in(&self, right: Procedure) -> Procedure {
        match self.made {
            Made::InTheRule(made) => Procedure { rule: made(right.rule), ..right },
            Made::Elsewhere(made) => made(right),
        }
    }
}

/// Every mistake, those in the rule itself first.
pub(super) fn mistakes() -> Vec<Mistake> {
    let in_rule =
        WRONG_RULES.iter().map(|(cause, made)| Mistake { cause, made: Made::InTheRule(*made) });
    let elsewhere =
        ELSEWHERE.iter().map(|(cause, made)| Mistake { cause, made: Made::Elsewhere(*made) });
    in_rule.chain(elsewhere).collect()
}

/// The mistakes that students make beside those in the rule itself.
const ELSEWHERE: &[(&Cause, InProcedure)] = &[
    (&adaptive::LOOKS_AFTER_EVERY_SAMPLE, |p| Procedure { step: |_| 1, ..p }),
    (&adaptive::BATCH_IGNORED, |p| Procedure { step: |_| 32, ..p }),
    (&adaptive::REST_OF_BATCH_DROPPED, |p| Procedure {
        limit: |cap, batch| cap - cap % batch,
        ..p
    }),
    (&adaptive::DIVIDED_BY_CAP, |p| Procedure { divisor: |_, cap| cap, ..p }),
    (&image::DIVIDED_BY_ONE_MORE, |p| Procedure { divisor: |used, _| used + 1.0, ..p }),
    (&adaptive::DIVIDED_BY_ONE_LESS, |p| Procedure { divisor: |used, _| used - 1.0, ..p }),
    (&image::NOT_DIVIDED, |p| Procedure { divisor: |_, _| 1.0, ..p }),
    (&adaptive::COUNTS_ARE_CAP, |p| Procedure { reported: |_, cap, _| cap, ..p }),
    (&adaptive::LAST_BATCH_NOT_COUNTED, |p| Procedure {
        reported: |used, _, batch| used.saturating_sub(batch),
        ..p
    }),
    (&adaptive::VARIANCE_BELOW_ZERO, |p| Procedure { is_late_on_equal_samples: true, ..p }),
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
        match self.count(Rule::RIGHT, self.batch) {
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
            |n: &u32| *n > 1 && rule.stops(&Sums::of(&samples[..*n as usize]), self.tolerance.0);
        looks.find(stops_at).unwrap_or(self.cap)
    }

    pub(super) fn is_of_equal_samples(&self) -> bool {
        self.repeats.iter().all(|value| *value == self.repeats[0])
    }

    /// So many samples, and their mean.
    pub(super) fn prefix(&self, used: u32) -> Answer {
        let samples = self.samples();
        (used, Sums::of(&samples[..(used as usize).clamp(1, samples.len())]).mean())
    }
}
