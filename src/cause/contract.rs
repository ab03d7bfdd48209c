//! Any part: answers of the wrong form.

use super::{Cause, causes};

causes! {
    NOT_A_NUMBER = "answer-not-a-number":
        "an answer is not a number",
        at "divisions, where a divisor can be 0, and square roots",
        fix "Look for 0/0, ∞ − ∞, the root of a negative number, and variables that are never set.";
    INFINITE = "answer-infinite":
        "an answer is infinite",
        at "divisions, where a divisor can be 0",
        fix "Divide only by what is not 0; a failed sample counts as nothing.";
    NEGATIVE = "answer-negative":
        "an answer is negative where it cannot be",
        at "cosines that are used without a test of their sign",
        fix "Light from below the horizon counts as 0: clamp the cosine, or return before.";
    UNTOUCHED = "answer-untouched":
        "an answer is never written",
        at "the function that should have written it",
        fix "Write every element of what the caller hands over.";
    NOT_UNIT = "answer-not-unit":
        "a direction is not of unit length",
        at "where the direction is made",
        fix "Normalise the direction, and keep the result.";
}
