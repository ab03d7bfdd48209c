//! From the records of a run to the causes of what failed in it.

use super::record::CoreRecord;
use super::second_look::SecondLook;
use super::{Outcome, Status, Transplants, TrialRecord};
use crate::case::Foundation;
use crate::contract::Components;
use crate::diagnosis::{self, Diagnosis, Ending, Evidence, Observation, Planted, Standing, View};

/// The causes of what failed on `core` among `trials`; those of other cores are left aside.
pub(crate) fn diagnose<'a>(
    core: &CoreRecord,
    trials: impl IntoIterator<Item = &'a TrialRecord>,
) -> Diagnosis {
    let of_core = trials.into_iter().filter(|trial| trial.core == core.spec);
    diagnosis::diagnose(&evidence(core, of_core))
}

/// The same, put to the proof by planted mistakes.
pub(super) fn diagnose_proven(
    core: &CoreRecord,
    trials: &[TrialRecord],
    planted: &dyn Planted,
) -> Diagnosis {
    let of_core = trials.iter().filter(|trial| trial.core == core.spec);
    diagnosis::diagnose_proven(&evidence(core, of_core), planted)
}

/// The same from second looks too, each at one component.
pub(super) fn diagnose_apart(
    core: &CoreRecord,
    trials: &[TrialRecord],
    transplants: &Transplants,
    views: &[SecondLook],
    planted: &dyn Planted,
) -> Diagnosis {
    let first: Vec<_> = trials.iter().filter(|trial| trial.core == core.spec).collect();
    let of_view = |view: &'_ SecondLook| {
        let mended = first.iter().filter(|t| transplants.place_of(&t.case) == Some(view.own));
        mended.map(|trial| trial.case.clone()).collect()
    };
    let views: Vec<_> = views
        .iter()
        .map(|view| View {
            evidence: evidence(core, seen_again(&first, view)),
            own: view.own,
            beside: transplants.beside(view.own),
            mended: of_view(view),
            of_own: view.of_own.clone(),
        })
        .collect();
    let evidence = evidence(core, first.iter().copied());
    diagnosis::diagnose_apart(&evidence, &views, &transplants.unmended, planted)
}

/// What was tried again, and of the rest what did not fail.
fn seen_again<'a>(
    first: &[&'a TrialRecord],
    view: &'a SecondLook,
) -> impl Iterator<Item = &'a TrialRecord> {
    let is_again = |case: &str| view.again.iter().any(|trial| trial.case == case);
    let stays = |t: &&TrialRecord| !t.outcome.status().is_failure() && !is_again(&t.case);
    first.iter().copied().filter(stays).chain(&view.again).collect::<Vec<_>>().into_iter()
}

fn evidence<'a>(core: &CoreRecord, trials: impl Iterator<Item = &'a TrialRecord>) -> Evidence<'a> {
    Evidence::new(trials.map(observation).collect(), core.conventions)
}

fn observation(trial: &TrialRecord) -> Observation<'_> {
    let standing = match trial.outcome.status() {
        Status::Pass => Standing::Passed,
        Status::Fail | Status::Crashed | Status::TimedOut => Standing::Failed,
        Status::Blocked | Status::Inconclusive | Status::Skipped | Status::Broken => unknown(trial),
    };
    Observation {
        case: &trial.case,
        tier: trial.tier,
        role: trial.role,
        is_specular: trial.scene.as_ref().is_some_and(|scene| scene.is_specular),
        rests_on: of_the_core(&trial.rests_on, trial.with),
        proves: proven(&trial.proves, &trial.outcome),
        standing,
        ending: ending(&trial.outcome),
        finding: trial.outcome.finding(),
        rerun: &trial.rerun,
        work: trial.work,
        circumstances: trial.circumstances,
        with: trial.with,
    }
}

/// Of what a case rests on, what was the core's own: by what it took from the bench it cannot fail.
fn of_the_core(rests_on: &[Foundation], with: Components) -> Vec<Foundation> {
    let is_own = |foundation: &Foundation| !with.contains(foundation.components());
    rests_on.iter().copied().filter(is_own).collect()
}

/// What a case proves by how it ended: nothing, where it failed for something else.
fn proven<'a>(proves: &'a [Foundation], outcome: &Outcome) -> &'a [Foundation] {
    let fails_otherwise = outcome.status().is_failure() && !outcome.breaks(proves);
    if fails_otherwise { &[] } else { proves }
}

fn ending(outcome: &Outcome) -> Option<Ending<'_>> {
    match outcome {
        Outcome::Refused { why } => Some(Ending::Refused { why }),
        Outcome::Crashed { how, during } => Some(Ending::Crashed { how, during }),
        Outcome::TimedOut { during, .. } => Some(Ending::TimedOut { during }),
        _ => None,
    }
}

fn unknown(trial: &TrialRecord) -> Standing {
    match &trial.outcome {
        Outcome::Blocked { by } => Standing::Blocked(by.clone()),
        _ => Standing::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::Finding;
    use crate::run::record::Transplanted;

    #[test]
    fn what_mends_only_beside_another_is_told_with_the_one_that_mends_nothing_alone() {
        let of = |(component, alone, together)| Transplanted {
            component,
            alone,
            together,
            judged: 0,
            cases: Vec::new(),
        };
        let beside = |components: &[(Components, usize, usize)]| {
            let components = components.iter().copied().map(of).collect();
            let (failures, mended, untried, unmended) = (4, 4, 0, Vec::new());
            let all = Transplants { failures, components, mended, untried, unmended };
            all.beside(Components::DIRECT_LIGHTING)
        };
        let direct = (Components::DIRECT_LIGHTING, 0, 3);
        let (light, bsdf) = ((Components::LIGHT_SAMPLING, 1, 1), (Components::BSDF, 0, 0));
        assert_eq!(beside(&[direct, light, bsdf]), Components::BSDF);
        assert_eq!(beside(&[direct, light]), Components::empty());
        let mends_alone = (Components::DIRECT_LIGHTING, 2, 3);
        assert_eq!(beside(&[mends_alone, bsdf]), Components::empty());
        let path = (Components::PATH, 0, 2);
        assert_eq!(beside(&[path, direct, bsdf]), Components::empty(), "it may be the path's");
    }

    #[test]
    fn nothing_follows_from_what_was_taken_from_the_bench() {
        let (hits, seeds) = (Foundation::Hits, Foundation::Seeds);
        assert_eq!(of_the_core(&[seeds, hits], Components::empty()), [seeds, hits]);
        assert_eq!(of_the_core(&[seeds, hits], hits.components()), [seeds]);
    }

    #[test]
    fn nothing_follows_from_a_negative_pixel_in_the_case_of_the_random_numbers() {
        let negative = Outcome::Judged { finding: Finding::failure("a pixel is negative") };
        assert_eq!(proven(&[Foundation::Seeds], &negative), []);
        assert_eq!(proven(&[Foundation::Camera], &negative), [Foundation::Camera]);
    }
}
