//! Which planted mistakes are asked, in which cases, and how closely.

use super::likeness::{Likeness, likeness};
use super::{CASES, Mistake, Proof, Question};
use crate::case::Subject;
use crate::checks::Finding;
use crate::diagnosis::rank::Ranked;
use crate::diagnosis::{Degree, Headline, Observation};
use std::slice;

/// Of cases that ask the bench's own core for more, few are tried: a second of a processor, about (`contract::Work`).
const COSTLY: u64 = 15_000_000;
/// Sets of mistakes that are put to a case to learn what it asks of them. One says little: of two in one case one took a
/// fourteenth of the other (docs/decisions/0015, 35).
pub(super) const SAMPLED: usize = 2;

impl<'a> Proof<'a> {
    /// A mistake of each cause that is named.
    pub(super) fn named(&self, told: &Ranked) -> Vec<Mistake> {
        let named = told.with_cause().filter(|headline| headline.degree == Degree::Named);
        named.filter_map(|headline| self.likeliest(headline)).collect()
    }

    /// Of the planted mistakes of a headline's cause the one that gives its numbers, or else the first: a count is one too many
    /// or one too few.
    pub(super) fn likeliest(&self, headline: &Headline) -> Option<Mistake> {
        self.likely(headline).first().copied()
    }

    /// The planted mistake of a headline's cause that gives its numbers, or all of them where none does.
    pub(super) fn likely(&self, headline: &Headline) -> Vec<Mistake> {
        let all: Vec<_> = self.of(headline).collect();
        if all.len() < 2 {
            return all;
        }
        let sets = all.iter().map(|mistake| vec![*mistake]).collect();
        let likely = self.likely_at_first(sets, &self.quickest(&headline.explains));
        let mut likely = likely.into_iter().map(|set| set[0]);
        likely.find(|one| self.is_reproduced(*one, headline)).map_or(all, |one| vec![one])
    }

    /// Those sets that a first look at each case does not tell from the core.
    pub(super) fn likely_at_first(
        &self,
        mut sets: Vec<Vec<Mistake>>,
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Mistake>> {
        for seen in self.cheapest_first(&sets, cases) {
            let mut likely = self.are_likely_at_first(&sets, seen).into_iter();
            sets.retain(|_| likely.next() == Some(true));
        }
        sets
    }

    /// Which sets a first look at a case does not tell from the core.
    pub(super) fn are_likely_at_first(
        &self,
        sets: &[Vec<Mistake>],
        seen: &Observation<'a>,
    ) -> Vec<bool> {
        let cases = slice::from_ref(&seen);
        let at_first = likenesses(cases, &self.glimpsed(sets, cases));
        at_first.into_iter().map(|of_set| of_set[0].may_be_reproduced()).collect()
    }

    /// The planted mistakes of a headline's cause.
    pub(super) fn of(&self, headline: &Headline) -> impl Iterator<Item = Mistake> + use<'a> {
        let name = headline.cause.clone();
        self.planted.mistakes().iter().copied().filter(move |mistake| mistake.cause.name == name)
    }

    /// Mistakes that may be made in what is the core's own, whose own cases fail here.
    pub(super) fn in_sight(&self) -> Vec<Mistake> {
        self.failing_alike(|mistake| self.made_in.may_be(mistake.components))
    }

    /// Those of the `wanted` mistakes whose own cases fail here, asked of what is the core's own. Where images alone fail,
    /// those too whose own cases cannot be asked: an image tells by its parts which it is.
    pub(super) fn failing_alike(&self, wanted: impl Fn(&Mistake) -> bool) -> Vec<Mistake> {
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

    pub(super) fn fails_images_alone(&self) -> bool {
        let answered = |seen: &Observation<'_>| seen.ending.is_none();
        self.evidence.failures().all(|seen| seen.is_about(Subject::Image))
            && self.evidence.failures().any(answered)
    }

    /// The quickest of `cases` whose numbers can be compared.
    pub(super) fn quickest(&self, cases: &[String]) -> Vec<&'a Observation<'a>> {
        quickest(cases.iter().filter_map(|case| self.evidence.failure_of(case)), CASES)
    }

    /// Those first that ask little of some of these sets, where there are many: few are left for the others. What a case asked
    /// of the core says nothing of that: a gross error ends it early, and what passes it is asked all.
    pub(super) fn cheapest_first<'s>(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&'s Observation<'a>],
    ) -> Vec<&'s Observation<'a>> {
        if sets.len() <= CASES || cases.len() < 2 || self.fails_images_alone() {
            return cases.to_vec();
        }
        let price = |(place, seen): (usize, &&'s Observation<'a>)| -> u64 {
            let some = sample(sets, place);
            self.glimpsed(&some, slice::from_ref(seen));
            let question = |set| question(set, seen, is_noisy(seen));
            some.iter().map(|set| self.planted.price(&question(set))).sum()
        };
        let prices = cases.iter().enumerate().map(price);
        let mut priced: Vec<_> = prices.zip(cases.iter().copied()).collect();
        priced.sort_by_key(|(price, _)| *price);
        priced.into_iter().map(|(_, seen)| seen).collect()
    }

    /// For each set of mistakes, how it compares in each case.
    pub(super) fn compare(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Likeness>> {
        likenesses(cases, &self.planted(sets, cases))
    }

    /// For each set of mistakes, what comes of each case.
    pub(super) fn planted(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        self.asked(sets, cases, |_| false)
    }

    /// The same, no closer than it takes to see what the core fails by: enough to speak for a mistake or against it, and not
    /// for what its numbers are alone.
    pub(super) fn weighed(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        self.asked(sets, cases, |seen| self.planted.is_seen_roughly(seen.case))
    }

    /// The same at a first look, where that takes less: of numbers that are known within their noise.
    pub(super) fn glimpsed(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Option<Finding>>> {
        self.asked(sets, cases, is_noisy)
    }

    pub(super) fn asked(
        &self,
        sets: &[Vec<Mistake>],
        cases: &[&Observation<'a>],
        roughly: impl Fn(&Observation<'_>) -> bool,
    ) -> Vec<Vec<Option<Finding>>> {
        let of_set = |set: &Vec<Mistake>| -> Vec<_> {
            cases.iter().map(|seen| question(set, seen, roughly(seen))).collect()
        };
        let questions: Vec<_> = sets.iter().flat_map(of_set).collect();
        let mut answers = self.planted.ask(&questions).into_iter();
        sets.iter().map(|_| answers.by_ref().take(cases.len()).collect()).collect()
    }
}

/// Some of the sets, others for each place, and as many: neighbours in the list of mistakes are alike.
pub(super) fn sample(sets: &[Vec<Mistake>], place: usize) -> Vec<Vec<Mistake>> {
    let apart = sets.len() / SAMPLED;
    let numbers = (0..SAMPLED).map(|number| (place + number * apart) % sets.len());
    numbers.map(|number| sets[number].clone()).collect()
}

/// What the core was asked in a case, of these mistakes.
fn question<'q>(set: &[Mistake], seen: &Observation<'q>, roughly: bool) -> Question<'q> {
    Question { mistakes: set.to_vec(), case: seen.case, with: seen.with, roughly }
}

/// Whether its numbers are known within their noise.
fn is_noisy(seen: &Observation<'_>) -> bool {
    let mut measures = seen.finding.into_iter().flat_map(|finding| &finding.measures);
    measures.any(|measure| measure.interval.is_some())
}

/// How the answers of each set of mistakes compare, case by case.
pub(super) fn likenesses(
    cases: &[&Observation<'_>],
    answers: &[Vec<Option<Finding>>],
) -> Vec<Vec<Likeness>> {
    let of_case = |(seen, planted): (&&Observation<'_>, &Option<Finding>)| match planted {
        Some(planted) => likeness(seen.finding, planted),
        None => Likeness::Unknown,
    };
    answers.iter().map(|of_set| cases.iter().zip(of_set).map(of_case).collect()).collect()
}

/// Those that ask the least, and few that ask for much: what it takes is known to whoever asks, and ends the asking.
pub(super) fn quickest<'s, 'a: 's>(
    seen: impl Iterator<Item = &'s Observation<'a>>,
    count: usize,
) -> Vec<&'s Observation<'a>> {
    let mut seen: Vec<_> = seen.collect();
    seen.sort_by_key(|seen| seen.work);
    let cheap = seen.partition_point(|seen| seen.work <= COSTLY);
    seen.truncate(count.min(cheap.max(CASES)));
    seen
}

/// Whether `case` is about what the headline's are about.
pub(super) fn is_of_one_part(headline: &Headline, case: &str) -> bool {
    headline.explains.iter().any(|own| Subject::of_case(own) == Subject::of_case(case))
}
