//! Causes put to the proof: the bench's own core with the suspected mistake planted in it is asked the same, and has to
//! come to the same numbers.
//!
//! What it contradicts is not told; what no rule recognises, and one planted mistake reproduces, is told by its name.

mod composition;
mod likeness;
mod siblings;

use self::composition::Seen;
use self::likeness::{Likeness, by_chance, likeness};
use super::rank::Ranked;
use super::{Degree, Evidence, Headline, Observation, Suspicion, look_without};
use crate::case::Subject;
use crate::cause::{self, Cause, bvh};
use crate::checks::Finding;
use crate::contract::Components;
use std::collections::{BTreeMap, BTreeSet};
use std::{ptr, slice};

/// Cases in which a suspicion is put to the proof, the quickest of those that it explains.
const CASES: usize = 4;
/// Cases of it that may contradict it one by one: what it does not explain may be another mistake of the same lines.
const CONTRADICTING: usize = 16;
/// Of cases that ask the bench's own core for more, few are tried: a second of a processor, about (`contract::Work`).
const COSTLY: u64 = 15_000_000;
/// Rounds in which what is contradicted makes room for the next suspicion.
const ROUNDS: usize = 6;
/// Searches for what has no name, each beside what the last has found.
const SEARCHES: usize = 3;
/// Mistakes of which pairs are tried.
const PAIRED: usize = 8;
/// Sets of several mistakes that are tried, and the cases that they have to reproduce.
const FORETOLD: usize = 12;
const PROVING: usize = 8;
/// Fewer sets of mistakes may come to the same numbers by chance, where one of them is named.
const BY_CHANCE: f64 = 0.1;

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

struct Proof<'a> {
    evidence: &'a Evidence<'a>,
    planted: &'a dyn Planted,
    made_in: MadeIn,
}

impl<'a> Proof<'a> {
    /// What is told after everything that is contradicted has made room for the next suspicion.
    fn uncontradicted(&self) -> (Refuted, Ranked) {
        // What takes the least time is asked first.
        let doubts: [fn(&Self, &Ranked) -> Refuted; 5] = [
            Self::contradicted,
            Self::following,
            Self::superfluous,
            Self::lost_in_the_dark,
            Self::outnumbered,
        ];
        let mut refuted = Refuted::new();
        let mut ranked = look_without(self.evidence, &refuted, Vec::new());
        for _ in 0..ROUNDS {
            let mut against = doubts.iter().map(|doubt| doubt(self, &ranked));
            match against.find(|against| !against.is_empty()) {
                Some(against) if !against.is_subset(&refuted) => refuted.extend(against),
                _ => break,
            }
            ranked = look_without(self.evidence, &refuted, Vec::new());
        }
        (refuted, ranked)
    }

    /// What is told of all but the refuted, and looks like it only where its mistakes leave a doubt.
    fn doubted(&self, refuted: &Refuted, found: &[Suspicion]) -> Ranked {
        let mut told = look_without(self.evidence, refuted, found.to_vec());
        let is_against = |one: &&Headline| {
            self.is_outnumbered(one, &told)
                || self.is_built_on_what_is_wrong(one, &told)
                || self.passes_its_own(one) && !self.is_needed(one)
        };
        let against: BTreeSet<_> =
            told.with_cause().filter(is_against).map(|one| one.cause.clone()).collect();
        let causes: BTreeSet<_> = found.iter().map(|suspicion| suspicion.cause.name).collect();
        let is_alone = |one: &&Headline| self.is_the_only_one_in_sight(one, &told);
        let alone: BTreeSet<_> =
            told.with_cause().filter(is_alone).map(|one| one.cause.clone()).collect();
        told.assure(|headline| alone.contains(&headline.cause));
        told.doubt(|headline| {
            let is_proven = causes.contains(&headline.cause[..])
                || alone.contains(&headline.cause)
                || self.is_needed(headline);
            let is_unsure = || self.is_dark_alone(headline) || self.is_of_another_size(headline);
            let is_doubtful = self.is_made_elsewhere(headline) || against.contains(&headline.cause);
            is_doubtful || !is_proven && is_unsure()
        });
        // Patterns of which each explains other cases contradict each other.
        told.as_one(&bvh::HITS_LOST, |headline| {
            let loses_hits = cause::find(&headline.cause).is_some_and(cause::loses_hits);
            loses_hits && !causes.contains(&headline.cause[..])
        });
        told
    }

    /// What says too little beside the other cases of its part; of what rules suspected, less is asked.
    fn unfounded(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let mut unfounded = self.outnumbered(told);
        unfounded.extend(self.superfluous(told));
        let unproven = self.unproven_beside(told).into_iter();
        unfounded.extend(unproven.filter(|(cause, _)| !suspected.contains(*cause)));
        unfounded.extend(self.lost_in_a_crowd(told));
        unfounded.extend(self.dark_and_not_alone(told, suspected));
        unfounded.extend(self.dim_among_the_dark(told, suspected));
        unfounded.extend(self.unlike_in_their_own(told));
        unfounded.extend(self.following(told));
        unfounded
    }

    /// The cases of each headline that contradict its cause, planted alone and beside all others that are told.
    fn contradicted(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().collect();
        let all: Vec<_> = told.iter().filter_map(|headline| self.likeliest(headline)).collect();
        told.iter().flat_map(|headline| self.contradicting(headline, &all)).collect()
    }

    fn contradicting(&self, headline: &Headline, all: &[Mistake]) -> Refuted {
        let Some(cause) = cause::find(&headline.cause) else { return Refuted::new() };
        let planted: Components = self.of(headline).map(|mistake| mistake.components).collect();
        let made = if cause::is_of_the_film_alone(cause) { Components::PIXEL } else { planted };
        if !made.is_empty() && self.made_in.leaves(made) {
            return refuted(cause, &headline.explains);
        }
        let explained = headline.explains.iter().filter_map(|case| self.evidence.failure_of(case));
        let cases = quickest(explained, CONTRADICTING);
        let alone: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
        let mut against = self.other_than(&alone, &cases);
        if all.len() > 1 {
            against = self.other_than(&[all.to_vec()], &against);
        }
        // What every case that was tried contradicts is not the cause of those that were not.
        if !against.is_empty() && against.len() == cases.len() {
            return refuted(cause, &headline.explains);
        }
        against.into_iter().map(|seen| (cause.name, seen.case.to_owned())).collect()
    }

    /// Cases that the core fails otherwise than each of these sets of mistakes would.
    fn other_than<'s>(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&'s Observation<'a>],
    ) -> Vec<&'s Observation<'a>> {
        let answers = likenesses(cases, &self.weighed(sets, cases));
        let is_other = |number: usize| {
            let of_sets = || answers.iter().map(|of_set| of_set[number]);
            of_sets().any(|likeness| likeness == Likeness::Other)
                && of_sets().all(|l| matches!(l, Likeness::Other | Likeness::Unknown))
        };
        (0..cases.len()).filter(|number| is_other(*number)).map(|number| cases[number]).collect()
    }

    /// Causes whose cases another one's mistake reproduces too, and that reproduce not all of that one's: one mistake is
    /// all there is, unless a check has seen that it takes both.
    fn following(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().collect();
        let reproduces = |one: &Headline, of: &Headline| {
            self.of(one).any(|mistake| self.is_reproduced(mistake, of))
        };
        let follows = |other: &&&Headline| {
            let others = told.iter().filter(|one| one.cause != other.cause);
            let mut of_both = others.filter(|one| reproduces(one, one) && reproduces(one, other));
            of_both.any(|one| !reproduces(other, one))
        };
        let following = told.iter().filter(follows).filter(|told| !self.is_needed(told));
        following.copied().filter_map(all_of).flatten().collect()
    }

    /// A cause whose numbers all others that are told give together: nothing takes it. Of several the one that explains the
    /// least.
    fn superfluous(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().collect();
        // That all others leave it dark where it is dark is enough here: they are told already.
        let is_superfluous = |one: &&&Headline| {
            let others = told.iter().filter(|other| other.cause != one.cause);
            let others: Vec<_> = others.filter_map(|other| self.likeliest(other)).collect();
            let cases = self.quickest(&one.explains);
            let is_given = || {
                self.compare(slice::from_ref(&others), &cases)[0]
                    .iter()
                    .all(|of| of.is_reproduced())
            };
            !others.is_empty() && !cases.is_empty() && !self.is_needed(one) && is_given()
        };
        let least = told.iter().filter(is_superfluous).min_by_key(|one| one.explains.len());
        least.copied().and_then(all_of).unwrap_or_default()
    }

    /// Causes that speak from answers of 0 or NaN alone, in a part where as much else is 0 or NaN that is right with their
    /// mistake, or among twice as much in all parts: one mistake is all there is.
    fn lost_in_the_dark(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().collect();
        let explains = |one: &Headline, seen: &Observation<'_>| {
            one.explains.iter().any(|case| case == seen.case)
        };
        let dark: Vec<_> = self.evidence.failures().filter(|seen| seen.is_dark()).collect();
        let is_free = |seen: &&&Observation<'_>| !told.iter().any(|one| explains(one, seen));
        let free: Vec<_> = dark.iter().filter(is_free).map(|seen| seen.case.to_owned()).collect();
        let is_lost = |one: &&&Headline| {
            let own = dark.iter().filter(|seen| explains(one, seen)).count();
            let of_part: Vec<_> =
                free.iter().filter(|case| is_of_one_part(one, case)).cloned().collect();
            let is_lost_in = |others: &[String], least: usize| {
                others.len() >= least && self.are_right(one, others)
            };
            own == one.explains.len()
                && (is_lost_in(&of_part, own) || is_lost_in(&free, siblings::OUTNUMBERED * own))
        };
        told.iter().filter(is_lost).copied().filter_map(all_of).flatten().collect()
    }

    /// Whether the mistakes of `headline` leave right what was tried of `cases`.
    fn are_right(&self, headline: &Headline, cases: &[String]) -> bool {
        let sets: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
        let answers = self.compare(&sets, &self.quickest(cases));
        let known = answers.iter().flatten().filter(|likeness| likeness.is_known());
        let mut likenesses = known.peekable();
        likenesses.peek().is_some() && likenesses.all(|likeness| *likeness == Likeness::Other)
    }

    /// Whether a check has recognised its cause beside others, answer by answer, which is more than counts can tell.
    fn is_needed(&self, headline: &Headline) -> bool {
        let seen =
            headline.explains.iter().filter_map(|case| self.evidence.failure_of(case)?.finding);
        let mut clues = seen.flat_map(|finding| &finding.clues);
        clues.any(|clue| clue.beside && clue.cause == headline.cause)
    }

    /// Whether one mistake gives the numbers of every case of `headline` that is tried.
    fn is_reproduced(&self, mistake: Mistake, headline: &Headline) -> bool {
        let cases = self.quickest(&headline.explains);
        !self.fitting(&[vec![mistake]], &cases).is_empty()
    }

    /// Whether its mistakes are planted in other components than those that mend the core.
    fn is_made_elsewhere(&self, headline: &Headline) -> bool {
        let mut mistakes = self.of(headline).peekable();
        matches!(self.made_in, MadeIn::Mended(_))
            && mistakes.peek().is_some()
            && mistakes.all(|mistake| !self.made_in.may_be(mistake.components))
    }

    /// Whether all that it explains is light of 0 or NaN, as many mistakes make it.
    fn is_dark_alone(&self, headline: &Headline) -> bool {
        let seen = headline.explains.iter().filter_map(|case| self.evidence.failure_of(case));
        let mut seen = seen.peekable();
        seen.peek().is_some() && seen.all(|seen| seen.is_about_light() && seen.is_dark())
    }

    /// What the search has found of darkness alone, and what is not the only one in sight.
    fn dark_and_not_alone(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let found = told.with_cause().filter(|one| !suspected.contains(&one.cause));
        let dark = found.filter(|one| self.is_dark_alone(one));
        let unsure = dark.filter(|one| !self.is_the_only_one_in_sight(one, told));
        unsure.filter_map(all_of).flatten().collect()
    }

    /// What the search has found of light that is too weak, where far more cases have none and its mistake leaves them right:
    /// whatever takes that light takes this, too.
    fn dim_among_the_dark(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let explained =
            |case: &str| told.with_cause().any(|one| one.explains.iter().any(|own| own == case));
        let dark = self.evidence.failures().filter(|seen| seen.is_about_light() && seen.is_dark());
        let dark = quickest(dark.filter(|seen| !explained(seen.case)), siblings::FAILED);
        let is_dim = |one: &Headline| {
            let mut seen = one.explains.iter().filter_map(|case| self.evidence.failure_of(case));
            seen.all(|seen| seen.is_about_light() && seen.is_too_weak())
        };
        let is_lost = |one: &&Headline| {
            let sets: Vec<_> = self.of(one).map(|mistake| vec![mistake]).collect();
            let answers = self.weighed(&sets, &dark);
            let right = (0..dark.len())
                .filter(|number| siblings::is_passed_by_all(&answers, *number))
                .count();
            right >= siblings::OUTNUMBERED * one.explains.len().max(1)
        };
        let found = told.with_cause().filter(|one| !suspected.contains(&one.cause));
        found.filter(|one| is_dim(one)).filter(is_lost).filter_map(all_of).flatten().collect()
    }

    /// Whether its mistakes are wrong in the same places, and nowhere by as much.
    fn is_of_another_size(&self, headline: &Headline) -> bool {
        let sets: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
        let cases = self.quickest(&headline.explains);
        let answers = self.compare(&sets, &cases);
        let of_case = |number: usize| answers.iter().map(move |of_set| of_set[number]);
        let is_same = |number: usize| of_case(number).any(|one| one == Likeness::Same);
        let is_unsized = |number: usize| of_case(number).any(|one| one == Likeness::Unsized);
        let mut known = (0..cases.len())
            .filter(|number| of_case(*number).any(Likeness::is_known) && !is_unsized(*number))
            .peekable();
        known.peek().is_some() && !known.any(is_same)
    }

    /// The causes whose mistake gives the same numbers, with that for evidence: in their own cases, for those that are named
    /// and those of which every rival is refuted, and in whatever else has no cause.
    fn confirmed(&self, ranked: &Ranked, refuted: &Refuted) -> Vec<Suspicion> {
        let is_rival = |headline: &Headline, case: &String, (cause, of): &(&str, String)| {
            of == case && *cause != headline.cause
        };
        let stands_alone = |headline: &Headline| {
            let mut cases = headline.explains.iter();
            cases.all(|case| refuted.iter().any(|other| is_rival(headline, case, other)))
        };
        let is_clear = |told: &Headline| told.degree == Degree::Named || stands_alone(told);
        let confirmed = |headline: &Headline| {
            let gives_own = |mistake: &Mistake| self.is_reproduced(*mistake, headline);
            let certain = self.of(headline).find(gives_own).filter(|_| is_clear(headline));
            let own = certain.map_or_else(Vec::new, |_| self.quickest(&headline.explains));
            let cases = [own, self.followers(headline, ranked)].concat();
            let mistake = certain.or_else(|| self.likeliest(headline))?;
            let likely = headline.degree.max(Degree::LooksLike);
            let degree = certain.map_or(likely, |_| Degree::Named);
            suspicions(&[mistake], &cases, degree).pop().filter(|_| !cases.is_empty())
        };
        ranked.with_cause().filter_map(confirmed).collect()
    }

    /// Mistakes that reproduce all that has no name yet and is not `given`; else what each headline without a name explains.
    fn reproduced(&self, ranked: &Ranked, given: &[String]) -> Vec<Suspicion> {
        let left = |told: &Headline| -> Vec<_> {
            told.explains.iter().filter(|case| !given.contains(case)).cloned().collect()
        };
        let groups: Vec<_> = ranked.unnamed().map(left).collect();
        let told: Vec<_> = ranked.with_cause().filter_map(|told| self.likeliest(told)).collect();
        let found = self.reproducing(&groups.concat(), &told);
        if !found.is_empty() || groups.len() < 2 {
            return found;
        }
        groups.iter().flat_map(|group| self.reproducing(group, &told)).collect()
    }

    /// What a case that only informs has recognised, where its mistake fails in the same places what has no name.
    fn informed(&self, ranked: &Ranked) -> Vec<Suspicion> {
        let causes: BTreeSet<_> = self.evidence.informed().map(|clue| &clue.cause[..]).collect();
        let is_informed = |mistake: &&Mistake| causes.contains(mistake.cause.name);
        let nameless = ranked.unnamed().flat_map(|told| &told.explains).cloned();
        let cases = self.quickest(&nameless.collect::<Vec<_>>());
        let alike = |mistake: &Mistake| {
            let answers = self.compare(&[vec![*mistake]], &cases).remove(0);
            let is_alike = |(_, of): &(_, Likeness)| matches!(of, Likeness::Same | Likeness::Alike);
            let alike: Vec<_> = cases.iter().zip(answers).filter(is_alike).collect();
            let cases: Vec<_> = alike.into_iter().map(|(seen, _)| *seen).collect();
            let found = suspicions(&[*mistake], &cases, Degree::LooksLike).pop()?;
            let recognised = "a case that only informs has recognised it, and ";
            let sentence = wrong_in_the_same_places(recognised, "", &found.cases.join(", "));
            (!cases.is_empty()).then(|| Suspicion { evidence: vec![sentence], ..found })
        };
        self.planted.mistakes().iter().filter(is_informed).filter_map(alike).collect()
    }

    /// Mistakes that reproduce what a cause explains, and failures of its part that its own do not.
    fn rivals(&self, headline: &Headline, ranked: &Ranked) -> Vec<Suspicion> {
        let of_part = ranked.without_cause(headline).filter(|case| is_of_one_part(headline, case));
        let beside =
            quickest(of_part.filter_map(|case| self.evidence.failure_of(case)), siblings::FAILED);
        let own = self.quickest(&headline.explains);
        if own.is_empty() || beside.is_empty() || self.is_needed(headline) {
            return Vec::new();
        }
        let others = self.in_sight().into_iter().filter(|one| one.cause.name != headline.cause);
        let others: Vec<_> = others.map(|mistake| vec![mistake]).collect();
        let fitting = kinds(self.fitting(&others, &own));
        let explaining_more = fitting.into_iter().filter_map(|set| {
            let answers = self.compare(slice::from_ref(set), &beside).remove(0).into_iter();
            let same = beside.iter().zip(answers).filter(|(_, of)| *of == Likeness::Same);
            let same: Vec<_> = same.map(|(seen, _)| *seen).collect();
            (!same.is_empty()).then(|| (set, [&own[..], &same].concat()))
        });
        let rivals: Vec<_> = explaining_more.collect();
        let found = rivals.iter().flat_map(|(set, cases)| {
            let degree = degree(rivals.len(), others.len(), cases);
            degree.map_or_else(Vec::new, |degree| suspicions(set, cases, degree))
        });
        let mut found: Vec<_> = found.collect();
        for suspicion in &mut found {
            suspicion.cases.extend(headline.explains.iter().cloned());
        }
        found
    }

    /// Mistakes that reproduce these cases alone, or all that is told does, with one more or without; or sets that foretell
    /// them, or pairs, or one that does it nearly.
    fn reproducing(&self, names: &[String], told: &[Mistake]) -> Vec<Suspicion> {
        let cases = self.quickest(names);
        if cases.is_empty() {
            return Vec::new();
        }
        let mistakes = self.in_sight();
        let alone: Vec<_> = mistakes.iter().map(|mistake| vec![*mistake]).collect();
        let mut found = self.of_sets(&alone, &cases, names);
        if found.is_empty() {
            found = self.of_all(told, &cases);
        }
        // Then nearly all mistakes are in sight, and there is time for each alone.
        if self.fails_images_alone() {
            return found;
        }
        let is_told = |mistake: &&Mistake| told.iter().any(|told| told.cause == mistake.cause);
        let others: Vec<_> = mistakes.iter().filter(|one| !is_told(one)).copied().collect();
        if found.is_empty() && !told.is_empty() {
            let one_more = others.iter().map(|other| [told, &[*other]].concat());
            found = self.composed(&one_more.collect::<Vec<_>>(), &cases, |_| others.len());
        }
        if !found.is_empty() {
            return found;
        }
        let failing = names.iter().filter_map(|case| self.evidence.failure_of(case));
        let many = quickest(failing, PROVING);
        let is_new = |told: &&Mistake| mistakes.iter().all(|other| other.cause != told.cause);
        let pool =
            [&mistakes[..], &told.iter().filter(is_new).copied().collect::<Vec<_>>()].concat();
        let likely = self.foretelling(&pool, &cases);
        found = self.composed(&likely, &many, |size| pool.len().saturating_pow(size as u32));
        if found.is_empty() {
            found = self.of_sets(&pairs(&others), &cases, names);
        }
        // A core may do what the bench has a component for in the midst of a higher one.
        let is_below =
            |components| !self.made_in.may_be(components) && !self.made_in.leaves(components);
        // With the bench's direct lighting a path that weighs both kinds of samples has no weights: its own mistakes go, too.
        let is_asked = |mistake: &Mistake| names.iter().any(|case| case == mistake.caught_by);
        let is_of_weights = |mistake: &Mistake| {
            matches!(self.made_in, MadeIn::Mended(Components::DIRECT_LIGHTING))
                && mistake.components == Components::PATH
                && is_asked(mistake)
        };
        let is_elsewhere =
            |mistake: &Mistake| is_below(mistake.components) || is_of_weights(mistake);
        let elsewhere = self.failing_alike(is_elsewhere);
        let elsewhere: Vec<_> = elsewhere.into_iter().map(|mistake| vec![mistake]).collect();
        if found.is_empty() {
            found = self.of_sets(&elsewhere, &cases, names);
        }
        if found.is_empty() {
            found = self.in_their_own_places(&alone, names);
        }
        if found.is_empty() {
            found = self.darkening(&alone, &cases, names);
        }
        if found.is_empty() {
            found = self.nearly_reproducing(&[alone, likely, elsewhere].concat(), &many);
        }
        found
    }

    /// Mistakes that give the numbers of the cases written for them and of others, and fail none of the rest otherwise: what
    /// they pass fails by something else, which nobody need know. Two that are seen in one case are none.
    fn in_their_own_places(&self, alone: &[Vec<Mistake>], names: &[String]) -> Vec<Suspicion> {
        let failing = names.iter().filter_map(|case| self.evidence.failure_of(case));
        let beside = quickest(failing, siblings::FAILED);
        let gives_its_own = |set: &&Vec<Mistake>| {
            let own = names.iter().find(|case| *case == set[0].caught_by);
            let own = own.and_then(|case| self.evidence.failure_of(case));
            own.is_some_and(|own| !self.fitting(slice::from_ref(set), &[own]).is_empty())
        };
        let sets: Vec<_> = alone.iter().filter(gives_its_own).collect();
        let all: Vec<_> =
            sets.iter().filter_map(|set| Some((*set, self.places_of(set, &beside)?))).collect();
        let is_seen_by_others = |set: &[Mistake], seen: &Observation<'_>| {
            let others = all.iter().filter(|(other, _)| other[0].cause != set[0].cause);
            others.flat_map(|(_, places)| places).any(|place| place.case == seen.case)
        };
        let found = all.iter().filter_map(|(set, places)| {
            let is_alone = !places.iter().any(|seen| is_seen_by_others(set, seen));
            let degree = degree(1, sets.len(), places).filter(|_| is_alone && places.len() > 1)?;
            Some(suspicions(set, places, degree))
        });
        found.flatten().collect()
    }

    /// The cases of which a set gives the numbers; none where it fails one otherwise.
    fn places_of<'s>(
        &self,
        set: &Vec<Mistake>,
        cases: &[&'s Observation<'a>],
    ) -> Option<Vec<&'s Observation<'a>>> {
        let at_first = self.glimpsed(slice::from_ref(set), cases).remove(0);
        let fails =
            |(_, answer): &(_, Option<Finding>)| answer.as_ref().is_some_and(Finding::failed);
        let failed: Vec<_> =
            cases.iter().zip(at_first).filter(fails).map(|(seen, _)| *seen).collect();
        let answers = self.compare(slice::from_ref(set), &failed).remove(0);
        let is_otherwise = |of: &Likeness| matches!(of, Likeness::Alike | Likeness::Other);
        let of_places = failed.into_iter().zip(&answers).filter(|(_, of)| **of == Likeness::Same);
        let places = of_places.map(|(seen, _)| seen).collect();
        (!answers.iter().any(is_otherwise)).then_some(places)
    }

    /// Where all that fails is dark, the only kind of mistake that leaves it dark, its own case among it. Darkness has no
    /// size: whether the cause is told is up to what passes with it.
    fn darkening(
        &self,
        alone: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
        names: &[String],
    ) -> Vec<Suspicion> {
        let mut failing = names.iter().filter_map(|case| self.evidence.failure_of(case));
        if !failing.all(|seen| seen.is_about_light() && seen.is_dark()) {
            return Vec::new();
        }
        let fails_its_own = |set: &&Vec<Mistake>| names.iter().any(|c| c == set[0].caught_by);
        let own: Vec<_> = alone.iter().filter(fails_its_own).cloned().collect();
        let answers = self.compare(&own, cases);
        let leaves_dark =
            |of_set: &[Likeness]| of_set.iter().all(|likeness| likeness.is_reproduced());
        let fitting = own.iter().zip(&answers).filter(|(_, of_set)| leaves_dark(of_set));
        match kinds(fitting.map(|(set, _)| set).collect())[..] {
            [only] => suspicions(only, cases, Degree::LooksLike),
            _ => Vec::new(),
        }
    }

    /// The only set that gives the numbers of most cases; or of half of them, where it fails the others in the same places
    /// and to the same side. The rest may be the noise of another sampler, or one mistake more.
    fn nearly_reproducing(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Suspicion> {
        let is_near = |of: &Likeness| of.is_reproduced() || *of == Likeness::Alike;
        let same = |of_set: &[Likeness]| {
            of_set.iter().filter(|likeness| **likeness == Likeness::Same).count()
        };
        let may_be = |of_set: &[Likeness]| {
            let (same, all) = (same(of_set), cases.len());
            same > 0 && (2 * same > all || 2 * same == all && of_set.iter().all(is_near))
        };
        let at_first = likenesses(cases, &self.glimpsed(sets, cases));
        let may_be_near = sets.iter().zip(at_first).filter(|(_, of_set)| may_be(of_set));
        let sets: Vec<_> = may_be_near.map(|(set, _)| set.clone()).collect();
        let answers = self.compare(&sets, cases);
        let most = answers.iter().filter(|of_set| may_be(of_set)).map(|of_set| same(of_set)).max();
        let nearest = sets.iter().zip(&answers).filter(|(_, of_set)| Some(same(of_set)) == most);
        let kinds = kinds(nearest.map(|(set, _)| set).collect());
        let ([only], true) = (&kinds[..], most.is_some()) else { return Vec::new() };
        let of_only = sets.iter().zip(&answers).filter(|(set, _)| ptr::eq(*set, *only));
        let of_cases = of_only.flat_map(|(_, of_set)| cases.iter().zip(of_set));
        let told = of_cases.filter(|(_, of)| is_near(of));
        let told: Vec<_> = told.map(|(seen, _)| *seen).collect();
        let mut found = suspicions(only, &told, Degree::LooksLike);
        for suspicion in &mut found {
            let names = suspicion.cases.join(", ");
            suspicion.evidence = vec![wrong_in_the_same_places("", together(only), &names)];
        }
        if only.len() > 1 { self.where_needed(found, only, &told) } else { found }
    }

    /// Everything that is told, where it reproduces every case: each in the cases that it is needed for.
    fn of_all(&self, told: &[Mistake], cases: &[&Observation<'a>]) -> Vec<Suspicion> {
        if told.len() < 2 || cases.is_empty() {
            return Vec::new();
        }
        let found = self.of_sets(&[told.to_vec()], cases, &[]);
        self.where_needed(found, told, cases)
    }

    /// Failures without a cause of which all that is named together gives the numbers; if it gives those of all that are
    /// asked, all of them.
    fn given_by_all(&self, told: &Ranked) -> Vec<String> {
        let named = self.named(told);
        let left: Vec<_> = told.differing().cloned().collect();
        let failures = left.iter().filter_map(|case| self.evidence.failure_of(case));
        let asked = quickest(failures, siblings::FAILED);
        if named.is_empty() || asked.is_empty() {
            return Vec::new();
        }
        let answers = self.compare(&[named], &asked).remove(0);
        let given = asked.iter().zip(answers).filter(|(_, of)| *of == Likeness::Same);
        let given: Vec<_> = given.map(|(seen, _)| seen.case.to_owned()).collect();
        if given.len() == asked.len() { left } else { given }
    }

    /// Each suspicion of a `set` in the cases that the others alone do not reproduce.
    fn where_needed(
        &self,
        mut found: Vec<Suspicion>,
        set: &[Mistake],
        cases: &[&Observation<'a>],
    ) -> Vec<Suspicion> {
        let all_but = |left_out: &Mistake| -> Vec<_> {
            set.iter().filter(|one| one.name != left_out.name).copied().collect()
        };
        let sets: Vec<_> = set.iter().map(all_but).collect();
        let answers = likenesses(cases, &self.weighed(&sets, cases));
        for (suspicion, without) in found.iter_mut().zip(answers) {
            let needs = cases.iter().zip(without).filter(|(_, l)| *l != Likeness::Same);
            suspicion.cases = needs.map(|(seen, _)| seen.case.to_owned()).collect();
        }
        found.retain(|suspicion| !suspicion.cases.is_empty());
        found
    }

    /// The sets of several mistakes that foretell what failed, the likeliest first.
    fn foretelling(&self, mistakes: &[Mistake], cases: &[&Observation<'a>]) -> Vec<Vec<Mistake>> {
        // Light alone is multiplied and added up: where counts are wrong, what each mistake makes of them foretells nothing.
        let cases: Vec<_> = cases.iter().copied().filter(|seen| is_of_light(seen)).collect();
        let alone: Vec<_> = mistakes.iter().map(|mistake| vec![*mistake]).collect();
        let mut answers = self.glimpsed(&alone, &cases);
        let of_case = |(number, seen): (usize, &&Observation<'a>)| {
            let alone = answers.iter_mut().map(|of_mistake| of_mistake[number].take()).collect();
            Some(Seen { core: seen.finding?, alone })
        };
        let seen: Vec<_> = cases.iter().enumerate().filter_map(of_case).collect();
        composition::likely(mistakes, &seen, FORETOLD)
    }

    /// The only smallest of these sets that reproduce every case, each mistake in the cases that it is needed for. `tried` is
    /// how many sets of a size there were to try.
    fn composed(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
        tried: impl Fn(usize) -> usize,
    ) -> Vec<Suspicion> {
        let fitting = self.fitting(sets, cases);
        let smallest = fitting.iter().map(|set| set.len()).min().unwrap_or_default();
        let [set] = kinds(fitting.into_iter().filter(|set| set.len() == smallest).collect())[..]
        else {
            return Vec::new();
        };
        let found = degree(1, tried(set.len()), cases).map(|degree| suspicions(set, cases, degree));
        self.where_needed(found.unwrap_or_default(), set, cases)
    }

    /// The suspicions of those sets that reproduce every case; none where too many do. What fails its own case among those
    /// that `failed` is thought of first, and has only its like beside it.
    fn of_sets(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
        failed: &[String],
    ) -> Vec<Suspicion> {
        let fails_its_own = |mistake: &Mistake| failed.iter().any(|c| c == mistake.caught_by);
        let is_first = |set: &[Mistake]| set.iter().all(fails_its_own);
        let fitting = self.fitting(sets, cases);
        let kinds = kinds(fitting);
        let tried = match kinds.iter().all(|set| is_first(set)) {
            true => sets.iter().filter(|set| is_first(set)).count(),
            false => sets.len(),
        };
        let degree = degree(kinds.len(), tried, cases);
        degree.map_or_else(Vec::new, |degree| {
            kinds.into_iter().flat_map(|set| suspicions(set, cases, degree)).collect()
        })
    }

    /// Those sets that reproduce every case: its numbers, or that it fails without any, but not all of them without.
    fn fitting<'s>(
        &self,
        sets: &'s [Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<&'s Vec<Mistake>> {
        let mut fitting: Vec<_> = sets.iter().map(|set| (set, false)).collect();
        let tried = |fitting: &[(&Vec<Mistake>, bool)]| -> Vec<_> {
            fitting.iter().map(|(set, _)| (*set).clone()).collect()
        };
        // The quickest case leaves few for the others, and a first look leaves few for the second.
        for seen in cases {
            if fitting.len() > CASES {
                let at_first = likenesses(&[seen], &self.glimpsed(&tried(&fitting), &[seen]));
                let mut at_first = at_first.into_iter();
                fitting.retain(|_| at_first.next().is_some_and(|of| of[0].may_be_reproduced()));
            }
            let answers = self.compare(&tried(&fitting), &[seen]).into_iter().map(|of| of[0]);
            let fits = fitting.into_iter().zip(answers).filter(|(_, of)| of.is_reproduced());
            fitting =
                fits.map(|((set, is_sized), of)| (set, is_sized || of == Likeness::Same)).collect();
        }
        fitting.into_iter().filter(|(_, is_sized)| *is_sized).map(|(set, _)| set).collect()
    }

    /// A mistake of each cause that is named.
    fn named(&self, told: &Ranked) -> Vec<Mistake> {
        let named = told.with_cause().filter(|headline| headline.degree == Degree::Named);
        named.filter_map(|headline| self.likeliest(headline)).collect()
    }

    /// Of the planted mistakes of a headline's cause the one that gives its numbers, or else the first: a count is one too many
    /// or one too few.
    fn likeliest(&self, headline: &Headline) -> Option<Mistake> {
        let sets: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
        let first = sets.first()?[0];
        if sets.len() == 1 {
            return Some(first);
        }
        let likely = self.likely_at_first(sets, &self.quickest(&headline.explains));
        let mut likely = likely.into_iter().map(|set| set[0]);
        likely.find(|one| self.is_reproduced(*one, headline)).or(Some(first))
    }

    /// Those sets that a first look at each case does not tell from the core.
    fn likely_at_first(
        &self,
        sets: Vec<Vec<Mistake>>,
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Mistake>> {
        let at_first = likenesses(cases, &self.glimpsed(&sets, cases));
        let may_give = |(_, of_set): &(_, Vec<Likeness>)| {
            of_set.iter().all(|likeness| likeness.may_be_reproduced())
        };
        sets.into_iter().zip(at_first).filter(may_give).map(|(set, _)| set).collect()
    }

    /// The planted mistakes of a headline's cause.
    fn of(&self, headline: &Headline) -> impl Iterator<Item = Mistake> + use<'a> {
        let name = headline.cause.clone();
        self.planted.mistakes().iter().copied().filter(move |mistake| mistake.cause.name == name)
    }

    /// Mistakes that may be made in what is the core's own, whose own cases fail here.
    fn in_sight(&self) -> Vec<Mistake> {
        self.failing_alike(|mistake| self.made_in.may_be(mistake.components))
    }

    /// Those of the `wanted` mistakes whose own cases fail here, asked of what is the core's own. Where images alone fail,
    /// those too whose own cases cannot be asked: an image tells by its parts which it is.
    fn failing_alike(&self, wanted: impl Fn(&Mistake) -> bool) -> Vec<Mistake> {
        let by_images = self.fails_images_alone();
        let fails = |mistake: &&Mistake| {
            let may_fail = match self.evidence.failure_of(mistake.caught_by) {
                Some(seen) => !seen.with.intersects(mistake.components),
                None => by_images && !self.evidence.has_asked(mistake.caught_by),
            };
            may_fail && wanted(mistake)
        };
        self.planted.mistakes().iter().filter(fails).copied().collect()
    }

    fn fails_images_alone(&self) -> bool {
        let answered = |seen: &Observation<'_>| seen.ending.is_none();
        self.evidence.failures().all(|seen| seen.is_about(Subject::Image))
            && self.evidence.failures().any(answered)
    }

    /// The quickest of `cases` whose numbers can be compared.
    fn quickest(&self, cases: &[String]) -> Vec<&'a Observation<'a>> {
        quickest(cases.iter().filter_map(|case| self.evidence.failure_of(case)), CASES)
    }

    /// For each set of mistakes, how it compares in each case.
    fn compare(&self, sets: &[Vec<Mistake>], cases: &[&Observation<'a>]) -> Vec<Vec<Likeness>> {
        likenesses(cases, &self.planted(sets, cases))
    }

    /// For each set of mistakes, what comes of each case.
    fn planted(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        self.asked(sets, cases, |_| false)
    }

    /// The same, no closer than it takes to see what the core fails by: enough to speak for a mistake or against it, and not
    /// for what its numbers are alone.
    fn weighed(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        self.asked(sets, cases, |seen| self.planted.is_seen_roughly(seen.case))
    }

    /// The same at a first look, where that takes less: of numbers that are known within their noise.
    fn glimpsed(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        let is_noisy = |seen: &Observation<'_>| {
            let mut measures = seen.finding.into_iter().flat_map(|finding| &finding.measures);
            measures.any(|measure| measure.interval.is_some())
        };
        self.asked(sets, cases, is_noisy)
    }

    fn asked(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
        roughly: impl Fn(&Observation<'_>) -> bool,
    ) -> Vec<Vec<Option<Finding>>> {
        let question = |set: &Vec<Mistake>, seen: &&Observation<'a>| Question {
            mistakes: set.clone(),
            case: seen.case,
            with: seen.with,
            roughly: roughly(seen),
        };
        let questions: Vec<_> =
            sets.iter().flat_map(|set| cases.iter().map(move |seen| question(set, seen))).collect();
        let mut answers = self.planted.ask(&questions).into_iter();
        sets.iter().map(|_| answers.by_ref().take(cases.len()).collect()).collect()
    }
}

/// How the answers of each set of mistakes compare, case by case.
fn likenesses(cases: &[&Observation<'_>], answers: &[Vec<Option<Finding>>]) -> Vec<Vec<Likeness>> {
    let of_case = |(seen, planted): (&&Observation<'_>, &Option<Finding>)| match planted {
        Some(planted) => likeness(seen.finding, planted),
        None => Likeness::Unknown,
    };
    answers.iter().map(|of_set| cases.iter().zip(of_set).map(of_case).collect()).collect()
}

/// Those that ask the least, and few that ask for much: what it takes is known to whoever asks, and ends the asking.
fn quickest<'s, 'a: 's>(
    seen: impl Iterator<Item = &'s Observation<'a>>,
    count: usize,
) -> Vec<&'s Observation<'a>> {
    let mut seen: Vec<_> = seen.collect();
    seen.sort_by_key(|seen| seen.work);
    let cheap = seen.partition_point(|seen| seen.work <= COSTLY);
    seen.truncate(count.min(cheap.max(CASES)));
    seen
}

/// Whether light is wrong in it, channel by channel.
fn is_of_light(seen: &Observation<'_>) -> bool {
    let wrong = seen.finding.into_iter().flat_map(Finding::failed_measures);
    wrong.filter(|measure| measure.channel.is_some()).count() > 0
}

/// Whether `case` is about what the headline's are about.
fn is_of_one_part(headline: &Headline, case: &str) -> bool {
    headline.explains.iter().any(|own| Subject::of_case(own) == Subject::of_case(case))
}

/// Pairs of the first `mistakes`: what they do together need not follow from what each does alone.
fn pairs(mistakes: &[Mistake]) -> Vec<Vec<Mistake>> {
    let first = &mistakes[..mistakes.len().min(PAIRED)];
    let of = |(number, one): (usize, &Mistake)| {
        let rest = first[number + 1..].iter().filter(|other| other.cause != one.cause);
        rest.map(|other| vec![*one, *other]).collect::<Vec<_>>()
    };
    first.iter().enumerate().flat_map(of).collect()
}

/// Sets of mistakes, one for all that have the same causes.
fn kinds(sets: Vec<&Vec<Mistake>>) -> Vec<&Vec<Mistake>> {
    let mut kinds: BTreeMap<Vec<&str>, &Vec<Mistake>> = BTreeMap::new();
    for set in sets {
        let mut causes: Vec<_> = set.iter().map(|mistake| mistake.cause.name).collect();
        causes.sort_unstable();
        kinds.entry(causes).or_insert(set);
    }
    kinds.into_values().collect()
}

/// How sure it is that one of so many `fitting` kinds, of so many that were tried, is there; not at all where too many fit.
fn degree(fitting: usize, tried: usize, cases: &[&Observation<'_>]) -> Option<Degree> {
    let by_chance = tried as f64 * by_chance(cases);
    let is_clear = by_chance < BY_CHANCE;
    let degree = Degree::of_one_among(if is_clear { fitting } else { 2 });
    (fitting <= 2 && by_chance <= 1.0).then_some(degree)
}

/// All that a cause explains, against it.
fn all_of(headline: &Headline) -> Option<Refuted> {
    Some(refuted(cause::find(&headline.cause)?, &headline.explains))
}

fn refuted(cause: &'static Cause, cases: &[String]) -> Refuted {
    cases.iter().map(|case| (cause.name, case.clone())).collect()
}

fn wrong_in_the_same_places(before: &str, together: &str, cases: &str) -> String {
    format!(
        "{before}the bench's own core with this mistake{together} is wrong in the same places in {cases}"
    )
}

/// What a mistake of `set` is planted with.
fn together(set: &[Mistake]) -> &'static str {
    if set.len() > 1 { " beside the others" } else { "" }
}

fn suspicions(set: &[Mistake], cases: &[&Observation<'_>], degree: Degree) -> Vec<Suspicion> {
    let names: Vec<_> = cases.iter().map(|seen| seen.case.to_owned()).collect();
    let together = together(set);
    let in_cases = match &names[..] {
        [first, _, ..] => format!("{first} and {} more", names.len() - 1),
        _ => names.concat(),
    };
    let sentence = format!(
        "the bench's own core with this mistake{together} gives the same numbers in {in_cases}"
    );
    let suspicion = |mistake: &Mistake| Suspicion {
        cause: mistake.cause,
        cases: names.clone(),
        evidence: vec![sentence.clone()],
        ruled_out: Vec::new(),
        weight: 1.0,
        degree,
        beside: set.len() > 1,
    };
    set.iter().map(suspicion).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Foundation;
    use crate::cause::{bsdf, integrator, light};
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};
    use crate::diagnosis::{Diagnosis, diagnose, diagnose_proven};
    use crate::image::Channel;

    const PI: Mistake = mistake("pi", &bsdf::WITHOUT_PI, "bsdf/a");
    const DIVIDED: Mistake = mistake("divided", &light::DIVIDED_BY_LIGHTS, "light/b");
    const COSINE: Mistake = mistake("cosine", &light::WORLD_COSINE, "light/b");
    const AGAIN: Mistake = mistake("again", &integrator::EMISSION_AGAIN, "light/b");

    const fn mistake(
        name: &'static str,
        cause: &'static Cause,
        caught_by: &'static str,
    ) -> Mistake {
        Mistake { name, cause, components: Components::BSDF, caught_by }
    }

    /// Mistakes, and the ratio to what is right that they give together in a case; 1 where nothing is said.
    struct Bench<'a> {
        mistakes: &'a [Mistake],
        gives: &'a [(&'a [&'a str], &'a str, f64)],
    }

    impl Planted for Bench<'_> {
        fn mistakes(&self) -> &[Mistake] {
            self.mistakes
        }

        fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
            let ratio = |question: &Question<'_>| {
                let names: Vec<_> = question.mistakes.iter().map(|one| one.name).collect();
                let of = |(set, case, _): &&(&[&str], &str, f64)| {
                    let is_set = set.len() == names.len() && names.iter().all(|n| set.contains(n));
                    is_set && *case == question.case
                };
                self.gives.iter().find(of).map_or(1.0, |(.., ratio)| *ratio)
            };
            questions.iter().map(|question| Some(light(ratio(question)))).collect()
        }
    }

    fn light(ratio: f64) -> Finding {
        means(vec![mean("bounce 1", Channel::Red, 0.5, ratio, 0.01)])
    }

    fn told(diagnosis: &Diagnosis) -> Vec<(&str, Degree, usize)> {
        let headlines = diagnosis.headlines.iter();
        headlines.map(|told| (&told.cause[..], told.degree, told.explains.len())).collect()
    }

    #[test]
    fn what_the_planted_mistake_contradicts_is_not_told() {
        let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
        let made = Made::new().with("bsdf/a", brighter);
        assert_eq!(diagnose(&made.evidence()).headlines[0].cause, bsdf::WITHOUT_PI.name);
        for other in [1.0, 0.5] {
            let planted = Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", other)] };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)], "{other}");
        }
        let planted = Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", 2.5)] };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let pi = bsdf::WITHOUT_PI.name;
        assert_eq!(told(&diagnosis), [(pi, Degree::LooksLike, 1)], "it is of another size");
    }

    #[test]
    fn a_mistake_whose_own_case_passes_is_not_told_of_one_other() {
        let seen = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
        let planted =
            Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", 3.0), (&["pi"], "bsdf/b", 2.0)] };
        let causes = |made: Made| {
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            diagnosis.headlines.into_iter().map(|told| told.cause).collect::<Vec<_>>()
        };
        let pi = bsdf::WITHOUT_PI.name;
        assert_eq!(causes(Made::new().with("bsdf/b", seen.clone())), [pi]);
        assert_eq!(
            causes(Made::new().with("bsdf/b", seen.clone()).with("bsdf/a", passing())),
            [""]
        );
    }

    #[test]
    fn three_mistakes_that_only_together_give_all_numbers_are_named() {
        const ALONE: [(&str, [f64; 6]); 3] = [
            ("pi", [2.0, 2.5, 1.0, 1.0, 4.0, 1.0]),
            ("cosine", [1.0, 1.5, 7.0, 5.0, 1.0, 3.0]),
            ("again", [3.0, 1.0, 1.0, 8.0, 5.0, 9.0]),
        ];
        let cases = ["bsdf/a", "light/b", "light/c", "light/d", "light/e", "light/f"];
        let ratio = |set: &[usize], case: usize| -> f64 {
            set.iter().map(|mistake| ALONE[*mistake].1[case]).product()
        };
        let made = (0..6)
            .fold(Made::new(), |made, case| made.with(cases[case], light(ratio(&[0, 1, 2], case))));
        let sets: [(&[usize], &[&str]); 7] = [
            (&[0], &["pi"]),
            (&[1], &["cosine"]),
            (&[2], &["again"]),
            (&[0, 1], &["pi", "cosine"]),
            (&[0, 2], &["pi", "again"]),
            (&[1, 2], &["cosine", "again"]),
            (&[0, 1, 2], &["pi", "cosine", "again"]),
        ];
        let given = sets.iter().flat_map(|(set, names)| {
            (0..6).map(move |case| (*names, cases[case], ratio(set, case)))
        });
        let gives: Vec<_> = given.collect();
        let planted = Bench { mistakes: &[PI, COSINE, AGAIN], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let mut named = told(&diagnosis);
        named.sort_unstable();
        let name = |cause: &'static Cause, cases| (cause.name, Degree::Named, cases);
        let mut expected = [
            name(&light::WORLD_COSINE, 4),
            name(&integrator::EMISSION_AGAIN, 4),
            name(&bsdf::WITHOUT_PI, 3),
        ];
        expected.sort_unstable();
        assert_eq!(named, expected);
    }

    #[test]
    fn of_two_mistakes_of_a_cause_the_one_that_is_there_stands_beside_the_next() {
        const MORE: Mistake = mistake("more", &bsdf::WITHOUT_PI, "bsdf/a");
        const LESS: Mistake = mistake("less", &bsdf::WITHOUT_PI, "bsdf/a");
        let seen = light(4.0).because(&bsdf::WITHOUT_PI, "x");
        let made = Made::new().with("bsdf/a", seen).with("light/b", light(20.0));
        let gives: [(&[&str], &str, f64); 6] = [
            (&["more"], "bsdf/a", 2.0),
            (&["less"], "bsdf/a", 4.0),
            (&["less"], "light/b", 1.5),
            (&["cosine"], "light/b", 3.0),
            (&["more", "cosine"], "light/b", 7.0),
            (&["less", "cosine"], "light/b", 20.0),
        ];
        let planted = Bench { mistakes: &[MORE, LESS, COSINE], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let causes: Vec<_> = told(&diagnosis).into_iter().map(|(cause, ..)| cause).collect();
        assert_eq!(causes, [bsdf::WITHOUT_PI.name, light::WORLD_COSINE.name]);
    }

    #[test]
    fn weak_light_is_not_told_among_much_that_is_dark_and_right_with_its_mistake() {
        let of_core = [("light/b", 0.5), ("light/c", 0.25)].into_iter();
        let of_core = of_core.chain(["light/d", "light/e", "light/f", "light/g"].map(|c| (c, 0.0)));
        let made = of_core.fold(Made::new(), |made, (case, ratio)| made.with(case, light(ratio)));
        let causes = |of_dark: f64| {
            let dark: [(&[&str], &str, f64); 4] =
                ["light/d", "light/e", "light/f", "light/g"].map(|c| (&["cosine"][..], c, of_dark));
            let own: [(&[&str], &str, f64); 2] =
                [(&["cosine"], "light/b", 0.5), (&["cosine"], "light/c", 0.25)];
            let gives = [&own[..], &dark].concat();
            let planted = Bench { mistakes: &[COSINE], gives: &gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            told(&diagnosis).into_iter().map(|(cause, ..)| cause.to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(causes(1.0), [""]);
        assert!(causes(0.0).contains(&light::WORLD_COSINE.name.to_owned()));
    }

    #[test]
    fn a_mistake_is_named_in_its_own_places_beside_one_that_nobody_knows() {
        let of_core = [("light/b", 2.0), ("light/c", 3.0), ("light/d", 5.0), ("light/e", 7.0)];
        let of_core = of_core.into_iter().chain([("light/f", 11.0)]);
        let made = of_core.fold(Made::new(), |made, (case, ratio)| made.with(case, light(ratio)));
        let causes = |of_d: f64, of_again: f64| {
            let gives: [(&[&str], &str, f64); 5] = [
                (&["cosine"], "light/b", 2.0),
                (&["cosine"], "light/c", 3.0),
                (&["cosine"], "light/d", of_d),
                (&["again"], "light/b", of_again),
                (&["again"], "light/c", 3.0),
            ];
            let planted = Bench { mistakes: &[COSINE, AGAIN], gives: &gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            told(&diagnosis).into_iter().map(|(cause, ..)| cause.to_owned()).collect::<Vec<_>>()
        };
        let cosine = light::WORLD_COSINE.name.to_owned();
        assert!(causes(1.0, 1.0).contains(&cosine));
        assert_eq!(causes(4.0, 1.0), [""], "what it fails otherwise is not its own");
        assert_eq!(causes(1.0, 2.0), [""], "two may be what is seen there");
    }

    #[test]
    fn a_cause_whose_numbers_all_others_give_together_is_not_told() {
        let seen = |ratio, cause: &Cause| light(ratio).because(cause, "x");
        let made = Made::new()
            .with("bsdf/a", seen(2.0, &bsdf::WITHOUT_PI))
            .with("light/b", seen(3.0, &light::WORLD_COSINE))
            .with("integrator/c", seen(5.0, &integrator::ROULETTE_NOT_PLAYED));
        let pi = bsdf::WITHOUT_PI.name;
        let names = |gives: &[(&[&str], &str, f64)]| -> Vec<String> {
            let planted = Bench { mistakes: &[PI, COSINE], gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            diagnosis.headlines.into_iter().map(|told| told.cause).collect()
        };
        let apart: [(&[&str], &str, f64); 4] = [
            (&["pi"], "bsdf/a", 2.0),
            (&["cosine"], "light/b", 3.0),
            (&["pi", "cosine"], "bsdf/a", 2.0),
            (&["pi", "cosine"], "light/b", 3.0),
        ];
        let roulette = integrator::ROULETTE_NOT_PLAYED.name;
        assert!(names(&apart).contains(&roulette.to_owned()));
        let together = [&apart[..], &[(&["pi", "cosine"], "integrator/c", 5.0)]].concat();
        let told = names(&together);
        assert!(told.contains(&pi.to_owned()) && !told.contains(&roulette.to_owned()), "{told:?}");
    }

    #[test]
    fn a_cause_of_darkness_that_all_others_leave_dark_is_not_told() {
        let seen = |ratio, cause: &Cause| light(ratio).because(cause, "x");
        let made = Made::new()
            .with("bsdf/a", seen(2.0, &bsdf::WITHOUT_PI))
            .with("light/b", seen(3.0, &light::WORLD_COSINE))
            .with("integrator/c", seen(0.0, &integrator::ROULETTE_NOT_PLAYED));
        let names = |dark: f64| -> Vec<String> {
            let gives: [(&[&str], &str, f64); 5] = [
                (&["pi"], "bsdf/a", 2.0),
                (&["cosine"], "light/b", 3.0),
                (&["pi", "cosine"], "bsdf/a", 2.0),
                (&["pi", "cosine"], "light/b", 3.0),
                (&["pi", "cosine"], "integrator/c", dark),
            ];
            let planted = Bench { mistakes: &[PI, COSINE], gives: &gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            diagnosis.headlines.into_iter().map(|told| told.cause).collect()
        };
        let roulette = integrator::ROULETTE_NOT_PLAYED.name.to_owned();
        assert!(names(1.0).contains(&roulette) && !names(0.0).contains(&roulette));
    }

    #[test]
    fn darkness_is_named_where_one_mistake_alone_leaves_it_and_its_neighbours_light() {
        const OTHER: Mistake = mistake("other", &light::WORLD_COSINE, "light/c");
        let causes = |by_other: f64, neighbours: usize| {
            let mut made = Made::new().with("light/b", light(0.0)).with("light/c", light(0.0));
            for name in &["light/d", "light/e", "light/f", "light/g"][..neighbours] {
                made = made.with(*name, light(1.0));
            }
            let gives: [(&[&str], &str, f64); 4] = [
                (&["divided"], "light/b", 0.0),
                (&["divided"], "light/c", 0.0),
                (&["other"], "light/b", by_other),
                (&["other"], "light/c", 0.0),
            ];
            let planted = Bench { mistakes: &[DIVIDED, OTHER], gives: &gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            let told = diagnosis.headlines.into_iter().map(|told| (told.cause, told.degree));
            told.collect::<Vec<_>>()
        };
        let nothing = [(String::new(), Degree::DiffersHere)];
        let divided = light::DIVIDED_BY_LIGHTS.name.to_owned();
        assert_eq!(causes(0.5, 4), [(divided, Degree::Named)]);
        assert_eq!(causes(0.0, 4), nothing, "another leaves it dark, too");
        assert_eq!(causes(0.5, 1), nothing, "too little was asked beside it");
    }

    /// A bench whose time is up.
    struct Late;

    impl Planted for Late {
        fn mistakes(&self) -> &[Mistake] {
            &[PI]
        }

        fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
            vec![None; questions.len()]
        }
    }

    /// Mistakes that are called by what they multiply by, and which of them were asked not only roughly.
    struct Factors {
        mistakes: Vec<Mistake>,
        asked: std::sync::Mutex<BTreeSet<&'static str>>,
    }

    impl Planted for Factors {
        fn mistakes(&self) -> &[Mistake] {
            &self.mistakes
        }

        fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
            let answer = |question: &Question<'_>| {
                let name = question.mistakes[0].name;
                if !question.roughly {
                    self.asked.lock().unwrap().insert(name);
                }
                Some(light(name.parse().unwrap()))
            };
            questions.iter().map(answer).collect()
        }
    }

    #[test]
    fn a_first_look_leaves_few_mistakes_for_the_second() {
        let made = Made::new().with("light/b", light(1.8));
        let of = |name| mistake(name, &bsdf::WITHOUT_PI, "light/b");
        let mistakes = ["1.2", "1.4", "1.6", "1.8", "2.0", "2.2"].map(of).to_vec();
        let bench = Factors { mistakes, asked: Default::default() };
        let diagnosis = diagnose_proven(&made.evidence(), &bench);
        assert_eq!(diagnosis.headlines[0].cause, bsdf::WITHOUT_PI.name);
        assert_eq!(bench.asked.into_inner().unwrap(), BTreeSet::from(["1.8"]));
    }

    /// Of one mistake in two places, one fails what the other passes, without a number.
    struct InTwoPlaces;

    impl Planted for InTwoPlaces {
        fn mistakes(&self) -> &[Mistake] {
            const HERE: Mistake = mistake("here", &bsdf::WITHOUT_PI, "bsdf/a");
            const THERE: Mistake = mistake("there", &bsdf::WITHOUT_PI, "bsdf/b");
            &[HERE, THERE]
        }

        fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
            let is_here = |question: &Question<'_>| {
                (question.mistakes[0].name == "here") == (question.case == "bsdf/a")
            };
            let answer = |is_here| if is_here { failing("a breach") } else { passing() };
            questions.iter().map(|question| Some(answer(is_here(question)))).collect()
        }
    }

    #[test]
    fn a_mistake_in_another_place_does_not_contradict_what_fails_without_a_number() {
        let breach = failing("a breach").because(&bsdf::WITHOUT_PI, "a breach");
        let made = Made::new().with("bsdf/a", breach);
        let diagnosis = diagnose_proven(&made.evidence(), &InTwoPlaces);
        assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 1)]);
    }

    #[test]
    fn a_cause_that_there_is_no_time_to_ask_keeps_its_name() {
        let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
        let made = Made::new().with("bsdf/a", brighter);
        let diagnosis = diagnose_proven(&made.evidence(), &Late);
        assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 1)]);
    }

    #[test]
    fn a_cause_is_put_to_the_proof_however_slow_the_core_is() {
        let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
        let made = Made::new().with("bsdf/a", brighter).taking(1 << 40);
        let planted = Bench { mistakes: &[PI], gives: &[] };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)]);
    }

    #[test]
    fn what_contradicts_one_cause_makes_room_for_the_next() {
        let finding =
            light(0.5).because(&bsdf::WITHOUT_PI, "x").because(&light::DIVIDED_BY_LIGHTS, "y");
        let made = Made::new().with("light/b", finding);
        let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.5)];
        let planted = Bench { mistakes: &[PI, DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let divided = light::DIVIDED_BY_LIGHTS.name;
        assert_eq!(told(&diagnosis), [(divided, Degree::Named, 1)]);
    }

    #[test]
    fn what_no_rule_knows_is_named_by_the_one_mistake_that_gives_the_same_numbers() {
        let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.25));
        let gives: &[(&[&str], _, _)] = &[
            (&["divided"], "light/b", 0.5),
            (&["divided"], "light/c", 0.25),
            (&["again"], "light/b", 0.5),
        ];
        let planted = Bench { mistakes: &[DIVIDED, AGAIN], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let divided = light::DIVIDED_BY_LIGHTS.name;
        assert_eq!(told(&diagnosis), [(divided, Degree::Named, 2)]);
    }

    #[test]
    fn one_mistake_that_is_wrong_alike_everywhere_and_mostly_by_as_much_is_looked_like() {
        let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.25));
        let told_where = |ratio| {
            let gives: &[(&[&str], _, _)] =
                &[(&["divided"], "light/b", 0.5), (&["divided"], "light/c", ratio)];
            let planted = Bench { mistakes: &[DIVIDED, AGAIN], gives };
            let diagnosis = diagnose_proven(&made.evidence(), &planted);
            let (cause, degree, cases) = told(&diagnosis)[0];
            (cause.to_owned(), degree, cases)
        };
        let divided = light::DIVIDED_BY_LIGHTS.name.to_owned();
        assert_eq!(told_where(0.4), (divided, Degree::LooksLike, 2));
        assert_eq!(told_where(1.4).1, Degree::DiffersHere, "to the other side");
    }

    #[test]
    fn two_mistakes_that_give_the_numbers_only_together_are_both_named() {
        let made = Made::new().with("bsdf/a", light(0.7)).with("light/b", light(0.4));
        let both: &[&str] = &["pi", "divided"];
        let gives = &[(both, "bsdf/a", 0.7), (both, "light/b", 0.4)];
        let planted = Bench { mistakes: &[PI, DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let names = [bsdf::WITHOUT_PI.name, light::DIVIDED_BY_LIGHTS.name];
        assert_eq!(told(&diagnosis), names.map(|name| (name, Degree::Named, 2)));
    }

    #[test]
    fn a_mistake_that_gives_the_numbers_of_two_causes_is_all_there_is() {
        let made = Made::new()
            .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
            .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"));
        let gives: &[(&[&str], _, _)] =
            &[(&["pi"], "bsdf/a", 1.5), (&["pi"], "light/b", 0.5), (&["divided"], "light/b", 0.5)];
        let planted = Bench { mistakes: &[PI, DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 2)]);
    }

    #[test]
    fn of_two_mistakes_that_give_the_numbers_of_a_cause_the_one_that_gives_more_is_told() {
        let made = Made::new()
            .with("light/b", light(1.5).because(&bsdf::WITHOUT_PI, "y"))
            .with("light/c", light(1.2));
        let gives: &[(&[&str], _, _)] = &[
            (&["pi"], "light/b", 1.5),
            (&["again"], "light/b", 1.5),
            (&["again"], "light/c", 1.2),
        ];
        let planted = Bench { mistakes: &[PI, AGAIN], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let again = integrator::EMISSION_AGAIN.name;
        assert_eq!(told(&diagnosis), [(again, Degree::Named, 2)]);
    }

    #[test]
    fn what_passes_with_a_named_mistake_does_not_follow_from_it() {
        let made = || {
            let pi = light(0.5).because(&bsdf::WITHOUT_PI, "x");
            let made = Made::new().with("bsdf/a", pi).with("light/b", light(0.9));
            let on = [Foundation::Diffuse];
            made.proving("bsdf/a", &on).resting("light/b", &on)
        };
        for (ratio, headlines) in [(0.7, 1), (1.0, 2)] {
            let gives: &[(&[&str], _, _)] =
                &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "light/b", ratio)];
            let planted = Bench { mistakes: &[PI], gives };
            assert_eq!(diagnose_proven(&made().evidence(), &planted).headlines.len(), headlines);
        }
    }

    #[test]
    fn what_only_informs_says_what_a_failure_looks_like() {
        let told_by = failing("the other way").because(&bsdf::WITHOUT_PI, "x");
        let made =
            Made::new().with("light/b", light(0.4)).with("bsdf/a", told_by).informing("bsdf/a");
        for (ratio, cause) in [(0.7, bsdf::WITHOUT_PI.name), (1.5, "")] {
            let gives: &[(&[&str], _, _)] = &[(&["pi"], "light/b", ratio)];
            let diagnosis = diagnose_proven(&made.evidence(), &Bench { mistakes: &[PI], gives });
            assert_eq!(told(&diagnosis)[0].0, cause);
            assert_ne!(told(&diagnosis)[0].1, Degree::Named);
        }
    }

    #[test]
    fn what_all_that_is_told_gives_together_is_no_further_mistake() {
        let made = Made::new()
            .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
            .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"))
            .with("light/c", light(0.7));
        let told_both: &[&str] = &["pi", "divided"];
        let gives: &[(&[&str], _, _)] = &[
            (&["pi"], "bsdf/a", 1.5),
            (&["divided"], "light/b", 0.5),
            (told_both, "light/c", 0.7),
            (&["pi", "divided", "again"], "light/c", 0.7),
        ];
        let planted = Bench { mistakes: &[PI, DIVIDED, AGAIN], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let names = [bsdf::WITHOUT_PI.name, light::DIVIDED_BY_LIGHTS.name];
        assert_eq!(told(&diagnosis), names.map(|name| (name, Degree::Named, 2)));
    }

    #[test]
    fn of_all_that_is_told_each_explains_what_it_is_needed_for() {
        let made = Made::new()
            .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
            .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"))
            .with("light/c", light(0.7))
            .with("light/d", light(0.6));
        let gives: &[(&[&str], _, _)] = &[
            (&["pi"], "bsdf/a", 1.5),
            (&["divided"], "light/b", 0.5),
            (&["pi", "divided"], "light/c", 0.7),
            (&["pi", "divided"], "light/d", 0.6),
            (&["divided"], "light/d", 0.6),
        ];
        let planted = Bench { mistakes: &[PI, DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let names = [(light::DIVIDED_BY_LIGHTS.name, 3), (bsdf::WITHOUT_PI.name, 2)];
        assert_eq!(told(&diagnosis), names.map(|(name, cases)| (name, Degree::Named, cases)));
    }

    #[test]
    fn in_the_dark_a_mistake_that_would_leave_light_elsewhere_is_not_told() {
        let dark = || light(0.0).because(&light::DIVIDED_BY_LIGHTS, "nothing arrives");
        let planted = |ratio| -> [(&[&str], _, f64); 3] {
            [
                (&["divided"], "light/b", 0.0),
                (&["divided"], "light/c", ratio),
                (&["divided"], "light/d", ratio),
            ]
        };
        let made = Made::new().with("light/b", dark()).with("light/c", light(0.0));
        let made = made.with("light/d", light(0.0));
        let of = |ratio| {
            let planted = Bench { mistakes: &[DIVIDED], gives: &planted(ratio) };
            told(&diagnose_proven(&made.evidence(), &planted))[0].0.to_owned()
        };
        assert_eq!(of(1.0), "");
        assert_eq!(of(0.0), light::DIVIDED_BY_LIGHTS.name, "dark there too");
    }

    #[test]
    fn the_only_mistake_in_sight_that_darkens_its_own_case_is_named() {
        let dark = || light(0.0).because(&light::DIVIDED_BY_LIGHTS, "nothing arrives");
        let lit = |count: usize| {
            let cases = ["light/c", "light/d", "light/e", "light/f"].into_iter().take(count);
            cases.fold(Made::new().with("light/b", dark()), |made, case| made.with(case, passing()))
        };
        let of_one: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.0)];
        let of_both: &[(&[&str], _, _)] = &[of_one[0], (&["again"], "light/b", 0.0)];
        let degree = |lit_beside, mistakes: &[Mistake], gives| {
            let planted = Bench { mistakes, gives };
            told(&diagnose_proven(&lit(lit_beside).evidence(), &planted))[0].1
        };
        assert_eq!(degree(4, &[DIVIDED], of_one), Degree::Named);
        assert_eq!(
            degree(4, &[DIVIDED, AGAIN], of_one),
            Degree::Named,
            "the other changes nothing"
        );
        assert_eq!(degree(4, &[DIVIDED, AGAIN], of_both), Degree::LooksLike);
        assert_eq!(degree(1, &[DIVIDED], of_one), Degree::LooksLike, "who knows what else is dark");
    }

    #[test]
    fn a_cause_whose_mistake_fails_more_that_passes_than_it_explains_is_not_told() {
        let halved = || light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved");
        let gives: &[(&[&str], _, _)] = &[
            (&["divided"], "light/b", 0.5),
            (&["divided"], "light/c", 0.5),
            (&["divided"], "light/d", 0.5),
            (&["divided"], "light/e", 0.5),
        ];
        let planted = Bench { mistakes: &[DIVIDED], gives };
        let others_are = |other: fn() -> Finding| {
            let made = Made::new().with("light/b", halved());
            let made = ["light/c", "light/d", "light/e"]
                .iter()
                .fold(made, |made, case| made.with(*case, other()));
            told(&diagnose_proven(&made.evidence(), &planted))[0].0.to_owned()
        };
        assert_eq!(others_are(passing), "");
        assert_eq!(others_are(|| light(1.5)), "");
        assert_eq!(others_are(|| light(0.5)), light::DIVIDED_BY_LIGHTS.name);
    }

    #[test]
    fn what_looks_like_the_cause_of_one_of_many_failures_is_not_told() {
        let shared = light(0.5).because(&light::DIVIDED_BY_LIGHTS, "x");
        let shared = shared.because(&integrator::EMISSION_AGAIN, "y");
        let few = Made::new().with("light/a", shared);
        let planted = Bench { mistakes: &[], gives: &[] };
        let told_of = |made: &Made| told(&diagnose_proven(&made.evidence(), &planted))[0].1;
        assert_eq!(told_of(&few), Degree::LooksLike);
        let others = ["b", "c", "d", "e", "f", "g", "h", "i"].map(|name| format!("light/{name}"));
        let many = others.iter().fold(few, |made, name| made.with(&name[..], light(0.3)));
        assert_eq!(told_of(&many), Degree::DiffersHere);
    }

    #[test]
    fn a_cause_above_what_is_wrong_by_itself_only_looks_like_it() {
        let halved = Mistake { components: Components::DIRECT_LIGHTING, ..DIVIDED };
        let sampler = Mistake {
            components: Components::LIGHT_SAMPLING,
            ..mistake("pdf", &light::LIGHT_PDF_PER_AREA, "light/samples")
        };
        let made = Made::new()
            .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved"))
            .with("light/samples", light(0.3));
        let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.5)];
        let degree = |mistakes: &[Mistake]| {
            let planted = Bench { mistakes, gives };
            told(&diagnose_proven(&made.evidence(), &planted))[0].1
        };
        assert_eq!(degree(&[halved]), Degree::Named);
        assert_eq!(degree(&[halved, sampler]), Degree::LooksLike);
    }

    #[test]
    fn what_no_rule_explains_and_the_mistake_of_a_cause_gives_is_of_that_cause() {
        let made = Made::new()
            .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved"))
            .with("light/c", light(0.7))
            .with("integrator/d", light(0.6));
        let gives: &[(&[&str], _, _)] =
            &[(&["divided"], "light/b", 0.5), (&["divided"], "integrator/d", 0.6)];
        let planted = Bench { mistakes: &[DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let divided = light::DIVIDED_BY_LIGHTS.name;
        assert_eq!(told(&diagnosis)[0], (divided, Degree::Named, 2));
        assert_eq!(diagnosis.unexplained, ["light/c"]);
    }

    #[test]
    fn of_many_mistakes_one_that_comes_to_a_single_number_only_looks_like_it() {
        let made = Made::new().with("bsdf/a", light(0.5)).with("light/b", light(0.5));
        let mistakes = [PI, DIVIDED, AGAIN];
        let gives: &[(&[&str], _, _)] = &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "light/b", 0.5)];
        let planted = Bench { mistakes: &mistakes, gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::LooksLike, 2)]);
    }

    #[test]
    fn patterns_of_lost_hits_that_contradict_each_other_are_told_as_lost_hits() {
        let skipped = failing("a").because(&bvh::SECOND_CHILD_SKIPPED, "x");
        let overwritten = failing("b").because(&bvh::RANGE_OVERWRITTEN, "y");
        let one = Made::new().with("bvh/a", skipped);
        let planted = Bench { mistakes: &[], gives: &[] };
        let alone = diagnose_proven(&one.evidence(), &planted);
        assert_eq!(told(&alone), [(bvh::SECOND_CHILD_SKIPPED.name, Degree::Named, 1)]);
        let both = one.with("bvh/b", overwritten);
        let diagnosis = diagnose_proven(&both.evidence(), &planted);
        assert_eq!(told(&diagnosis), [(bvh::HITS_LOST.name, Degree::Named, 2)]);
    }

    #[test]
    fn a_mistake_of_a_lower_component_that_alone_gives_the_numbers_is_looked_like() {
        let made = Made::new().with("bsdf/a", light(0.5)).with("bsdf/b", light(0.7));
        let gives: &[(&[&str], _, _)] = &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "bsdf/b", 0.7)];
        let planted = Bench { mistakes: &[PI], gives };
        let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(Components::PATH));
        let pi = bsdf::WITHOUT_PI.name;
        assert_eq!(told(&ranked.told()), [(pi, Degree::LooksLike, 2)]);
    }

    #[test]
    fn a_mistake_of_the_path_that_direct_lighting_mends_is_looked_like_if_its_own_case_fails() {
        let of_path = |caught_by| Mistake {
            components: Components::PATH,
            ..mistake("pi", &bsdf::WITHOUT_PI, caught_by)
        };
        let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.7));
        let gives: &[(&[&str], _, _)] = &[(&["pi"], "light/b", 0.5), (&["pi"], "light/c", 0.7)];
        let degree = |mistake: Mistake, broken: Components| {
            let planted = Bench { mistakes: &[mistake], gives };
            let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(broken));
            told(&ranked.told())[0].1
        };
        let direct = Components::DIRECT_LIGHTING;
        assert_eq!(degree(of_path("light/b"), direct), Degree::LooksLike);
        assert_eq!(degree(of_path("light/b"), Components::BSDF), Degree::DiffersHere);
    }

    #[test]
    fn what_the_traversal_mends_is_no_mistake_of_a_pixel() {
        let pixel = Mistake { components: Components::PIXEL, ..PI };
        let finding = || light(0.5).because(&bsdf::WITHOUT_PI, "x");
        let made = Made::new().with("bsdf/a", finding());
        let planted = Bench { mistakes: &[pixel], gives: &[(&["pi"], "bsdf/a", 0.5)] };
        let of = |made_in| told(&proven(&made.evidence(), &planted, made_in).told())[0].1;
        assert_eq!(of(MadeIn::Mended(Components::TRAVERSAL)), Degree::DiffersHere);
        assert_eq!(of(MadeIn::Mended(Components::PIXEL)), Degree::Named);
    }

    #[test]
    fn a_factor_of_images_that_the_direct_light_mends_is_none_of_the_film() {
        use crate::cause::image;
        let factor = || Finding {
            measures: Vec::new(),
            ..light(0.5).because_in_size(&image::FACTOR, "half", Some([0.49, 0.51]))
        };
        let made = Made::new().with("image/a", factor()).with("image/b", factor());
        let planted = Bench { mistakes: &[], gives: &[] };
        let of = |made_in| told(&proven(&made.evidence(), &planted, made_in).told())[0].1;
        assert_eq!(of(MadeIn::Mended(Components::DIRECT_LIGHTING)), Degree::DiffersHere);
        assert_eq!(of(MadeIn::Mended(Components::PIXEL)), Degree::Named);
    }

    #[test]
    fn a_mistake_whose_own_case_passes_is_not_there() {
        let made = Made::new().with("light/c", light(0.5)).with("light/b", passing());
        let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/c", 0.5)];
        let planted = Bench { mistakes: &[DIVIDED], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)]);
    }

    #[test]
    fn a_mistake_of_another_component_than_the_one_that_mends_only_looks_like_it() {
        let finding = light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y");
        let made = Made::new().with("light/b", finding).with("light/c", light(0.25));
        let gives: &[(&[&str], _, _)] =
            &[(&["divided"], "light/b", 0.5), (&["divided"], "light/c", 0.25)];
        let planted = Bench { mistakes: &[DIVIDED], gives };
        let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(Components::PATH));
        let divided = light::DIVIDED_BY_LIGHTS.name;
        assert_eq!(told(&ranked.told()), [(divided, Degree::LooksLike, 2)]);
    }
}
