//! Spheres near and far: t and the normal, with the digits that distance may cost and no more.

use super::exact_sphere::{Encounter, Formula};
use super::sphere_range::{Answer, Judged, Range, complaint, explain};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::{CoreError, Hit, Precision};
use crate::stats::Tolerance;
use crate::text::{Count, Several};
use glam::DVec3;

/// From so many radii on, distance may have cost a normal its length.
const FAR: f64 = 2.0;

check! {
    /// Spheres are hit where they are, from any distance.
    pub(crate) struct FarSpheres {
        /// From the origin of the rays to the centre, in radii; 0 is inside.
        distances: Several<f64>,
        /// At each distance.
        rays: Count,
        /// Whose roundings are allowed.
        formula: Formula,
    }
    name: "far-spheres",
    summary: "hits of spheres at growing distances against exact arithmetic",
    needs: INTERSECT_PRIMITIVE,
}

impl Check for FarSpheres {
    fn validate(&self) -> Result<(), String> {
        let is_distance = |distance: &f64| (0.0..=1e6).contains(distance);
        let are_distances = self.distances.iter().all(is_distance);
        are_distances
            .then_some(())
            .ok_or("`distances` needs numbers of radii from 0 to a million".to_owned())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut ranges = Vec::new();
        for distance in self.distances.iter() {
            let stream = &mut context.seed.child(distance).stream();
            let mut answers = Vec::new();
            for _ in 0..self.rays.0 {
                let encounter = Encounter::random(*distance, context.info.precision, stream);
                let found = match ask(context, &encounter) {
                    Err(CheckError::Core(CoreError::BrokeContract(_))) if *distance >= FAR => {
                        SPOILT
                    }
                    found => found?,
                };
                answers.push(Answer { encounter, found });
            }
            ranges.push(Range { distance: *distance, answers });
        }
        Ok(self.judge(&ranges, context.info.precision))
    }
}

/// What stands for an answer that breaks the contract: wrong in every number.
const SPOILT: Hit = Hit { t: f64::NAN, geometric_normal: DVec3::NAN, primitive: 0, ..Hit::MISS };

fn ask(context: &mut Context<'_>, encounter: &Encounter) -> Result<Hit, CheckError> {
    let mut hit = [Hit::MISS];
    context.core.intersect_primitive(&encounter.primitive(), &[encounter.ray], &mut hit)?;
    Ok(hit[0])
}

impl FarSpheres {
    fn judge(&self, ranges: &[Range], precision: Precision) -> Finding {
        let judged: Vec<_> =
            ranges.iter().map(|range| (range, range.judge(self.formula, precision))).collect();
        let failed = judged.iter().filter(|(_, judged)| judged.failed());
        let complaints = failed.map(|(range, judged)| complaint(range, judged, precision));
        let rays: usize = judged.iter().map(|(_, judged)| judged.clear).sum();
        let measures = judged.iter().flat_map(|(_, judged)| judged.measures.clone()).collect();
        let nearest = self.distances.iter().copied().fold(f64::INFINITY, f64::min).max(1.0);
        let magnified = if self.formula == Formula::Quadratic { nearest } else { 1.0 };
        let resolution = format!(
            "would have caught an error of {} of the distance in one of {rays} rays",
            figure(Tolerance::ROUNDINGS.of(precision) * magnified)
        );
        let right = passing_statement(&judged, precision);
        let finding = Finding::of(right, resolution, measures).complaining(complaints);
        if finding.failed() { explain(finding, ranges, precision) } else { finding }
    }
}

fn passing_statement(judged: &[(&Range, Judged)], precision: Precision) -> String {
    let rays: usize = judged.iter().map(|(_, judged)| judged.clear).sum();
    let worst = judged.iter().map(|(range, j)| range.digits_lost(j.worst_t, precision));
    format!(
        "{rays} rays meet their spheres where they should; distance costs {:.0} of {:.0} digits",
        worst.fold(0.0, f64::max),
        -precision.epsilon().log10()
    )
}

#[cfg(test)]
mod tests {
    use super::super::imitation::{Answer as Meeting, Formula as Intersection, intersection};
    use super::*;
    use crate::checks::Measure;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge, try_judge};
    use crate::contract::{Primitive, Ray};

    /// r² − |l|², after Hearn and Baker, as Haines et al. (2019) recommend.
    fn stable(primitive: &Primitive, ray: &Ray) -> Option<Meeting> {
        let Primitive::Sphere { centre, radius } = *primitive else { return None };
        let from_centre = ray.origin - centre;
        let a = ray.direction.length_squared();
        let middle = -from_centre.dot(ray.direction) / a;
        let offset = from_centre + middle * ray.direction;
        let half = ((radius * radius - offset.length_squared()) / a).sqrt();
        let t = [middle - half, middle + half]
            .into_iter()
            .find(|t| ray.t_min < *t && *t < ray.t_max)?;
        Some(Meeting::of_sphere(t, ((ray.at(t) - centre) / radius).normalize()))
    }

    const ALL: &str = "distances = [0, 2, 1e2, 1e4, 1e6]\nrays = 300\nformula = ";

    fn found(formula: &str, intersection: Intersection) -> Finding {
        let check: FarSpheres = check_of(&format!("[expect]\n{ALL}\"{formula}\""));
        judge(&check, &mut Fake::intersecting(intersection))
    }

    #[test]
    fn the_stable_formula_passes_its_own_bound_and_the_other() {
        assert_passes(&found("stable", stable));
        assert_passes(&found("quadratic", stable));
    }

    /// The quadratic of the lecture, with its normal set right.
    fn quadratic(primitive: &Primitive, ray: &Ray) -> Option<Meeting> {
        let answer = intersection(primitive, ray)?;
        Some(answer.with_normal(answer.geometric_normal.normalize()))
    }

    #[test]
    fn the_quadratic_passes_its_own_bound_and_is_named_under_the_stable_one() {
        assert_passes(&found("quadratic", quadratic));
        let finding = found("stable", quadratic);
        let statement = failure(&finding);
        assert!(statement.contains("1e6 radii away: "), "{statement}");
        assert!(statement.contains(" of 16 digits are lost"), "{statement}");
        assert_eq!(finding.clues[0].cause, "sphere-cancellation");
    }

    #[test]
    fn a_float_on_the_way_is_named() {
        let finding = found("stable", |primitive, ray| {
            let answer = stable(primitive, ray)?;
            Some(Meeting { t: f64::from(answer.t as f32), ..answer })
        });
        failure(&finding);
        assert_eq!(finding.clues[0].cause, "single-precision-inside");
    }

    #[test]
    fn an_error_far_below_the_roundings_of_a_float_is_not_one() {
        let finding = found("stable", |primitive, ray| {
            let answer = stable(primitive, ray)?;
            Some(Meeting { t: answer.t * (1.0 + 1e-11), ..answer })
        });
        failure(&finding);
        assert!(finding.clues.is_empty(), "{:?}", finding.clues);
    }

    #[test]
    fn normals_that_lose_their_length_far_away_are_a_failure_and_nearby_break_the_contract() {
        let far: FarSpheres =
            check_of("[expect]\ndistances = [1e4, 1e6]\nrays = 300\nformula = \"stable\"");
        let finding = judge(&far, &mut Fake::intersecting(intersection));
        assert!(failure(&finding).contains(" break the contract"), "{}", finding.statement);
        let twice = |primitive: &Primitive, ray: &Ray| {
            let answer = stable(primitive, ray)?;
            Some(answer.with_normal(2.0 * answer.geometric_normal))
        };
        let near: FarSpheres = check_of(&format!("[expect]\n{ALL}\"stable\""));
        let error = try_judge(&near, &mut Fake::intersecting(twice), None).unwrap_err();
        assert!(matches!(error, CheckError::Core(CoreError::BrokeContract(_))), "{error:?}");
    }

    #[test]
    fn normals_are_looked_at_from_inside_too() {
        let finding = found("quadratic", |primitive, ray| {
            let answer = stable(primitive, ray)?;
            Some(answer.turned(-answer.geometric_normal.dot(ray.direction).signum()))
        });
        failure(&finding);
        let failed: Vec<_> = finding.failed_measures().map(Measure::name).collect();
        assert!(failed[0].starts_with("from inside: normal off by"), "{failed:?}");
        assert!(finding.clues.is_empty());
    }
}
