//! Rows of rays against one triangle or one sphere, each with what has to come out of it.

use super::entry::{SphereEntry, TriangleEntry};
use super::hit_row::{Row, complaint, measures};
use super::imitation::{Answer, explanations, intersection};
use crate::cause::Cause;
use crate::checks::few::Few;
use crate::checks::phrase::{percent, some_are};
use crate::checks::ray_row::{Grades, RayRow};
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::{Hit, Precision, Primitive, Ray};
use crate::stats::Tolerance;

/// Wrong rays that a statement spells out.
const SPELT_OUT: usize = 3;

check! {
    /// Rays meet a primitive where their rows say, and nowhere else.
    pub(crate) struct HitsPrimitive {
        triangle: Option<TriangleEntry>,
        sphere: Option<SphereEntry>,
        ray: Vec<Row>,
    }
    name: "hits-primitive",
    summary: "rows of rays against one triangle or sphere",
    needs: INTERSECT_PRIMITIVE,
}

impl HitsPrimitive {
    fn primitive(&self) -> Option<Primitive> {
        match (self.triangle, self.sphere) {
            (Some(triangle), None) => Some(triangle.primitive()),
            (None, Some(sphere)) => Some(sphere.primitive()),
            _ => None,
        }
    }
}

impl Check for HitsPrimitive {
    fn validate(&self) -> Result<(), String> {
        let primitive = self.primitive().ok_or("give either a `triangle` or a `sphere`")?;
        if !self.ray.iter().any(Row::is_graded) {
            return Err("no ray is graded".to_owned());
        }
        for (number, row) in self.ray.iter().enumerate() {
            let ray = row.ray();
            if ray.t_min.is_nan() || ray.t_max.is_nan() || ray.t_min < 0.0 {
                let told = "a segment ends at numbers, and begins at 0 or later";
                return Err(format!("{}: {told}", row.label(number)));
            }
            if !row.is_graded() {
                continue;
            }
            let answer = intersection(&primitive, &ray);
            if !row.is_true_of(answer.as_ref()) {
                let truth = answer.map_or_else(|| "a miss".to_owned(), |answer| answer.in_words());
                return Err(format!("{}: the geometry gives {truth}", row.label(number)));
            }
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let primitive =
            self.primitive().ok_or_else(|| CheckError::Broken("no primitive".into()))?;
        let rays: Vec<_> = self.ray.iter().map(Row::ray).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        context.core.intersect_primitive(&primitive, &rays, &mut hits)?;
        Ok(judge(&self.ray, &primitive, &hits, context.info.precision))
    }
}

fn judge(rows: &[Row], primitive: &Primitive, hits: &[Hit], precision: Precision) -> Finding {
    let mut grades = Grades::default();
    for (number, (row, hit)) in rows.iter().zip(hits).enumerate() {
        let answer = right_for(primitive, &row.ray(), hit.t, precision);
        let measures = measures(row, number, answer.as_ref(), hit, precision);
        grades.take(row, measures, |worst| complaint(row, number, answer.as_ref(), hit, worst));
    }
    let graded = || rows.iter().zip(hits).filter(|(row, _)| row.is_graded());
    let rays: Vec<_> = graded().map(|(row, _)| row.ray()).collect();
    let answers: Vec<_> = graded().map(|(_, hit)| *hit).collect();
    let allowed = Tolerance::INTERSECTION.of(precision);
    let resolution = format!("would have caught a t that is off by {}", percent(allowed));
    let right = format!("{} rays come out as they should", rays.len());
    let finding = Finding::of(right, resolution, grades.measures);
    if grades.complaints.is_empty() {
        return finding;
    }
    let few = explanations(primitive, &rays, &answers, 100.0 * allowed);
    let evidence = format!("predicts the answers to all {} rays", rays.len());
    let statement = failing_statement(&grades.complaints, rays.len(), &few);
    finding.complaining([statement]).because_few(few, &evidence)
}

/// What has to come out of a ray that hits at `t`. The normal of a sphere is that of the point where the core hits, if it may hit
/// there: near the silhouette normals turn by more than t is off.
fn right_for(primitive: &Primitive, ray: &Ray, t: f64, precision: Precision) -> Option<Answer> {
    let answer = intersection(primitive, ray)?;
    let allowed = Tolerance::INTERSECTION.of(precision) * answer.t.abs();
    match primitive {
        Primitive::Sphere { centre, .. } if (t - answer.t).abs() <= allowed => {
            let normal = (ray.at(t) - *centre).normalize();
            Some(Answer { geometric_normal: normal, shading_normal: normal, ..answer })
        }
        _ => Some(answer),
    }
}

fn failing_statement(complaints: &[String], all: usize, few: &Few<&'static Cause>) -> String {
    let wrong = some_are(complaints.len(), all, "rays");
    let details = complaints[..complaints.len().min(SPELT_OUT)].join("; ");
    let more = if complaints.len() > SPELT_OUT { "; and so on" } else { "" };
    let why = if few.is_empty() { String::new() } else { few.words() + ". " };
    format!("{wrong} wrong: {why}{details}{more}")
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Intersection, MISTAKES, mistake};
    use super::*;
    use crate::cause::shape;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge, try_judge};

    const CASES: [&str; 4] = [
        include_str!("../../../cases/shape/ray-triangle-hits-are-right.toml"),
        include_str!("../../../cases/shape/hits-lie-between-t-min-and-t-max.toml"),
        include_str!("../../../cases/shape/shading-normals-are-interpolated.toml"),
        include_str!("../../../cases/shape/ray-sphere-hit-is-the-nearest-root-ahead.toml"),
    ];

    fn found(
        case: usize,
        formula: impl Fn(&Primitive, &Ray) -> Option<Answer> + Send + 'static,
    ) -> Finding {
        judge(&check_of::<HitsPrimitive>(CASES[case]), &mut Fake::intersecting(formula))
    }

    #[test]
    fn the_right_formula_passes_every_case() {
        (0..CASES.len()).for_each(|case| assert_passes(&found(case, intersection)));
    }

    #[test]
    fn every_mistake_is_told_and_named_by_one_of_the_cases() {
        for (cause, _) in MISTAKES {
            // A wrong sphere may answer a triangle with what is no answer at all.
            let is_named = |case: &str| {
                let check: HitsPrimitive = check_of(case);
                let found = try_judge(&check, &mut Fake::intersecting(mistake(cause)), None);
                found.is_ok_and(|finding| {
                    finding.failed()
                        && finding.statement.contains(cause.headline)
                        && causes(&finding).contains(&cause.name)
                })
            };
            assert!(CASES.into_iter().any(is_named), "{}", cause.name);
        }
    }

    #[test]
    fn a_wrong_hit_and_a_wrong_normal_are_told_together() {
        let of = |cause: &Cause| MISTAKES.iter().find(|(known, _)| *known == cause).unwrap().1;
        let [wide, facing] = [&shape::PARALLELOGRAM, &shape::NORMALS_FACE_RAY];
        let both = Intersection::RIGHT.with(of(wide)).with(of(facing));
        let finding = found(0, move |primitive, ray| both.answer(primitive, ray));
        assert_eq!(causes(&finding), [wide.name, facing.name]);
        assert!(finding.clues.iter().all(|clue| clue.beside));
    }

    #[test]
    fn a_ray_from_inside_that_misses_is_told_where_it_should_hit() {
        let finding = found(3, mistake(&shape::NEAR_ROOT_ONLY));
        assert!(failure(&finding).contains("misses; it should hit at t = "), "{finding:?}");
    }

    #[test]
    fn near_the_silhouette_a_normal_is_that_of_where_the_core_hits() {
        let sphere = Primitive::Sphere { centre: glam::DVec3::ZERO, radius: 1.0 };
        let ray = Ray::new(glam::DVec3::new(0.999_999, 0.0, 3.0), glam::DVec3::NEG_Z);
        let right = intersection(&sphere, &ray).unwrap();
        let t = right.t * (1.0 + 0.5 * Tolerance::INTERSECTION.of(Precision::Single));
        let there = right_for(&sphere, &ray, t, Precision::Single).unwrap();
        let turned = there.geometric_normal.distance(right.geometric_normal);
        assert!(turned > Tolerance::DIRECTION.of(Precision::Single), "{turned}");
        assert_eq!(there.t, right.t);
        assert_eq!(right_for(&sphere, &ray, 2.0 * t, Precision::Single), Some(right), "elsewhere");
    }

    #[test]
    fn a_core_that_hits_nothing_is_not_explained() {
        for case in 0..CASES.len() {
            assert!(causes(&found(case, |_, _| None)).is_empty());
        }
    }

    #[test]
    fn rows_for_robustness_are_shown_and_not_graded() {
        let text = "[expect]\nsphere = { centre = [0, 0, 0], radius = 1 }\n\
             [[expect.ray]]\nfrom = [3, 0, 0]\ntoward = [1, 0, 0]\nhits = false\n\
             [[expect.ray]]\nfrom = [0, 3, 0]\ntoward = [1, 0, 0]\n\
             hits = true\nt = 1.0\nrobustness = true\n";
        let check: HitsPrimitive = check_of(text);
        let finding = judge(&check, &mut Fake::intersecting(intersection));
        assert_passes(&finding);
        assert_eq!(finding.measures[1].measured, 0.0);
    }

    #[test]
    fn a_row_that_contradicts_its_own_geometry_is_the_cases_fault() {
        let text = "sphere = { centre = [0, 0, 0], radius = 1 }\n\
                    [[ray]]\nfrom = [3, 0, 0]\ntoward = [-1, 0, 0]\nhits = true\nt = 2.5\n";
        let error = crate::text::read_toml::<HitsPrimitive>(text).unwrap().validate().unwrap_err();
        let truth = "ray 1: the geometry gives t = 2, normal = [1, 0, 0]";
        assert!(error.starts_with(truth), "{error}");
    }
}
