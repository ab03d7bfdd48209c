//! Causes put to the proof: the bench's own core with the suspected mistake planted in it is asked the same, and has to
//! come to the same numbers.
//!
//! What it contradicts is not told; what no rule recognises, and one planted mistake reproduces, is told by its name.

mod asking;
mod composition;
mod doubts;
mod likeness;
mod search;
mod siblings;

use self::asking::{is_of_one_part, likenesses, quickest};
use super::rank::Ranked;
use super::{Degree, Evidence, Headline, Suspicion, look_without};
use crate::cause::Cause;
use crate::checks::Finding;
use crate::contract::Components;
use std::collections::BTreeSet;

/// Cases in which a suspicion is put to the proof, the quickest of those that it explains.
const CASES: usize = 4;
/// Rounds in which what is contradicted makes room for the next suspicion.
const ROUNDS: usize = 6;
/// Searches for what has no name, each beside what the last has found.
const SEARCHES: usize = 3;

/// A mistake that the bench can plant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mistake {
    pub(crate) name: &'static str,
    pub(crate) cause: &'static Cause,
    /// What of a path tracer it is made in.
    pub(crate) components: Components,
    /// The case that fails by it.
    pub(crate) caught_by: &'static str,
}

/// Mistakes that are on together, and what they are asked.
#[derive(Clone, Debug)]
pub(crate) struct Question<'a> {
    pub(crate) mistakes: Vec<Mistake>,
    pub(crate) case: &'a str,
    /// What is the bench's own, without any mistake.
    pub(crate) with: Components,
    /// Whether a first look is enough: more noise, for less.
    pub(crate) roughly: bool,
}

/// The bench's own core with mistakes planted in it.
pub(crate) trait Planted {
    /// All there are.
    fn mistakes(&self) -> &[Mistake];

    /// Whether a first look sees what a case fails by.
    fn is_seen_roughly(&self, _case: &str) -> bool {
        false
    }

    /// Whether one core can make them all.
    fn may_be_together(&self, _mistakes: &[Mistake]) -> bool {
        true
    }

    /// What it took to answer a question, in the work of a ray (`contract::Work`); 0 if it was not asked.
    fn price(&self, _question: &Question<'_>) -> u64 {
        0
    }

    /// Keeps as much time for each of so many others as for what is asked next.
    fn keep_for(&self, _others: usize) {}

    /// What comes of each question; nothing where the mistakes exclude each other, or time is up.
    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>>;
}

/// Causes that a case contradicts.
pub(super) type Refuted = BTreeSet<(&'static str, String)>;

/// What transplants have shown of where mistakes are made.
#[derive(Clone, Copy, Debug)]
pub(super) enum MadeIn {
    /// In these: with the bench's own, what failed passes.
    Mended(Components),
    /// In these, by other failures; for these the time was too short.
    Likely(Components),
    Unknown,
}

impl MadeIn {
    fn may_be(self, components: Components) -> bool {
        match self {
            Self::Mended(broken) | Self::Likely(broken) => components.intersects(broken),
            Self::Unknown => true,
        }
    }

    /// Whether what mends the failures is not made of any of these, so that mistakes of theirs stay.
    fn leaves(self, components: Components) -> bool {
        let highest = |these: Components| these.bits().checked_ilog2();
        let lowest = components.bits().trailing_zeros();
        matches!(self, Self::Mended(broken) if highest(broken).is_some_and(|highest| lowest > highest))
    }
}

/// The headlines of `evidence` that planted mistakes do not contradict, and those that they add.
pub(super) fn proven(evidence: &Evidence<'_>, planted: &dyn Planted, made_in: MadeIn) -> Ranked {
    Sifted::of(evidence, planted, made_in).and_searched()
}

/// The same without causes that nothing takes where all that is named is planted together, and where NaN, infinite and
/// negative numbers that it gives follow from it, whatever component each mistake is made in, and what is named is told of
/// every place that it is made in. What is lost in the dark only looks like its cause.
pub(super) fn without_what_follows(
    mut told: Ranked,
    evidence: &Evidence<'_>,
    planted: &dyn Planted,
) -> Ranked {
    let proof = Proof { evidence, planted, made_in: MadeIn::Unknown };
    for _ in 0..ROUNDS {
        let Some(cause) = proof.needless(&told) else { break };
        told.leave_to_others(&cause);
    }
    let following = proof.symptoms_given_by_all(&told);
    told.follow(&following);
    for (cause, cases) in proof.made_again(&told) {
        told.explain(cause, &cases);
    }
    // One darkness may go through several components.
    let lost = told.with_cause().filter(|one| is_lost(one, &told, &proof));
    let lost: Vec<_> = lost.map(|one| one.cause.clone()).collect();
    told.doubt(|headline| lost.contains(&headline.cause));
    told
}

/// Whether a cause is lost in a darkness that follows from nothing else that is named.
fn is_lost(headline: &Headline, told: &Ranked, proof: &Proof<'_>) -> bool {
    let named = told.with_cause().filter(|one| one.degree == Degree::Named);
    let others: Vec<_> = named.filter(|one| one.cause != headline.cause).collect();
    let follows = |case: &str| others.iter().any(|one| one.may_follow.iter().any(|it| it == case));
    let unexplained = proof.evidence.failures().map(|seen| seen.case);
    let unexplained: Vec<_> = unexplained.filter(|case| !follows(case)).collect();
    let evidence = proof.evidence.with_failures_of(&unexplained);
    let proof = Proof { evidence: &evidence, ..*proof };
    proof.lost_among_the_dark(told).iter().any(|(cause, _)| *cause == headline.cause)
}

/// What rules suspect, put to the proof. It takes little time; the search for what no rule knows takes much.
pub(super) struct Sifted<'a> {
    proof: Proof<'a>,
    refuted: Refuted,
    ranked: Ranked,
    confirmed: Vec<Suspicion>,
}

impl<'a> Sifted<'a> {
    pub(super) fn of(
        evidence: &'a Evidence<'a>,
        planted: &'a dyn Planted,
        made_in: MadeIn,
    ) -> Self {
        let proof = Proof { evidence, planted, made_in };
        let (mut refuted, ranked) = proof.uncontradicted();
        let mut confirmed = proof.confirmed(&ranked, &refuted);
        let look = |refuted: &Refuted, confirmed: &[Suspicion]| {
            look_without(evidence, refuted, confirmed.to_vec())
        };
        let ranked = look(&refuted, &confirmed);
        confirmed.extend(ranked.with_cause().flat_map(|told| proof.rivals(told, &ranked)));
        let ranked = look(&refuted, &confirmed);
        refuted.extend(proof.not_following(&ranked));
        let ranked = look(&refuted, &confirmed);
        Self { proof, refuted, ranked, confirmed }
    }

    /// Asks what the end asks of the darkness that was seen at `first`: the search may take all the time, and what was asked
    /// before is known.
    pub(super) fn asking_of_darkness(self, first: &Evidence<'_>) -> Self {
        let planted = self.proof.planted;
        let proof = Proof { evidence: first, planted, made_in: MadeIn::Unknown };
        proof.lost_among_the_dark(&self.ranked);
        self
    }

    /// The same with the mistakes that reproduce what has no name.
    pub(super) fn and_searched(self) -> Ranked {
        let Self { proof, mut refuted, mut ranked, confirmed: mut found } = self;
        let suspected: BTreeSet<_> = ranked.with_cause().map(|told| told.cause.clone()).collect();
        // What is found explains some of it, and of the rest the next may be found.
        for _ in 0..SEARCHES {
            let is_known = |one: &Suspicion| {
                let known = found.iter().filter(|other| other.cause.name == one.cause.name);
                let known: Vec<_> = known.flat_map(|other| &other.cases).collect();
                one.cases.iter().all(|case| known.contains(&case))
            };
            let given = proof.given_by_all(&ranked);
            let of_all = proof.of_all(&proof.named(&ranked), &proof.quickest(&given));
            let searched = proof.reproduced(&ranked, &given).into_iter().chain(of_all);
            let new: Vec<_> = searched.filter(|one| !is_known(one)).collect();
            if new.is_empty() {
                break;
            }
            found.extend(new);
            ranked = look_without(proof.evidence, &refuted, found.clone());
        }
        found.extend(proof.informed(&ranked));
        let mut told = proof.doubted(&refuted, &found);
        // What the search has found has to stand beside the rest as well, and so has what is doubted.
        for _ in 0..ROUNDS {
            let unfounded = proof.unfounded(&told, &suspected);
            if unfounded.is_empty() {
                break;
            }
            found.retain(|one| !unfounded.iter().any(|(cause, _)| *cause == one.cause.name));
            refuted.extend(unfounded);
            told = proof.doubted(&refuted, &found);
        }
        let apart = proof.not_following(&told);
        if !apart.is_subset(&refuted) {
            refuted.extend(apart);
            told = proof.doubted(&refuted, &found);
        }
        let following = proof.given_by_all(&told);
        told.follow(&following);
        told
    }
}

#[derive(Clone, Copy)]
struct Proof<'a> {
    evidence: &'a Evidence<'a>,
    planted: &'a dyn Planted,
    made_in: MadeIn,
}

#[cfg(test)]
mod tests;
