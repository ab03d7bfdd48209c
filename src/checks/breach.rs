//! Which mistake an answer is that has not the contract's form.

use super::{CheckError, Clue, Finding};
use crate::cause::{Cause, camera, contract, sampling, shape};
use crate::contract::{Breach, BreachKind, CoreError};
use crate::stats::Verdict;

/// The failure that a breach of the contract is.
pub(crate) fn failure(breach: &Breach) -> Finding {
    let statement = CoreError::from(breach.clone()).to_string();
    Finding::failure(statement).because_each(cause_of(breach), &breach.to_string())
}

/// The same with what the check found once it was mended. What is wrong then as well may be what made the breach. Where one
/// formula gives what is left once all is made unit, it made no length: both are there.
pub(crate) fn failure_beside(breach: &Breach, mended: Result<Finding, CheckError>) -> Finding {
    let (alone, mend) = (failure(breach), breach.mend().unwrap_or_default());
    match mended {
        Ok(found) if found.failed() => {
            let statement = format!("{}; {mend}, {}", alone.statement, found.statement);
            let not_enough = cause_of(breach).map(|cause| cause.name.to_owned());
            // What lies between the ends of a range has broken the contract, too: it is not the ends that were forgotten.
            let is_of_ends = |clue: &Clue| clue.cause == sampling::ENDS_OF_RANGE.name;
            let clues = found.clues.into_iter().filter(|clue| !is_of_ends(clue));
            let mut clues: Vec<_> = clues.collect();
            let beside = match (&breach.kind, &mut clues[..]) {
                (BreachKind::NotUnit(_), [only]) => {
                    only.beside = true;
                    cause_of(breach)
                }
                _ => None,
            };
            let found = Finding { statement, not_enough, clues, ..found };
            found.because_all(beside, &breach.to_string())
        }
        Ok(found) if found.verdict == Verdict::Pass => failure_alone(breach, "is right"),
        _ => alone,
    }
}

/// The failure where everything else is right once it is mended; `is_right` says how right.
pub(crate) fn failure_alone(breach: &Breach, is_right: &str) -> Finding {
    let mend = breach.mend().unwrap_or_default();
    let evidence = format!("{breach}; {mend}, everything else {is_right}");
    Finding { clues: Vec::new(), ..failure(breach) }.because_each(cause_of(breach), &evidence)
}

/// The mistake that a breach of the contract is, if its kind says so.
pub(crate) fn cause_of(breach: &Breach) -> Option<&'static Cause> {
    let cause = match (breach.element(), breach.field.as_ref(), &breach.kind) {
        ("ray", "direction", BreachKind::NotUnit(_)) => &camera::DIRECTION_NOT_UNIT,
        (_, "geometric_normal" | "shading_normal", BreachKind::NotUnit(_)) => {
            &shape::NORMAL_NOT_UNIT
        }
        // The NaN of a sphere is the square root of a negative number, or what it was made of.
        ("hit", "t", BreachKind::NotANumber) if !breach.is_about("intersect-sphere") => {
            &shape::NAN_HIT_ACCEPTED
        }
        (_, _, BreachKind::Untouched) => &contract::UNTOUCHED,
        (_, _, BreachKind::NotUnit(_)) => &contract::NOT_UNIT,
        (_, _, BreachKind::NotANumber) => &contract::NOT_A_NUMBER,
        (_, _, BreachKind::Infinite) => &contract::INFINITE,
        // A sum of squares with a wrong sign, and no cosine's.
        ("variance of pixel", _, BreachKind::Negative(_)) => return None,
        (_, _, BreachKind::Negative(_)) => &contract::NEGATIVE,
        _ => return None,
    };
    Some(cause)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::Ray;
    use crate::contract::crossing::{Request, Sent};
    use glam::DVec3;

    #[test]
    fn what_is_wrong_with_unit_directions_too_is_no_missing_normalisation() {
        let breach = Breach::of("shading_normal", BreachKind::NotUnit(0.9)).in_element("hit", 3, 9);
        let wrong = failure_beside(&breach, Ok(Finding::failure("7 of 9 normals are wrong")));
        assert!(wrong.clues.is_empty());
        assert_eq!(wrong.not_enough.as_deref(), Some("normal-not-unit"));
        assert!(
            wrong.statement.ends_with("not 1; made unit, 7 of 9 normals are wrong"),
            "{}",
            wrong.statement
        );
        let at_an_end = Finding::failure("a sample is NaN").because(&sampling::ENDS_OF_RANGE, "0");
        assert!(failure_beside(&breach, Ok(at_an_end)).clues.is_empty());
        let moved = Finding::failure("7 wrong").because(&shape::NORMALS_MOVED_ON, "all 9 rays");
        let both = failure_beside(&breach, Ok(moved)).clues;
        let both: Vec<_> = both.iter().map(|clue| (&clue.cause[..], clue.beside)).collect();
        assert_eq!(both, [("normals-moved-on", true), ("normal-not-unit", true)]);
        let right = Finding { verdict: Verdict::Pass, ..Finding::failure("all normals are right") };
        let alone = failure_beside(&breach, Ok(right));
        assert!(alone.failed());
        assert_eq!(alone.clues[0].cause, "normal-not-unit");
        assert!(alone.clues[0].evidence.ends_with("made unit, everything else is right"));
    }

    #[test]
    fn a_breach_is_known_by_its_kind_and_its_place() {
        let told = |what, field: &'static str, kind| {
            cause_of(&Breach::of(field, kind).in_element(what, 0, 9)).map(|cause| cause.name)
        };
        let long = || BreachKind::NotUnit(1.2);
        assert_eq!(told("ray", "direction", long()), Some("direction-not-unit"));
        assert_eq!(told("hit", "shading_normal", long()), Some("normal-not-unit"));
        assert_eq!(told("sample", "wi", long()), Some("answer-not-unit"));
        assert_eq!(told("hit", "t", BreachKind::NotANumber), Some("nan-hit-accepted"));
        assert_eq!(
            told("radiance", "radiance", BreachKind::NotANumber),
            Some("answer-not-a-number")
        );
        assert_eq!(told("hit", "t", BreachKind::Infinite), Some("answer-infinite"));
        assert_eq!(told("pixel", "radiance", BreachKind::Negative(-1.0)), Some("answer-negative"));
        assert_eq!(told("variance of pixel", "it", BreachKind::Negative(-1.0)), None);
        let rays = [Ray::new(DVec3::ZERO, DVec3::X); 9];
        let request = Request::new("intersect_sphere").with_array(Sent::new("rays", &rays));
        let nan = Breach::of("t", BreachKind::NotANumber).in_element("hit", 0, 9);
        let nan = nan.with_question(&request);
        assert_eq!(cause_of(&nan).map(|cause| cause.name), Some("answer-not-a-number"));
        let ghost = BreachKind::NoSuchPrimitive { shape: 7, primitive: 0 };
        assert_eq!(told("hit", "primitive", ghost), None);
        assert_eq!(cause_of(&Breach::other("NaN, inf, negative")), None);
    }
}
