//! A sample is a function of its own random numbers: the same again for the same, wherever it
//! stands in a batch, and moved by each of the two that choose the direction.

use super::distribution::{Distribution, DistributionEntry};
use super::of_distributions::OfDistributions;
use super::replay::{COUNT, Replayed};
use crate::checks::numbers::Numbers;
use crate::checks::{Context, Finding, Result, check};

check! {
    pub(crate) struct NumbersAsGiven {
        distribution: DistributionEntry,
    }
    name: "numbers-as-given",
    summary: "samples follow from their own numbers, and use both",
    needs: CALLERS_RANDOMNESS,
}

impl OfDistributions for NumbersAsGiven {
    type Judged = Replayed;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Replayed> {
        let numbers = Numbers::new(context.seed.child(distribution.name()), COUNT);
        let ask = &mut |numbers: &Numbers| distribution.sample(context.core, numbers.randomness());
        Ok(Replayed::of(distribution.name(), &numbers, ask)?)
    }

    fn finding(replayed: &[Replayed]) -> Finding {
        let right = format!("{} samples follow from their own numbers", COUNT * replayed.len());
        let caught = "would have caught one sample that is not a function of its numbers";
        Finding::of(right, caught, replayed.iter().flat_map(Replayed::measures).collect())
            .complaining(replayed.iter().filter_map(Replayed::complaint))
            .because_of(replayed.iter().filter_map(Replayed::cause))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::cosine;
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::{DirectionSample, Randomness};
    use glam::{DVec2, DVec3};

    fn found(point: fn(&[DVec2], usize, u64) -> DVec2) -> Finding {
        let check: NumbersAsGiven =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        let mut calls = 0;
        let direction = move |random: &Randomness<'_>, number| {
            calls += u64::from(number == 0);
            let direction = cosine(point(random.points, number, calls)).unwrap_or(DVec3::Z);
            DirectionSample { direction, pdf: direction.z }
        };
        judge(&check, &mut Fake { direction: Box::new(direction), ..Fake::default() })
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
    fn samples_that_are_all_alike_lie_on_no_curve() {
        assert_eq!(cause(|_, _, _| DVec2::splat(0.3)), "");
    }

    #[test]
    fn a_number_that_moves_nothing_is_told() {
        let finding = found(|points, number, _| points[number].with_y(0.3));
        assert!(failure(&finding).ends_with("the second number moves 0 % of the samples"));
    }
}
