//! The stopping rule on streams whose count is known, without any picture.

use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{AdaptiveMean, AdaptiveSettings, Capabilities};
use crate::stats::Tolerance;
use crate::text::Percent;
use serde::Deserialize;

/// The number of a normal distribution's standard deviations that hold 95 %.
const NORMAL_95: f64 = 1.96;

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

/// A stopping rule: whether to stop after these samples.
type Rule = fn(&Sums, f64) -> bool;

/// The mistakes that students make, each with the rule it amounts to.
const MISTAKES: &[(&str, Rule)] = &[
    ("the variance is divided by n, not n - 1", |s, tolerance| {
        NORMAL_95 * (s.population_variance() / s.n).sqrt() <= tolerance * s.mean()
    }),
    ("sigma is divided by n, not by its root", |s, tolerance| {
        NORMAL_95 * s.variance().sqrt() / s.n <= tolerance * s.mean()
    }),
    ("the factor 1.96 is missing", |s, tolerance| {
        (s.variance() / s.n).sqrt() <= tolerance * s.mean()
    }),
    ("the variance stands where sigma should", |s, tolerance| {
        NORMAL_95 * s.variance() / s.n.sqrt() <= tolerance * s.mean()
    }),
    ("the tolerance is not multiplied by the mean", |s, tolerance| {
        NORMAL_95 * (s.variance() / s.n).sqrt() <= tolerance
    }),
    ("it never stops before the cap", |_, _| false),
];

/// The course's rule.
fn stops(sums: &Sums, tolerance: f64) -> bool {
    NORMAL_95 * (sums.variance() / sums.n).sqrt() <= tolerance * sums.mean()
}

/// What the rule needs of the samples so far.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn of(samples: &[f64]) -> Self {
        let squares = samples.iter().map(|x| x * x).sum();
        Self { n: samples.len() as f64, sum: samples.iter().sum(), squares }
    }

    fn mean(&self) -> f64 {
        self.sum / self.n
    }

    fn population_variance(&self) -> f64 {
        (self.squares / self.n - self.mean() * self.mean()).max(0.0)
    }

    fn variance(&self) -> f64 {
        self.population_variance() * self.n / (self.n - 1.0)
    }
}

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

    /// The mistakes that would stop where the core did.
    fn mistakes(&self, used: u32) -> Vec<&'static str> {
        let mut named: Vec<_> = MISTAKES
            .iter()
            .filter(|(_, rule)| self.count(*rule, self.batch) == used)
            .map(|(name, _)| *name)
            .collect();
        if self.count(stops, 1) == used {
            named.push("it looks after every sample, not after every batch");
        }
        named
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
        let mut measures = Vec::new();
        let mut complaints = Vec::new();
        for stream in &self.stream {
            let answer = ask(context, stream)?;
            let samples = stream.samples();
            let prefix = &samples[..(answer.used as usize).clamp(1, samples.len())];
            let mean = Sums::of(prefix).mean();
            let used = Measure::exact(
                format!("{}: samples used", stream.name),
                f64::from(answer.used),
                f64::from(stream.stops_at),
                0.0,
            );
            complaints.extend(complaint(stream, answer, mean, tolerance));
            measures.push(used);
            let name = format!("{}: mean of the samples used", stream.name);
            measures.push(Measure::exact(name, answer.mean, mean, tolerance * mean.abs()));
        }
        let statement = match complaints.is_empty() {
            true => format!("{} streams stop where they should", self.stream.len()),
            false => complaints.join("; "),
        };
        Ok(Finding::of(statement, "would have caught a count that is off by one batch", measures))
    }
}

fn ask(context: &mut Context<'_>, stream: &StreamEntry) -> Result<AdaptiveMean, CheckError> {
    let settings =
        AdaptiveSettings { samples_per_batch: stream.batch, max_tolerance: stream.tolerance.0 };
    let mut means = [AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }];
    context.core.adaptive_mean(settings, &[&stream.samples()], &mut means)?;
    Ok(means[0])
}

/// What is wrong with one stream, and which mistake explains it.
fn complaint(
    stream: &StreamEntry,
    answer: AdaptiveMean,
    mean: f64,
    tolerance: f64,
) -> Option<String> {
    let (used, right) = (answer.used, stream.stops_at);
    if used != right {
        let mistakes = stream.mistakes(used);
        let why = if mistakes.is_empty() {
            String::new()
        } else {
            format!(", as if {}", mistakes.join(", or "))
        };
        return Some(format!("{} stops at {used} instead of {right}{why}", stream.name));
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
        for (name, rule) in MISTAKES {
            let finding = found(*rule, false);
            assert!(failure(&finding).contains(name), "{name}: {}", finding.statement);
        }
    }

    #[test]
    fn dividing_by_the_cap_is_seen() {
        let finding = found(stops, true);
        assert!(failure(&finding).contains("0.156 of that"), "{}", finding.statement);
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
