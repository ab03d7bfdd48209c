//! Any part: answers of the wrong form.

use super::{Cause, causes};

causes! {
    NOT_A_NUMBER = "answer-not-a-number":
        "an answer is NaN",
        at "often divisions whose divisor can be 0, and square roots",
        fix "Look for 0/0, ∞ − ∞, square roots of negative numbers, and uninitialised variables.";
    INFINITE = "answer-infinite":
        "an answer is infinite",
        at "often divisions whose divisor can be 0",
        fix "Never divide by 0: a failed sample contributes 0.";
    NEGATIVE = "answer-negative":
        "an answer is negative where it cannot be",
        at "often cosines used without a test of their sign",
        fix "Light from below the horizon contributes 0: clamp the cosine, or return early.";
    UNTOUCHED = "answer-untouched":
        "an answer is never written",
        at "the function that should have written it",
        fix "Write every element of the caller's buffer.";
    NOT_UNIT = "answer-not-unit":
        "a direction is not normalised",
        at "where the direction is computed",
        fix "Normalise the direction and keep the result.";
}
