//! Random triangles and rays against exact arithmetic, where the answer does not depend on rounding.

use super::encounter::{Encounter, explanation};
use super::exact_triangle::{GridRay, GridTriangle};
use crate::cause::Cause;
use crate::checks::law::{Answered, Terms, law_of, place_of_wrong};
use crate::checks::phrase::{figure, one_in, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Hit, Precision, Ray};
use crate::stats::{Tolerance, judge_exact};
use crate::text::Count;

/// Rays at each triangle.
const RAYS_EACH: usize = 10;

check! {
    /// A core hits what exact arithmetic hits, misses what it misses, at the right t.
    pub(crate) struct AgreesWithExactArithmetic {
        /// Random rays, ten at each random triangle.
        rays: Count,
    }
    name: "agrees-with-exact-arithmetic",
    summary: "random rays and triangles of all shapes against exact arithmetic",
    needs: INTERSECT_PRIMITIVE,
}

impl Check for AgreesWithExactArithmetic {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let triangles = self.rays.0.div_ceil(RAYS_EACH as u64);
        let mut encounters = Vec::new();
        for number in 0..triangles {
            encounters.extend(encounters_with(context, number)?);
        }
        Ok(judge(&encounters))
    }
}

fn encounters_with(context: &mut Context<'_>, number: u64) -> Result<Vec<Encounter>, CheckError> {
    let mut stream = context.seed.child(number).stream();
    let precision = context.info.precision;
    let triangle = GridTriangle::random(&mut stream);
    let grid_rays: Vec<_> = (0..RAYS_EACH).map(|_| triangle.ray(&mut stream)).collect();
    let rays: Vec<_> = grid_rays.iter().map(|ray| triangle.world_ray(ray)).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    context.core.intersect_primitive(&triangle.primitive(), &rays, &mut hits)?;
    let encounter = |((grid_ray, ray), hit): ((&GridRay, &Ray), &Hit)| {
        let found = hit.is_hit().then_some(hit.t);
        let meeting = triangle.meeting(grid_ray, precision)?;
        Some(Encounter { meeting, t_max: ray.t_max, found })
    };
    let answered = grid_rays.iter().zip(&rays).zip(&hits);
    Ok(answered.filter_map(encounter).filter(Encounter::is_clear).collect())
}

fn judge(encounters: &[Encounter]) -> Finding {
    let (hits, misses): (Vec<&Encounter>, Vec<&Encounter>) =
        encounters.iter().partition(|e| e.should_hit());
    let lost = hits.iter().filter(|e| e.found.is_none()).count();
    let invented = misses.iter().filter(|e| e.found.is_some()).count();
    let t = judge_exact(encounters.iter().filter_map(Encounter::t_compared));
    let measures = vec![
        Measure::none(format!("hits lost of {}", hits.len()), lost),
        Measure::none(format!("hits invented among {} misses", misses.len()), invented),
        Measure::none(format!("wrong t among {} hits", t.compared), t.disagree),
    ];
    let wrong = lost + invented + t.disagree;
    let explained = if wrong == 0 { None } else { explanation(encounters) };
    let places = [place(&hits, "hits are lost"), place(&misses, "hits are invented")];
    let laws = places.into_iter().chain([law_of_t(&hits)]).flatten();
    let laws: Vec<_> = laws.filter(|_| explained.is_none()).collect();
    let statement = if wrong == 0 {
        format!("{} clear hits and {} clear misses agree", hits.len(), misses.len())
    } else {
        failing_statement(encounters, [lost, invented, t.disagree], explained.as_ref())
    };
    let rare = one_in(encounters.len());
    let resolution = format!("would have caught a mistake in one ray of {rare}");
    Finding::of(statement, resolution, measures).because_of(explained).by_law(laws)
}

const TERMS: Terms = Terms {
    quantities: &["the determinant", "b0", "b1", "b2", "t"],
    places: &[["from behind", "from the front"]],
    right: "what it should be",
};

/// What a ray and a triangle come to.
fn quantities(e: &Encounter) -> (Vec<f64>, Vec<bool>) {
    let [b0, b1, b2] = e.meeting.weights;
    let determinant = e.meeting.determinant;
    (vec![determinant.abs(), b0, b1, b2, e.meeting.t], vec![determinant < 0.0])
}

fn place(encounters: &[&Encounter], what: &str) -> Option<String> {
    let answers = encounters.iter().map(|e| {
        let (quantities, places) = quantities(e);
        (e.found.is_some() == e.should_hit(), quantities, places)
    });
    Some(format!("{what} {}", place_of_wrong(TERMS, answers)?))
}

fn law_of_t(hits: &[&Encounter]) -> Option<String> {
    let answered = |e: &&Encounter| {
        let (quantities, places) = quantities(e);
        Some(Answered { found: e.found?, right: e.meeting.t, quantities, places })
    };
    let answers: Vec<_> = hits.iter().filter_map(answered).collect();
    Some(format!("t {}", law_of(TERMS, &answers, Tolerance::FORMULA.of(Precision::Double))?))
}

/// `counts` are of hits lost, hits invented, and wrong t.
fn failing_statement(
    encounters: &[Encounter],
    counts: [usize; 3],
    explained: Option<&(&Cause, String)>,
) -> String {
    let wrong = some_are(counts.iter().sum(), encounters.len(), "clear rays");
    let kinds = counts.into_iter().zip(["hits lost", "hits invented", "wrong t"]);
    let kinds = kinds.filter(|(count, _)| *count > 0);
    let kinds: Vec<_> = kinds.map(|(count, what)| format!("{count} {what}")).collect();
    let why = match explained {
        Some((cause, evidence)) => format!(": {} ({evidence})", cause.headline),
        None => example(encounters),
    };
    format!("{wrong} wrong ({}){why}", kinds.join(", "))
}

/// The first wrong ray in numbers.
fn example(encounters: &[Encounter]) -> String {
    let Some(wrong) = encounters.iter().find(|e| e.is_wrong()) else { return String::new() };
    let [u, v, w] = wrong.meeting.weights.map(figure);
    let found = wrong.found.map_or_else(|| "a miss".to_owned(), |t| format!("t = {t:e}"));
    let right =
        if wrong.should_hit() { format!("t = {:e}", wrong.meeting.t) } else { "a miss".into() };
    format!("; for example {found} instead of {right}, at weights {u}, {v}, {w}")
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer, intersection, mistake};
    use super::*;
    use crate::cause::shape;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::Primitive;

    fn found(formula: impl Fn(&Primitive, &Ray) -> Option<Answer> + Send + 'static) -> Finding {
        let check: AgreesWithExactArithmetic = check_of("[expect]\nrays = \"20 k\"");
        judge(&check, &mut Fake::intersecting(formula))
    }

    #[test]
    fn the_right_formula_passes_and_most_rays_are_clear() {
        let finding = found(intersection);
        assert_passes(&finding);
        assert!(finding.resolution.contains("one ray of 2"), "{}", finding.resolution);
    }

    #[test]
    fn missing_conditions_are_named() {
        for cause in [
            &shape::PARALLELOGRAM,
            &shape::BACK_CULLED,
            &shape::SEGMENT_IGNORED,
            &shape::SEGMENT_END_IGNORED,
            &shape::HITS_BEHIND_ORIGIN,
        ] {
            let finding = found(mistake(cause));
            let statement = failure(&finding);
            assert!(statement.contains(cause.headline), "{}: {statement}", cause.name);
            assert_eq!(finding.clues[0].cause, cause.name);
        }
    }

    #[test]
    fn an_absolute_epsilon_on_the_determinant_is_named_with_its_size() {
        let finding = found(|primitive, ray| {
            let Primitive::Triangle { positions: [a, b, c], .. } = primitive else { return None };
            let determinant = (*b - *a).dot(ray.direction.cross(*c - *a));
            if determinant.abs() < 1e-3 { None } else { intersection(primitive, ray) }
        });
        let statement = failure(&finding);
        assert!(statement.contains("below about 0.001"), "{statement}");
        assert_eq!(finding.clues[0].cause, "determinant-threshold");
    }

    #[test]
    fn a_t_that_is_off_by_a_millionth_fails() {
        let finding = found(|primitive, ray| {
            let answer = intersection(primitive, ray)?;
            Some(Answer { t: answer.t * (1.0 + 1e-6), ..answer })
        });
        assert!(failure(&finding).contains("wrong t"), "{finding:?}");
    }
}
