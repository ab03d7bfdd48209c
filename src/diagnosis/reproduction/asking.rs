//! Which planted mistakes are asked, in which cases, and how closely.

use super::likeness::{Likeness, likeness};
use super::{CASES, Mistake, Proof, Question};
use crate::case::Subject;
use crate::checks::Finding;
use crate::diagnosis::rank::Ranked;
use crate::diagnosis::{Degree, Headline, Observation};

/// Of cases that ask the bench's own core for more, few are tried: a second of a processor, about (`contract::Work`).
const COSTLY: u64 = 15_000_000;

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
        let is_noisy = |seen: &Observation<'_>| {
            let mut measures = seen.finding.into_iter().flat_map(|finding| &finding.measures);
            measures.any(|measure| measure.interval.is_some())
        };
        self.asked(sets, cases, is_noisy)
    }

    pub(super) fn asked(
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
