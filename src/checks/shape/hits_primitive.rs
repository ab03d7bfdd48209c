//! Rows of rays against one triangle or one sphere, each with what has to come out of it.

use super::imitation::{Answer, explanations, intersection};
use crate::cause::Cause;
use crate::checks::phrase::{figure, percent, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Hit, Precision, Primitive, Ray};
use crate::stats::Tolerance;
use crate::text::{Arrow, Positive, Vector};
use glam::DVec3;
use serde::Deserialize;

/// How far the numbers of a row may be from its own geometry: they are typed with this many digits.
const TYPED: f64 = 1e-6;
/// Wrong rays that a statement spells out.
const SPELT_OUT: usize = 3;

check! {
    /// Rays meet a primitive where their rows say, and nowhere else.
    pub(crate) struct HitsPrimitive {
        triangle: Option<TriangleEntry>,
        sphere: Option<SphereEntry>,
        ray: Vec<RayRow>,
    }
    name: "hits-primitive",
    summary: "rows of rays against one triangle or sphere",
    needs: INTERSECT_PRIMITIVE,
}

/// Vertices counter-clockwise, and the shading normals at them; none for a flat triangle.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TriangleEntry {
    vertices: [Vector; 3],
    normals: Option<[Arrow; 3]>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereEntry {
    centre: Vector,
    radius: Positive,
}

/// A ray segment and what has to come out of it. What a row does not say is known from the geometry.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RayRow {
    from: Vector,
    toward: Arrow,
    #[serde(default)]
    after: f64,
    #[serde(default = "infinity")]
    up_to: f64,
    hits: bool,
    t: Option<f64>,
    normal: Option<DVec3>,
    shading_normal: Option<DVec3>,
    barycentric: Option<[f64; 3]>,
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

    /// Whether the row says what the geometry says.
    fn is_true_of(&self, answer: Option<&Answer>) -> bool {
        let Some(answer) = answer else { return !self.hits };
        let near = |typed: Option<DVec3>, known: DVec3| {
            typed.is_none_or(|typed| typed.distance(known) <= TYPED)
        };
        let weights = self.barycentric.is_none_or(|typed| {
            answer.weights.is_some_and(|known| DVec3::from(typed).distance(known.into()) <= TYPED)
        });
        self.hits
            && self.t.is_some_and(|t| (t - answer.t).abs() <= TYPED * answer.t.abs())
            && near(self.normal, answer.geometric_normal)
            && near(self.shading_normal, answer.shading_normal)
            && weights
    }

    /// `ray 3 (from inside)`
    fn label(&self, number: usize) -> String {
        match self.because.as_str() {
            "" => format!("ray {}", number + 1),
            because => format!("ray {} ({because})", number + 1),
        }
    }
}

impl HitsPrimitive {
    fn primitive(&self) -> Option<Primitive> {
        match (self.triangle, self.sphere) {
            (Some(TriangleEntry { vertices: positions, normals }), None) => {
                let positions = positions.map(|position| position.0);
                let [a, b, c] = positions;
                let flat = (b - a).cross(c - a).normalize_or_zero();
                let normals = normals
                    .map_or([flat; 3], |typed| typed.map(|normal| normal.0.normalize_or_zero()));
                Some(Primitive::Triangle { positions, normals })
            }
            (None, Some(SphereEntry { centre, radius })) => {
                Some(Primitive::Sphere { centre: centre.0, radius: radius.0 })
            }
            _ => None,
        }
    }
}

impl Check for HitsPrimitive {
    fn validate(&self) -> Result<(), String> {
        let primitive = self.primitive().ok_or("give either a `triangle` or a `sphere`")?;
        if self.ray.iter().all(|row| row.robustness) {
            return Err("no ray is graded".to_owned());
        }
        for (number, row) in self.ray.iter().enumerate().filter(|(_, row)| !row.robustness) {
            if row.after.is_nan() || row.up_to.is_nan() {
                return Err(format!("{}: a segment ends at numbers", row.label(number)));
            }
            let answer = intersection(&primitive, &row.ray());
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
        let rays: Vec<_> = self.ray.iter().map(RayRow::ray).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        context.core.intersect_primitive(&primitive, &rays, &mut hits)?;
        Ok(judge(&self.ray, &primitive, &hits, context.info.precision))
    }
}

fn judge(rows: &[RayRow], primitive: &Primitive, hits: &[Hit], precision: Precision) -> Finding {
    let mut measures = Vec::new();
    let mut complaints = Vec::new();
    for (number, (row, hit)) in rows.iter().zip(hits).enumerate() {
        let answer = intersection(primitive, &row.ray());
        let mut of_row = row_measures(row, number, answer.as_ref(), hit, precision);
        if row.robustness {
            of_row = of_row.into_iter().map(Measure::not_graded).collect();
        } else if let Some(worst) = of_row.iter().find(|measure| measure.failed()) {
            complaints.push(complaint(row, number, answer.as_ref(), hit, worst));
        }
        measures.extend(of_row);
    }
    let graded = || rows.iter().zip(hits).filter(|(row, _)| !row.robustness);
    let rays: Vec<_> = graded().map(|(row, _)| row.ray()).collect();
    let answers: Vec<_> = graded().map(|(_, hit)| *hit).collect();
    let allowed = 100.0 * Tolerance::INTERSECTION.of(precision);
    let causes = match complaints.is_empty() {
        true => Vec::new(),
        false => explanations(primitive, &rays, &answers, allowed),
    };
    let statement = match complaints.is_empty() {
        true => format!("{} rays come out as they should", rays.len()),
        false => failing_statement(&complaints, rays.len(), &causes),
    };
    let resolution = format!(
        "would have caught a t that is off by {}",
        percent(Tolerance::INTERSECTION.of(precision))
    );
    Finding::of(statement, resolution, measures)
        .because_each(causes, &format!("predicts the answers to all {} rays", rays.len()))
}

fn failing_statement(complaints: &[String], all: usize, causes: &[&Cause]) -> String {
    let wrong = some_are(complaints.len(), all, "rays");
    let mut details = complaints[..complaints.len().min(SPELT_OUT)].join("; ");
    if complaints.len() > SPELT_OUT {
        details += "; and so on";
    }
    match causes {
        [] => format!("{wrong} wrong: {details}"),
        causes => {
            let headlines: Vec<_> = causes.iter().map(|cause| cause.headline).collect();
            format!("{wrong} wrong: {}. {details}", headlines.join(", or "))
        }
    }
}

/// Whether it hits; and if it does and should, where, with which normals and weights.
fn row_measures(
    row: &RayRow,
    number: usize,
    answer: Option<&Answer>,
    hit: &Hit,
    precision: Precision,
) -> Vec<Measure> {
    let label = row.label(number);
    let flag = |hits| f64::from(u8::from(hits));
    let hits = Measure::exact("hits", flag(hit.is_hit()), flag(row.hits), 0.0).of_row(&label);
    let (true, Some(answer)) = (hit.is_hit() && row.hits, answer) else { return vec![hits] };
    let intersection = Tolerance::INTERSECTION.of(precision);
    let direction = Tolerance::DIRECTION.of(precision);
    let error = |what: &str, error: f64, allowed: f64| {
        Measure::exact(format!("error of the {what}"), error, 0.0, allowed).of_row(&label)
    };
    let geometric = hit.geometric_normal.distance(answer.geometric_normal);
    let shading = hit.shading_normal.distance(answer.shading_normal);
    let mut measures = vec![
        hits,
        Measure::exact("t", hit.t, answer.t, intersection * answer.t.abs()).of_row(&label),
        error("geometric normal", geometric, direction),
        error("shading normal", shading, direction),
    ];
    if let Some([_, v, w]) = answer.weights {
        let off = (hit.uv.x - v).abs().max((hit.uv.y - w).abs());
        measures.push(error("barycentric weights", off, intersection));
    }
    measures
}

fn complaint(
    row: &RayRow,
    number: usize,
    answer: Option<&Answer>,
    hit: &Hit,
    worst: &Measure,
) -> String {
    let label = row.label(number);
    match (hit.is_hit(), answer) {
        (true, None) => format!("{label} hits at t = {}; it should miss", figure(hit.t)),
        (false, Some(answer)) => {
            format!("{label} misses; it should hit at t = {}", figure(answer.t))
        }
        _ if worst.expected == 0.0 => format!("{} is {}", worst.name(), figure(worst.measured)),
        _ => {
            let (found, right) = (figure(worst.measured), figure(worst.expected));
            format!("{} is {found} instead of {right}", worst.name())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Formula, mistake};
    use super::*;
    use crate::cause::shape;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    const CASES: [&str; 4] = [
        include_str!("../../../cases/shape/ray-triangle-hits-are-right.toml"),
        include_str!("../../../cases/shape/hits-lie-between-t-min-and-t-max.toml"),
        include_str!("../../../cases/shape/shading-normals-are-interpolated.toml"),
        include_str!("../../../cases/shape/ray-sphere-hit-is-the-nearest-root-ahead.toml"),
    ];

    fn found(case: usize, formula: Formula) -> Finding {
        judge(&check_of::<HitsPrimitive>(CASES[case]), &mut Fake::intersecting(formula))
    }

    #[test]
    fn the_right_formula_passes_every_case() {
        (0..CASES.len()).for_each(|case| assert_passes(&found(case, intersection)));
    }

    #[test]
    fn mistakes_are_named_by_the_case_that_is_about_them() {
        let named = [
            (0, &shape::PARALLELOGRAM),
            (0, &shape::BACK_CULLED),
            (0, &shape::NORMALS_FACE_RAY),
            (1, &shape::SEGMENT_END_IGNORED),
            (1, &shape::SEGMENT_START_IGNORED),
            (1, &shape::SEGMENT_IGNORED),
            (1, &shape::HITS_BEHIND_ORIGIN),
            (1, &shape::T_IN_SCENE_UNITS),
            (2, &shape::BARYCENTRICS_SWAPPED),
            (2, &shape::NORMALS_SWAPPED),
            (2, &shape::BARYCENTRICS_MOVED_ON),
            (2, &shape::NORMALS_MOVED_BACK),
            (2, &shape::FLAT_SHADING_NORMAL),
            (2, &shape::GEOMETRIC_NORMAL_INTERPOLATED),
            (3, &shape::NEAR_ROOT_ONLY),
            (3, &shape::BOTH_ROOTS_REQUIRED),
            (3, &shape::FIRST_ROOT_UNCHECKED),
            (3, &shape::QUADRATIC_PRECEDENCE),
            (3, &shape::FAR_ROOT_TAKEN),
            (3, &shape::QUADRATIC_WITHOUT_A),
            (3, &shape::QUADRATIC_DIVIDES_BY_A),
            (3, &shape::NORMALS_INSIDE_OUT),
            (3, &shape::SEGMENT_START_IGNORED),
        ];
        for (case, cause) in named {
            let finding = found(case, mistake(cause));
            let statement = failure(&finding);
            assert!(statement.contains(cause.headline), "{}: {statement}", cause.name);
            assert!(finding.clues.iter().any(|clue| clue.cause == cause.name), "{}", cause.name);
        }
    }

    #[test]
    fn a_ray_from_inside_that_misses_is_told_where_it_should_hit() {
        let finding = found(3, mistake(&shape::NEAR_ROOT_ONLY));
        assert!(failure(&finding).contains("misses; it should hit at t = "), "{finding:?}");
    }

    #[test]
    fn rows_for_robustness_are_shown_and_not_graded() {
        let row = "hits = true\nt = 1.0\nrobustness = true";
        let text = format!(
            "[expect]\nsphere = {{ centre = [0, 0, 0], radius = 1 }}\n\
             [[expect.ray]]\nfrom = [3, 0, 0]\ntoward = [1, 0, 0]\nhits = false\n\
             [[expect.ray]]\nfrom = [0, 3, 0]\ntoward = [1, 0, 0]\n{row}\n"
        );
        let finding =
            judge(&check_of::<HitsPrimitive>(&text), &mut Fake::intersecting(intersection));
        assert_passes(&finding);
        assert_eq!(finding.measures[1].measured, 0.0);
    }

    #[test]
    fn a_row_that_contradicts_its_own_geometry_is_the_cases_fault() {
        let text = "sphere = { centre = [0, 0, 0], radius = 1 }\n\
                    [[ray]]\nfrom = [3, 0, 0]\ntoward = [-1, 0, 0]\nhits = true\nt = 2.5\n";
        let error = crate::text::read_toml::<HitsPrimitive>(text).unwrap().validate().unwrap_err();
        assert!(
            error.starts_with("ray 1: the geometry gives t = 2, normal = [1, 0, 0]"),
            "{error}"
        );
    }
}
