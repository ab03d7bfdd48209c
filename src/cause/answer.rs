//! Any part: answers whose form is wrong.

use super::Cause;

/// See its headline.
pub static NOT_A_NUMBER: Cause = Cause {
    name: "answer-not-a-number",
    headline: "an answer is not a number",
    look_at: "divisions, where a divisor can be 0, and square roots",
    remedy: "Look for 0/0, ∞ − ∞, the root of a negative number, and variables that are never set.",
};

/// See its headline.
pub static INFINITE: Cause = Cause {
    name: "answer-infinite",
    headline: "an answer is infinite",
    look_at: "divisions, where a divisor can be 0",
    remedy: "Divide only by what is not 0; a failed sample counts as nothing.",
};

/// See its headline.
pub static NEGATIVE: Cause = Cause {
    name: "answer-negative",
    headline: "an answer is negative where it cannot be",
    look_at: "cosines that are used without a test of their sign",
    remedy: "Light from below the horizon counts as 0: clamp the cosine, or return before.",
};

/// See its headline.
pub static UNTOUCHED: Cause = Cause {
    name: "answer-untouched",
    headline: "an answer is never written",
    look_at: "the function that should have written it",
    remedy: "Write every element of what the caller hands over.",
};

/// See its headline.
pub static NOT_UNIT: Cause = Cause {
    name: "answer-not-unit",
    headline: "a direction is not of unit length",
    look_at: "where the direction is made",
    remedy: "Normalise the direction, and keep the result.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&NOT_A_NUMBER, &INFINITE, &NEGATIVE, &UNTOUCHED, &NOT_UNIT];
