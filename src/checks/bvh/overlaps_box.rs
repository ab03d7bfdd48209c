//! Rows of rays against boxes, the slab test, with exact rational arithmetic as the judge of the rows themselves.
//!
//! A ray that runs exactly along a face of the box divides 0 by 0 in the textbook's slab test, and
//! correct programs differ there: such rows are marked `robustness`, shown, and not graded. A false
//! hit only costs time; a false miss loses what is in the box.

use super::box_row::{BoxEntry, Row, complaint, measures};
use super::exact_overlap::Overlap;
use super::slabs::{Wrong, because, wrong_as};
use crate::checks::phrase::some_are;
use crate::checks::ray_row::{Grades, RayRow};
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::BoxHit;
use crate::stats::Tolerance;
use crate::text::Several;

check! {
    /// Rays meet boxes where their rows say.
    pub(crate) struct OverlapsBox {
        /// For the rows that have no box of their own.
        r#box: BoxEntry,
        ray: Several<Row>,
    }
    name: "overlaps-box",
    summary: "rows of rays against boxes, with exact arithmetic as the judge",
    needs: INTERSECT_BOX,
}

impl Check for OverlapsBox {
    fn validate(&self) -> Result<(), String> {
        for (number, row) in self.ray.iter().enumerate() {
            let bounds = row.bounds(self.r#box);
            let truth = Overlap::exact(&bounds, &row.ray());
            let truth = truth.ok_or_else(|| format!("ray {} is not finite", number + 1))?;
            if !bounds.min.cmple(bounds.max).all() {
                return Err(format!("{}: the box ends before it begins", row.label(number)));
            }
            if truth.hits != row.hits {
                let row = row.label(number);
                return Err(format!("{row}: exact arithmetic says that hits = {}", truth.hits));
            }
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut answers = Vec::new();
        for row in self.ray.iter() {
            let mut hit = [BoxHit { t_enter: 0.0, t_exit: 0.0, hit: 0, reserved: 0 }];
            context.core.intersect_box(&row.bounds(self.r#box), &[row.ray()], &mut hit)?;
            answers.push(hit[0]);
        }
        Ok(self.judge(&answers, Tolerance::INTERSECTION.of(context.info.precision)))
    }
}

impl OverlapsBox {
    fn judge(&self, answers: &[BoxHit], allowed: f64) -> Finding {
        let mut grades = Grades::default();
        for (number, (row, answer)) in self.ray.iter().zip(answers).enumerate() {
            let measures = measures(row, number, &row.bounds(self.r#box), answer, allowed);
            grades.take(row, measures, |worst| complaint(row, number, answer, worst));
        }
        let Grades { measures, complaints } = grades;
        let graded = self.ray.iter().filter(|row| row.is_graded()).count();
        let right = self.passing_statement(graded, answers);
        let finding = Finding::of(right, "would have caught one wrong ray", measures);
        if complaints.is_empty() {
            return finding;
        }
        let wrong = self.wrong_as(answers);
        let some = some_are(complaints.len(), graded, "rays");
        let why = wrong.as_ref().map_or_else(String::new, |wrong| format!(": {}", wrong.words()));
        let finding =
            finding.complaining([format!("{some} wrong{why}; {}", complaints.join("; "))]);
        because(finding, wrong.as_ref(), &format!("which of {graded} rays hit"))
    }

    fn passing_statement(&self, graded: usize, answers: &[BoxHit]) -> String {
        let right = format!("{graded} rays meet boxes as they should");
        let rows = || self.ray.iter().zip(answers).filter(|(row, _)| !row.is_graded());
        let robust = rows().filter(|(row, answer)| (answer.hit == 1) == row.hits).count();
        match rows().count() {
            0 => right,
            all => format!("{right}; of {all} along a face, not graded, {robust} do"),
        }
    }

    /// The wrong implementation that gives every graded answer of the core.
    fn wrong_as(&self, answers: &[BoxHit]) -> Option<Wrong> {
        let graded = || self.ray.iter().zip(answers).filter(|(row, _)| row.is_graded());
        if graded().all(|(row, answer)| row.hits == (answer.hit == 1)) {
            return None;
        }
        let answered =
            graded().map(|(row, answer)| (row.bounds(self.r#box), row.ray(), answer.hit == 1));
        wrong_as(&answered.collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::super::slabs::{Slabs, hitting, pairs_of_mistakes, single_mistakes};
    use super::*;
    use crate::cause::bvh;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::Ray;

    const CASES: [&str; 3] = [
        include_str!("../../../cases/bvh/ray-box-overlap-is-right.toml"),
        include_str!("../../../cases/bvh/flat-boxes-are-hit.toml"),
        include_str!("../../../cases/bvh/rays-in-a-face-hit-the-box.toml"),
    ];

    fn found(case: usize, hits: impl Fn(Slabs, &Ray) -> bool + Send + 'static) -> Finding {
        judge(&check_of::<OverlapsBox>(CASES[case]), &mut hitting(hits))
    }

    #[test]
    fn the_right_test_passes_every_case() {
        for case in 0..CASES.len() {
            assert_passes(&found(case, |slabs, ray| slabs.span().hits(ray)));
        }
    }

    #[test]
    fn every_mistake_is_caught_and_named_by_one_of_the_cases() {
        for mistake in single_mistakes() {
            let named = (0..CASES.len()).any(|case| {
                let finding = found(case, move |slabs, ray| mistake.hits(slabs, ray));
                finding.failed()
                    && finding.clues.iter().any(|clue| clue.cause == mistake.cause.name)
            });
            assert!(named, "{}", mistake.cause.name);
        }
    }

    #[test]
    fn two_mistakes_are_told_together() {
        let both = (&bvh::BOX_SEGMENT_IGNORED, Some(&bvh::PARALLEL_AXES_SKIPPED));
        let mut pairs = pairs_of_mistakes();
        let wrong = pairs.find(|wrong| (wrong.cause, wrong.besides) == both).unwrap();
        let finding = found(0, move |slabs, ray| wrong.hits(slabs, ray));
        let statement = failure(&finding);
        let both =
            "7 of 19 rays are wrong: the slab test ignores t_min and t_max, and the slab test";
        assert!(statement.starts_with(both), "{statement}");
        assert_eq!(finding.clues[0].cause, "box-segment-ignored");
    }

    #[test]
    fn the_wrong_ray_is_named_with_its_reason() {
        let finding =
            found(0, |slabs, ray| slabs.span().hits(ray) && slabs.span().enters >= ray.t_min);
        let statement = failure(&finding);
        assert!(statement.contains("(from inside) misses, and should hit"), "{statement}");
    }

    #[test]
    fn a_row_that_is_not_true_is_the_cases_fault() {
        let text = "box = { min = [0, 0, 0], max = [1, 1, 1] }\n\
                    [[ray]]\nfrom = [-1, 0.5, 0.5]\ntoward = [1, 0, 0]\nhits = false\n";
        let error = crate::text::read_toml::<OverlapsBox>(text).unwrap().validate().unwrap_err();
        assert_eq!(error, "ray 1: exact arithmetic says that hits = true");
    }
}
