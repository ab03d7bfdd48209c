//! Suspect on a few samples, confirm on many: the plan that every test in stages follows.
//!
//! A first stage tests at [`STAGE_LEVEL`](super::level::STAGE_LEVEL). What it rejects is tested again on fresh samples, 4 and
//! then 16 times as many, or fewer where less confirms an effect as large as the first stage saw; only what all three
//! reject fails. How large a fresh stage is changes nothing of its level. A single test at the same overall level
//! would rest on tails of 10⁻⁹, where the central limit theorem is wrong by factors of thousands for
//! the skewed sums that renderers make; a product of three moderate tails stays right, and a correct
//! core pays for the first stage only.
//!
//! Not here: what a stage tests (`test`, `image`).

use super::{Hypothesis, TestKind};
use crate::math::rng::Seed;
use crate::text::spoken;

/// How many times the samples that would just show what the first stage saw confirm it: an effect
/// seen 2 standard errors too far out is still confirmed.
const MARGIN: f64 = 2.0;

spoken! {
    /// A step of a test. Each has its own random numbers.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stage {
        /// Measures the noise, decides nothing.
        Pilot = "pilot",
        /// Suspects.
        First = "stage 1",
        /// Confirms on at most 4 times the samples.
        Second = "stage 2",
        /// Confirms on at most 16 times the samples.
        Third = "stage 3",
    }
}

impl Stage {
    /// The stages that decide, in their order.
    pub(crate) const DECIDING: [Self; 3] = [Self::First, Self::Second, Self::Third];

    /// The most samples for each sample of the first stage.
    pub(crate) const fn factor(self) -> u64 {
        match self {
            Self::Second => 4,
            Self::Third => 16,
            _ => 1,
        }
    }

    /// Its place among those that decide.
    pub(in crate::stats) fn index(self) -> usize {
        Self::DECIDING.iter().position(|stage| *stage == self).unwrap_or(0)
    }

    /// The seed of this stage below the seed of its check.
    pub(crate) fn seed(self, check: Seed) -> Seed {
        check.child(self)
    }
}

/// What one stage found.
pub trait Scored {
    /// Whether it rejects.
    fn rejects(&self) -> bool;

    /// How many it drew.
    fn samples(&self) -> u64;

    /// How many times fewer samples would just have shown what it saw.
    fn excess(&self) -> f64;
}

/// The stages of one test that were drawn, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Escalation<S>(Vec<S>);

impl<S> Default for Escalation<S> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<S> std::ops::Deref for Escalation<S> {
    type Target = [S];

    fn deref(&self) -> &[S] {
        &self.0
    }
}

impl<S: Scored> Escalation<S> {
    /// The stage to be drawn: the first, or the next after one that rejects. None when all is said.
    pub(crate) fn next(&self) -> Option<Stage> {
        let goes_on = self.0.last().is_none_or(Scored::rejects);
        Stage::DECIDING.get(self.0.len()).copied().filter(|_| goes_on)
    }

    /// Takes in the stage that was to be drawn.
    pub(crate) fn push(&mut self, score: S) {
        self.0.push(score);
    }

    /// On how many samples `stage` confirms what the first one saw.
    pub(crate) fn confirming(&self, stage: Stage) -> f64 {
        let of = |first: &S| {
            let factor = (MARGIN / first.excess()).min(stage.factor() as f64);
            factor * first.samples() as f64
        };
        self.0.first().map_or(0.0, of)
    }

    /// The stage of the most samples, the last of equals: it knows best by how much. Where it is the
    /// first, that was so far out that having been chosen by it says nothing.
    pub(crate) fn largest(&self) -> Option<&S> {
        self.0.iter().max_by_key(|score| score.samples())
    }

    /// Whether the first stage rejects, so that there has to be a second.
    pub(crate) fn suspects(&self) -> bool {
        self.0.first().is_some_and(Scored::rejects)
    }

    pub(crate) fn rejects(&self) -> bool {
        self.0.len() == Stage::DECIDING.len() && self.0.iter().all(Scored::rejects)
    }

    /// What the ledger enters.
    pub(crate) fn hypothesis(&self, kind: TestKind) -> Hypothesis {
        Hypothesis::new(kind, self.suspects())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Scored for bool {
        fn rejects(&self) -> bool {
            *self
        }

        fn samples(&self) -> u64 {
            100
        }

        fn excess(&self) -> f64 {
            1.0
        }
    }

    /// A stage that rejects: its samples, and its excess.
    impl Scored for (u64, f64) {
        fn rejects(&self) -> bool {
            true
        }

        fn samples(&self) -> u64 {
            self.0
        }

        fn excess(&self) -> f64 {
            self.1
        }
    }

    #[test]
    fn what_is_seen_far_out_is_confirmed_on_fewer_samples() {
        let confirmed = |excess| {
            let stages = Escalation(vec![(1000, excess)]);
            [Stage::Second, Stage::Third].map(|stage| stages.confirming(stage))
        };
        assert_eq!(confirmed(0.1), [4000.0, 16_000.0]);
        assert_eq!(confirmed(1.0), [2000.0, 2000.0]);
        assert_eq!(confirmed(400.0), [5.0, 5.0]);
        assert_eq!(Escalation(vec![(9, 1.0), (7, 1.0)]).largest(), Some(&(9, 1.0)));
    }

    fn after(scores: &[bool]) -> Escalation<bool> {
        let mut stages = Escalation::default();
        for score in scores {
            assert!(stages.next().is_some());
            stages.push(*score);
        }
        stages
    }

    #[test]
    fn a_stage_follows_one_that_rejects_and_three_are_enough() {
        assert_eq!(after(&[]).next(), Some(Stage::First));
        assert_eq!(after(&[true]).next(), Some(Stage::Second));
        assert_eq!(after(&[true, true]).next(), Some(Stage::Third));
        for ended in [&[false][..], &[true, false], &[true, true, true]] {
            assert_eq!(after(ended).next(), None);
        }
    }

    #[test]
    fn only_three_rejections_reject() {
        assert!(after(&[true, true, true]).rejects());
        for cleared in [&[][..], &[true], &[true, true], &[true, true, false]] {
            assert!(!after(cleared).rejects());
        }
        assert!(after(&[true, false]).suspects() && !after(&[false]).suspects());
    }

    #[test]
    fn the_names_of_stages_are_part_of_their_seeds() {
        let seed = Seed(5);
        assert_eq!(Stage::Pilot.seed(seed), seed.child("pilot"));
        assert_eq!(
            Stage::DECIDING.map(|s| s.seed(seed)),
            [1, 2, 3].map(|n| seed.child(format!("stage {n}")))
        );
    }
}
