//! Part 4: paths of many bounces.

use super::Cause;

/// See its headline.
pub static ROULETTE_NOT_DIVIDED: Cause = Cause {
    name: "roulette-not-divided",
    headline: "Russian roulette ends paths, and the survivors are not divided by their chance to survive",
    look_at: "indirect light, after the roulette test",
    remedy: "Divide by the probability of going on.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&ROULETTE_NOT_DIVIDED];
