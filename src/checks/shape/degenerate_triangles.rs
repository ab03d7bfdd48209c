//! Triangles that are none, rays that run in their plane, directions of any length: an answer is
//! asked for, not a crash and not NaN, and what has no area is not hit.

use super::awkward::{ANY_LENGTH, IN_PLANE, Question, questions};
use crate::cause::shape;
use crate::checks::phrase::some_are;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{BreachKind, CoreError, Hit};

check! {
    /// Degenerate triangles are missed, and every other question gets an answer.
    pub(crate) struct DegenerateTriangles {}
    name: "degenerate-triangles",
    summary: "triangles without area, rays in their plane: no crash, no NaN",
    needs: INTERSECT_PRIMITIVE,
}

impl Check for DegenerateTriangles {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut outcomes = Vec::new();
        for question in questions(&mut context.seed.stream()) {
            let rays = question.rays.len();
            let mut hits = vec![Hit::MISS; rays];
            let asked =
                context.core.intersect_primitive(&question.primitive, &question.rays, &mut hits);
            let complaint = match asked {
                Ok(()) => None,
                Err(error @ (CoreError::BrokeContract(_) | CoreError::Crashed { .. })) => {
                    Some(error)
                }
                Err(other) => return Err(other.into()),
            };
            let hit = hits.iter().filter(|hit| complaint.is_none() && hit.is_hit()).count();
            outcomes.push(Outcome { question, hit, complaint });
        }
        Ok(judge(&outcomes))
    }
}

/// What came of a question.
struct Outcome {
    question: Question,
    hit: usize,
    /// Why there is no answer.
    complaint: Option<CoreError>,
}

impl Outcome {
    fn wrong_hits(&self) -> usize {
        if self.question.may_hit { 0 } else { self.hit }
    }

    fn measures(&self) -> [Measure; 2] {
        [
            Measure::none("questions without an answer", usize::from(self.complaint.is_some())),
            Measure::none("wrong hits", self.wrong_hits()),
        ]
        .map(|measure| measure.of_row(self.question.name))
    }

    fn words(&self) -> Option<String> {
        let name = self.question.name;
        if let Some(complaint) = &self.complaint {
            return Some(format!("{name}: {complaint}"));
        }
        let all = self.question.rays.len();
        let wrong = self.wrong_hits();
        (wrong > 0).then(|| format!("{name}: {} hits", some_are(wrong, all, "rays")))
    }
}

fn judge(outcomes: &[Outcome]) -> Finding {
    let rays: usize = outcomes.iter().map(|outcome| outcome.question.rays.len()).sum();
    let right =
        format!("{rays} rays at triangles of no area, in planes and along edges get answers");
    let measures = outcomes.iter().flat_map(Outcome::measures).collect();
    let finding = Finding::of(right, "would have caught one wrong answer", measures)
        .complaining(outcomes.iter().filter_map(Outcome::words));
    explain(finding, outcomes)
}

fn explain(finding: Finding, outcomes: &[Outcome]) -> Finding {
    let is_nan = |outcome: &Outcome| {
        matches!(&outcome.complaint, Some(CoreError::BrokeContract(breach))
            if breach.kind == BreachKind::NotANumber)
    };
    let count = |is: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|o| is(o)).count();
    let (nan, hit) = (count(&is_nan), count(&|outcome| outcome.wrong_hits() > 0));
    let in_plane = count(&|outcome| outcome.question.name == IN_PLANE && is_nan(outcome));
    let (all, without_area) = (outcomes.len(), count(&|outcome| !outcome.question.may_hit));
    let nan_told = format!(
        "{nan} of {all} kinds of questions are answered with NaN, rays in the plane of a triangle too"
    );
    // What misses triangles that have an area hits those that have none for the same reason, whatever it is.
    let meets = |outcome: &Outcome| 10 * outcome.hit >= 9 * outcome.question.rays.len();
    let meets_others = count(&|outcome| outcome.question.name == ANY_LENGTH && meets(outcome)) > 0;
    let hit_told = format!("{hit} of {without_area} kinds of triangles without area are hit");
    finding
        .because_of((in_plane > 0).then_some((&shape::NAN_HIT_ACCEPTED, nan_told)))
        .because_of((hit > 0 && meets_others).then_some((&shape::DEGENERATE_HIT, hit_told)))
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer, Formula, intersection};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::{Primitive, Ray};
    use glam::DVec3;

    fn found(formula: Formula) -> Finding {
        judge(&check_of::<DegenerateTriangles>("[expect]"), &mut Fake::intersecting(formula))
    }

    #[test]
    fn comparisons_that_nan_makes_false_pass() {
        assert_passes(&found(|primitive, ray| {
            intersection(primitive, ray).filter(|answer| answer.geometric_normal.is_finite())
        }));
    }

    /// Rejects instead of accepting, so that NaN comes through, and does not look at the determinant.
    fn rejecting(primitive: &Primitive, ray: &Ray) -> Option<Answer> {
        let Primitive::Triangle { positions: [a, b, c], .. } = *primitive else { return None };
        let (e1, e2, from_a) = (b - a, c - a, ray.origin - a);
        let scale = e1.dot(ray.direction.cross(e2)).recip();
        let v = scale * from_a.dot(ray.direction.cross(e2));
        let w = scale * ray.direction.dot(from_a.cross(e1));
        let t = scale * e2.dot(from_a.cross(e1));
        if v < 0.0 || w < 0.0 || v + w > 1.0 || t < ray.t_min || t > ray.t_max {
            return None;
        }
        Some(Answer::of_sphere(t, DVec3::Z))
    }

    #[test]
    fn nan_that_comes_through_is_told_with_its_triangle() {
        let finding = found(rejecting);
        let told = "three times the same vertex: the core broke";
        assert!(failure(&finding).starts_with(told), "{finding:?}");
        assert_eq!(finding.clues[0].cause, "nan-hit-accepted");
    }

    /// Tests `|det| < ε` first, as many do: what NaN makes of that comparison is accepted.
    fn rejecting_small(primitive: &Primitive, ray: &Ray) -> Option<Answer> {
        let Primitive::Triangle { positions: [a, b, c], .. } = *primitive else { return None };
        let determinant = (b - a).dot(ray.direction.cross(c - a));
        if determinant.abs() < 1e-12 { None } else { rejecting(primitive, ray) }
    }

    #[test]
    fn nan_of_vertices_that_are_nan_is_no_ray_in_a_plane() {
        let finding = found(rejecting_small);
        let statement = failure(&finding);
        assert!(statement.starts_with("a vertex that is NaN: the core broke"), "{statement}");
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn hits_on_nothing_are_counted_and_named() {
        let finding = found(|primitive, ray| {
            rejecting(primitive, ray).map(|answer| Answer { t: 1.0, ..answer })
        });
        let told = "three times the same vertex: 200 of 200 rays are hits";
        assert!(failure(&finding).contains(told), "{finding:?}");
        assert_eq!(finding.clues[0].cause, "degenerate-triangle-hit");
    }

    #[test]
    fn hits_on_nothing_have_no_name_where_triangles_with_an_area_are_missed() {
        let finding = found(|primitive, ray| {
            let Primitive::Triangle { positions, normals } = *primitive else { return None };
            let [a, b, _] = positions;
            let positions = [a, b, DVec3::new(4.0, -3.0, 2.0)];
            rejecting(&Primitive::Triangle { positions, normals }, ray)
        });
        assert!(failure(&finding).contains("three times the same vertex"), "{finding:?}");
        assert!(finding.clues.iter().all(|clue| clue.cause != "degenerate-triangle-hit"));
    }

    #[test]
    fn a_panic_is_told_as_one() {
        let finding = found(|_, ray| {
            assert!(ray.direction.length() < 10.0, "too long");
            None
        });
        let statement = failure(&finding);
        assert!(statement.contains("a direction of any length: the core crashed"), "{statement}");
    }
}
