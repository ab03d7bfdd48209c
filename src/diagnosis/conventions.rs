//! Conventions are tried before blame: a core that follows another one than it declares is not wrong in its code but
//! in what it says of itself, and is told so.

use super::evidence::measure;
use super::readings::{Reading, channels};
use super::{Degree, Evidence, Suspicion};
use crate::case::Role;
use crate::cause::{Cause, convention};
use crate::contract::{EmissionSides, Falloff, GlassRadiance};
use crate::image::CHANNELS;
use crate::text::number::figure;

/// Point lights at several distances, and the squared distance of each row.
const POINT_LIGHT: Role = Role::PointLight;
const SQUARED_DISTANCES: [(&str, f64); 3] =
    [("below and beside", 3.06), ("nearly below", 2.27), ("far away", 12.91)];
const SEEN_LIGHT: Role = Role::VisibleLight;
const LIGHT_IN_GLASS: Role = Role::LightInsideGlass;
const INDEX_SQUARED: f64 = 2.25;

/// Every choice that another choice would explain.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    [falloff, emission, glass].iter().filter_map(|rule| rule(evidence)).collect()
}

/// A convention explains all of a case: it weighs more than any mistake that would.
fn suspicion(cause: &'static Cause, case: &str, sentence: String) -> Suspicion {
    Suspicion {
        cause,
        cases: vec![case.to_owned()],
        evidence: vec![sentence],
        ruled_out: Vec::new(),
        weight: 1.5,
        degree: Degree::Named,
        beside: false,
    }
}

/// Without falloff every row is its squared distance too bright.
fn falloff(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let finding = evidence.failed_finding(POINT_LIGHT)?;
    let (cause, power) = match evidence.conventions.point_light_falloff {
        Falloff::InverseSquare => (&convention::NO_FALLOFF, 1),
        Falloff::None => (&convention::INVERSE_SQUARE, -1),
    };
    let mut seen = Vec::new();
    for (row, squared) in SQUARED_DISTANCES {
        let predicted = squared.powi(power);
        let readings: Vec<_> = channels(finding, row).into_iter().flatten().collect();
        let reading = readings.first()?;
        if !readings.iter().all(|reading| reading.admits(predicted)) {
            return None;
        }
        seen.push(format!("{} at distance {}", figure(reading.ratio), figure(squared.sqrt())));
    }
    let sentence = format!("over what it should be: {}: distance squared", seen.join(", "));
    Some(suspicion(cause, evidence.case(POINT_LIGHT), sentence))
}

/// From behind the light has the radiance that it has in front.
fn emission(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let finding = evidence.failed_finding(SEEN_LIGHT)?;
    if evidence.conventions.emission != EmissionSides::Front {
        return None;
    }
    let row =
        |row: &str| CHANNELS.map(|channel| measure(finding, row, channel).map(|m| m.measured));
    let (front, behind) = (row("the light, from below"), row("the light, from behind"));
    let same = front.iter().zip(&behind).all(|(front, behind)| match (front, behind) {
        (Some(front), Some(behind)) => (behind / front - 1.0).abs() <= 1e-3,
        _ => false,
    });
    same.then(|| {
        let sentence = "from behind, the light is as bright as from the front".to_owned();
        suspicion(&convention::TWO_SIDED_EMISSION, evidence.case(SEEN_LIGHT), sentence)
    })
}

/// Without scaling a light in glass is the index squared brighter.
fn glass(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let finding = evidence.failed_finding(LIGHT_IN_GLASS)?;
    if evidence.conventions.glass_radiance != GlassRadiance::Scaled {
        return None;
    }
    let readings: Vec<Reading> = finding.measures.iter().filter_map(Reading::of).collect();
    let all = !readings.is_empty() && readings.iter().all(|r| r.admits(INDEX_SQUARED));
    all.then(|| {
        let sentence = format!(
            "the light in glass is {} of what it should be: 1.5² = 2.25",
            figure(readings[0].ratio)
        );
        suspicion(&convention::UNSCALED_RADIANCE, evidence.case(LIGHT_IN_GLASS), sentence)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::{Finding, Measure};
    use crate::diagnosis::testing::{Made, mean, means};

    fn point_lights(power: i32) -> Finding {
        let rows = SQUARED_DISTANCES.iter().flat_map(|(row, squared)| {
            let ratio = squared.powi(power);
            CHANNELS.map(|channel| mean(row, channel, 0.07, ratio, 1e-4))
        });
        means(rows.collect())
    }

    #[test]
    fn a_light_without_falloff_differs_from_what_is_declared() {
        let made = Made::new().with(POINT_LIGHT, point_lights(1));
        assert_eq!(made.first(), Some(convention::NO_FALLOFF.name));
        let mut other = Made::new().with(POINT_LIGHT, point_lights(-1));
        assert_eq!(other.first(), None);
        other.conventions.point_light_falloff = Falloff::None;
        assert_eq!(other.first(), Some(convention::INVERSE_SQUARE.name));
    }

    #[test]
    fn lights_that_emit_behind_are_two_sided() {
        let rows = [("the light, from below", 5.0), ("the light, from behind", 0.0)];
        let measures = rows.iter().flat_map(|(row, expected)| {
            CHANNELS.map(|c| Measure::exact("", 5.0, *expected, 1e-4).of_row(row).of_channel(c))
        });
        let made = Made::new().with(SEEN_LIGHT, means(measures.collect()));
        assert_eq!(made.first(), Some(convention::TWO_SIDED_EMISSION.name));
    }

    #[test]
    fn glass_that_does_not_scale_is_told_by_the_index_squared() {
        let measures = CHANNELS.map(|c| mean("bounces 0 to 40", c, 0.4267, 2.25, 0.004));
        let made = Made::new().with(LIGHT_IN_GLASS, means(measures.into()));
        assert_eq!(made.first(), Some(convention::UNSCALED_RADIANCE.name));
    }

    #[test]
    fn the_distances_are_those_of_the_case() {
        let text =
            include_str!("../../cases/light/point-light-follows-the-inverse-square-law.toml");
        let light = glam::DVec3::new(0.9, 0.0, 1.5);
        let points = [(0.0, 0.0), (0.8, 0.1), (-2.0, 1.5)];
        for ((row, squared), (x, y)) in SQUARED_DISTANCES.iter().zip(points) {
            assert!(text.contains(row));
            let found = light.distance_squared(glam::DVec3::new(x, y, 0.0));
            assert!((found - squared).abs() < 1e-12, "{row}: {found}");
        }
    }
}
