//! Which mistake an answer in the wrong form is, from the words of [`crate::contract::validate`].

use crate::cause::{Cause, camera, contract, shape};

/// Words of a complaint, and what they tell. The first that is found counts.
const WORDS: &[(&[&str], &Cause)] = &[
    (&["ray ", ": direction has length"], &camera::DIRECTION_NOT_UNIT),
    (&["normal has length"], &shape::NORMAL_NOT_UNIT),
    (&["hit ", ": t is NaN"], &shape::NAN_HIT_ACCEPTED),
    (&["left untouched"], &contract::UNTOUCHED),
    (&["has length"], &contract::NOT_UNIT),
    (&["NaN"], &contract::NOT_A_NUMBER),
    (&["inf"], &contract::INFINITE),
    (&["negative"], &contract::NEGATIVE),
];

/// The mistake that a breach of the contract is, if its words say so.
pub fn cause_of(complaint: &str) -> Option<&'static Cause> {
    let tells = |words: &&[&str]| words.iter().all(|word| complaint.contains(word));
    WORDS.iter().find(|(words, _)| tells(words)).map(|(_, cause)| *cause)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complaints_of_validation_are_understood() {
        let told = |complaint| cause_of(complaint).map(|cause| cause.name);
        assert_eq!(
            told("ray 0 of 159: direction has length 1.2, not 1"),
            Some("direction-not-unit")
        );
        assert_eq!(
            told("hit 3 of 9: shading_normal has length 0.9, not 1"),
            Some("normal-not-unit")
        );
        assert_eq!(told("hit 3 of 9: t is NaN; a miss is NONE"), Some("nan-hit-accepted"));
        assert_eq!(told("sample 1 of 2: wi has length 2, not 1"), Some("answer-not-unit"));
        assert_eq!(told("radiance 7 of 9: radiance is NaN (red)"), Some("answer-not-a-number"));
        assert_eq!(told("pixel (3, 4): radiance = -1 is negative (red)"), Some("answer-negative"));
        assert_eq!(told("shape 7 has no primitive 0"), None);
    }
}
