//! A sample has nothing to do with the one before: pairs of consecutive samples fill their cells
//! evenly, heights and azimuths against each other.
//!
//! Counts of single samples cannot see this: a generator whose numbers come in pairs has the right
//! pdf and the wrong picture.

use super::distribution::{Distribution, DistributionEntry};
use super::pairs::{CELLS, correlation, count_pairs, sampler_of, strongest};
use crate::cause::{Cause, sampling};
use crate::checks::phrase::{figure, percent};
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::Capabilities;
use crate::stats::{CellProbabilities, CountReport, Stage, Verdict, judge_counts};
use crate::text::{Count, Percent};

check! {
    /// Height and azimuth of a sample and the height of the next, in 8 × 8 × 8 cells.
    pub(crate) struct ConsecutiveSamples {
        /// A sampler of the hemisphere: what is even in it is known.
        distribution: DistributionEntry,
        /// The smallest dependence that must be seen, as a root mean square error of the cells.
        detects: Percent,
        at_most: Count,
    }
    name: "consecutive-samples",
    summary: "consecutive samples are independent, by chi-square of pairs",
}

impl Check for ConsecutiveSamples {
    fn needs_besides(&self) -> Capabilities {
        self.distribution.needs()
    }

    fn validate(&self) -> Result<(), String> {
        self.distribution.validate()?;
        let is_sampler = |distribution: &Distribution| sampler_of(distribution).is_some();
        match self.distribution.distributions().iter().all(is_sampler) {
            true => Ok(()),
            false => Err("give a `sampler`: what a surface draws is not even".to_owned()),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let effort = context.effort(self.detects, self.at_most);
        let expected = CellProbabilities::exact(vec![1.0 / CELLS as f64; CELLS]);
        let mut judged = Vec::new();
        for distribution in self.distribution.distributions() {
            let seed = context.seed.child(distribution.name());
            let report = judge_counts(&expected, &effort, &mut |stage: Stage, pairs| {
                count_pairs(context, &distribution, seed.child(stage), pairs)
            })?;
            judged.push((distribution.name(), report));
        }
        Ok(finding(&judged))
    }
}

fn complaint(name: &str, report: &CountReport) -> Option<String> {
    match report.verdict {
        Verdict::Pass => None,
        Verdict::Inconclusive => Some(format!("{name}: too few pairs")),
        Verdict::Fail => {
            let (coefficient, what) = strongest(report);
            let empty = report.observed.iter().filter(|count| **count == 0).count();
            let empty = percent(empty as f64 / CELLS as f64);
            let told = figure(coefficient);
            Some(format!(
                "{name}: {what} are correlated by {told}; {empty} of the cells of pairs stay empty"
            ))
        }
    }
}

/// The next sample repeats a number of this one.
fn cause(report: &CountReport) -> Option<(&'static Cause, String)> {
    let repeats = |pair| correlation(report, pair) > 0.99;
    let (cause, what) = if report.verdict != Verdict::Fail {
        return None;
    } else if repeats([0, 1]) {
        (&sampling::ONE_NUMBER_TWICE, "height and azimuth are one number")
    } else if repeats([0, 2]) {
        (&sampling::NUMBER_DRAWN_AGAIN, "the next sample has the same height")
    } else if repeats([1, 2]) {
        (&sampling::NUMBER_DRAWN_AGAIN, "the next sample begins with this one's last number")
    } else {
        return None;
    };
    Some((cause, format!("{what}, in all pairs")))
}

fn finding(judged: &[(String, CountReport)]) -> Finding {
    let measure = |(name, report): &(String, CountReport)| {
        Measure::of("χ² per degree of freedom of pairs", report).of_row(name)
    };
    Finding::measured("consecutive samples are independent", judged.iter().map(measure))
        .in_terms(" of the cells of pairs, root mean square")
        .complaining(judged.iter().filter_map(|(name, report)| complaint(name, report)))
        .because_of(judged.iter().filter_map(|(_, report)| cause(report)))
}

#[cfg(test)]
mod tests {
    use super::super::fake::cosine;
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge, number_after};
    use crate::contract::{DirectionSample, Randomness};
    use crate::math::rng::Seed;
    use crate::math::rng::{Stream, uniform};
    use glam::DVec2;
    use glam::DVec3;

    fn found(next: fn(&mut Stream, DVec2) -> DVec2) -> Finding {
        let check: ConsecutiveSamples = check_of(
            "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }\n\
             detects = \"8 %\"\nat-most = \"100 k\"",
        );
        // Numbers of its own, each point from the one before.
        let (mut stream, mut point) = (Seed(0).stream(), DVec2::ZERO);
        let direction = move |random: &Randomness<'_>, number| {
            if number == 0 {
                (stream, point) = (Seed(random.seed).stream(), DVec2::splat(0.5));
            }
            point = next(&mut stream, point);
            let direction = cosine(point).unwrap_or(DVec3::Z);
            DirectionSample { direction, pdf: direction.z }
        };
        judge(&check, &mut Fake { direction: Box::new(direction), ..Fake::default() })
    }

    fn fresh(stream: &mut Stream) -> DVec2 {
        DVec2::new(uniform(stream), uniform(stream))
    }

    #[test]
    fn fresh_numbers_pass() {
        assert_passes(&found(|stream, _| fresh(stream)));
    }

    #[test]
    fn numbers_that_come_again_are_named() {
        let finding = found(|stream, last| DVec2::new(1.0 - last.y, uniform(stream)));
        let statement = failure(&finding);
        assert!(statement.contains("the azimuth of a sample and the height of the next"));
        assert_eq!(finding.clues[0].cause, "random-number-drawn-again");
        let finding = found(|stream, _| DVec2::splat(uniform(stream)));
        failure(&finding);
    }

    #[test]
    fn a_weak_dependence_is_seen_and_has_no_name() {
        let finding = found(|stream, last| {
            let point = fresh(stream);
            if uniform(stream) < 0.3 { point.with_x(last.x) } else { point }
        });
        let statement = failure(&finding);
        let told = "the heights of consecutive samples are correlated by ";
        assert!((number_after(statement, told) - 0.3).abs() < 0.02, "{statement}");
        assert!(finding.clues.is_empty());
    }
}
