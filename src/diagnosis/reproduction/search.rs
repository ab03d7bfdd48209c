//! Mistakes that give the numbers of what is suspected and of what no rule knows, alone, beside what is told, or in sets.

use super::composition::{self, Seen};
use super::likeness::{Likeness, by_chance};
use super::{
    CASES, MadeIn, Mistake, Proof, Refuted, is_of_one_part, likenesses, quickest, siblings,
};
use crate::checks::Finding;
use crate::contract::Components;
use crate::diagnosis::rank::Ranked;
use crate::diagnosis::{Degree, Headline, Observation, Suspicion};
use std::collections::{BTreeMap, BTreeSet};
use std::{ptr, slice};

/// Mistakes of which pairs are tried.
const PAIRED: usize = 8;
/// Sets of several mistakes that are tried, and the cases that they have to reproduce.
const FORETOLD: usize = 12;
const PROVING: usize = 8;
/// Failures without a cause that are put to each named mistake at the end, the quickest.
const ELSEWHERE: usize = 8;
/// Fewer sets of mistakes may come to the same numbers by chance, where one of them is named.
const BY_CHANCE: f64 = 0.1;

impl<'a> Proof<'a> {
    /// The causes whose mistake gives the same numbers, with that for evidence: in their own cases, for those that are named
    /// and those of which every rival is refuted, and in whatever else has no cause.
    pub(super) fn confirmed(&self, ranked: &Ranked, refuted: &Refuted) -> Vec<Suspicion> {
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
    pub(super) fn reproduced(&self, ranked: &Ranked, given: &[String]) -> Vec<Suspicion> {
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
    pub(super) fn informed(&self, ranked: &Ranked) -> Vec<Suspicion> {
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
    pub(super) fn rivals(&self, headline: &Headline, ranked: &Ranked) -> Vec<Suspicion> {
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
    pub(super) fn of_all(&self, told: &[Mistake], cases: &[&Observation<'a>]) -> Vec<Suspicion> {
        if told.len() < 2 || cases.is_empty() {
            return Vec::new();
        }
        let found = self.of_sets(&[told.to_vec()], cases, &[]);
        self.where_needed(found, told, cases)
    }

    /// Failures without a cause of which all that is named together gives the numbers, or that it leaves as dark as they are;
    /// if it gives all that are asked, and not only darkness, all of them.
    pub(super) fn given_by_all(&self, told: &Ranked) -> Vec<String> {
        let named = self.named(told);
        let left: Vec<_> = told.differing().cloned().collect();
        let failures = left.iter().filter_map(|case| self.evidence.failure_of(case));
        let asked = quickest(failures, siblings::FAILED);
        if named.is_empty() || asked.is_empty() {
            return Vec::new();
        }
        let answers = self.compare(&[named], &asked).remove(0);
        let gives_numbers = answers.contains(&Likeness::Same);
        // Nothing else need take a light that what is named takes.
        let is_given = |(seen, of): &(&&Observation<'_>, Likeness)| {
            *of == Likeness::Same || *of == Likeness::Unsized && seen.is_dark()
        };
        let given = asked.iter().zip(answers).filter(is_given);
        let given: Vec<_> = given.map(|(seen, _)| seen.case.to_owned()).collect();
        if gives_numbers && given.len() == asked.len() { left } else { given }
    }

    /// Cases with NaN, infinite or negative numbers that all that is named gives together, too.
    pub(super) fn symptoms_given_by_all(&self, told: &Ranked) -> Vec<String> {
        let named = self.named(told);
        let is_given = |symptom: &&Headline| {
            let cases = self.quickest(&symptom.explains);
            let answers = self.compare(slice::from_ref(&named), &cases).remove(0);
            !cases.is_empty() && answers.into_iter().all(|of| of == Likeness::Same)
        };
        let given = told.symptoms().filter(|_| !named.is_empty()).filter(is_given);
        given.flat_map(|symptom| &symptom.explains).cloned().collect()
    }

    /// Failures without a cause that have the numbers of a named mistake where its component is the core's own, though they
    /// asked the bench for it or were looked at for another: the core has the mistake in that place, too.
    pub(super) fn made_again(&self, told: &Ranked) -> Vec<(&'static str, Vec<String>)> {
        let named = self.named(told);
        let of_mistake = |mistake: &Mistake| {
            let failures = told.differing().filter_map(|case| self.evidence.failure_of(case));
            let own = |seen: &Observation<'a>| Observation {
                with: seen.with - mistake.components,
                ..seen.clone()
            };
            let own: Vec<_> = quickest(failures, ELSEWHERE).into_iter().map(own).collect();
            let asked: Vec<_> = own.iter().collect();
            let answers = self.compare(&[vec![*mistake]], &asked).remove(0);
            let given = asked.iter().zip(answers).filter(|(_, of)| *of == Likeness::Same);
            let given: Vec<_> = given.map(|(seen, _)| *seen).collect();
            let is_clear = by_chance(&given) * (named.len() as f64) < BY_CHANCE;
            let cases = given.iter().map(|seen| seen.case.to_owned()).collect();
            is_clear.then_some((mistake.cause.name, cases))
        };
        named.iter().filter_map(of_mistake).collect()
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
    pub(super) fn fitting<'s>(
        &self,
        sets: &'s [Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<&'s Vec<Mistake>> {
        let mut fitting: Vec<_> = sets.iter().map(|set| (set, false)).collect();
        let tried = |fitting: &[(&Vec<Mistake>, bool)]| -> Vec<_> {
            fitting.iter().map(|(set, _)| (*set).clone()).collect()
        };
        // A first look leaves few for the second.
        for seen in self.cheapest_first(sets, cases) {
            if fitting.len() > CASES {
                let mut likely = self.are_likely_at_first(&tried(&fitting), seen).into_iter();
                fitting.retain(|_| likely.next() == Some(true));
            }
            let answers = self.compare(&tried(&fitting), &[seen]).into_iter().map(|of| of[0]);
            let fits = fitting.into_iter().zip(answers).filter(|(_, of)| of.is_reproduced());
            fitting =
                fits.map(|((set, is_sized), of)| (set, is_sized || of == Likeness::Same)).collect();
        }
        fitting.into_iter().filter(|(_, is_sized)| *is_sized).map(|(set, _)| set).collect()
    }
}

/// Whether light is wrong in it, channel by channel.
fn is_of_light(seen: &Observation<'_>) -> bool {
    let wrong = seen.finding.into_iter().flat_map(Finding::failed_measures);
    wrong.filter(|measure| measure.channel.is_some()).count() > 0
}

/// Pairs of the first `mistakes`: what they do together need not follow from what each does alone.
pub(super) fn pairs(mistakes: &[Mistake]) -> Vec<Vec<Mistake>> {
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
pub(super) fn degree(fitting: usize, tried: usize, cases: &[&Observation<'_>]) -> Option<Degree> {
    let by_chance = tried as f64 * by_chance(cases);
    let is_clear = by_chance < BY_CHANCE;
    let degree = Degree::of_one_among(if is_clear { fitting } else { 2 });
    (fitting <= 2 && by_chance <= 1.0).then_some(degree)
}

fn wrong_in_the_same_places(before: &str, together: &str, cases: &str) -> String {
    format!(
        "{before}the bench's own core with this mistake{together} is wrong in the same places in {cases}"
    )
}

/// What a mistake of `set` is planted with.
pub(super) fn together(set: &[Mistake]) -> &'static str {
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
