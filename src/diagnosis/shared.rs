//! What the failures of a difference have in common, and what passes has not: where there is no cause yet, it says where to
//! look. `all 4 failures are with Russian roulette, and 1 of 63 cases that pass`
//!
//! One circumstance, or two at once, that all failures share. That they share it by chance has a probability: of the ways in
//! which as many cases may fail, the share in which they all have it. It is told where that is small for all that were tried.

use super::Observation;
use crate::contract::Circumstances;

/// The probability that some circumstance is shared by chance.
const BY_CHANCE: f64 = 0.01;
/// Of the cases that pass, those with it too, where it still says where the core is wrong.
const FEW: usize = 10;

/// What failures share.
#[derive(Debug, PartialEq)]
pub(super) struct Shared {
    circumstances: Circumstances,
    failing: usize,
    /// Cases that pass, and those of them with it.
    passing: [usize; 2],
}

impl Shared {
    /// Of failures, where others pass.
    pub(super) fn of<'o, 'a: 'o>(
        failing: impl Iterator<Item = &'o Observation<'a>>,
        passing: impl Iterator<Item = &'o Observation<'a>>,
    ) -> Option<Self> {
        let of = |seen: &Observation<'_>| seen.circumstances;
        let failing: Vec<_> = failing.map(of).filter(|of| !of.is_empty()).collect();
        let passing: Vec<_> = passing.map(of).filter(|of| !of.is_empty()).collect();
        let all = failing.iter().copied().reduce(|all, of| all & of)?;
        let singles: Vec<_> = all.iter().collect();
        let later = |place: usize| singles[place + 1..].iter();
        let pairs = singles
            .iter()
            .enumerate()
            .flat_map(|(place, one)| later(place).map(move |other| *one | *other));
        let tried: Vec<_> = singles.iter().copied().chain(pairs).collect();
        let with = |these: Circumstances| passing.iter().filter(|of| of.contains(these)).count();
        let chance = |these: &Circumstances| {
            let there = failing.len() + with(*these);
            let cases = failing.len() + passing.len();
            (0..failing.len())
                .map(|drawn| (there - drawn) as f64 / (cases - drawn) as f64)
                .product::<f64>()
        };
        // Of two that say as much, the first: one comes before two.
        let best = tried.iter().copied().min_by(|a, b| chance(a).total_cmp(&chance(b)))?;
        let is_told = chance(&best) * tried.len() as f64 <= BY_CHANCE;
        is_told.then(|| Self {
            circumstances: best,
            failing: failing.len(),
            passing: [passing.len(), with(best)],
        })
    }

    /// `several samples a light and mesh lights`.
    fn words(&self) -> String {
        let words: Vec<_> = self.circumstances.iter().map(Circumstances::word).collect();
        words.join(" and ")
    }

    /// What it adds to where the core differs; none where much that passes has it too.
    pub(super) fn place(&self) -> Option<String> {
        let [passing, with] = self.passing;
        (with * FEW <= passing).then(|| format!("with {}", self.words()))
    }

    /// `all 4 failures are with several lights, and 2 of 63 cases that pass`.
    pub(super) fn in_words(&self) -> String {
        let [passing, with] = self.passing;
        let (failing, words) = (self.failing, self.words());
        format!("all {failing} failures are with {words}, and {with} of {passing} cases that pass")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::testing::{Made, failing, passing};

    const ROULETTE: Circumstances = Circumstances::ROULETTE;
    const LIGHTS: Circumstances = Circumstances::SEVERAL_LIGHTS;
    const MESH: Circumstances = Circumstances::MESH_LIGHT;

    fn shared(failures: &[Circumstances], passed: &[Circumstances]) -> Option<String> {
        let cases = |prefix: &'static str, of: &[Circumstances]| {
            let named = |(number, under): (usize, &Circumstances)| {
                (format!("light/{prefix}{number}"), *under)
            };
            of.iter().enumerate().map(named).collect::<Vec<_>>()
        };
        let mut made = Made::new();
        for (case, under) in cases("a", failures) {
            made = made.with(&case[..], failing("x")).under(&case, under);
        }
        for (case, under) in cases("b", passed) {
            made = made.with(&case[..], passing()).under(&case, under);
        }
        let evidence = made.evidence();
        Shared::of(evidence.failures(), evidence.passed())?.place()
    }

    #[test]
    fn what_all_failures_have_and_little_that_passes_is_told() {
        let passed = [MESH; 30];
        assert_eq!(
            shared(&[ROULETTE | MESH; 2], &passed).as_deref(),
            Some("with Russian roulette")
        );
        let both = [[ROULETTE | LIGHTS; 3], [ROULETTE | LIGHTS | MESH; 3]].concat();
        let passed = [[ROULETTE; 20], [LIGHTS; 20]].concat();
        let words = shared(&both, &passed);
        assert_eq!(words.as_deref(), Some("with several lights and Russian roulette"));
    }

    #[test]
    fn what_may_be_chance_is_not_told() {
        assert_eq!(shared(&[ROULETTE | MESH], &[MESH; 30]), None, "one failure shares all it has");
        assert_eq!(shared(&[ROULETTE, MESH], &[MESH; 30]), None, "nothing is shared");
        assert_eq!(shared(&[MESH; 4], &[MESH; 30]), None, "what passes has it too");
        assert_eq!(shared(&[], &[MESH; 30]), None);
    }
}
