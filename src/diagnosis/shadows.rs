//! What blocks light and what does not, where light that is not blocked is right.

use super::readings::{CHANNELS, channels};
use super::{Evidence, Suspicion};
use crate::cause::light;

/// Direct light that nothing blocks.
const OPEN: &str = "lights/a-rectangle-overhead-matches-its-form-factor";
/// Light behind something.
const BLOCKER: &str = "lights/a-blocker-hides-what-is-behind-it";
const WALL: &str = "lights/a-light-behind-a-wall-gives-nothing";
/// Lights found by the hemisphere, looked at from far and from near.
const FOUND: [&str; 2] = [
    "lights/a-tilted-light-is-found-by-the-hemisphere",
    "lights/a-slanted-light-is-found-by-the-hemisphere",
];

/// Shadows that are missing, and rays that are too short.
pub fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    no_shadows(evidence).into_iter().chain(range_kept(evidence)).collect()
}

/// Open light is right, and nothing hides a light.
fn no_shadows(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let wall = evidence.failed_finding(WALL)?;
    evidence.failed_finding(BLOCKER)?;
    let light = wall.measures.iter().map(|measure| measure.measured).fold(0.0, f64::max);
    (evidence.has_passed(OPEN) && light > 0.0).then(|| Suspicion {
        cause: &light::NO_SHADOWS,
        cases: vec![BLOCKER.to_owned(), WALL.to_owned()],
        evidence: vec![format!(
            "behind a wall there is light ({light:.3}), behind a blocker too much, and without one it is right"
        )],
        ruled_out: vec!["a wrong strength of lights (open light is right)".to_owned()],
        weight: 1.0,
    })
}

/// Right from afar and dark from nearby: rays go no further than the eye was away.
fn range_kept(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let is_dark = |case: &&str| {
        evidence.failed_finding(case).is_some_and(|finding| {
            let near: Vec<_> = channels(finding, "from nearby").into_iter().flatten().collect();
            let far: Vec<_> = channels(finding, "bounce 1").into_iter().flatten().collect();
            near.len() == CHANNELS.len()
                && near.iter().all(|reading| reading.admits(0.0))
                && far.iter().all(|reading| reading.admits(1.0))
        })
    };
    let cases: Vec<_> = FOUND.iter().filter(|c| is_dark(c)).map(|&c| c.to_owned()).collect();
    (!cases.is_empty()).then(|| Suspicion {
        cause: &light::RANGE_KEPT,
        cases,
        evidence: vec![
            "a light 1.6 units away is found by rays of an eye 2.3 away, and not of one 0.6 away"
                .to_owned(),
        ],
        ruled_out: vec!["a wrong strength of lights (from afar it is right)".to_owned()],
        weight: 1.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::{Finding, Measure};
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, mean, means, passing};

    fn first(made: &Made) -> Option<&'static str> {
        diagnose(&made.evidence()).first().map(|cause| cause.name)
    }

    #[test]
    fn light_behind_a_wall_is_a_missing_shadow_where_open_light_is_right() {
        let lit = || means(vec![Measure::exact("behind, red", 0.2, 0.0, 0.0)]);
        let bright = || means(vec![mean("row, red", 0.1, 1.6, 1e-3)]);
        let made = || Made::new().with(WALL, lit()).with(BLOCKER, bright());
        assert_eq!(first(&made().with(OPEN, passing())), Some(light::NO_SHADOWS.name));
        assert_eq!(first(&made()), None);
    }

    #[test]
    fn darkness_from_nearby_is_a_range_that_was_kept() {
        let finding = |near: f64| -> Finding {
            let rows = [("bounce 1", 1.0), ("from nearby", near)];
            let row = |(row, ratio): (&str, f64)| {
                CHANNELS.map(|channel| mean(&format!("{row}, {channel}"), 0.05, ratio, 0.004))
            };
            means(rows.into_iter().flat_map(row).collect())
        };
        assert_eq!(first(&Made::new().with(FOUND[0], finding(0.0))), Some(light::RANGE_KEPT.name));
        assert_eq!(first(&Made::new().with(FOUND[0], finding(0.5))), None);
    }
}
