//! What checks have recognised themselves: a formula that gives every wrong answer, a ratio with a name.

use super::{Degree, Evidence, Suspicion};
use crate::case::Subject;
use crate::cause;
use crate::checks::Finding;

/// By how much each clue weighs less than the one before it.
const NEXT: f64 = 0.7;

pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let mut suspicions = Vec::new();
    let failures = evidence.failures().chain(evidence.failures_of_robustness());
    // What an image resembles has to be so of the other images too.
    for failure in failures.filter(|seen| !seen.is_about(Subject::Image)) {
        let Some(finding) = failure.finding else { continue };
        // A name that the glossary does not know comes from another version: it explains nothing here.
        let known = finding.clues.iter().filter_map(|clue| Some((clue, cause::find(&clue.cause)?)));
        // That a number is NaN says nothing where it is known what made it so.
        let (symptoms, causes): (Vec<_>, Vec<_>) =
            known.partition(|(_, cause)| cause::is_symptom(cause));
        let clues = if causes.is_empty() { symptoms } else { causes };
        let rivals = clues.iter().filter(|(clue, _)| !clue.beside).count();
        let mut weight = 1.0;
        for (clue, cause) in clues {
            if is_not_enough(evidence, &clue.cause) {
                continue;
            }
            suspicions.push(Suspicion {
                cause,
                cases: vec![failure.case.to_owned()],
                evidence: vec![format!("{}: {}", failure.case, clue.evidence)],
                ruled_out: Vec::new(),
                weight,
                degree: if clue.beside { Degree::Named } else { Degree::of_one_among(rivals) },
                beside: clue.beside,
            });
            if !clue.beside {
                weight *= NEXT;
            }
        }
    }
    suspicions
}

/// Whether as many cases fail with it put right as those that it explains; and none shows that it is there beside the rest.
fn is_not_enough(evidence: &Evidence<'_>, cause: &str) -> bool {
    let findings = || evidence.failures().filter_map(|failure| failure.finding);
    let remains = |finding: &&Finding| finding.not_enough.as_deref() == Some(cause);
    let explained = |finding: &&Finding| finding.clues.iter().any(|clue| clue.cause == cause);
    let is_there =
        |finding: &Finding| finding.clues.iter().any(|clue| clue.beside && clue.cause == cause);
    let remaining = findings().filter(remains).count();
    remaining > 0 && remaining >= findings().filter(explained).count() && !findings().any(is_there)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{camera, shape};
    use crate::diagnosis::testing::{Made, failing, passing};

    #[test]
    fn what_fails_with_a_mistake_put_right_is_not_explained_by_it() {
        let unit = || failing("not unit").because(&shape::NORMAL_NOT_UNIT, "1.2");
        let not_enough = Some(shape::NORMAL_NOT_UNIT.name.to_owned());
        let beside = || Finding { not_enough: not_enough.clone(), ..failing("made unit, wrong") };
        let once = Made::new().with("shape/a", unit()).with("shape/b", beside());
        assert_eq!(suspect(&once.evidence()).len(), 0);
        let both = [&shape::NORMAL_NOT_UNIT];
        let of_all = once.with("shape/c", beside().because_all(both, "1.1"));
        assert_eq!(suspect(&of_all.evidence()).len(), 2);
        let twice = Made::new().with("shape/a", unit()).with("shape/b", beside());
        assert_eq!(suspect(&twice.with("shape/c", unit()).evidence()).len(), 2);
    }

    #[test]
    fn only_failing_cases_give_clues_and_the_first_weighs_most() {
        let finding = failing("wrong")
            .because(&camera::FILM_Y_DOWN, "predicts all 159 rays")
            .because(&shape::SEGMENT_END_IGNORED, "predicts most");
        let made = Made::new()
            .with("camera/a", finding)
            .with("camera/b", passing().because(&camera::FILM_Y_DOWN, "not a failure"));
        let found = suspect(&made.evidence());
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].cause.name, camera::FILM_Y_DOWN.name);
        assert_eq!(found[0].evidence, ["camera/a: predicts all 159 rays"]);
        assert!(found[0].weight > found[1].weight);
    }
}
