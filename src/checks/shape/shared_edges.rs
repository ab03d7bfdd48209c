//! Rays exactly at the edge that two triangles share: one of the two has to be hit.
//!
//! Random rays never meet an edge. These do: vertices are small integers, rays run along an axis
//! through a binary fraction of the edge, and areas are powers of two, so that the usual formulas
//! make no rounding error in either precision and a weight is exactly 0.

use super::lattice::Pair;
use crate::cause::shape;
use crate::checks::phrase::percent;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Hit, Primitive};
use crate::text::Count;

check! {
    /// Pairs of triangles, each with a ray at the edge between them and one into either.
    pub(crate) struct SharedEdges {
        /// At the default budget.
        pairs: Count,
    }
    name: "shared-edges",
    summary: "a ray exactly at a shared edge meets one of its triangles",
    needs: INTERSECT_PRIMITIVE,
}

impl Check for SharedEdges {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut stream = context.seed.stream();
        let mut missed = Missed::default();
        for _ in 0..context.budget.samples(self.pairs.0) {
            missed.ask(&Pair::random(&mut stream), context)?;
        }
        Ok(missed.finding())
    }
}

/// How many rays met nothing.
#[derive(Clone, Copy, Debug, Default)]
struct Missed {
    pairs: usize,
    at_edges: usize,
    inside: usize,
}

impl Missed {
    fn ask(&mut self, pair: &Pair, context: &mut Context<'_>) -> Result<(), CheckError> {
        let mut is_hit = [[false; 3]; 2];
        for (positions, is_hit) in pair.triangles.into_iter().zip(&mut is_hit) {
            let [a, b, c] = positions;
            let primitive =
                Primitive::Triangle { positions, normals: [(b - a).cross(c - a).normalize(); 3] };
            let mut hits = [Hit::MISS; 3];
            context.core.intersect_primitive(&primitive, &pair.rays, &mut hits)?;
            *is_hit = hits.map(|hit| hit.is_hit());
        }
        self.pairs += 1;
        self.at_edges += usize::from(!is_hit[0][0] && !is_hit[1][0]);
        self.inside += usize::from(!is_hit[0][1]) + usize::from(!is_hit[1][2]);
        Ok(())
    }

    fn finding(self) -> Finding {
        let statement = match (self.at_edges, self.inside) {
            (0, 0) => format!("none of {} rays falls through a shared edge", self.pairs),
            _ => format!(
                "{} of {} rays fall through the edge that two triangles share, and {} of {} through \
                 the middle of a triangle",
                self.at_edges,
                self.pairs,
                self.inside,
                2 * self.pairs
            ),
        };
        let measures = vec![
            Measure::none("rays that fall through an edge", self.at_edges),
            Measure::none("rays that fall through a triangle", self.inside),
        ];
        let finding = Finding::of(statement, "would have caught one ray", measures);
        let share = percent(self.at_edges as f64 / self.pairs as f64);
        let evidence = format!("{share} of rays exactly at an edge meet neither triangle");
        let are_edges = finding.failed() && self.inside == 0;
        finding.because_of(are_edges.then_some((&shape::EDGES_EXCLUDED, evidence)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer, Formula, intersection};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::Ray;

    fn found(formula: Formula) -> Finding {
        let check: SharedEdges = check_of("[expect]\npairs = \"500\"");
        judge(&check, &mut Fake::intersecting(formula))
    }

    /// Where one of the weights is at most `least`, there is no hit.
    fn without_edges(primitive: &Primitive, ray: &Ray, least: f64) -> Option<Answer> {
        let answer = intersection(primitive, ray)?;
        answer.weights.is_some_and(|w| w.iter().all(|weight| *weight > least)).then_some(answer)
    }

    #[test]
    fn edges_that_belong_to_both_pass() {
        assert_passes(&found(intersection));
    }

    #[test]
    fn edges_that_belong_to_none_are_named() {
        let finding = found(|primitive, ray| without_edges(primitive, ray, 0.0));
        assert!(failure(&finding).starts_with("500 of 500 rays fall through the edge"));
        assert_eq!(finding.clues[0].cause, "edges-excluded");
    }

    #[test]
    fn triangles_with_holes_are_another_mistake() {
        let finding = found(|primitive, ray| without_edges(primitive, ray, 0.3));
        failure(&finding);
        assert!(finding.clues.is_empty());
    }
}
