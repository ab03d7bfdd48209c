//! How many paths Russian roulette lets reach a bounce, right and wrong.

use crate::cause::{Cause, integrator as cause};
use crate::contract::Roulette;

/// The probability that a path brings light at a bounce.
pub(super) type Law = fn(&Roulette, u32) -> f64;

/// q to the number of coins thrown before this bounce: one after each vertex but the guaranteed ones.
pub(super) fn law(roulette: &Roulette, bounce: u32) -> f64 {
    survival(roulette).powi(coins(bounce, 1 + roulette.guaranteed))
}

fn survival(roulette: &Roulette) -> f64 {
    1.0 - roulette.stop
}

/// Bounces beyond the first `spared`.
fn coins(bounce: u32, spared: u32) -> i32 {
    i32::try_from(bounce.saturating_sub(spared)).unwrap_or(i32::MAX)
}

/// What common mistakes make of it.
pub(super) const MISTAKES: &[(&Cause, Law)] = &[
    (&cause::ROULETTE_STOPS_DIRECT, |roulette, bounce| {
        survival(roulette).powi(coins(bounce, roulette.guaranteed))
    }),
    (&cause::ROULETTE_SURVIVES_BY_STOP, |roulette, bounce| {
        roulette.stop.powi(coins(bounce, 1 + roulette.guaranteed))
    }),
    (&cause::ROULETTE_GUARANTEE_FORGOTTEN, |roulette, bounce| {
        survival(roulette).powi(coins(bounce, 1))
    }),
    (&cause::ROULETTE_GUARANTEES_ONE_MORE, |roulette, bounce| {
        survival(roulette).powi(coins(bounce, 2 + roulette.guaranteed))
    }),
    (&cause::ROULETTE_PLAYED_ONCE, |roulette, bounce| {
        survival(roulette).powi(coins(bounce, 1 + roulette.guaranteed).min(1))
    }),
    (&cause::ROULETTE_NOT_PLAYED, |_, _| 1.0),
];
