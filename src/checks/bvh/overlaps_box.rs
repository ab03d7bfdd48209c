//! Rows of rays against boxes, the slab test, with exact rational arithmetic as the judge of the
//! rows themselves.
//!
//! A ray that runs exactly along a face of the box divides 0 by 0 in the textbook's slab test, and
//! correct programs differ there: such rows are marked `robustness`, shown, and not graded. A false
//! hit only costs time; a false miss loses what is in the box.

use super::slabs::{Wrong, because, wrong_as};
use crate::checks::phrase::{figure, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{BoxHit, Ray};
use crate::scene::Aabb;
use crate::stats::Tolerance;
use crate::text::{Arrow, Several, Vector};
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use serde::Deserialize;

check! {
    /// Rays meet boxes where their rows say.
    pub(crate) struct OverlapsBox {
        /// For the rows that have no box of their own.
        r#box: BoxEntry,
        ray: Several<RayRow>,
    }
    name: "overlaps-box",
    summary: "rows of rays against boxes, with exact arithmetic as the judge",
    needs: INTERSECT_BOX,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxEntry {
    min: Vector,
    max: Vector,
}

/// A ray segment, and whether it meets the closed box.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RayRow {
    r#box: Option<BoxEntry>,
    from: Vector,
    toward: Arrow,
    #[serde(default)]
    after: f64,
    #[serde(default = "infinity")]
    up_to: f64,
    hits: bool,
    #[serde(default)]
    because: String,
    /// Shown, but not graded: correct implementations differ.
    #[serde(default)]
    robustness: bool,
}

const fn infinity() -> f64 {
    f64::INFINITY
}

impl RayRow {
    fn ray(&self) -> Ray {
        let (origin, direction) = (self.from.0, self.toward.0);
        Ray { origin, t_min: self.after, direction, t_max: self.up_to }
    }

    fn label(&self, number: usize) -> String {
        match self.because.as_str() {
            "" => format!("ray {}", number + 1),
            because => format!("ray {} ({because})", number + 1),
        }
    }
}

impl OverlapsBox {
    fn bounds(&self, row: &RayRow) -> Aabb {
        let BoxEntry { min, max } = row.r#box.unwrap_or(self.r#box);
        Aabb { min: min.0, max: max.0 }
    }
}

impl Check for OverlapsBox {
    fn validate(&self) -> Result<(), String> {
        for (number, row) in self.ray.iter().enumerate() {
            let truth = Overlap::exact(&self.bounds(row), &row.ray());
            let truth = truth.ok_or_else(|| format!("ray {} is not finite", number + 1))?;
            let bounds = self.bounds(row);
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
            context.core.intersect_box(&self.bounds(row), &[row.ray()], &mut hit)?;
            answers.push(hit[0]);
        }
        Ok(self.judge(&answers, Tolerance::INTERSECTION.of(context.info.precision)))
    }
}

impl OverlapsBox {
    fn judge(&self, answers: &[BoxHit], allowed: f64) -> Finding {
        let mut measures = Vec::new();
        let mut complaints = Vec::new();
        for (number, (row, answer)) in self.ray.iter().zip(answers).enumerate() {
            let mut of_row = self.row_measures(row, number, answer, allowed);
            if row.robustness {
                of_row = of_row.into_iter().map(Measure::not_graded).collect();
            } else if let Some(worst) = of_row.iter().find(|measure| measure.failed()) {
                complaints.push(complaint(row, number, answer, worst));
            }
            measures.extend(of_row);
        }
        let graded = self.ray.iter().filter(|row| !row.robustness).count();
        let wrong = if complaints.is_empty() { None } else { self.wrong_as(answers) };
        let statement = if complaints.is_empty() {
            self.passing_statement(graded, answers)
        } else {
            let some = some_are(complaints.len(), graded, "rays");
            let why =
                wrong.as_ref().map_or_else(String::new, |wrong| format!(": {}", wrong.words()));
            format!("{some} wrong{why}; {}", complaints.join("; "))
        };
        let finding = Finding::of(statement, "would have caught one wrong ray", measures);
        because(finding, wrong.as_ref(), &format!("which of {graded} rays hit"))
    }

    fn row_measures(
        &self,
        row: &RayRow,
        number: usize,
        answer: &BoxHit,
        allowed: f64,
    ) -> Vec<Measure> {
        let label = row.label(number);
        let flag = |hits| f64::from(u8::from(hits));
        let hits = answer.hit == 1;
        let mut measures = vec![Measure::exact("hits", flag(hits), flag(row.hits), 0.0)];
        if let (true, Some(truth)) = (hits, Overlap::exact(&self.bounds(row), &row.ray()))
            && truth.hits
        {
            let end =
                |what, found, right: f64| Measure::exact(what, found, right, allowed * right.abs());
            measures.push(end("t_enter", answer.t_enter, truth.enters));
            measures.push(end("t_exit", answer.t_exit, truth.exits));
        }
        measures.into_iter().map(|measure| measure.of_row(&label)).collect()
    }

    fn passing_statement(&self, graded: usize, answers: &[BoxHit]) -> String {
        let rows = || self.ray.iter().zip(answers).filter(|(row, _)| row.robustness);
        let robust = rows().filter(|(row, answer)| (answer.hit == 1) == row.hits).count();
        match rows().count() {
            0 => format!("{graded} rays meet boxes as they should"),
            all => format!(
                "{graded} rays meet boxes as they should; of {all} along a face, not graded, {robust} do"
            ),
        }
    }

    /// The wrong implementation that gives every graded answer of the core.
    fn wrong_as(&self, answers: &[BoxHit]) -> Option<Wrong> {
        let graded = || self.ray.iter().zip(answers).filter(|(row, _)| !row.robustness);
        if graded().all(|(row, answer)| row.hits == (answer.hit == 1)) {
            return None;
        }
        let answered = graded().map(|(row, answer)| (self.bounds(row), row.ray(), answer.hit == 1));
        wrong_as(&answered.collect::<Vec<_>>())
    }
}

fn complaint(row: &RayRow, number: usize, answer: &BoxHit, worst: &Measure) -> String {
    let label = row.label(number);
    match (answer.hit == 1, row.hits) {
        (true, false) => format!("{label} hits, and should miss"),
        (false, true) => format!("{label} misses, and should hit"),
        _ => {
            let (found, right) = (figure(worst.measured), figure(worst.expected));
            format!("{} is {found} instead of {right}", worst.name())
        }
    }
}

/// The truth about a ray and a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overlap {
    pub(super) hits: bool,
    /// Where the line enters the box and leaves it, rounded once.
    enters: f64,
    exits: f64,
}

impl Overlap {
    /// In rationals: t ∈ [(lo − o)/d, (hi − o)/d] on each axis, or the axis decides alone if d = 0.
    /// `None` if a number that has to be finite is not.
    pub(super) fn exact(bounds: &Aabb, ray: &Ray) -> Option<Self> {
        let mut line: Option<(BigRational, BigRational)> = None;
        for axis in 0..3 {
            let [low, high, origin, direction] =
                [bounds.min[axis], bounds.max[axis], ray.origin[axis], ray.direction[axis]]
                    .map(BigRational::from_float);
            let (from, to, direction) =
                (low? - origin.as_ref()?, high? - origin.as_ref()?, direction?);
            if direction.is_zero() {
                if from > BigRational::zero() || to < BigRational::zero() {
                    return Some(Self { hits: false, enters: f64::NAN, exits: f64::NAN });
                }
                continue;
            }
            let (a, b) = (from / &direction, to / &direction);
            let (near, far) = if a <= b { (a, b) } else { (b, a) };
            line = Some(match line {
                None => (near, far),
                Some((enters, exits)) => (enters.max(near), exits.min(far)),
            });
        }
        let (enters, exits) = line?;
        let starts_in_time = BigRational::from_float(ray.t_max).is_none_or(|end| enters <= end);
        let ends_late_enough =
            BigRational::from_float(ray.t_min).is_none_or(|start| exits >= start);
        let hits = enters <= exits && starts_in_time && ends_late_enough;
        Some(Self { hits, enters: enters.to_f64()?, exits: exits.to_f64()? })
    }
}

#[cfg(test)]
mod tests {
    use super::super::slabs::{Slabs, hitting, pairs_of_mistakes, single_mistakes};
    use super::*;
    use crate::cause::bvh;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::stats::Verdict;
    use glam::DVec3;

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
        for number in 0..single_mistakes().count() {
            let mistake = || single_mistakes().nth(number).unwrap();
            let named = (0..CASES.len()).any(|case| {
                let wrong = mistake();
                let finding = found(case, move |slabs, ray| wrong.hits(slabs, ray));
                finding.verdict == Verdict::Fail
                    && finding.clues.iter().any(|clue| clue.cause == mistake().cause.name)
            });
            assert!(named, "{}", mistake().cause.name);
        }
    }

    #[test]
    fn two_mistakes_are_told_together() {
        let wrong = pairs_of_mistakes().find(|wrong| {
            wrong.cause == &bvh::BOX_SEGMENT_IGNORED
                && wrong.besides == Some(&bvh::PARALLEL_AXES_SKIPPED)
        });
        let finding = found(0, {
            let wrong = wrong.unwrap();
            move |slabs, ray| wrong.hits(slabs, ray)
        });
        let statement = failure(&finding);
        assert!(
            statement.starts_with(
                "7 of 18 rays are wrong: the slab test ignores t_min and t_max, and the slab test"
            ),
            "{statement}"
        );
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

    #[test]
    fn exact_arithmetic_sees_what_doubles_cannot() {
        // The ray leaves x at t = 2 and enters y at 2 + 2ε, or at 2.
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 1.0) };
        let just_over = 1.0 + f64::EPSILON;
        let ray = Ray::new(DVec3::new(-1.0, -just_over, 0.5), DVec3::new(1.0, 0.5, 0.0));
        assert!(!Overlap::exact(&bounds, &ray).unwrap().hits);
        let ray = Ray::new(DVec3::new(-1.0, -1.0, 0.5), DVec3::new(1.0, 0.5, 0.0));
        assert!(Overlap::exact(&bounds, &ray).unwrap().hits);
    }
}
