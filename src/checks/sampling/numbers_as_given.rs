//! A sample is a function of its own random numbers: the same again for the same, wherever it
//! stands in a batch, and moved by each of the two that choose the direction.

use super::distribution::DistributionEntry;
use super::replay::{COUNT, Replayed};
use crate::checks::numbers::Numbers;
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::Capabilities;
use serde::Deserialize;

/// Samples follow from the numbers they are given.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct NumbersAsGiven {
    distribution: DistributionEntry,
}

impl Check for NumbersAsGiven {
    const NAME: &'static str = "numbers-as-given";
    const SUMMARY: &'static str = "samples follow from their own numbers, and use both";

    fn needs(&self) -> Capabilities {
        self.distribution.needs() | Capabilities::CALLERS_RANDOMNESS
    }

    fn validate(&self) -> Result<(), String> {
        self.distribution.validate()
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut replayed = Vec::new();
        for distribution in self.distribution.distributions() {
            let seed = context.seed.child(distribution.name());
            let numbers = Numbers::new(seed, COUNT);
            let mut ask =
                |numbers: &Numbers| distribution.sample(context.core, numbers.randomness());
            replayed.push(Replayed::of(distribution.name(), &numbers, &mut ask)?);
        }
        Ok(finding(&replayed))
    }
}

fn finding(replayed: &[Replayed]) -> Finding {
    let measures = replayed.iter().flat_map(Replayed::measures).collect();
    let complaints: Vec<_> = replayed.iter().filter_map(Replayed::complaint).collect();
    let statement = match complaints.is_empty() {
        true => format!("{} samples follow from their own numbers", COUNT * replayed.len()),
        false => complaints.join("; "),
    };
    let resolution = "would have caught one sample that is not a function of its numbers";
    let finding = Finding::of(statement, resolution, measures);
    let causes = replayed.iter().filter_map(Replayed::cause);
    causes.fold(finding, |finding, (cause, evidence)| finding.because(cause, evidence))
}

#[cfg(test)]
mod tests {
    use super::super::fake::cosine;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, info, judge};
    use crate::contract::{
        Core, CoreInfo, DirectionSample, Precision, Randomness, Result, Sampler,
    };
    use glam::{DVec2, DVec3};

    /// Samples by the numbers of a whole batch.
    struct Batches {
        point: fn(&[DVec2], usize, u64) -> DVec2,
        calls: u64,
    }

    impl Core for Batches {
        fn info(&self) -> CoreInfo {
            info(Precision::Double)
        }

        fn sample_direction(
            &mut self,
            _: Sampler,
            random: Randomness<'_>,
            samples: &mut [DirectionSample],
        ) -> Result<()> {
            self.calls += 1;
            for (number, sample) in samples.iter_mut().enumerate() {
                let point = (self.point)(random.points, number, self.calls);
                let direction = cosine(point).unwrap_or(DVec3::Z);
                *sample = DirectionSample { direction, pdf: direction.z };
            }
            Ok(())
        }
    }

    fn found(point: fn(&[DVec2], usize, u64) -> DVec2) -> Finding {
        let check: NumbersAsGiven =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut Batches { point, calls: 0 })
    }

    fn cause(point: fn(&[DVec2], usize, u64) -> DVec2) -> String {
        let finding = found(point);
        failure(&finding);
        finding.clues.first().map_or_else(String::new, |clue| clue.cause.clone())
    }

    #[test]
    fn a_function_of_its_numbers_passes() {
        assert_passes(&found(|points, number, _| points[number]));
    }

    #[test]
    fn numbers_of_its_own_are_named() {
        let name = cause(|points, number, calls| (points[number] + 0.1 * calls as f64).fract());
        assert_eq!(name, "own-random-numbers");
    }

    #[test]
    fn numbers_of_another_sample_are_named() {
        let name = cause(|points, number, _| points[(number + 1) % points.len()]);
        assert_eq!(name, "numbers-of-another-sample");
        assert_eq!(cause(|points, _, _| points[0]), "numbers-of-another-sample");
    }

    #[test]
    fn one_number_for_both_coordinates_is_named() {
        assert_eq!(cause(|points, number, _| DVec2::splat(points[number].x)), "one-number-twice");
    }

    #[test]
    fn a_number_that_moves_nothing_is_told() {
        let finding = found(|points, number, _| points[number].with_y(0.3));
        assert!(failure(&finding).ends_with("the second number moves 0 % of the samples"));
    }
}
