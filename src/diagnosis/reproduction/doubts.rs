//! What planted mistakes say against what is suspected: what they contradict is not told, and what they leave a doubt of
//! only looks like it.

use super::likeness::Likeness;
use super::{
    MadeIn, Mistake, Proof, ROUNDS, Refuted, is_of_one_part, likenesses, quickest, siblings,
};
use crate::cause::{self, Cause, bvh};
use crate::contract::Components;
use crate::diagnosis::rank::Ranked;
use crate::diagnosis::{Ending, Headline, Observation, Suspicion, look_without};
use std::collections::BTreeSet;

/// Cases of a cause that may contradict it one by one: what it does not explain may be another mistake of the same lines.
const CONTRADICTING: usize = 16;
/// Sets of one mistake of each cause that are asked what all causes give together.
const TOGETHER: usize = 8;

impl<'a> Proof<'a> {
    /// What is told after everything that is contradicted has made room for the next suspicion.
    pub(super) fn uncontradicted(&self) -> (Refuted, Ranked) {
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
    pub(super) fn doubted(&self, refuted: &Refuted, found: &[Suspicion]) -> Ranked {
        let mut told = look_without(self.evidence, refuted, found.to_vec());
        let is_against = |one: &&Headline| {
            self.is_outnumbered(one, &told)
                || self.is_built_on_what_is_wrong(one, &told)
                || self.passes_its_own(one) && !self.is_needed(one)
        };
        let against: BTreeSet<_> =
            told.with_cause().filter(is_against).map(|one| one.cause.clone()).collect();
        let causes: BTreeSet<_> = found.iter().map(|suspicion| suspicion.cause.name).collect();
        let stops_in_its_build = self.stops_in_its_build();
        let is_alone = |one: &&Headline| self.is_the_only_one_in_sight(one, &told);
        let alone: BTreeSet<_> =
            told.with_cause().filter(is_alone).map(|one| one.cause.clone()).collect();
        told.assure(|headline| alone.contains(&headline.cause));
        told.doubt(|headline| {
            let is_proven = causes.contains(&headline.cause[..])
                || alone.contains(&headline.cause)
                || self.is_needed(headline);
            let is_unsure = || self.is_dark_alone(headline) || self.is_of_another_size(headline);
            let is_doubtful = self.is_made_elsewhere(headline)
                || against.contains(&headline.cause)
                || stops_in_its_build;
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
    pub(super) fn unfounded(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let mut unfounded = self.outnumbered(told);
        unfounded.extend(self.superfluous(told));
        let unproven = self.unproven_beside(told).into_iter();
        unfounded.extend(unproven.filter(|(cause, _)| !suspected.contains(*cause)));
        unfounded.extend(self.lost_in_a_crowd(told));
        unfounded.extend(self.lost_among_symptoms(told));
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
        let made = self.components_of(headline, cause);
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

    /// Where its mistake is made: what cannot be planted, where others of its subject are.
    fn components_of(&self, headline: &Headline, cause: &Cause) -> Components {
        let made_by = |is_like: &dyn Fn(&Cause) -> bool| -> Components {
            let like = self.planted.mistakes().iter().filter(|mistake| is_like(mistake.cause));
            like.map(|mistake| mistake.components).collect()
        };
        let planted = made_by(&|other| other.name == headline.cause);
        match () {
            () if cause::is_of_the_film_alone(cause) => Components::PIXEL,
            () if !planted.is_empty() => planted,
            // Some of the mistakes of a BVH are made by the shapes that it asks.
            () if cause::is_of_bvh(cause) => Components::BOX_TEST | Components::TRAVERSAL,
            () => made_by(&|other| cause::are_of_one_component(cause, other)),
        }
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
    pub(super) fn following(&self, ranked: &Ranked) -> Refuted {
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

    /// A cause whose numbers all others that are told give together, whichever mistakes theirs are: nothing takes it. Of
    /// several the one that explains the least.
    fn superfluous(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().map(|one| (one, self.likely(one))).collect();
        // That all others leave it dark where it is dark is enough here: they are told already.
        let is_superfluous = |(one, _): &&(&Headline, Vec<Mistake>)| {
            let others = beside(one, &told);
            let cases = self.quickest(&one.explains);
            let is_asked = !others[0].is_empty() && !cases.is_empty();
            let is_given = || {
                let answers = self.compare(&others, &cases);
                answers.iter().any(|of_set| of_set.iter().all(|one| one.is_reproduced()))
            };
            is_asked && !self.is_needed(one) && is_given()
        };
        let superfluous = told.iter().filter(is_superfluous).map(|(one, _)| *one);
        superfluous.min_by_key(|one| one.explains.len()).and_then(all_of).unwrap_or_default()
    }

    /// A cause whose numbers all others that are told give together, and not with it, whichever mistakes theirs are. Of several
    /// the one that explains the least.
    pub(super) fn needless(&self, told: &Ranked) -> Option<String> {
        let told: Vec<_> = told.with_cause().map(|one| (one, self.likely(one))).collect();
        let is_needless = |(one, own): &&(&Headline, Vec<Mistake>)| {
            let others = beside(one, &told);
            let cases = self.quickest(&one.explains);
            let is_asked = !own.is_empty() && !others[0].is_empty() && !cases.is_empty();
            is_asked && !self.is_needed(one) && self.give_without(&others, own, &cases)
        };
        let needless = told.iter().filter(is_needless).map(|(one, _)| *one);
        Some(needless.min_by_key(|one| one.explains.len())?.cause.clone())
    }

    /// Whether one of the sets gives the numbers of all `cases`, and other numbers, if any, beside each of `own`.
    fn give_without(
        &self,
        sets: &[Vec<Mistake>],
        own: &[Mistake],
        cases: &[&Observation<'a>],
    ) -> bool {
        let answers = self.compare(sets, cases);
        let is_given = |of_set: &[Likeness]| of_set.iter().all(|one| *one == Likeness::Same);
        let giving = sets.iter().zip(&answers).filter(|(_, of_set)| is_given(of_set));
        let giving: Vec<_> = giving.map(|(set, _)| set.clone()).collect();
        let beside =
            giving.iter().flat_map(|set| own.iter().map(|one| [&set[..], &[*one]].concat()));
        let possible: Vec<_> = beside.filter(|set| self.planted.may_be_together(set)).collect();
        let is_other = |one: &Likeness| matches!(one, Likeness::Alike | Likeness::Other);
        let with = self.compare(&possible, cases);
        !giving.is_empty() && with.iter().all(|of_set| of_set.iter().any(is_other))
    }

    /// Causes that speak from dark answers alone, in a part where as much else is dark that is right with their mistake,
    /// or among twice as much in all parts: one mistake is all there is. Light that does not arrive is no such crowd
    /// for what functions answer.
    fn lost_in_the_dark(&self, ranked: &Ranked) -> Refuted {
        let told: Vec<_> = ranked.with_cause().collect();
        let explains = |one: &Headline, seen: &Observation<'_>| {
            one.explains.iter().any(|case| case == seen.case)
        };
        let dark: Vec<_> = self.evidence.failures().filter(|seen| seen.is_dark()).collect();
        let is_free = |seen: &&&Observation<'_>| !told.iter().any(|one| explains(one, seen));
        let free: Vec<_> = dark.iter().filter(is_free).collect();
        let is_lost = |one: &&&Headline| {
            let own: Vec<_> = dark.iter().filter(|seen| explains(one, seen)).collect();
            let may_crowd = own.iter().any(|seen| seen.is_about_light());
            let crowd = free.iter().filter(|seen| may_crowd || !seen.is_about_light());
            let free: Vec<_> = crowd.map(|seen| seen.case.to_owned()).collect();
            let of_part: Vec<_> =
                free.iter().filter(|case| is_of_one_part(one, case)).cloned().collect();
            let is_lost_in = |others: &[String], least: usize| {
                others.len() >= least && self.are_right(one, others)
            };
            own.len() == one.explains.len()
                && (is_lost_in(&of_part, own.len())
                    || is_lost_in(&free, siblings::OUTNUMBERED * own.len()))
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
    pub(super) fn is_needed(&self, headline: &Headline) -> bool {
        let seen =
            headline.explains.iter().filter_map(|case| self.evidence.failure_of(case)?.finding);
        let mut clues = seen.flat_map(|finding| &finding.clues);
        clues.any(|clue| clue.beside && clue.cause == headline.cause)
    }

    /// Whether one mistake gives the numbers of every case of `headline` that is tried.
    pub(super) fn is_reproduced(&self, mistake: Mistake, headline: &Headline) -> bool {
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

    /// Whether all that it explains is dark light, as many mistakes make it.
    fn is_dark_alone(&self, headline: &Headline) -> bool {
        let seen = headline.explains.iter().filter_map(|case| self.evidence.failure_of(case));
        let mut seen = seen.peekable();
        seen.peek().is_some() && seen.all(|seen| seen.is_about_light() && seen.is_dark())
    }

    /// Whether a build stops though the bench finds the hits: what the core prepares for all its components is broken, and none
    /// of them can be judged without it.
    fn stops_in_its_build(&self) -> bool {
        let stops = |seen: &Observation<'_>| match seen.ending {
            Some(Ending::Crashed { during, .. } | Ending::TimedOut { during }) => {
                during == "build" && seen.with.contains(Components::TRAVERSAL)
            }
            _ => false,
        };
        self.evidence.all_failures().any(stops)
    }

    /// Causes of light that is lost or too weak, among far more that is dark and right with their mistakes.
    pub(super) fn lost_among_the_dark(&self, told: &Ranked) -> Refuted {
        let lost = self.lost_in_the_dark(told);
        lost.into_iter().chain(self.dim_among_the_dark(told, &BTreeSet::new())).collect()
    }

    /// What the search has found of darkness alone, and what is not the only one in sight.
    fn dark_and_not_alone(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let found = told.with_cause().filter(|one| !suspected.contains(&one.cause));
        let dark = found.filter(|one| self.is_dark_alone(one));
        let unsure = dark.filter(|one| !self.is_the_only_one_in_sight(one, told));
        unsure.filter_map(all_of).flatten().collect()
    }

    /// Causes of light that is too weak, but for those that rules suspected, where far more cases have none and their mistakes
    /// leave them right: whatever takes that light takes this, too.
    fn dim_among_the_dark(&self, told: &Ranked, suspected: &BTreeSet<String>) -> Refuted {
        let explained =
            |case: &str| told.with_cause().any(|one| one.explains.iter().any(|own| own == case));
        let dark = self.evidence.failures().filter(|seen| seen.is_about_light() && seen.is_dark());
        let dark = dark.filter(|seen| !explained(seen.case)).map(|seen| seen.case.to_owned());
        let dark: Vec<_> = dark.collect();
        let is_dim = |one: &Headline| {
            let mut seen = one.explains.iter().filter_map(|case| self.evidence.failure_of(case));
            seen.all(|seen| seen.is_about_light() && seen.is_too_weak())
        };
        let is_lost = |one: &&Headline| {
            let least = siblings::OUTNUMBERED * one.explains.len().max(1);
            dark.len() >= least && self.are_right(one, &dark)
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
}

/// Sets of one mistake of each cause that is told beside this one.
fn beside(one: &Headline, told: &[(&Headline, Vec<Mistake>)]) -> Vec<Vec<Mistake>> {
    let others = told.iter().filter(|(other, _)| other.cause != one.cause);
    one_of_each(others.map(|(_, mistakes)| &mistakes[..]))
}

/// Sets of one mistake out of each of these, and no more than `TOGETHER` of them.
fn one_of_each<'m>(of: impl Iterator<Item = &'m [Mistake]>) -> Vec<Vec<Mistake>> {
    let beside = |sets: Vec<Vec<Mistake>>, mistakes: &[Mistake]| {
        let with_each = |set: Vec<Mistake>| match mistakes {
            [] => vec![set],
            _ => mistakes.iter().map(|one| [&set[..], &[*one]].concat()).collect(),
        };
        sets.into_iter().flat_map(with_each).take(TOGETHER).collect()
    };
    of.fold(vec![Vec::new()], beside)
}

/// All that a cause explains, against it.
pub(super) fn all_of(headline: &Headline) -> Option<Refuted> {
    Some(refuted(cause::find(&headline.cause)?, &headline.explains))
}

pub(super) fn refuted(cause: &'static Cause, cases: &[String]) -> Refuted {
    cases.iter().map(|case| (cause.name, case.clone())).collect()
}
