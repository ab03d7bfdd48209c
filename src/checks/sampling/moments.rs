//! Moments of the samples of one distribution, those of its pdf, and those of frames that are turned.

use super::distribution::Distribution;
use crate::cause::{Cause, sampling};
use crate::checks::phrase::{degrees, figure};
use crate::checks::{CheckError, Context, Measure, Result};
use crate::contract::Core;
use crate::math::harmonics::{COUNT, NAMES, harmonics};
use crate::math::quadrature::Diligence;
use crate::math::sphere::angle_between;
use crate::stats::{Band, Claim, Effort, MeanReport, SphereCells, Verdict, judge_means};
use glam::{DMat3, DVec3};

/// Rings and sectors over which the pdf is integrated.
const CELLS: (usize, usize) = (4, 8);
const QUADRATURE: Diligence = Diligence { tolerance: 1e-7, most_evaluations: 2_000_000 };
/// How far moments may be from those of a turned pdf, beyond their interval.
const EXPLAINED: f64 = 2e-3;

/// What came of one distribution.
pub(crate) struct Judged {
    name: String,
    reports: Vec<MeanReport>,
    pub(super) cause: Option<(&'static Cause, String)>,
}

impl Judged {
    pub(super) fn of(
        context: &mut Context<'_>,
        distribution: &Distribution,
        band: Band,
        effort: &Effort,
    ) -> Result<Self> {
        let seed = context.seed.child(distribution.name());
        let core = &mut *context.core;
        let expected = expected_moments(core, distribution, DMat3::IDENTITY)?;
        let claim = |expected| Claim { scale: 1.0, expected, ..Claim::value(1.0, band) };
        let reports = judge_means(&expected.map(claim), effort, &mut |draw| {
            let moments = |direction, _| harmonics(direction);
            Ok::<_, CheckError>(distribution.means(core, draw.seed(seed), draw.samples, moments)?)
        })?;
        let failed = reports.iter().any(|report| report.verdict == Verdict::Fail);
        let cause = if failed { cause(core, distribution, &reports)? } else { None };
        Ok(Self { name: distribution.name(), reports, cause })
    }

    pub(super) fn measures(&self) -> impl Iterator<Item = Measure> {
        self.reports.iter().zip(NAMES).map(|(report, harmonic)| {
            Measure::of(format!("mean of {harmonic}"), report).of_row(&self.name)
        })
    }

    /// The mean direction, which is half of the story, and the worst moment otherwise.
    pub(super) fn complaint(&self) -> Option<String> {
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
                "{name}: samples lean {by} away from where the pdf says, towards ({x}, {y}, {z})"
            ));
        }
        let (found, right) = (figure(worst.mean), figure(worst.expected));
        Some(format!("{name}: the mean of {} is {found} instead of {right}", NAMES[number]))
    }
}

/// ∫ pdf(ω) Y(turn ω) dω.
fn expected_moments(
    core: &mut dyn Core,
    distribution: &Distribution,
    turn: DMat3,
) -> Result<[f64; COUNT]> {
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
) -> Result<Option<(&'static Cause, String)>> {
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
