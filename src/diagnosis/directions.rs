//! Bounces that carry the right energy in the wrong directions: a furnace, where every direction is like every other,
//! is right, and a scene that sees directions is not.

use super::bounces::{FURNACES, rows};
use super::readings::channels;
use super::{Degree, Evidence, RuledOut, Suspicion};
use crate::case::{Role, Subject};
use crate::cause::integrator;

/// The cavity that sees directions, which a furnace cannot.
const CAVITY: Role = Role::Cavity;
const SIDE: Role = Role::SidewaysWall;
/// Directions of bounces, and the cosine they are weighted with.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    wrong_directions(evidence).into_iter().chain(world_cosine(evidence)).collect()
}

/// In a furnace every direction is like every other: what is right there and wrong in the cavity is where light goes.
fn wrong_directions(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let cavity = evidence.failed_finding(CAVITY)?;
    if !evidence.has_passed(FURNACES[0]) {
        return None;
    }
    let rows = rows(cavity);
    let admits_one = |bounce: u32| {
        rows.iter()
            .filter(|row| row.bounces == [bounce, bounce])
            .flat_map(|row| row.readings.iter().flatten())
            .all(|reading| reading.admits(1.0))
    };
    (admits_one(1) && !admits_one(2)).then(|| Suspicion {
        cause: &integrator::BOUNCE_DIRECTIONS,
        cases: vec![evidence.case(CAVITY).to_owned()],
        evidence: vec![
            "bounce 1 of the cavity is right and bounce 2 is not".to_owned(),
            format!("{} passes: the energy of each bounce is right", evidence.case(FURNACES[0])),
        ],
        ruled_out: vec![RuledOut::new("a wrong weight of bounces", "the furnace would see it")],
        weight: 1.0,
        degree: Degree::LooksLike,
        beside: false,
    })
}

/// Where a room faces sideways, a cosine with +z weighs the sphere in its middle otherwise; averaged over all
/// directions, as in the furnace and the cavity, it is the same.
fn world_cosine(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let finding = evidence.failed_finding(SIDE)?;
    let admits_one = |bounce: u32| {
        let readings = channels(finding, &format!("bounce {bounce}"));
        readings.iter().flatten().all(|reading| reading.admits(1.0))
    };
    let averages = [FURNACES[0], CAVITY].iter().all(|role| evidence.has_withstood(*role));
    (averages && admits_one(1) && !admits_one(2)).then(|| Suspicion {
        cause: &integrator::BOUNCE_WORLD_COSINE,
        cases: std::iter::once(evidence.case(SIDE).to_owned())
            .chain(specular_cases(evidence))
            .collect(),
        evidence: vec![
            "at a wall that faces sideways bounce 1 is right and bounce 2 is not".to_owned(),
            format!(
                "{} and {} do not fail: over all directions the weights are right",
                evidence.case(FURNACES[0]),
                evidence.case(CAVITY)
            ),
        ],
        ruled_out: vec![RuledOut::new("bounces in wrong directions", "the cavity would see it")],
        weight: 1.0,
        degree: Degree::LooksLike,
        beside: false,
    })
}

/// Failing cases with mirrors and smooth glass, whose only direction has a cosine too.
fn specular_cases(evidence: &Evidence<'_>) -> impl Iterator<Item = String> {
    let failures = evidence.failures().filter(|seen| seen.is_about(Subject::Integrator));
    failures.filter(|seen| seen.is_specular).map(|seen| seen.case.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::Finding;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};
    use crate::image::Channel;

    /// Bounce 1 is right and bounce 2 is not.
    fn second_bounce_wrong() -> Finding {
        let rows = [("bounce 1", 1.0), ("bounce 2", 0.8)];
        means(rows.map(|(row, ratio)| mean(row, Channel::Red, 0.2, ratio, 0.004)).into())
    }

    #[test]
    fn a_wall_that_faces_sideways_shows_a_cosine_with_the_world() {
        let made = |cavity: Finding| {
            let made = Made::new().with(FURNACES[0], passing()).with(CAVITY, cavity);
            made.with(SIDE, second_bounce_wrong())
        };
        assert_eq!(made(passing()).first(), Some(integrator::BOUNCE_WORLD_COSINE.name));
        assert_eq!(made(failing("too")).first(), None);
        let with_glass = made(passing())
            .with("integrator/rough", failing("too bright"))
            .with("integrator/pane", failing("too bright"))
            .in_a_specular_scene("integrator/pane");
        let explains = &diagnose(&with_glass.evidence()).headlines[0].explains;
        assert!(explains.contains(&"integrator/pane".to_owned()) && explains.len() == 2);
    }

    #[test]
    fn a_cavity_that_is_wrong_where_the_furnace_is_right_is_about_directions() {
        let made = Made::new().with(FURNACES[0], passing()).with(CAVITY, second_bounce_wrong());
        assert_eq!(made.first(), Some(integrator::BOUNCE_DIRECTIONS.name));
    }
}
