//! What blocks light and what does not, where light that is not blocked is right.

use super::evidence::measure;
use super::readings::channels;
use super::{Degree, Evidence, RuledOut, Suspicion};
use crate::case::{Role, Subject};
use crate::cause::light;
use crate::checks::{Finding, Measure};
use crate::contract::Circumstances;
use crate::image::CHANNELS;
use crate::text::number::figure;

/// Direct light that nothing blocks.
const OPEN: Role = Role::OpenLight;
const BLOCKER: Role = Role::OccludedInPart;
const WALL: Role = Role::OccludedInFull;
/// Lights found by hemisphere sampling, looked at from far and from near.
const FOUND: [Role; 2] = [Role::TiltedLightByHemisphere, Role::SlantedLightByHemisphere];

/// Where light is found by rays that leave a surface, and not by light sampling.
const FINDING_BY_RAYS: Circumstances = Circumstances::HEMISPHERE_SAMPLING
    .union(Circumstances::INDIRECT_LIGHT)
    .union(Circumstances::MIRROR)
    .union(Circumstances::GLASS);

/// The variance of one light sample under [`OPEN`].
const NOISE: Role = Role::LightSamplingVariance;
/// Light that no shadow ray to an area light takes part in.
const WITHOUT_AREA_LIGHTS: [Role; 2] = [Role::OpenLightByHemisphere, Role::PointLight];
/// Relative error forgiven of a variance beyond its interval: σ² is 0.9 % of L² for uniform points on the light, and less
/// for better maps.
const VARIANCE_SLACK: f64 = 0.02;

/// Shadows that are missing, rays that are too short, and lights that shadow themselves.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let rules = [no_shadows, meeting_nothing, range_kept, shadowed_at_times];
    rules.into_iter().filter_map(|rule| rule(evidence)).collect()
}

/// Light samples arrive whole or not at all, whichever they are: rounding decides whether their shadow rays meet the
/// light. Where a share p of them arrives, the mean is p L and the variance of one sample p σ² + p (1 − p) L².
fn shadowed_at_times(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let (open, noise) = (evidence.failed_finding(OPEN)?, evidence.failed_finding(NOISE)?);
    if !WITHOUT_AREA_LIGHTS.iter().all(|role| evidence.has_passed(*role)) {
        return None;
    }
    let channels = CHANNELS.map(|channel| {
        let mean = measure(open, "bounce 1", channel)?;
        let variance = measure(noise, "one point", channel)?;
        some_arrive(mean, variance).then_some((mean, variance))
    });
    let [(mean, variance), ..] = channels.into_iter().collect::<Option<Vec<_>>>()?[..] else {
        return None;
    };
    let dark = evidence.failures().filter(|seen| seen.is_too_weak());
    let dark = dark.filter(|seen| seen.is_about(Subject::Light)).map(|seen| seen.case);
    Some(Suspicion {
        cause: &light::EMITTER_SHADOWS_ITSELF,
        cases: dark.chain([evidence.case(NOISE)]).map(str::to_owned).collect(),
        evidence: vec![format!(
            "{} of the emitted light arrives, and the variance of a sample is {}, as where so many of them arrive \
             whole and the others not at all",
            figure(mean.measured / mean.expected),
            figure(variance.measured)
        )],
        ruled_out: vec![
            RuledOut::new("a wrong pdf or cosine", "samples would be too dark, not missing"),
            RuledOut::new("a wrong emission", "hemisphere sampling finds all of it"),
        ],
        weight: 1.0,
        degree: Degree::Named,
        beside: false,
    })
}

/// Whether a mean and the variance of one sample are those of samples of which some are lost.
fn some_arrive(mean: &Measure, variance: &Measure) -> bool {
    let (Some(means), Some([least, most])) = (mean.interval, variance.interval) else {
        return false;
    };
    let predicted = |mean_found: f64| {
        let share = mean_found / mean.expected;
        share * variance.expected + share * (1.0 - share) * mean.expected.powi(2)
    };
    let [a, b] = means.map(predicted);
    let is_between = means.iter().all(|found| 0.0 < *found && *found < mean.expected);
    is_between
        && a.min(b) <= most * (1.0 + VARIANCE_SLACK)
        && a.max(b) >= least * (1.0 - VARIANCE_SLACK)
}

/// Open light is right, and nothing hides a light.
fn no_shadows(evidence: &Evidence<'_>) -> Option<Suspicion> {
    nothing_hides_a_light(evidence).filter(|_| !are_dark_by_hemisphere(evidence))
}

/// Nothing hides a light, and no direction that was sampled finds one, though light sampling does.
fn meeting_nothing(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let no_shadows = nothing_hides_a_light(evidence)?;
    let (mut cases, mut told) = (no_shadows.cases, no_shadows.evidence);
    let found = evidence.failures().filter(|seen| seen.circumstances.intersects(FINDING_BY_RAYS));
    let dark = found.filter(|seen| seen.is_about_light() && seen.is_dark()).map(|seen| seen.case);
    cases.extend(dark.map(str::to_owned));
    told.push("hemisphere sampling finds no light at all".to_owned());
    are_dark_by_hemisphere(evidence).then(|| Suspicion {
        cause: &light::SECONDARY_RAYS_LOST,
        cases,
        evidence: told,
        ruled_out: vec![RuledOut::new(
            "missing shadow rays",
            "hemisphere sampling, which has none, would be right",
        )],
        weight: 1.0,
        degree: Degree::Named,
        beside: false,
    })
}

fn nothing_hides_a_light(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let wall = evidence.failed_finding(WALL)?;
    evidence.failed_finding(BLOCKER)?;
    let light = wall.measures.iter().map(|measure| measure.measured).fold(0.0, f64::max);
    (evidence.has_passed(OPEN) && light > 0.0).then(|| Suspicion {
        cause: &light::NO_SHADOWS,
        cases: [BLOCKER, WALL].map(|role| evidence.case(role).to_owned()).into(),
        evidence: vec![format!(
            "behind a wall there is light ({}), behind a blocker too much, and without one it is right",
            figure(light)
        )],
        ruled_out: vec![RuledOut::new("a wrong strength of lights", "open light is right")],
        weight: 1.0,
        degree: Degree::Named,
        beside: false,
    })
}

/// Whether hemisphere sampling finds nothing, from afar and from nearby.
fn are_dark_by_hemisphere(evidence: &Evidence<'_>) -> bool {
    let is_dark = |finding: &Finding| {
        !finding.measures.is_empty() && finding.measures.iter().all(Measure::is_degenerate)
    };
    FOUND.iter().all(|role| evidence.failed_finding(*role).is_some_and(is_dark))
}

/// Right from afar and dark from nearby, wherever it was tried: rays go no further than the camera was away. At one point
/// alone rounding may have done it.
fn range_kept(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let is_dark = |finding: &Finding| {
        let readings = |row: &str| channels(finding, row).into_iter().flatten().collect::<Vec<_>>();
        let (near, far) = (readings("from nearby"), readings("bounce 1"));
        near.len() == CHANNELS.len()
            && near.iter().all(|reading| reading.admits(0.0))
            && far.iter().all(|reading| reading.admits(1.0))
    };
    let found = FOUND.iter().all(|role| evidence.failed_finding(*role).is_some_and(is_dark));
    found.then(|| Suspicion {
        cause: &light::T_MAX_NOT_RESET,
        cases: FOUND.map(|role| evidence.case(role).to_owned()).into(),
        evidence: vec![
            "a light 1.6 units away is found by rays of a camera 2.3 away, and not of one 0.6 away"
                .to_owned(),
        ],
        ruled_out: vec![RuledOut::new("a wrong strength of lights", "from afar it is right")],
        weight: 1.0,
        degree: Degree::Named,
        beside: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::integrator;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};

    #[test]
    fn light_behind_a_wall_is_a_missing_shadow_where_open_light_is_right() {
        let lit = || means(vec![Measure::exact("behind", 0.2, 0.0, 0.0)]);
        let bright = || means(vec![mean("row", CHANNELS[0], 0.1, 1.6, 1e-3)]);
        let made = || Made::new().with(WALL, lit()).with(BLOCKER, bright());
        assert_eq!(made().with(OPEN, passing()).first(), Some(light::NO_SHADOWS.name));
        assert_eq!(made().first(), None);
    }

    #[test]
    fn rays_that_meet_nothing_cast_no_shadow_and_find_no_light() {
        let lit = || means(vec![Measure::exact("behind", 0.2, 0.0, 0.0)]);
        let found = |ratio: f64| means(vec![mean("bounce 1", CHANNELS[0], 0.1, ratio, 1e-3)]);
        let made = |by_hemisphere: f64| {
            let bounces = failing("dark").because(&integrator::NO_INDIRECT, "0 from bounce 2 on");
            let made =
                Made::new().with(WALL, lit()).with(BLOCKER, found(1.6)).with(OPEN, passing());
            let made = made.with("integrator/a", bounces);
            let made = made.with("light/b", found(0.0)).with("light/c", found(0.0));
            let made = made.under("light/b", Circumstances::HEMISPHERE_SAMPLING);
            FOUND.into_iter().fold(made, |made, role| made.with(role, found(by_hemisphere)))
        };
        let told = |by_hemisphere: f64| {
            let told = diagnose(&made(by_hemisphere).evidence()).headlines.into_iter();
            told.map(|headline| headline.cause)
                .filter(|cause| !cause.is_empty())
                .collect::<Vec<_>>()
        };
        assert_eq!(told(0.0), [light::SECONDARY_RAYS_LOST.name]);
        let dark = &diagnose(&made(0.0).evidence()).headlines[0].explains;
        assert!(dark.contains(&"light/b".to_owned()), "{dark:?}");
        assert!(!dark.contains(&"light/c".to_owned()), "light sampling traces no such ray");
        assert_eq!(told(0.7), [light::NO_SHADOWS.name, integrator::NO_INDIRECT.name]);
    }

    #[test]
    fn lights_that_lose_whole_samples_shadow_themselves() {
        // What a submission of 2025 comes to: 0.388 of the light, and 27 times the variance.
        let [lit, noise] = [[0.218083, 0.187433, 0.167393], [4.187e-4, 3.093e-4, 2.467e-4]];
        let finding = |row: &str, expected: [f64; 3], ratio: f64| {
            let pairs = CHANNELS.into_iter().zip(expected);
            means(pairs.map(|(c, e)| mean(row, c, e, ratio, 0.01)).collect())
        };
        let made = |variance: f64| {
            let made = Made::new()
                .with(OPEN, finding("bounce 1", lit, 0.3878))
                .with(NOISE, finding("one point", noise, variance));
            WITHOUT_AREA_LIGHTS.into_iter().fold(made, |made, case| made.with(case, passing()))
        };
        assert_eq!(made(27.25).first(), Some(light::EMITTER_SHADOWS_ITSELF.name));
        assert_eq!(made(0.3878 * 0.3878).first(), None, "all samples too dark alike");
    }

    #[test]
    fn darkness_from_nearby_is_a_range_that_was_kept() {
        let finding = |near: f64| -> Finding {
            let rows = [("bounce 1", 1.0), ("from nearby", near)];
            let row = |(row, ratio): (&str, f64)| {
                CHANNELS.map(|channel| mean(row, channel, 0.05, ratio, 0.004))
            };
            means(rows.into_iter().flat_map(row).collect())
        };
        let made = |near: [f64; 2]| {
            let [first, second] = near.map(finding);
            Made::new().with(FOUND[0], first).with(FOUND[1], second)
        };
        assert_eq!(made([0.0, 0.0]).first(), Some(light::T_MAX_NOT_RESET.name));
        assert_eq!(made([0.5, 0.5]).first(), None);
        assert_eq!(made([0.0, 1.0]).first(), None, "one point alone");
    }
}
