//! What the mistake of a cause makes of the cases beside those that it explains: where it gives their numbers too, it
//! explains them; where it fails what the core passes, or fails it otherwise, something else is wrong.

use super::doubts::{all_of, refuted};
use super::likeness::{Likeness, breaks_otherwise, hardly_explains, likeness};
use super::{CASES, Mistake, Proof, Refuted, is_of_one_part, quickest};
use crate::cause;
use crate::checks::Finding;
use crate::contract::Components;
use crate::diagnosis::rank::Ranked;
use crate::diagnosis::{Degree, Headline, Observation};
use crate::stats::Verdict;
use std::slice;

/// Failures without a cause that are put to each, the quickest.
pub(super) const FAILED: usize = 16;
/// Cases of its part that passed and are put to it, the quickest.
const PASSED: usize = 6;
/// A cause is not told if so many times more speaks against it than for it, and no less than this many cases.
pub(super) const OUTNUMBERED: usize = 2;
const LEAST_AGAINST: usize = 2;
/// The case that was written for a mistake speaks against it as loud as so many others.
const OWN_CASE: usize = 2;
/// So many cases of its part that the core passes speak for a mistake that passes them too.
const AGREEING: usize = 4;
/// What looks like a cause and explains one of so many failures of its part says little.
const CROWD: usize = 5;

/// What was asked beside the cases of a cause.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Siblings {
    /// Failures of which its mistake gives the numbers.
    same: Vec<String>,
    /// How many it fails otherwise than the core does.
    against: usize,
    /// How many it fails in the same places, by another size.
    of_another_size: usize,
    /// How many it passes as the core does.
    agreeing: usize,
    /// How many there was no time for.
    unasked: usize,
}

impl Siblings {
    /// Whether nothing speaks against a cause, and enough was asked to say so.
    fn stand_by(&self) -> bool {
        self.against + self.of_another_size == 0 && self.agreeing >= AGREEING
    }

    fn doubt(&self, headline: &Headline) -> bool {
        self.against + self.of_another_size > headline.explains.len() + self.same.len()
    }

    fn refute(&self, headline: &Headline) -> bool {
        let against = self.against >= OUTNUMBERED * (headline.explains.len() + self.same.len());
        against && self.against >= LEAST_AGAINST
    }
}

impl<'a> Proof<'a> {
    /// Causes that far more of their part speaks against than for.
    pub(super) fn outnumbered(&self, ranked: &Ranked) -> Refuted {
        let told = ranked.with_cause().filter(|headline| !self.is_needed(headline));
        let told = told.filter(|headline| self.siblings(headline, ranked).refute(headline));
        told.filter_map(all_of).flatten().collect()
    }

    /// Causes that nothing beside their own cases was asked of, though there is something.
    pub(super) fn unproven_beside(&self, ranked: &Ranked) -> Refuted {
        let is_unproven = |headline: &&Headline| {
            let Siblings { same, against, of_another_size, unasked, .. } =
                self.siblings(headline, ranked);
            let is_unasked = same.is_empty() && against + of_another_size == 0 && unasked > 0;
            // More cases than one mistake is tried on are proof enough.
            is_unasked && headline.explains.len() <= CASES
        };
        ranked.with_cause().filter(is_unproven).filter_map(all_of).flatten().collect()
    }

    /// Likenesses that explain next to nothing of what fails in their part.
    pub(super) fn lost_in_a_crowd(&self, ranked: &Ranked) -> Refuted {
        let is_lost = |told: &&Headline| {
            let others = ranked.without_cause(told).filter(|case| is_of_one_part(told, case));
            let (all, own) = (told.explains.len() + others.count(), CROWD * told.explains.len());
            let is_alone = || self.siblings(told, ranked).same.is_empty();
            told.degree == Degree::LooksLike && all >= own && is_alone()
        };
        ranked.with_cause().filter(is_lost).filter_map(all_of).flatten().collect()
    }

    /// Causes of a NaN or two among many more of their part that they do not explain: what makes those makes these.
    pub(super) fn lost_among_symptoms(&self, ranked: &Ranked) -> Refuted {
        let shows = |case: &String, symptom: &Headline| {
            let finding = self.evidence.failure_of(case).and_then(|seen| seen.finding);
            finding.is_some_and(|found| found.clues.iter().any(|clue| clue.cause == symptom.cause))
        };
        let is_lost = |told: &&Headline| {
            let alike = ranked.symptoms().filter(|symptom| symptom.cause != told.cause);
            let alike =
                alike.filter(|symptom| told.explains.iter().all(|case| shows(case, symptom)));
            let others = alike.flat_map(|symptom| &symptom.explains);
            let others = others.filter(|case| is_of_one_part(told, case)).count();
            let (all, own) = (told.explains.len() + others, CROWD * told.explains.len());
            all >= own && !self.is_needed(told)
        };
        ranked.with_cause().filter(is_lost).filter_map(all_of).flatten().collect()
    }

    /// Likenesses that are none in the cases that were written for their mistakes: the core fails those otherwise. So are
    /// names where another name explains such a case, or where the core breaks the contract in it and nothing that is told
    /// does, or where their mistakes explain hardly any of its wrong answers.
    pub(super) fn unlike_in_their_own(&self, ranked: &Ranked) -> Refuted {
        let all: Vec<_> = ranked.with_cause().filter_map(|told| self.likeliest(told)).collect();
        let named: Vec<_> =
            ranked.with_cause().filter(|told| told.degree == Degree::Named).collect();
        let is_refuted = |headline: &&Headline| {
            let is_likeness = headline.degree == Degree::LooksLike;
            let is_needed = self.is_needed(headline);
            // Its own cases are passed over here, so that whatever explains one is another.
            let has_a_name = |seen: &Observation<'_>| {
                named.iter().any(|one| one.explains.iter().any(|case| case == seen.case))
            };
            let is_unlike = |seen: &Observation<'_>, planted: &Finding| {
                let is_other = likeness(seen.finding, planted) == Likeness::Other;
                let is_against = |core: &Finding| {
                    breaks_otherwise(core, planted) || hardly_explains(planted, core)
                };
                let may_be_other = is_likeness || !is_needed && has_a_name(seen);
                may_be_other && is_other || !is_needed && seen.finding.is_some_and(is_against)
            };
            let mut mistakes = self.of(headline).peekable();
            mistakes.peek().is_some()
                && mistakes.all(|mistake| self.is_in_its_own(&is_unlike, headline, mistake, &all))
        };
        ranked.with_cause().filter(is_refuted).filter_map(all_of).flatten().collect()
    }

    /// Whether this is so in the case that was written for a mistake, if its cause does not explain it: of the mistake alone
    /// and of all that are told.
    fn is_in_its_own(
        &self,
        is_so: &dyn Fn(&Observation<'_>, &Finding) -> bool,
        headline: &Headline,
        mistake: Mistake,
        all: &[Mistake],
    ) -> bool {
        let own = self.evidence.failure_of(mistake.caught_by);
        let own = own.filter(|seen| !seen.with.intersects(mistake.components));
        let own = own.filter(|seen| !headline.explains.iter().any(|case| case == seen.case));
        own.is_some_and(|seen| {
            let answers = self.glimpsed(&[vec![mistake], all.to_vec()], &[seen]);
            let mut answers = answers.into_iter().flatten();
            answers.all(|answer| answer.is_some_and(|planted| is_so(seen, &planted)))
        })
    }

    /// Whether more of its part speaks against a cause than for it.
    pub(super) fn is_outnumbered(&self, headline: &Headline, ranked: &Ranked) -> bool {
        !self.is_needed(headline) && self.siblings(headline, ranked).doubt(headline)
    }

    /// Whether its mistake alone, of all whose own cases fail, gives what its cases show, and leaves right what was asked
    /// beside them: what else failed its own case would be seen there, too.
    pub(super) fn is_the_only_one_in_sight(&self, headline: &Headline, ranked: &Ranked) -> bool {
        let cases = self.quickest(&headline.explains);
        let sets = self.in_sight().into_iter().map(|mistake| vec![mistake]);
        let (own, others): (Vec<_>, Vec<_>) =
            sets.partition(|set| set[0].cause.name == headline.cause);
        let fails_its_own =
            |set: &Vec<Mistake>| headline.explains.iter().any(|case| case == set[0].caught_by);
        own.iter().any(fails_its_own)
            && self.is_given_by_some(own, &cases)
            && !self.is_given_by_some(others, &cases)
            && self.siblings(headline, ranked).stand_by()
    }

    /// Whether one of `sets` gives all that `cases` show; a first look leaves few of them for a second.
    fn is_given_by_some(&self, sets: Vec<Vec<Mistake>>, cases: &[&Observation<'_>]) -> bool {
        let left = self.likely_at_first(sets, cases);
        let gives = |of_set: Vec<Likeness>| of_set.into_iter().all(Likeness::is_reproduced);
        !cases.is_empty() && self.compare(&left, cases).into_iter().any(gives)
    }

    /// Whether something that its mistake is built upon is wrong by itself, for a reason that is not told.
    pub(super) fn is_built_on_what_is_wrong(&self, headline: &Headline, ranked: &Ranked) -> bool {
        let made: Components = self.of(headline).map(|mistake| mistake.components).collect();
        let is_lower = |case: &String| {
            let mut of_case =
                self.planted.mistakes().iter().filter(|one| one.caught_by == case).peekable();
            of_case.peek().is_some()
                && of_case
                    .all(|one| one.components.bits() < made.bits() & made.bits().wrapping_neg())
        };
        let mut others = ranked.without_cause(headline);
        !made.is_empty()
            && others.any(|case| {
                is_of_one_part(headline, case)
                    && is_lower(case)
                    && !self.is_failed_by_told(case, ranked)
            })
    }

    /// Whether some mistake that is told fails a case, too: then nothing else need be wrong in it.
    fn is_failed_by_told(&self, case: &str, ranked: &Ranked) -> bool {
        let told: Vec<_> = ranked.with_cause().flat_map(|told| self.of(told)).collect();
        let sets: Vec<_> = told.into_iter().map(|mistake| vec![mistake]).collect();
        let seen = self.evidence.failure_of(case);
        let mut answers = seen.into_iter().flat_map(|seen| self.weighed(&sets, &[seen])).flatten();
        answers.any(|answer| answer.is_some_and(|finding| finding.failed()))
    }

    /// Whether the core passes, with what is its own, every case that was written for a mistake of this cause.
    pub(super) fn passes_its_own(&self, headline: &Headline) -> bool {
        let passed = |mistake: Mistake| {
            let mut passed = self.evidence.passed();
            passed.any(|seen| {
                seen.case == mistake.caught_by && !seen.with.intersects(mistake.components)
            })
        };
        let mut mistakes = self.of(headline).peekable();
        mistakes.peek().is_some() && mistakes.all(passed)
    }

    /// What else is explained by a cause that is told.
    pub(super) fn followers(&self, headline: &Headline, ranked: &Ranked) -> Vec<&Observation<'_>> {
        let same = self.siblings(headline, ranked).same;
        same.iter().filter_map(|case| self.evidence.failure_of(case)).collect()
    }

    /// Failures that would follow from a cause whose mistake passes them. If it passes all that there is time to ask, none
    /// follows.
    pub(super) fn not_following(&self, ranked: &Ranked) -> Refuted {
        let of_headline = |headline: &Headline| {
            let alone: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
            let left: Vec<_> = ranked.without_cause(headline).cloned().collect();
            let failures = left.iter().filter_map(|case| self.evidence.failure_of(case));
            let following = quickest(failures, FAILED);
            let answers = self.weighed(&alone, &following);
            let passes = |number: &usize| is_passed_by_all(&answers, *number);
            let apart: Vec<_> = (0..following.len()).filter(passes).collect();
            let names = |number: usize| following[number].case.to_owned();
            let all_pass = apart.len() == following.len() && apart.len() >= CASES;
            let apart: Vec<_> = match all_pass {
                true => left,
                false => apart.into_iter().map(names).collect(),
            };
            Some(refuted(cause::find(&headline.cause)?, &apart))
        };
        ranked.with_cause().filter_map(of_headline).flatten().collect()
    }

    fn siblings(&self, headline: &Headline, ranked: &Ranked) -> Siblings {
        let own: Vec<_> = self.of(headline).map(|mistake| vec![mistake]).collect();
        if own.is_empty() {
            return Siblings::default();
        }
        let failed = ranked.without_cause(headline);
        let failed = failed.filter_map(|case| self.evidence.failure_of(case));
        let passed = self.evidence.passed().filter(|seen| is_of_one_part(headline, seen.case));
        let asked = [quickest(failed, FAILED), quickest(passed, PASSED)].concat();
        let is_its_own =
            |seen: &Observation<'_>| self.of(headline).any(|one| one.caught_by == seen.case);
        let passes_its_own = self.passes_its_own(headline);
        let against = if passes_its_own { OWN_CASE } else { 0 };
        let mut found = Siblings { against, ..Siblings::default() };
        let is_same_closely =
            |seen| is_same(seen, &findings(self.planted(&own, slice::from_ref(&seen))).remove(0));
        for (seen, answers) in asked.iter().copied().zip(self.beside(&own, ranked, &asked)) {
            if answers.is_empty() {
                found.unasked += 1;
            } else if is_same(seen, &answers) {
                found.same.extend(is_same_closely(seen).then(|| seen.case.to_owned()));
            } else if speak_against(seen, &answers) {
                found.against += match is_its_own(seen) {
                    // It is counted already.
                    true if passes_its_own && !seen.has_failed() => 0,
                    true => OWN_CASE,
                    false => 1,
                };
            } else if are_alike(seen, &answers) {
                found.of_another_size += 1;
            } else if !seen.has_failed() {
                found.agreeing += 1;
            }
        }
        found
    }

    /// What each of these sets of mistakes makes of each case, and where none of them stands by the core, all that is told
    /// together.
    fn beside(
        &self,
        own: &[Vec<Mistake>],
        ranked: &Ranked,
        cases: &[&Observation<'a>],
    ) -> Vec<Vec<Finding>> {
        let mut answers = findings(self.weighed(own, cases));
        let all: Vec<_> = ranked.with_cause().filter_map(|told| self.likeliest(told)).collect();
        let is_doubtful = |number: &usize| {
            let (seen, of_own) = (cases[*number], &answers[*number]);
            !of_own.is_empty() && (speak_against(seen, of_own) || are_alike(seen, of_own))
        };
        let doubtful: Vec<_> = (0..cases.len()).filter(is_doubtful).collect();
        if all.len() > 1 {
            let left: Vec<_> = doubtful.iter().map(|number| cases[*number]).collect();
            for (number, of_all) in doubtful.into_iter().zip(findings(self.weighed(&[all], &left)))
            {
                answers[number].extend(of_all);
            }
        }
        answers
    }
}

/// Whether every one of these sets passes a case, as far as that is known.
fn is_passed_by_all(of_sets: &[Vec<Option<Finding>>], case: usize) -> bool {
    let mut known = of_sets.iter().filter_map(|of_set| of_set[case].as_ref()).peekable();
    known.peek().is_some() && known.all(|answer| answer.verdict == Verdict::Pass)
}

/// Case by case, the answers that there are.
fn findings(of_sets: Vec<Vec<Option<Finding>>>) -> Vec<Vec<Finding>> {
    let cases = of_sets.first().map_or(0, Vec::len);
    let mut findings = vec![Vec::new(); cases];
    for of_set in of_sets {
        for (of_case, answer) in findings.iter_mut().zip(of_set) {
            of_case.extend(answer);
        }
    }
    findings
}

/// Whether the core fails a case as any of these do.
fn is_same(seen: &Observation<'_>, planted: &[Finding]) -> bool {
    let is_same = |planted: &Finding| likeness(seen.finding, planted) == Likeness::Same;
    seen.has_failed() && planted.iter().any(is_same)
}

/// Whether all of these are wrong where the core is, by another size.
fn are_alike(seen: &Observation<'_>, planted: &[Finding]) -> bool {
    planted.iter().all(|one| likeness(seen.finding, one) == Likeness::Alike)
}

/// Whether all of these fail a case that the core passes, or fails otherwise.
fn speak_against(seen: &Observation<'_>, planted: &[Finding]) -> bool {
    let speaks = |planted: &Finding| {
        let is_other = || likeness(seen.finding, planted) == Likeness::Other;
        planted.failed() && (!seen.has_failed() || is_other())
    };
    planted.iter().all(speaks)
}
