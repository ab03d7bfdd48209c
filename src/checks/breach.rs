//! Which mistake an answer is that has not the contract's form.

use crate::cause::{Cause, camera, contract, shape};
use crate::contract::{Breach, BreachKind};

/// The mistake that a breach of the contract is, if its kind says so.
pub(crate) fn cause_of(breach: &Breach) -> Option<&'static Cause> {
    let cause = match (breach.element(), breach.field.as_ref(), &breach.kind) {
        ("ray", "direction", BreachKind::NotUnit(_)) => &camera::DIRECTION_NOT_UNIT,
        (_, "geometric_normal" | "shading_normal", BreachKind::NotUnit(_)) => {
            &shape::NORMAL_NOT_UNIT
        }
        ("hit", "t", BreachKind::NotANumber) => &shape::NAN_HIT_ACCEPTED,
        (_, _, BreachKind::Untouched) => &contract::UNTOUCHED,
        (_, _, BreachKind::NotUnit(_)) => &contract::NOT_UNIT,
        (_, _, BreachKind::NotANumber) => &contract::NOT_A_NUMBER,
        (_, _, BreachKind::Infinite) => &contract::INFINITE,
        (_, _, BreachKind::Negative(_)) => &contract::NEGATIVE,
        _ => return None,
    };
    Some(cause)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let ghost = BreachKind::NoSuchPrimitive { shape: 7, primitive: 0 };
        assert_eq!(told("hit", "primitive", ghost), None);
        assert_eq!(cause_of(&Breach::other("NaN, inf, negative")), None);
    }
}
