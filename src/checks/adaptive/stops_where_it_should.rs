//! The stopping rule on streams whose count is known, without any picture.

use super::rule::{Rule, Sums, WRONG_RULES, stops};
use crate::cause::{Cause, adaptive, image};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{AdaptiveMean, AdaptiveSettings};
use crate::stats::Tolerance;
use crate::text::{Percent, Several};
use serde::Deserialize;

check! {
    /// Each stream stops after a given number of samples, with the mean of just those.
    pub(crate) struct StopsWhereItShould {
        stream: Several<StreamEntry>,
    }
    name: "stops-where-it-should",
    summary: "the adaptive stopping rule on streams whose count is known",
    needs: ADAPTIVE_MEAN,
}

/// A stream of luminances that repeats, and where it has to stop.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StreamEntry {
    name: String,
    repeats: Several<f64>,
    batch: u32,
    tolerance: Percent,
    cap: u32,
    stops_at: u32,
}

/// What a core would answer to a stream: the samples used, and their mean.
type Answer = (u32, f64);

/// A mistake, and what it answers.
struct Mistake {
    cause: &'static Cause,
    answers: fn(&StreamEntry) -> Answer,
}

/// A rule that is looked at after every batch, and right otherwise.
fn by(stream: &StreamEntry, rule: Rule) -> Answer {
    stream.prefix(stream.count(rule, stream.batch))
}

/// The right count, with a mean that is this share of the right one.
fn scaled(stream: &StreamEntry, share: fn(f64, f64) -> f64) -> Answer {
    let (used, mean) = stream.prefix(stream.stops_at);
    (used, mean * share(f64::from(used), f64::from(stream.cap)))
}

/// The right mean, with another count beside it.
fn reported(stream: &StreamEntry, count: u32) -> Answer {
    (count, stream.prefix(stream.stops_at).1)
}

/// The mistakes that students make beside those in the rule itself.
const MISTAKES: &[Mistake] = &[
    Mistake {
        cause: &adaptive::LOOKS_AFTER_EVERY_SAMPLE,
        answers: |stream| stream.prefix(stream.count(stops, 1)),
    },
    Mistake {
        cause: &adaptive::BATCH_IGNORED,
        answers: |stream| stream.prefix(stream.count(stops, 32)),
    },
    Mistake {
        cause: &adaptive::REST_OF_BATCH_DROPPED,
        answers: |stream| {
            let whole_batches = stream.cap - stream.cap % stream.batch;
            stream.prefix(stream.count(stops, stream.batch).min(whole_batches))
        },
    },
    Mistake {
        cause: &adaptive::DIVIDED_BY_CAP,
        answers: |stream| scaled(stream, |used, cap| used / cap),
    },
    Mistake {
        cause: &image::DIVIDED_BY_ONE_MORE,
        answers: |stream| scaled(stream, |used, _| used / (used + 1.0)),
    },
    Mistake {
        cause: &adaptive::DIVIDED_BY_ONE_LESS,
        answers: |stream| scaled(stream, |used, _| used / (used - 1.0)),
    },
    Mistake { cause: &image::NOT_DIVIDED, answers: |stream| scaled(stream, |used, _| used) },
    Mistake { cause: &adaptive::COUNTS_ARE_CAP, answers: |stream| reported(stream, stream.cap) },
    Mistake {
        cause: &adaptive::LAST_BATCH_NOT_COUNTED,
        answers: |stream| reported(stream, stream.stops_at.saturating_sub(stream.batch)),
    },
];

impl StreamEntry {
    /// As long as the cap.
    fn samples(&self) -> Vec<f64> {
        self.repeats.iter().copied().cycle().take(self.cap as usize).collect()
    }

    /// Where a rule stops, looking every `step` samples.
    fn count(&self, rule: Rule, step: u32) -> u32 {
        let samples = self.samples();
        let looks = (1..).map(|look| look * step).take_while(|n| *n < self.cap);
        let mut stopping = looks
            .filter(|n| *n > 1)
            .filter(|n| rule(&Sums::of(&samples[..*n as usize]), self.tolerance.0));
        stopping.next().unwrap_or(self.cap)
    }

    /// So many samples, and their mean.
    fn prefix(&self, used: u32) -> Answer {
        let samples = self.samples();
        (used, Sums::of(&samples[..(used as usize).clamp(1, samples.len())]).mean())
    }
}

impl Check for StopsWhereItShould {
    fn validate(&self) -> Result<(), String> {
        for stream in self.stream.iter() {
            if stream.repeats.iter().any(|value| !value.is_finite())
                || stream.batch < 2
                || stream.cap < stream.batch
            {
                return Err(format!(
                    "stream `{}` needs values, a batch of 2 or more and a cap not below it",
                    stream.name
                ));
            }
            let right = stream.count(stops, stream.batch);
            if right != stream.stops_at {
                return Err(format!("stream `{}` stops at {right} by the rule", stream.name));
            }
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let tolerance = Tolerance::SAME_VALUE.of(context.info.precision);
        let asked: Result<Vec<_>, _> =
            self.stream.iter().map(|stream| ask(context, stream)).collect();
        Ok(judge(&asked?, tolerance))
    }
}

/// A stream, and what the core made of it.
type Answered<'a> = (&'a StreamEntry, AdaptiveMean);

fn judge(answered: &[Answered<'_>], tolerance: f64) -> Finding {
    let measures = answered.iter().flat_map(|answered| measures(answered, tolerance)).collect();
    let complaints: Vec<_> = answered.iter().filter_map(|a| complaint(a, tolerance)).collect();
    let (causes, evidence) = match complaints.is_empty() {
        true => (Vec::new(), String::new()),
        false => explanations(answered, tolerance),
    };
    let headlines: Vec<_> = causes.iter().map(|cause| cause.headline).collect();
    let statement = match (complaints.is_empty(), headlines.is_empty()) {
        (true, _) => format!("{} streams stop where they should", answered.len()),
        (false, true) => complaints.join("; "),
        (false, false) => format!("{}: {}", complaints.join("; "), headlines.join(", or ")),
    };
    Finding::of(statement, "would have caught a count that is off by one batch", measures)
        .because_each(causes, &evidence)
}

fn measures((stream, answer): &Answered<'_>, tolerance: f64) -> [Measure; 2] {
    let (_, mean) = stream.prefix(answer.used);
    let (used, right) = (f64::from(answer.used), f64::from(stream.stops_at));
    [
        Measure::exact("samples used", used, right, 0.0),
        Measure::exact("mean of the samples used", answer.mean, mean, tolerance * mean.abs()),
    ]
    .map(|measure| measure.of_row(&stream.name))
}

/// The mistakes that predict the answers for every stream, and what speaks for them.
fn explanations(answered: &[Answered<'_>], tolerance: f64) -> (Vec<&'static Cause>, String) {
    let predicts = |answers: &dyn Fn(&StreamEntry) -> Answer| {
        answered.iter().all(|(stream, answer)| {
            let (used, mean) = answers(stream);
            answer.used == used && (answer.mean - mean).abs() <= tolerance * mean.abs()
        })
    };
    let in_rule = WRONG_RULES.iter().filter(|(_, rule)| predicts(&|stream| by(stream, *rule)));
    let elsewhere = MISTAKES.iter().filter(|mistake| predicts(&mistake.answers));
    let causes: Vec<_> =
        in_rule.map(|(cause, _)| *cause).chain(elsewhere.map(|mistake| mistake.cause)).collect();
    if causes.is_empty() && equal_samples_alone_are_late(answered, tolerance) {
        let evidence = "every stream stops where it should but those of equal samples";
        return (vec![&adaptive::VARIANCE_BELOW_ZERO], evidence.to_owned());
    }
    (causes, format!("predicts where {} streams stop, and their means", answered.len()))
}

/// Equal samples take more batches than one, and all else is right. How many depends on every rounding.
fn equal_samples_alone_are_late(answered: &[Answered<'_>], tolerance: f64) -> bool {
    answered.iter().filter(|answered| complaint(answered, tolerance).is_some()).all(
        |(stream, answer)| {
            stream.repeats.iter().all(|value| *value == stream.repeats[0])
                && answer.used > stream.stops_at
                && answer.used.is_multiple_of(stream.batch)
        },
    )
}

fn ask<'a>(context: &mut Context<'_>, stream: &'a StreamEntry) -> Result<Answered<'a>, CheckError> {
    let settings =
        AdaptiveSettings { samples_per_batch: stream.batch, max_tolerance: stream.tolerance.0 };
    let mut means = [AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }];
    context.core.adaptive_mean(settings, &[&stream.samples()], &mut means)?;
    Ok((stream, means[0]))
}

/// What is wrong with one stream.
fn complaint((stream, answer): &Answered<'_>, tolerance: f64) -> Option<String> {
    let (used, mean) = stream.prefix(answer.used);
    let right = stream.stops_at;
    if used != right {
        return Some(format!("{} stops at {used} instead of {right}", stream.name));
    }
    let is_right = (answer.mean - mean).abs() <= tolerance * mean.abs();
    (!is_right).then(|| {
        format!(
            "{}: the mean is {} of that of the {used} samples used",
            stream.name,
            figure(answer.mean / mean)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(answers: impl Fn(&StreamEntry) -> Answer + Send + 'static) -> Finding {
        let case =
            include_str!("../../../cases/adaptive/known-streams-stop-where-the-rule-says.toml");
        let mean = move |settings: AdaptiveSettings, stream: &[f64]| {
            let mut entry = StreamEntry {
                name: String::new(),
                repeats: stream.to_vec().try_into().unwrap(),
                batch: settings.samples_per_batch,
                tolerance: Percent(settings.max_tolerance),
                cap: u32::try_from(stream.len()).unwrap(),
                stops_at: 0,
            };
            entry.stops_at = entry.count(stops, entry.batch);
            let (used, mean) = answers(&entry);
            AdaptiveMean { mean, used, reserved: 0 }
        };
        let mut core = Fake { mean: Box::new(mean), ..Fake::default() };
        judge(&check_of::<StopsWhereItShould>(case), &mut core)
    }

    #[test]
    fn the_rule_itself_passes() {
        assert_passes(&found(|stream| by(stream, stops)));
    }

    #[test]
    fn every_mistake_fails_and_is_told_from_the_others() {
        let assert_told = |cause: &Cause, finding: Finding| {
            let told: Vec<_> = finding.clues.iter().map(|clue| clue.cause.as_str()).collect();
            assert!(failure(&finding).contains(cause.headline), "{}", finding.statement);
            assert_eq!(told, [cause.name]);
        };
        for (cause, rule) in WRONG_RULES {
            assert_told(cause, found(|stream| by(stream, *rule)));
        }
        for mistake in MISTAKES {
            assert_told(mistake.cause, found(mistake.answers));
        }
    }

    #[test]
    fn equal_samples_that_stop_late_have_a_variance_below_zero() {
        let told = |late: u32| {
            let finding =
                found(move |stream| match stream.repeats[..32].iter().all(|x| *x == 0.7) {
                    true => stream.prefix(late),
                    false => by(stream, stops),
                });
            failure(&finding);
            finding.clues.first().map(|clue| clue.cause.clone())
        };
        assert_eq!(told(128).as_deref(), Some("variance-below-zero"));
        assert_eq!(told(33), None);
    }

    #[test]
    fn a_mean_of_something_else_is_seen() {
        let finding = found(|stream| (stream.stops_at, 0.99 * stream.prefix(stream.stops_at).1));
        assert!(failure(&finding).contains("the mean is 0.99 of that"), "{}", finding.statement);
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn a_case_with_a_wrong_count_is_refused() {
        let wrong = "stream = [{ name = \"five values\", repeats = [1, 3, 0.5, 1, 1], batch = 2, \
                     tolerance = \"50 %\", cap = 64, stops-at = 8 }]";
        let check: StopsWhereItShould = crate::text::read_toml(wrong).unwrap();
        assert!(check.validate().unwrap_err().contains("stops at 10"));
    }
}
