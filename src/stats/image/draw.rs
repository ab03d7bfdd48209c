//! What a picture is worth, and how its runs are asked for.

use crate::math::rng::Seed;
use crate::stats::Stage;
use crate::stats::plan::level::{CONFIRM_LEVEL, SCREEN_LEVEL};

/// How often confirmations are looked at.
const LOOKS: usize = 4;

/// What a picture is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageEffort {
    /// The relative error of the whole picture that must be seen.
    pub(crate) detects: f64,
    /// Samples a pixel of each run, which the caller draws; 1 if that is not known.
    pub(crate) samples: u32,
    /// Runs of the screen: all that a correct core pays.
    pub(crate) screen_runs: u32,
    /// Runs of each of two confirmations at each look at them. The first tells only of too much light, and all but the last
    /// only of large cells.
    pub(crate) looks: [u32; LOOKS],
}

impl ImageEffort {
    /// The effort that sees an error of `detects` of the whole picture, if the runs have samples
    /// enough.
    pub const fn new(detects: f64, samples: u32) -> Self {
        Self { detects, samples, screen_runs: 16, looks: [4, 8, 16, 32] }
    }

    /// With half of the runs, for a first look, which fails no core.
    pub(crate) fn halved(self) -> Self {
        let looks = self.looks.map(|runs| runs / 2);
        Self { screen_runs: self.screen_runs / 2, looks, ..self }
    }

    /// The fewest runs of a confirmation.
    pub(crate) const fn first_look(&self) -> u32 {
        self.looks[0]
    }

    /// The most runs of a confirmation.
    pub(crate) const fn confirm_runs(&self) -> u32 {
        self.looks[LOOKS - 1]
    }
}

/// A request for one run: a whole picture with its own seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageDraw {
    /// [`Stage::First`] screens, [`Stage::Second`] and [`Stage::Third`] confirm.
    pub(crate) stage: Stage,
    /// Number of the run in its stage.
    pub(crate) run: u32,
}

impl ImageDraw {
    /// Of every image.
    pub(crate) const FIRST: Self = Self { stage: Stage::First, run: 0 };

    /// The seed of this run below the seed of its check.
    pub fn seed(&self, check: Seed) -> Seed {
        self.stage.seed(check).child(self.run)
    }
}

/// How easily a picture is suspected and a suspicion confirmed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Levels {
    /// [`SCREEN_LEVEL`], over all cells.
    pub(super) screen: f64,
    /// [`CONFIRM_LEVEL`], of each confirmation at each scale.
    pub(super) confirm: f64,
}

impl Levels {
    /// Of each confirmation at one look: what both confirmations of any look reject wrongly is then no more than
    /// those of one look at [`Levels::confirm`].
    pub(super) fn of_a_look(self) -> f64 {
        self.confirm / (LOOKS as f64).sqrt()
    }
}

impl Levels {
    /// Those that count.
    pub(super) const DEFAULT: Self = Self { screen: SCREEN_LEVEL, confirm: CONFIRM_LEVEL };
}
