//! Rays exactly at the edge that two triangles share: one of the two has to be hit.
//!
//! Random rays never meet an edge. These do: vertices are small integers, rays run along an axis
//! through a binary fraction of the edge, and areas are powers of two, so that the usual formulas
//! make no rounding error in either precision and a weight is exactly 0.

use crate::cause::shape;
use crate::checks::phrase::percent;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Capabilities, Hit, Primitive, Ray};
use crate::math::rng::{Stream, uniform};
use crate::text::Count;
use glam::{DVec2, DVec3, IVec2, Vec3Swizzles};
use serde::Deserialize;

/// Rays start so far from the plane of the axes they cross; triangles stay well within.
const AWAY: f64 = 64.0;
/// Coordinates on the lattice are between minus this and this.
const REACH: i32 = 4;

/// Pairs of triangles, each with a ray at the edge between them and one into either.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SharedEdges {
    /// At the default budget.
    pairs: Count,
}

impl Check for SharedEdges {
    const NAME: &'static str = "shared-edges";
    const SUMMARY: &'static str = "a ray exactly at a shared edge meets one of its triangles";

    fn needs(&self) -> Capabilities {
        Capabilities::INTERSECT_PRIMITIVE
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut stream = context.seed.stream();
        let mut missed = Missed::default();
        for _ in 0..context.budget.samples(self.pairs.0) {
            missed.ask(&Pair::random(&mut stream), context)?;
        }
        Ok(missed.finding())
    }
}

/// Two triangles on either side of an edge, and the rays at them.
struct Pair {
    triangles: [[DVec3; 3]; 2],
    /// At the edge, into the one triangle, and into the other.
    rays: [Ray; 3],
}

impl Pair {
    fn random(stream: &mut Stream) -> Self {
        let [start, along, left, right] = corners(stream);
        let place = Place::random(stream);
        let first = below(stream, 3);
        let triangle = |apex: IVec2| {
            let mut corners = [start, start + along, start + apex].map(|p| place.on_plane(p));
            corners.rotate_left(first);
            corners
        };
        let quarter = f64::from(1 + below(stream, 3) as u8) / 4.0;
        let at_edge = start.as_dvec2() + quarter * along.as_dvec2();
        let into = |apex: IVec2| at_edge.lerp((start + apex).as_dvec2(), 0.25);
        Self {
            triangles: [left, right].map(triangle),
            rays: [at_edge, into(left), into(right)].map(|p| place.ray_through(p)),
        }
    }
}

/// Where an edge starts, how it runs, and the third corner on either side of it, both seen from the start; the areas
/// are powers of two.
fn corners(stream: &mut Stream) -> [IVec2; 4] {
    loop {
        let [start, along, left, right] = std::array::from_fn(|_| lattice(stream));
        let [left_area, right_area] = [left, right].map(|apex| along.perp_dot(apex));
        let is_exact = |area: i32| area.unsigned_abs().is_power_of_two();
        if left_area > 0 && right_area < 0 && is_exact(left_area) && is_exact(right_area) {
            return [start, along, left, right];
        }
    }
}

fn lattice(stream: &mut Stream) -> IVec2 {
    let mut coordinate = || below(stream, 2 * REACH as usize + 1) as i32 - REACH;
    IVec2::new(coordinate(), coordinate())
}

/// An integer from 0 up to and without `end`.
fn below(stream: &mut Stream, end: usize) -> usize {
    (uniform(stream) * end as f64) as usize
}

/// How the lattice lies in space.
struct Place {
    /// Rise of the plane for a step along either axis of the lattice.
    slope: DVec2,
    /// Which axis rays run along, and in which direction.
    axis: usize,
    sign: f64,
}

impl Place {
    fn random(stream: &mut Stream) -> Self {
        let mut rise = || below(stream, 3) as f64 - 1.0;
        let slope = DVec2::new(rise(), rise());
        let sign = if uniform(stream) < 0.5 { -1.0 } else { 1.0 };
        Self { slope, axis: below(stream, 3), sign }
    }

    fn on_plane(&self, p: IVec2) -> DVec3 {
        let p = p.as_dvec2();
        self.turned(p.extend(p.dot(self.slope)))
    }

    fn ray_through(&self, p: DVec2) -> Ray {
        let origin = self.turned(p.extend(-self.sign * AWAY));
        Ray::new(origin, self.turned(DVec3::new(0.0, 0.0, self.sign)))
    }

    /// The third axis becomes the one along the rays.
    fn turned(&self, p: DVec3) -> DVec3 {
        [p, p.yzx(), p.zxy()][self.axis]
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
        let share = self.at_edges as f64 / self.pairs as f64;
        match finding.failed() && self.inside == 0 {
            true => finding.because(
                &shape::EDGES_EXCLUDED,
                format!("{} of rays exactly at an edge meet neither triangle", percent(share)),
            ),
            false => finding,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer, Formula, intersection};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(formula: Formula) -> Finding {
        judge(
            &check_of::<SharedEdges>("[expect]\npairs = \"500\""),
            &mut Fake::intersecting(formula),
        )
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
