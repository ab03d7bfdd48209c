//! Means of low harmonics over the samples against those of the density: fifteen numbers that see a
//! smooth error, such as a lobe that leans, long before counts in cells do, and say which way it
//! leans.

use super::distribution::{Distribution, DistributionEntry, Drawn};
use super::of_distributions::OfDistributions;
use crate::cause::{Cause, sampling};
use crate::checks::phrase::{degrees, figure};
use crate::checks::{CheckError, Context, Finding, Measure, check};
use crate::contract::Core;
use crate::math::harmonics::{COUNT, NAMES, harmonics};
use crate::math::quadrature::Diligence;
use crate::math::rng::Seed;
use crate::math::sphere::angle_between;
use crate::stats::{Band, Claim, Effort, MeanReport, SphereCells, Verdict, judge_means};
use crate::text::{Count, Percent};
use glam::{DMat3, DVec3};

/// Rings and sectors over which the density is integrated.
const CELLS: (usize, usize) = (4, 8);
const QUADRATURE: Diligence = Diligence { tolerance: 1e-7, most_evaluations: 2_000_000 };
/// How far moments may be from those of a turned density, beyond their interval.
const EXPLAINED: f64 = 2e-3;

check! {
    /// E\[Yₗₘ\] over samples is ∫ pdf Yₗₘ, for degrees 1 to 3.
    pub(crate) struct MomentsFollowPdf {
        distribution: DistributionEntry,
        /// The smallest error of a moment that must be seen; moments lie between −1 and 1.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
    }
    name: "moments-follow-pdf",
    summary: "means of spherical harmonics over samples against their density",
}

impl OfDistributions for MomentsFollowPdf {
    type Judged = Judged;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Self::Judged, CheckError> {
        let effort = context.effort(self.detects, self.at_most);
        let band = Band::math(context.info.precision);
        Judged::of(context, distribution, band, &effort)
    }

    fn finding(judged: &[Self::Judged]) -> Finding {
        let measures: Vec<_> = judged.iter().flat_map(Judged::measures).collect();
        let right = format!("{} moments of samples are those of their densities", measures.len());
        Finding::measured(right, measures)
            .in_terms(" of the range of a moment")
            .complaining(judged.iter().filter_map(Judged::complaint))
            .because_of(judged.iter().filter_map(|judged| judged.cause.clone()))
    }
}

/// What came of one distribution.
pub(crate) struct Judged {
    name: String,
    reports: Vec<MeanReport>,
    cause: Option<(&'static Cause, String)>,
}

impl Judged {
    fn of(
        context: &mut Context<'_>,
        distribution: &Distribution,
        band: Band,
        effort: &Effort,
    ) -> Result<Self, CheckError> {
        let seed = context.seed.child(distribution.name());
        let core = &mut *context.core;
        let expected = expected_moments(core, distribution, DMat3::IDENTITY)?;
        let claim = |expected| Claim { scale: 1.0, expected, ..Claim::value(1.0, band) };
        let reports = judge_means(&expected.map(claim), effort, &mut |draw| {
            moments(core, distribution, draw.seed(seed), draw.samples)
        })?;
        let failed = reports.iter().any(|report| report.verdict == Verdict::Fail);
        let cause = if failed { cause(core, distribution, &reports)? } else { None };
        Ok(Self { name: distribution.name(), reports, cause })
    }

    fn measures(&self) -> impl Iterator<Item = Measure> {
        self.reports.iter().zip(NAMES).map(|(report, harmonic)| {
            Measure::of(format!("mean of {harmonic}"), report).of_row(&self.name)
        })
    }

    /// The mean direction, which is half of the story, and the worst moment otherwise.
    fn complaint(&self) -> Option<String> {
        let off = |report: &&MeanReport| (report.mean - report.expected).abs();
        let (number, worst) = self
            .reports
            .iter()
            .enumerate()
            .filter(|(_, report)| report.verdict == Verdict::Fail)
            .max_by(|a, b| off(&a.1).total_cmp(&off(&b.1)))?;
        let mean = |of: fn(&MeanReport) -> f64| {
            DVec3::new(of(&self.reports[2]), of(&self.reports[0]), of(&self.reports[1]))
        };
        let (found, right) = (mean(|report| report.mean), mean(|report| report.expected));
        let leans = angle_between(found, right);
        let name = &self.name;
        if number < 3 && leans > EXPLAINED {
            let [x, y, z] = found.to_array().map(figure);
            let by = degrees(leans);
            return Some(format!(
                "{name}: samples lean {by} away from where the density says, towards ({x}, {y}, {z})"
            ));
        }
        let (found, right) = (figure(worst.mean), figure(worst.expected));
        Some(format!("{name}: the mean of {} is {found} instead of {right}", NAMES[number]))
    }
}

/// Means over one run; a failed sample counts as zero.
fn moments(
    core: &mut dyn Core,
    distribution: &Distribution,
    seed: Seed,
    samples: u64,
) -> Result<Vec<f64>, CheckError> {
    let mut sums = vec![0.0; COUNT];
    distribution.draw(core, seed, samples, |drawn: &[Drawn]| {
        for direction in drawn.iter().filter_map(|drawn| drawn.direction) {
            sums.iter_mut().zip(harmonics(direction)).for_each(|(sum, value)| *sum += value);
        }
    })?;
    Ok(sums.into_iter().map(|sum| sum / samples as f64).collect())
}

/// ∫ pdf(ω) Y(turn ω) dω.
fn expected_moments(
    core: &mut dyn Core,
    distribution: &Distribution,
    turn: DMat3,
) -> Result<[f64; COUNT], CheckError> {
    let mut expected = [0.0; COUNT];
    for (number, expected) in expected.iter_mut().enumerate() {
        let cells =
            SphereCells::sphere(CELLS.0, CELLS.1).with_kinks(distribution.kink().as_slice());
        let integrals = cells.probabilities(QUADRATURE, &mut |directions, values| {
            distribution.pdf(core, directions, values)?;
            let weights = directions.iter().map(|direction| harmonics(turn * *direction)[number]);
            values.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
            Ok::<_, CheckError>(())
        })?;
        *expected = integrals.mass;
    }
    Ok(expected)
}

/// Frames that people take by mistake: what the samples would be if theirs were turned so.
const TURNS: [(&Cause, DMat3); 5] = [
    (&sampling::AROUND_Y, DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y)),
    (&sampling::AROUND_X, DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::X)),
    (&sampling::BELOW_SURFACE, DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::NEG_Z)),
    (&sampling::LOBE_AROUND_VIEWER, DMat3::from_cols(DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z)),
    (&sampling::TANGENTS_SWAPPED, DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::Z)),
];

/// The turned frame that predicts every moment.
fn cause(
    core: &mut dyn Core,
    distribution: &Distribution,
    reports: &[MeanReport],
) -> Result<Option<(&'static Cause, String)>, CheckError> {
    for (cause, turn) in TURNS {
        let expected = expected_moments(core, distribution, turn)?;
        let holds = |(report, expected): (&MeanReport, f64)| {
            let [low, high] = report.interval;
            (low - EXPLAINED..=high + EXPLAINED).contains(&expected)
        };
        if reports.iter().zip(expected).all(holds) {
            return Ok(Some((cause, format!("predicts all {COUNT} moments"))));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_density, drawing, uniform, uniform_density};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use glam::{DQuat, DVec2};

    type Map = fn(DVec2) -> Option<DVec3>;

    fn found(map: Map, density: fn(DVec3) -> f64) -> Finding {
        let check: MomentsFollowPdf = check_of(
            "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }\n\
             detects = \"1 %\"\nat-most = \"400 k\"",
        );
        judge(&check, &mut drawing(map, density))
    }

    #[test]
    fn right_samplers_pass() {
        assert_passes(&found(cosine, cosine_density));
        assert_passes(&found(uniform, uniform_density));
    }

    #[test]
    fn a_lobe_that_leans_by_two_degrees_is_seen_and_told_which_way() {
        let finding = found(
            |point| cosine(point).map(|d| DQuat::from_rotation_y(2f64.to_radians()) * d),
            cosine_density,
        );
        let statement = failure(&finding);
        assert!(statement.contains("samples lean 2"), "{statement}");
        assert!(statement.contains("towards (0.02"), "{statement}");
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn turned_frames_have_names() {
        let cases: [(Map, &str); 3] = [
            (|point| cosine(point).map(|d| DVec3::new(d.x, d.z, d.y)), "hemisphere-around-y"),
            (|point| cosine(point).map(|d| DVec3::new(d.z, d.y, d.x)), "hemisphere-around-x"),
            (|point| cosine(point).map(|d| -d), "samples-below-surface"),
        ];
        for (map, name) in cases {
            let finding = found(map, cosine_density);
            failure(&finding);
            let causes: Vec<_> = finding.clues.iter().map(|clue| clue.cause.as_str()).collect();
            assert_eq!(causes, [name], "{}", finding.statement);
        }
    }

    #[test]
    fn another_law_of_heights_is_told_by_its_moment() {
        let finding = found(uniform, cosine_density);
        let statement = failure(&finding);
        // ∫ (3z² − 1)/2 is 0 over the hemisphere and 1/4 with the cosine.
        assert!(statement.contains("the mean of 3z² − 1 is "), "{statement}");
        assert!(statement.ends_with(" instead of 0.25"), "{statement}");
    }
}
