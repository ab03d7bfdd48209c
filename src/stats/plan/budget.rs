//! How small an error has to be seen, and what it may cost. The one place that says what a budget
//! means.

use crate::text::{all_of, hint, spoken};
use serde::{Deserialize, Serialize};

/// What a claim is worth: the error it promises to catch, and the samples it may spend on that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The relative error that must be seen: a claim passes only if this would have been caught
    /// with probability 0.999.
    pub(crate) detects: f64,
    /// The most samples of the first stage, over all its runs.
    pub(crate) most_samples: u64,
    /// Independent runs of the core in each stage: the units of replication, at least 32.
    pub(crate) runs: u32,
    /// The samples of a run come in multiples of this (the pixels of a film, say).
    pub(crate) grain: u64,
    /// Whether means are tested for gross errors before they are tested for `detects`: what fails
    /// there is known soon, and less precisely.
    pub(crate) coarse_first: bool,
    /// Whether nobody is judged by it any more: a mean that is grossly too low is confirmed on fewer samples, which may miss
    /// what happens once in 30 000.
    pub(crate) in_a_hurry: bool,
}

impl Effort {
    /// Errors beyond this are gross: nobody who stops at the first failure wants to know them better.
    const GROSS: f64 = 0.25;
    /// Fewer runs leave the standard error itself uncertain by more than 13 %.
    pub(crate) const FEWEST_RUNS: u32 = 32;

    /// The effort that sees an error of `detects`, relative to the scale of the claim.
    pub(crate) fn new(detects: f64) -> Self {
        let (coarse_first, in_a_hurry) = (false, false);
        Self { detects, most_samples: 4_000_000, runs: 64, grain: 1, coarse_first, in_a_hurry }
    }

    /// The same where something of the trial has failed already.
    pub(crate) fn beside_a_failure(self) -> Self {
        Self { in_a_hurry: true, ..self }
    }

    /// The effort that sees gross errors alone, if those are to be looked for first.
    pub(in crate::stats) fn coarse(self) -> Option<Self> {
        let worthwhile = self.coarse_first && 2.0 * self.detects <= Self::GROSS;
        worthwhile.then_some(Self { detects: Self::GROSS, ..self })
    }

    pub(crate) fn with_most_samples(self, most_samples: u64) -> Self {
        Self { most_samples, ..self }
    }

    /// The same with another number of runs a stage; never fewer than [`Effort::FEWEST_RUNS`].
    pub(crate) fn with_runs(self, runs: u32) -> Self {
        Self { runs: runs.max(Self::FEWEST_RUNS), ..self }
    }

    pub(crate) fn in_steps_of(self, grain: u64) -> Self {
        Self { grain: grain.max(1), ..self }
    }
}

/// What a trial may spend: a budget, and whether its first failure ends it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allowance {
    pub(crate) budget: Budget,
    /// Whether one failure is enough: `--fail-fast`.
    pub(crate) stops_at_failure: bool,
    /// Whether a first look is enough: errors are seen that are as many times larger as a quick run's are than the default's.
    pub(crate) looks_roughly: bool,
    /// Whether a failure is enough as it is: nothing is asked that only tells why.
    pub(crate) judges_alone: bool,
    /// Whether of an image its first run is enough, which judges nothing: it tells whether something has changed it.
    pub(crate) only_glances: bool,
    /// The budget that tells how many samples a pixel has, where it is another: a sum that is not divided by their number
    /// is as bright as they are many.
    pub(crate) of_a_pixel: Option<Budget>,
}

impl Allowance {
    pub(crate) fn scale(self, effort: Effort) -> Effort {
        let Effort { detects, most_samples, .. } = effort;
        Effort {
            detects: detects * self.coarseness(),
            most_samples: self.samples(most_samples),
            coarse_first: self.stops_at_failure,
            in_a_hurry: self.stops_at_failure || self.judges_alone,
            ..effort
        }
    }

    /// What a number of samples meant for the default budget becomes under this one.
    pub(crate) fn samples(self, default: u64) -> u64 {
        (default as f64 / self.coarseness().powi(2)).ceil() as u64
    }

    /// The same of the samples of a pixel.
    pub(crate) fn samples_of_a_pixel(self, default: u32) -> u32 {
        let samples = self.of_a_pixel.map_or(self, Self::from).samples(u64::from(default));
        samples.try_into().unwrap_or(u32::MAX)
    }

    /// By how much the smallest error that must be seen is multiplied.
    pub(crate) const fn coarseness(self) -> f64 {
        let look = if self.looks_roughly { Budget::Quick.coarseness() } else { 1.0 };
        self.budget.coarseness() * look
    }
}

impl From<Budget> for Allowance {
    fn from(budget: Budget) -> Self {
        Self { budget, ..Self::default() }
    }
}

spoken! {
    /// How thorough a run of the suite is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Budget {
        /// While you work: errors of 5 % where the default sees 2 %.
        Quick = "quick",
        /// What a case promises.
        #[default]
        Default = "default",
        /// For a release: errors of 0.5 % where the default sees 2 %.
        Strict = "strict",
    }
}

impl Budget {
    /// By how much the smallest error that must be seen is multiplied.
    pub(crate) const fn coarseness(self) -> f64 {
        match self {
            Budget::Quick => 2.5,
            Budget::Default => 1.0,
            Budget::Strict => 0.25,
        }
    }
}

impl std::str::FromStr for Budget {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let budgets = [Budget::Quick, Budget::Default, Budget::Strict];
        budgets.into_iter().find(|budget| budget.to_string() == word).ok_or_else(|| {
            let names = budgets.map(|budget| budget.to_string());
            let names = || names.iter().map(String::as_str);
            let hint = hint(word, names(), || all_of(names()));
            format!("there is no budget `{word}`\nhint: {hint}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_budgets_see_five_two_and_half_a_per_cent() {
        let sees = |budget: Budget| Allowance::from(budget).scale(Effort::new(0.02)).detects;
        assert!((sees(Budget::Quick) - 0.05).abs() < 1e-15);
        assert!((sees(Budget::Default) - 0.02).abs() < 1e-15);
        assert!((sees(Budget::Strict) - 0.005).abs() < 1e-15);
    }

    #[test]
    fn a_quarter_of_the_error_costs_sixteen_times_the_samples() {
        let samples = |allowance: Allowance| allowance.samples(1000);
        assert_eq!(samples(Budget::Strict.into()), 16_000);
        assert_eq!(samples(Budget::Quick.into()), 160);
        let roughly = Allowance { looks_roughly: true, ..Allowance::default() };
        assert_eq!(samples(roughly), 160);
    }

    #[test]
    fn a_first_look_can_have_the_samples_of_the_core() {
        let roughly = Allowance { looks_roughly: true, ..Budget::Quick.into() };
        assert_eq!(roughly.samples_of_a_pixel(1000), 26);
        let as_the_core = Allowance { of_a_pixel: Some(Budget::Default), ..roughly };
        assert_eq!(as_the_core.samples_of_a_pixel(1000), 1000);
    }

    #[test]
    fn nobody_can_ask_for_too_few_runs() {
        assert_eq!(Effort::new(0.02).with_runs(4).runs, Effort::FEWEST_RUNS);
    }
}
