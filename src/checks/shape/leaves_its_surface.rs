//! No self-intersection: a ray that starts where another hit, and leads away, does not meet the same primitive again.
//!
//! The hit point is a little off the surface, on one side or the other; `t_min` is there so that
//! this does no harm, and here it is as large as geometry asks: at grazing angles a point that lies
//! δ inside a sphere of radius r meets it again after √(2rδ).

use super::body::{Body, FROM, RandomBody};
use crate::cause::shape;
use crate::checks::phrase::{figure, one_in, percent};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Hit, Ray};
use crate::math::rng::Stream;
use crate::math::sphere::on_sphere;
use crate::stats::Tolerance;
use crate::text::Count;

/// Rays onto each primitive, each followed by one away from it.
const RAYS_EACH: usize = 100;
check! {
    /// Rays spawned at a surface leave it.
    pub(crate) struct LeavesItsSurface {
        /// Rays away from spheres, and as many from triangles.
        rays: Count,
    }
    name: "leaves-its-surface",
    summary: "rays away from a hit do not meet the same primitive again",
    needs: INTERSECT_PRIMITIVE,
}

impl Check for LeavesItsSurface {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let kinds: [(&str, RandomBody); 2] =
            [("spheres", Body::sphere), ("triangles", Body::triangle)];
        let mut tallies = Vec::new();
        for (name, random) in kinds {
            let mut tally = Tally { name, spawned: 0, met: Vec::new(), before_start: 0 };
            for number in 0..self.rays.0.div_ceil(RAYS_EACH as u64) {
                let stream = &mut context.seed.child(name).child(number).stream();
                tally.take(context, &random(stream), stream)?;
            }
            tallies.push(tally);
        }
        Ok(judge(&tallies))
    }
}

/// What came of one kind of primitive.
struct Tally {
    name: &'static str,
    spawned: usize,
    /// Where the surface was met again, in sizes of the primitive.
    met: Vec<f64>,
    /// Of those, before the ray began.
    before_start: usize,
}

impl Tally {
    fn take(
        &mut self,
        context: &mut Context<'_>,
        body: &Body,
        stream: &mut Stream,
    ) -> Result<(), CheckError> {
        let rays: Vec<_> = (0..RAYS_EACH).map(|_| body.ray(stream)).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        context.core.intersect_primitive(&body.primitive, &rays, &mut hits)?;
        let off = Tolerance::ROUNDINGS.of(context.info.precision) * FROM * body.size;
        let t_min = 2.0 * (2.0 * body.size * off).sqrt();
        let pairs = rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit());
        let away: Vec<_> = pairs.map(|(ray, hit)| spawned(ray, hit, t_min, stream)).collect();
        let mut again = vec![Hit::MISS; away.len()];
        context.core.intersect_primitive(&body.primitive, &away, &mut again)?;
        self.spawned += away.len();
        for hit in again.iter().filter(|hit| hit.is_hit()) {
            self.met.push(hit.t / body.size);
            self.before_start += usize::from(hit.t <= t_min);
        }
        Ok(())
    }
}

/// From the hit into the half space that the first ray came from.
fn spawned(ray: &Ray, hit: &Hit, t_min: f64, stream: &mut Stream) -> Ray {
    let normal = hit.geometric_normal;
    let outward = if normal.dot(ray.direction) < 0.0 { normal } else { -normal };
    let any = on_sphere(stream);
    let direction = if any.dot(outward) < 0.0 { -any } else { any };
    Ray { t_min, ..Ray::new(ray.at(hit.t), direction) }
}

fn judge(tallies: &[Tally]) -> Finding {
    let measure = |tally: &Tally| {
        let row = format!("{} {}", tally.spawned, tally.name);
        Measure::none("rays that meet their own surface again", tally.met.len()).of_row(row)
    };
    let measures = tallies.iter().map(measure).collect();
    let spawned: usize = tallies.iter().map(|tally| tally.spawned).sum();
    let rare = one_in(spawned);
    let right = format!("{spawned} rays leave the surface they start from");
    let finding = Finding::of(right, format!("would have caught one ray in {rare}"), measures)
        .complaining(tallies.iter().filter_map(complaint));
    let met: usize = tallies.iter().map(|tally| tally.met.len()).sum();
    let early: usize = tallies.iter().map(|tally| tally.before_start).sum();
    let is_start = met > 0 && early == met;
    let evidence = format!("all {met} hits lie before t_min");
    finding.because_of(is_start.then_some((&shape::SEGMENT_START_IGNORED, evidence)))
}

fn complaint(tally: &Tally) -> Option<String> {
    let farthest = tally.met.iter().copied().reduce(f64::max)?;
    let share = percent(tally.met.len() as f64 / tally.spawned as f64);
    Some(format!(
        "{share} of the rays away from {} meet them again, up to {} of their size away",
        tally.name,
        figure(farthest)
    ))
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer, Formula, intersection};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(formula: Formula) -> Finding {
        let unit = |answer: Answer| answer.with_normal(answer.geometric_normal.normalize());
        let mut core = Fake::intersecting(move |p, ray| formula(p, ray).map(unit));
        judge(&check_of::<LeavesItsSurface>("[expect]\nrays = \"20 k\""), &mut core)
    }

    #[test]
    fn the_quadratic_of_the_lecture_passes() {
        assert_passes(&found(intersection));
    }

    #[test]
    fn a_start_that_is_ignored_is_named() {
        let finding = found(|primitive, ray| {
            let answer = intersection(primitive, &Ray { t_min: -1e-3 * ray.t_min, ..*ray })?;
            (answer.t != 0.0).then_some(answer)
        });
        let statement = failure(&finding);
        assert!(statement.contains("of the rays away from spheres meet them again"), "{statement}");
        assert_eq!(finding.clues[0].cause, "segment-start-ignored");
    }

    #[test]
    fn a_sphere_that_is_hit_a_little_too_early_is_seen() {
        let finding = found(|primitive, ray| {
            let answer = intersection(primitive, ray)?;
            Some(Answer { t: answer.t * (1.0 + 1e-4), ..answer })
        });
        failure(&finding);
        assert!(finding.clues.is_empty(), "{finding:?}");
    }
}
