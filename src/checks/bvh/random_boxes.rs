//! Random rays and boxes: a box that a ray meets must never be missed, for what is in it would be
//! lost; one that is hit for nothing only costs time, and is counted.
//!
//! No rationals are needed: in double precision each crossing is right to two roundings, and an
//! overlap is graded only where it is thousands of times as long. Not here: flat boxes and rays
//! along a face, which need exact arithmetic (`overlaps-box`).

use super::random_segments::{RAYS_EACH, Trial, Truth};
use super::slabs::{because, wrong_as};
use crate::checks::law::{Terms, place_of_wrong};
use crate::checks::phrase::{figure, one_in, percent, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{BoxHit, Ray};
use crate::scene::Aabb;
use crate::stats::Tolerance;
use crate::text::Count;

check! {
    /// No box is missed that a segment meets.
    pub(crate) struct BoxesAreNeverMissed {
        /// Random segments at the default budget, a thousand at each random box.
        rays: Count,
    }
    name: "boxes-are-never-missed",
    summary: "random segments against random boxes: no false miss",
    needs: INTERSECT_BOX,
}

impl Check for BoxesAreNeverMissed {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let margin = Tolerance::SLAB.of(context.info.precision);
        let boxes = context.budget.samples(self.rays.0).div_ceil(RAYS_EACH as u64);
        let mut tally = Tally::default();
        for number in 0..boxes {
            let trial = Trial::random(context.seed.child(number));
            let blank = BoxHit { t_enter: 0.0, t_exit: 0.0, hit: 0, reserved: 0 };
            let mut hits = vec![blank; trial.rays.len()];
            context.core.intersect_box(&trial.bounds, &trial.rays, &mut hits)?;
            tally.take(&trial, &hits, margin);
        }
        Ok(tally.finding(margin))
    }
}

/// Answers, counted.
#[derive(Default)]
struct Tally {
    met: usize,
    missed: usize,
    passed: usize,
    false_hits: usize,
    example: Option<(Aabb, Ray)>,
    /// Some of the clear answers, for naming a mistake.
    answers: Vec<(Aabb, Ray, bool)>,
}

/// Answers by which a mistake is named: more would be as sure, and slower.
const ENOUGH: usize = 20_000;

const TERMS: Terms = Terms {
    quantities: &[],
    places: &[
        ["along -x", "along +x"],
        ["along -y", "along +y"],
        ["along -z", "along +z"],
        ["that start inside", "that start outside"],
        ["that end inside", "that end outside"],
        ["with a −0 in their direction", "without a −0 in their direction"],
    ],
    right: "",
};

/// Whether a ray is perpendicular to an axis with a −0: who asks for `direction < 0` takes it for a 0.
fn has_negative_zero(ray: &Ray) -> bool {
    ray.direction.to_array().into_iter().any(|along| along == 0.0 && along.is_sign_negative())
}

impl Tally {
    fn take(&mut self, trial: &Trial, hits: &[BoxHit], margin: f64) {
        for (ray, hit) in trial.rays.iter().zip(hits) {
            let (truth, found) = (Truth::of(&trial.bounds, ray, margin), hit.hit == 1);
            self.met += usize::from(truth == Truth::Meet);
            self.passed += usize::from(truth == Truth::Pass);
            self.false_hits += usize::from(truth == Truth::Pass && found);
            if truth == Truth::Meet && !found {
                self.missed += 1;
                self.example.get_or_insert((trial.bounds, *ray));
            }
            if truth != Truth::Touch && self.answers.len() < ENOUGH {
                self.answers.push((trial.bounds, *ray, found));
            }
        }
    }

    /// Where the boxes are missed that are met, and no others.
    fn place_of_misses(&self, margin: f64) -> Option<String> {
        let met = self
            .answers
            .iter()
            .filter(|(bounds, ray, _)| Truth::of(bounds, ray, margin) == Truth::Meet);
        let of = |(bounds, ray, found): &(Aabb, Ray, bool)| {
            let holds = |t: f64| {
                let point = ray.at(t);
                point.cmpge(bounds.min).all() && point.cmple(bounds.max).all()
            };
            let backwards = ray.direction.to_array().map(|along| along < 0.0);
            let ends = [holds(ray.t_min), holds(ray.t_max)];
            let places = backwards.into_iter().chain(ends).chain([has_negative_zero(ray)]);
            (*found, Vec::new(), places.collect())
        };
        place_of_wrong(TERMS, met.map(of))
    }

    fn finding(&self, margin: f64) -> Finding {
        let share = self.false_hits as f64 / self.passed.max(1) as f64;
        let measures = vec![
            Measure::none(format!("boxes missed of {} that are met", self.met), self.missed),
            Measure::exact("share of boxes hit for nothing (not graded)", share, 0.0, 1.0),
        ];
        let for_nothing = match self.false_hits {
            0 => "none is hit for nothing".to_owned(),
            _ => format!("{} of the others are hit for nothing", percent(share)),
        };
        let statement = match self.example {
            None => format!("none of {} boxes is missed; {for_nothing}", self.met),
            Some((Aabb { min, max }, Ray { origin, direction, .. })) => {
                let some = some_are(self.missed, self.met, "boxes");
                let example = format!("{min} to {max} from {origin} towards {direction}");
                format!("{some} missed; for example {example}; {for_nothing}")
            }
        };
        let (one_in, overlap) = (one_in(self.met), figure(margin));
        let resolution = format!(
            "would have caught a miss in one of {one_in} boxes, by an overlap of {overlap} of t"
        );
        let wrong = if self.missed > 0 { wrong_as(&self.answers) } else { None };
        let place = if wrong.is_none() { self.place_of_misses(margin) } else { None };
        let place = place.map(|place| format!("boxes are missed by rays {place}"));
        let finding = Finding::of(statement, resolution, measures).by_law(place);
        because(finding, wrong.as_ref(), &format!("which of {} segments hit", self.answers.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::exact_overlap::Overlap;
    use super::super::slabs::{Slabs, hitting, single_mistakes};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::rng::Seed;

    fn found(hits: impl Fn(Slabs, &Ray) -> bool + Send + 'static) -> Finding {
        let check = check_of::<BoxesAreNeverMissed>("[expect]\nrays = \"50 k\"");
        judge(&check, &mut hitting(hits))
    }

    #[test]
    fn the_truth_agrees_with_rationals() {
        let mut counts = [0; 3];
        for number in 0..4 {
            let trial = Trial::random(Seed(number));
            for ray in &trial.rays[..300] {
                let truth = Truth::of(&trial.bounds, ray, 1e-12);
                counts[truth as usize] += 1;
                if truth != Truth::Touch {
                    let exact = Overlap::exact(&trial.bounds, ray).unwrap().hits;
                    assert_eq!(truth == Truth::Meet, exact, "{:?} {ray:?}", trial.bounds);
                }
            }
        }
        assert!(counts[0] > 200 && counts[1] > 200 && counts[2] < 100, "{counts:?}");
    }

    #[test]
    fn the_right_test_passes() {
        let finding = found(|slabs, ray| slabs.span().hits(ray));
        assert_passes(&finding);
        assert!(finding.statement.ends_with("none is hit for nothing"), "{}", finding.statement);
    }

    #[test]
    fn every_mistake_that_loses_boxes_fails_under_its_name() {
        let findings = single_mistakes()
            .map(|mistake| (mistake, found(move |slabs, ray| mistake.hits(slabs, ray))));
        let failed: Vec<_> = findings.filter(|(_, finding)| finding.failed()).collect();
        assert_eq!(failed.len(), 3, "not swapped, from inside, ends inside");
        for (mistake, finding) in failed {
            assert_eq!(finding.clues[0].cause, mistake.cause.name);
        }
    }

    #[test]
    fn planes_that_are_swapped_by_a_sign_which_minus_zero_has_not_are_told_by_their_rays() {
        let finding = found(|slabs, ray| slabs.span().hits(ray) && !has_negative_zero(ray));
        assert_eq!(finding.laws, ["boxes are missed by rays with a −0 in their direction"]);
    }

    #[test]
    fn a_test_that_shrinks_boxes_a_little_is_seen_and_has_no_name() {
        let finding = found(|slabs, ray| {
            let span = slabs.span();
            span.hits(ray) && span.exits - span.enters > 1e-4 * span.exits.abs()
        });
        assert!(failure(&finding).contains("missed; for example "), "{finding:?}");
        assert!(finding.clues.is_empty());
    }
}
