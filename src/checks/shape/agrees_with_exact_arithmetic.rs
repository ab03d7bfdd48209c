//! Random triangles and rays against exact arithmetic, where the answer does not depend on rounding.

use super::exact_triangle::{GridTriangle, Meeting, Truth};
use crate::cause::{Cause, shape};
use crate::checks::phrase::{figure, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Capabilities, Hit, Precision};
use crate::stats::{Compared, judge_exact};
use crate::text::Count;
use serde::Deserialize;

/// Rays at each triangle.
const RAYS_EACH: usize = 10;

/// A core hits what exact arithmetic hits, misses what it misses, at the right t.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AgreesWithExactArithmetic {
    /// Random rays, ten at each random triangle.
    rays: Count,
}

impl Check for AgreesWithExactArithmetic {
    const NAME: &'static str = "agrees-with-exact-arithmetic";
    const SUMMARY: &'static str =
        "random rays and triangles of all shapes against exact arithmetic";

    fn needs(&self) -> Capabilities {
        Capabilities::INTERSECT_PRIMITIVE
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let triangles = self.rays.0.div_ceil(RAYS_EACH as u64);
        let mut encounters = Vec::new();
        for number in 0..triangles {
            encounters.extend(encounters_with(context, number)?);
        }
        Ok(judge(&encounters))
    }
}

/// A ray, what exact arithmetic says of it, and what the core does.
#[derive(Clone, Copy)]
struct Encounter {
    meeting: Meeting,
    t_max: f64,
    /// The core's t, if it hit.
    found: Option<f64>,
}

impl Encounter {
    fn is_clear(&self) -> bool {
        self.meeting.truth != Truth::Ambiguous
    }

    fn should_hit(&self) -> bool {
        matches!(self.meeting.truth, Truth::Hit { .. })
    }

    /// The error of t, where there is a t to compare.
    fn t_compared(&self) -> Option<Compared> {
        match (self.meeting.truth, self.found) {
            (Truth::Hit { allowed }, Some(t)) => Some(Compared::within(t, self.meeting.t, allowed)),
            _ => None,
        }
    }

    fn is_wrong(&self) -> bool {
        self.found.is_some() != self.should_hit()
            || self.t_compared().is_some_and(|compared| !compared.agrees())
    }
}

fn encounters_with(context: &mut Context<'_>, number: u64) -> Result<Vec<Encounter>, CheckError> {
    let mut stream = context.seed.child(number).stream();
    let precision: Precision = context.info.precision;
    let triangle = GridTriangle::random(&mut stream);
    let grid_rays: Vec<_> = (0..RAYS_EACH).map(|_| triangle.ray(&mut stream)).collect();
    let rays: Vec<_> = grid_rays.iter().map(|ray| triangle.world_ray(ray)).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    context.core.intersect_primitive(&triangle.primitive(), &rays, &mut hits)?;
    let meetings = grid_rays.iter().map(|ray| triangle.meeting(ray, precision));
    let encounter = |(meeting, (hit, t_max)): (Option<Meeting>, (&Hit, f64))| {
        let found = hit.is_hit().then_some(hit.t);
        meeting.map(|meeting| Encounter { meeting, t_max, found })
    };
    let answers = hits.iter().zip(rays.iter().map(|ray| ray.t_max));
    Ok(meetings.zip(answers).filter_map(encounter).filter(Encounter::is_clear).collect())
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
    let statement = if wrong == 0 {
        format!("{} clear hits and {} clear misses agree", hits.len(), misses.len())
    } else {
        failing_statement(encounters, [lost, invented, t.disagree], explained.as_ref())
    };
    // 6.9 = −ln 0.001: that many mistaken rays are expected where none is seen in one case of a thousand.
    let rare = encounters.len() as f64 / 6.9;
    let resolution = format!("would have caught a mistake in one ray of {}", figure(rare.floor()));
    Finding::of(statement, resolution, measures).because_of(explained)
}

/// `counts` are of hits lost, hits invented, and wrong t.
fn failing_statement(
    encounters: &[Encounter],
    counts: [usize; 3],
    explained: Option<&(&Cause, String)>,
) -> String {
    let wrong = some_are(counts.iter().sum(), encounters.len(), "clear rays");
    let kinds: Vec<_> = counts
        .iter()
        .zip(["hits lost", "hits invented", "wrong t"])
        .filter(|(count, _)| **count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
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

/// A rule by which a wrong core decides what is a hit.
struct Rule {
    cause: &'static Cause,
    hits: fn(&Encounter) -> bool,
}

const RULES: &[Rule] = &[
    Rule { cause: &shape::BACK_CULLED, hits: |e| e.should_hit() && e.meeting.determinant > 0.0 },
    Rule { cause: &shape::FRONT_CULLED, hits: |e| e.should_hit() && e.meeting.determinant < 0.0 },
    Rule {
        cause: &shape::PARALLELOGRAM,
        hits: |e| is_on_segment(e) && e.meeting.weights[1] >= 0.0 && e.meeting.weights[2] >= 0.0,
    },
    Rule {
        cause: &shape::V_NOT_COMPARED,
        hits: |e| is_on_segment(e) && e.meeting.weights[0] >= 0.0 && e.meeting.weights[2] >= 0.0,
    },
    Rule {
        cause: &shape::W_NOT_COMPARED,
        hits: |e| is_on_segment(e) && e.meeting.weights[0] >= 0.0 && e.meeting.weights[1] >= 0.0,
    },
    Rule { cause: &shape::SEGMENT_END_IGNORED, hits: |e| is_inside(e) && e.meeting.t > 0.0 },
    Rule { cause: &shape::SEGMENT_IGNORED, hits: is_inside },
    Rule { cause: &shape::HITS_BEHIND_ORIGIN, hits: |e| is_inside(e) && e.meeting.t < e.t_max },
];

fn is_inside(e: &Encounter) -> bool {
    e.meeting.weights.iter().all(|weight| *weight >= 0.0)
}

fn is_on_segment(e: &Encounter) -> bool {
    e.meeting.t > 0.0 && e.meeting.t < e.t_max
}

/// The mistake that explains every clear ray, if one does, and what speaks for it.
fn explanation(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
    if encounters.iter().filter_map(Encounter::t_compared).any(|t| !t.agrees()) {
        return None;
    }
    let follows = |rule: &&Rule| encounters.iter().all(|e| (rule.hits)(e) == e.found.is_some());
    let evidence = || format!("predicts which of {} clear rays hit", encounters.len());
    let rule = RULES.iter().find(follows).map(|rule| (rule.cause, evidence()));
    rule.or_else(|| threshold(encounters))
}

/// Hits are lost exactly where the determinant is small: its size says nothing about parallelism.
fn threshold(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
    if encounters.iter().any(|e| e.is_wrong() && !e.should_hit()) {
        return None;
    }
    let sizes = |lost: bool| {
        let hits = encounters.iter().filter(move |e| e.should_hit() && e.found.is_none() == lost);
        hits.map(|e| e.meeting.determinant.abs())
    };
    let largest_lost = sizes(true).fold(0.0, f64::max);
    let smallest_kept = sizes(false).fold(f64::INFINITY, f64::min);
    (largest_lost < smallest_kept).then(|| {
        let evidence = format!("hits are lost just below about {}", figure(smallest_kept));
        (&shape::DETERMINANT_THRESHOLD, evidence)
    })
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Formula, intersection, mistake};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::Primitive;

    fn found(formula: Formula) -> Finding {
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
            Some(super::super::imitation::Answer { t: answer.t * (1.0 + 1e-6), ..answer })
        });
        assert!(failure(&finding).contains("wrong t"), "{finding:?}");
    }
}
