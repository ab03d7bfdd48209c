//! Pictures as a whole: film, encoding, alignment.

use super::Cause;

/// See its headline.
pub static GAMMA_TWICE: Cause = Cause {
    name: "gamma-in-film",
    headline: "the film holds gamma-encoded values where linear radiance belongs",
    look_at: "the film, where radiance is stored",
    remedy: "Write linear radiance; encode only when an 8-bit picture is written.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&GAMMA_TWICE];
