//! The stopping rule on streams whose count is known, without any picture.

use super::rule::{Rule, Sums, WRONG_RULES, stops};
use crate::cause::{Cause, adaptive};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{AdaptiveMean, AdaptiveSettings, Capabilities};
use crate::stats::Tolerance;
use crate::text::Percent;
use serde::Deserialize;

/// Each stream stops after a given number of samples, with the mean of just those.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopsWhereItShould {
    stream: Vec<StreamEntry>,
}

/// A stream of luminances that repeats, and where it has to stop.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StreamEntry {
    name: String,
    repeats: Vec<f64>,
    batch: u32,
    tolerance: Percent,
    cap: u32,
    stops_at: u32,
}

/// The mean as a share of the right one, where so many samples were used of so many that were allowed.
type Share = fn(f64, f64) -> f64;

/// The mistakes that students make in what they divide by.
const WRONG_DIVISORS: &[(&Cause, Share)] = &[
    (&adaptive::DIVIDED_BY_CAP, |used, cap| used / cap),
    (&adaptive::DIVIDED_BY_ONE_MORE, |used, _| used / (used + 1.0)),
    (&adaptive::DIVIDED_BY_ONE_LESS, |used, _| used / (used - 1.0)),
    (&adaptive::NOT_DIVIDED, |used, _| used),
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

    /// The mean that the samples have which a core says it has used.
    fn mean_of(&self, answer: &AdaptiveMean) -> f64 {
        let samples = self.samples();
        Sums::of(&samples[..(answer.used as usize).clamp(1, samples.len())]).mean()
    }
}

impl Check for StopsWhereItShould {
    const NAME: &'static str = "stops-where-it-should";
    const SUMMARY: &'static str = "the adaptive stopping rule on streams whose count is known";

    fn needs(&self) -> Capabilities {
        Capabilities::ADAPTIVE_MEAN
    }

    fn validate(&self) -> Result<(), String> {
        for stream in &self.stream {
            if stream.repeats.is_empty() || stream.batch < 2 || stream.cap < stream.batch {
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
        if self.stream.is_empty() { Err("there are no streams".to_owned()) } else { Ok(()) }
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
    let causes = match complaints.is_empty() {
        true => Vec::new(),
        false => explanations(answered, tolerance),
    };
    let headlines: Vec<_> = causes.iter().map(|cause| cause.headline).collect();
    let statement = match (complaints.is_empty(), headlines.is_empty()) {
        (true, _) => format!("{} streams stop where they should", answered.len()),
        (false, true) => complaints.join("; "),
        (false, false) => format!("{}: {}", complaints.join("; "), headlines.join(", or ")),
    };
    let evidence = format!("predicts where {} streams stop, and their means", answered.len());
    Finding::of(statement, "would have caught a count that is off by one batch", measures)
        .because_each(causes, &evidence)
}

fn measures((stream, answer): &Answered<'_>, tolerance: f64) -> [Measure; 2] {
    let mean = stream.mean_of(answer);
    let (used, right) = (f64::from(answer.used), f64::from(stream.stops_at));
    let name = |what: &str| format!("{}: {what}", stream.name);
    [
        Measure::exact(name("samples used"), used, right, 0.0),
        Measure::exact(name("mean of the samples used"), answer.mean, mean, tolerance * mean.abs()),
    ]
}

/// The mistakes that predict the answers for every stream.
fn explanations(answered: &[Answered<'_>], tolerance: f64) -> Vec<&'static Cause> {
    let stops_by = |rule: Rule, each_sample: bool| {
        answered.iter().all(|(stream, answer)| {
            let step = if each_sample { 1 } else { stream.batch };
            stream.count(rule, step) == answer.used
        })
    };
    let mean_is = |share: &dyn Fn(f64, f64) -> f64| {
        answered.iter().all(|(stream, answer)| {
            let share = share(f64::from(answer.used), f64::from(stream.cap));
            let mean = share * stream.mean_of(answer);
            (answer.mean - mean).abs() <= tolerance * mean.abs()
        })
    };
    if stops_by(stops, false) {
        let made = WRONG_DIVISORS.iter().filter(|(_, share)| mean_is(share));
        return made.map(|(cause, _)| *cause).collect();
    }
    if !mean_is(&|_, _| 1.0) {
        return Vec::new();
    }
    let made = WRONG_RULES.iter().filter(|(_, rule)| stops_by(*rule, false));
    let too_often = stops_by(stops, true).then_some(&adaptive::LOOKS_AFTER_EVERY_SAMPLE);
    made.map(|(cause, _)| *cause).chain(too_often).collect()
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
    let (used, right, mean) = (answer.used, stream.stops_at, stream.mean_of(answer));
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
    use crate::checks::testing::{assert_passes, check_of, failure, info, judge};
    use crate::contract::{Core, CoreInfo, Precision, Result};

    const CASE: &str = r#"
        [[expect.stream]]
        name      = "five values"
        repeats   = [1, 3, 0.5, 1, 1]
        batch     = 2
        tolerance = "50 %"
        cap       = 64
        stops-at  = 10
    "#;

    /// Stops by a rule, and divides by what it says.
    struct Stopping {
        rule: Rule,
        divide_by_cap: bool,
    }

    impl Core for Stopping {
        fn info(&self) -> CoreInfo {
            info(Precision::Double)
        }

        fn adaptive_mean(
            &mut self,
            settings: AdaptiveSettings,
            streams: &[&[f64]],
            means: &mut [AdaptiveMean],
        ) -> Result<()> {
            for (stream, mean) in streams.iter().zip(means) {
                let step = settings.samples_per_batch as usize;
                let stop = (step..stream.len())
                    .step_by(step)
                    .find(|n| (self.rule)(&Sums::of(&stream[..*n]), settings.max_tolerance));
                let used = stop.unwrap_or(stream.len());
                let divisor = if self.divide_by_cap { stream.len() } else { used };
                let sum: f64 = stream[..used].iter().sum();
                let used = u32::try_from(used).unwrap();
                *mean = AdaptiveMean { mean: sum / divisor as f64, used, reserved: 0 };
            }
            Ok(())
        }
    }

    fn found(rule: Rule, divide_by_cap: bool) -> Finding {
        judge(&check_of::<StopsWhereItShould>(CASE), &mut Stopping { rule, divide_by_cap })
    }

    #[test]
    fn the_rule_itself_passes() {
        assert_passes(&found(stops, false));
    }

    #[test]
    fn every_mistake_fails_and_is_named() {
        for (cause, rule) in WRONG_RULES {
            let finding = found(*rule, false);
            assert!(failure(&finding).contains(cause.headline), "{}", finding.statement);
            assert_eq!(finding.clues.len(), 1, "{:?}", finding.clues);
        }
    }

    #[test]
    fn dividing_by_the_cap_is_seen() {
        let finding = found(stops, true);
        assert!(failure(&finding).contains("0.156 of that"), "{}", finding.statement);
        assert_eq!(finding.clues[0].cause, "divided-by-cap");
    }

    #[test]
    fn a_case_with_a_wrong_count_is_refused() {
        let check = check_of::<StopsWhereItShould>(CASE);
        let mut stream = check.stream[0].clone();
        stream.stops_at = 8;
        let wrong = StopsWhereItShould { stream: vec![stream] };
        assert!(wrong.validate().unwrap_err().contains("stops at 10"));
    }
}
