//! Suspicions become headlines: the earliest part that explains the most comes first, and failures that share a cause
//! are told once.

use super::headline::{EVIDENCE, Headline, part_of_mistake};
use super::reproduction::Refuted;
use super::{Degree, Evidence, Observation, RuledOut, Suspicion, differences, endings};
use crate::case::{Part, Subject, Tier, asked_by};
use crate::cause::{self, Cause};
use crate::contract::{Circumstances, Components};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Diagnosis {
    /// Crashes, then causes, then what merely differs: the one to look at first in front.
    pub(crate) headlines: Vec<Headline>,
    /// Failing cases that no cause explains, though a headline may tell what they share.
    pub(crate) unexplained: Vec<String>,
}

impl Diagnosis {
    /// The first cause of the glossary.
    pub(crate) fn first(&self) -> Option<&'static Cause> {
        self.headlines.iter().find_map(|headline| cause::find(&headline.cause))
    }
}

/// Headlines, kind by kind, each kind in the order in which it is told.
#[derive(Default)]
pub(super) struct Ranked {
    endings: Vec<Headline>,
    causes: Vec<Headline>,
    /// What differs, and follows from no headline.
    differing: Vec<Headline>,
    /// What counts nothing.
    beside: Vec<Headline>,
    /// Cases that causes do not explain.
    refuted: Refuted,
}

impl Ranked {
    pub(super) fn told(self) -> Diagnosis {
        let this = self.without_what_others_bring();
        let without_cause = this.endings.iter().chain(&this.differing);
        let without_cause = without_cause.filter(|headline| headline.cause.is_empty());
        let unexplained = without_cause.flat_map(|headline| headline.explains.clone()).collect();
        let causes = behind_what_differs_below(this.causes, this.differing);
        let kinds = [this.endings, causes, this.beside];
        let mut headlines: Vec<_> = kinds.into_iter().flatten().collect();
        rule_out_once(&mut headlines);
        // That a number is NaN is seen, and not what made it so.
        for symptom in headlines.iter_mut().filter(|headline| headline.is_symptom()) {
            symptom.degree = Degree::DiffersHere;
        }
        Diagnosis { headlines, unexplained }
    }

    /// Graded headlines that tell a cause.
    pub(super) fn with_cause(&self) -> impl Iterator<Item = &Headline> {
        let told = self.endings.iter().chain(&self.causes);
        told.filter(|headline| !headline.cause.is_empty())
    }

    /// Causes that are sure are named.
    pub(super) fn assure(&mut self, is_sure: impl Fn(&Headline) -> bool) {
        for headline in self.causes.iter_mut().filter(|headline| is_sure(headline)) {
            headline.degree = Degree::Named;
        }
    }

    /// Causes that are not sure become what it looks like.
    pub(super) fn doubt(&mut self, is_doubtful: impl Fn(&Headline) -> bool) {
        for headline in self.causes.iter_mut().filter(|headline| is_doubtful(headline)) {
            headline.degree = headline.degree.min(Degree::LooksLike);
        }
    }

    /// Causes of which each would be the only one of its kind are told as what they share.
    pub(super) fn as_one(&mut self, shared: &Cause, is_one: impl Fn(&Headline) -> bool) {
        let at = self.causes.iter().position(&is_one);
        let several: Vec<_> = self.causes.extract_if(.., |headline| is_one(headline)).collect();
        let one = match several.len() {
            0 | 1 => several.into_iter().next(),
            _ => several.into_iter().reduce(Headline::and).map(|one| one.because(shared)),
        };
        self.causes.splice(at.unwrap_or(0)..at.unwrap_or(0), one);
    }

    /// What merely says what is lost follows from a mistake of the BVH that has a name, and some mistakes bring others
    /// along.
    fn without_what_others_bring(mut self) -> Self {
        let of = |headline: &Headline| cause::find(&headline.cause);
        let both = |told: &Headline, other: &Headline| Some((of(told)?, of(other)?));
        let brings = |told: &Headline, other: &Headline| {
            both(told, other).is_some_and(|(told, other)| cause::brings_along(told, other))
        };
        let shows = |told: &Headline, other: &Headline| {
            both(told, other).is_some_and(|(told, other)| cause::shows_beside(told, other))
        };
        let named = self.causes.iter().filter(|headline| headline.degree == Degree::Named);
        let named: Vec<_> = named.cloned().collect();
        for told in named {
            let brought = self.causes.extract_if(.., |other| brings(&told, other));
            let is_of_it = |other: &mut Headline| brings(&told, other) || shows(&told, other);
            let beside = self.beside.extract_if(.., is_of_it);
            let brought: Vec<_> = brought.chain(beside).collect();
            if let Some(told) = self.causes.iter_mut().find(|one| one.cause == told.cause) {
                told.may_follow.extend(brought.into_iter().flat_map(|one| one.explains));
            }
        }
        // What a likeness may bring is no surer than it is.
        let likenesses = self.causes.iter().filter(|one| one.degree == Degree::LooksLike);
        let likenesses: Vec<_> = likenesses.cloned().collect();
        let may_be_brought = |other: &Headline| {
            !of(other).is_some_and(cause::is_vague)
                && likenesses.iter().any(|one| brings(one, other))
        };
        for other in self.causes.iter_mut().chain(&mut self.beside) {
            if may_be_brought(other) {
                other.degree = other.degree.min(Degree::LooksLike);
            }
        }
        self
    }

    /// Failures that have no cause, and those that may follow from this one.
    pub(super) fn without_cause<'r>(
        &'r self,
        headline: &'r Headline,
    ) -> impl Iterator<Item = &'r String> {
        let differing = self.differing.iter().filter(|other| other.cause.is_empty());
        differing.flat_map(|other| &other.explains).chain(&headline.may_follow)
    }

    /// Failures that follow from no cause.
    pub(super) fn differing(&self) -> impl Iterator<Item = &String> {
        self.differing.iter().flat_map(|headline| &headline.explains)
    }

    /// Numbers that are NaN, infinite or negative, whatever made them so.
    pub(super) fn symptoms(&self) -> impl Iterator<Item = &Headline> {
        self.with_cause().filter(|headline| headline.is_symptom())
    }

    /// These failures follow from what is named.
    pub(super) fn follow(&mut self, cases: &[String]) {
        let Some(first) = self.causes.iter().position(Headline::is_sure) else { return };
        let symptoms = self.causes.iter_mut().filter(|headline| headline.is_symptom());
        let without_cause = self.differing.iter_mut().chain(symptoms);
        let follows = |headline: &mut Headline| -> Vec<_> {
            headline.explains.extract_if(.., |case| cases.contains(case)).collect()
        };
        let following: Vec<_> = without_cause.flat_map(follows).collect();
        self.causes[first].may_follow.extend(following);
        self.differing.retain(|headline| !headline.explains.is_empty());
        self.causes.retain(|headline| !headline.explains.is_empty());
    }

    /// This cause explains what of these failures has none.
    pub(super) fn explain(&mut self, cause: &str, cases: &[String]) {
        let Some(one) = self.causes.iter_mut().find(|one| one.cause == cause) else { return };
        for headline in &mut self.differing {
            one.explains.extend(headline.explains.extract_if(.., |case| cases.contains(case)));
        }
        self.differing.retain(|headline| !headline.explains.is_empty());
    }

    /// What this cause explains follows from the others.
    pub(super) fn leave_to_others(&mut self, cause: &str) {
        let left: Vec<_> = self.causes.extract_if(.., |one| one.cause == cause).collect();
        for case in left.into_iter().flat_map(|one| one.explains.into_iter().chain(one.may_follow))
        {
            let before = self.causes.iter().position(|one| one.comes_before(&case));
            if let Some(one) = self.causes.get_mut(before.unwrap_or(0)) {
                one.may_follow.push(case);
            }
        }
    }

    /// Of what counts nothing, these alone are told, and causes that are told of graded cases, too.
    pub(super) fn tell_beside(&mut self, is_told: impl Fn(&Headline) -> bool) {
        let causes = &self.causes;
        let is_graded = |beside: &Headline| causes.iter().any(|one| one.cause == beside.cause);
        self.beside.retain(|beside| is_told(beside) || is_graded(beside));
    }

    /// What differs, and what no more than looks like a cause.
    pub(super) fn unnamed(&self) -> impl Iterator<Item = &Headline> {
        let vague = self.causes.iter().filter(|headline| headline.degree == Degree::LooksLike);
        vague.chain(&self.differing)
    }

    /// The same where everything but a component, and those beside it, is the bench's: whatever else failed is of its only cause too, and what has no
    /// cause differs there.
    pub(super) fn of_component(mut self, own: [Components; 2], evidence: &Evidence<'_>) -> Self {
        match (&mut self.causes[..], &self.endings[..]) {
            ([only], []) => {
                for headline in &mut self.differing {
                    let told = only.clone();
                    let may_follow = |case: &mut String| {
                        told.comes_before(case) && !is_refuted(&self.refuted, &told.cause, case)
                    };
                    only.may_follow.extend(headline.explains.extract_if(.., may_follow));
                }
                self.differing.retain(|headline| !headline.explains.is_empty());
                self.differing_as_one(own, evidence);
            }
            ([], []) => self.differing_as_one(own, evidence),
            _ => {}
        }
        self
    }

    /// A component that answers rightly where it is asked alone may be called wrongly, or be wrong where no case asks it. One
    /// that mends nothing alone is told with those `beside` it.
    fn differing_as_one(&mut self, [own, beside]: [Components; 2], evidence: &Evidence<'_>) {
        let Some(one) = self.differing.drain(..).reduce(Headline::and) else { return };
        let component = own.in_words();
        let (mistake, look_at) = if !beside.is_empty() {
            (
                format!("what differs is the core's {}", (own | beside).in_words()),
                "what they have in common: the bench's own mend it only together".to_owned(),
            )
        } else if passes_its_own_cases(own, evidence) {
            (
                format!(
                    "the core's {component} passes its own cases, and what rests on it does not"
                ),
                format!(
                    "what its cases do not ask{}, and where the core calls its {component}: what it hands over and what it \
                     does with the answer",
                    not_asked_of(own)
                ),
            )
        } else {
            (format!("what differs is the core's {component}"), String::new())
        };
        self.differing.push(Headline { look_at, ..one }.differing(&mistake).under(evidence, own));
    }

    /// The same where what has no cause is told of these cases alone.
    pub(super) fn differing_in(
        mut self,
        evidence: &Evidence<'_>,
        is_told: impl Fn(&str) -> bool,
    ) -> Self {
        let all = self.differing.drain(..).flat_map(|headline| headline.explains);
        let told: Vec<_> = all.filter(|case| is_told(case)).collect();
        self.differing = differences::headlines(evidence, &told);
        self
    }

    /// The same where what has no cause, and was not tried with components of the bench, may differ only for what it is made
    /// of and is known to be broken.
    pub(super) fn unless_below(
        mut self,
        broken: Components,
        is_tried: impl Fn(&str) -> bool,
    ) -> Self {
        for headline in &mut self.differing {
            let subject = headline.explains.first().and_then(|case| Subject::of_case(case));
            let asked = subject.map_or(Components::empty(), asked_by);
            let is_below = |one: &Components| asked.iter().any(|of| of.is_made_of(*one));
            let below: Components = (broken - asked).iter().filter(is_below).collect();
            if !below.is_empty() && !headline.explains.iter().any(|case| is_tried(case)) {
                headline.mistake += &format!(", or only the core's {}", below.in_words());
            }
        }
        self
    }

    /// Whether `case` follows from its first cause that may be below it, or from what differs.
    pub(super) fn followed_by(&mut self, case: &str) -> bool {
        let Self { causes, differing, refuted, .. } = self;
        let may_follow = |cause: &&mut Headline| {
            cause.comes_before(case) && !is_refuted(refuted, &cause.cause, case)
        };
        match (causes.iter_mut().find(may_follow), differing.first_mut()) {
            (Some(cause), _) => cause.may_follow.push(case.to_owned()),
            (None, Some(difference)) => difference.explains.push(case.to_owned()),
            (None, None) => return false,
        }
        true
    }

    /// Both; a cause or an ending that both tell is told once.
    pub(super) fn and(mut self, other: Self) -> Self {
        join(&mut self.endings, other.endings);
        join(&mut self.causes, other.causes);
        self.causes.sort_by_key(Headline::part);
        join(&mut self.beside, other.beside);
        self.refuted.extend(other.refuted);
        self.differing.extend(other.differing);
        let causes = &self.causes;
        let has_cause = |case: &String| causes.iter().any(|headline| headline.accounts_for(case));
        for headline in &mut self.differing {
            headline.explains.retain(|case| !has_cause(case));
        }
        self.differing.retain(|headline| !headline.explains.is_empty());
        self
    }
}

/// Whether no case that asks about the core's own `component` itself fails, and those that prove it pass.
fn passes_its_own_cases(component: Components, evidence: &Evidence<'_>) -> bool {
    // Light sampling is asked alone where its samples are, and not what comes of them.
    let is_sampler = component == Components::LIGHT_SAMPLING;
    let asks_itself = |seen: &Observation<'_>| {
        let subject = Subject::of_case(seen.case);
        subject.is_some_and(|subject| asked_by(subject).intersects(component))
            && !(is_sampler && seen.circumstances.contains(Circumstances::RADIANCE))
    };
    let is_own = |seen: &Observation<'_>| asks_itself(seen) && !seen.with.intersects(component);
    let is_proven = match is_sampler {
        true => evidence.passed().any(is_own),
        false => evidence.has_proven(component),
    };
    is_proven && !evidence.failures().any(asks_itself)
}

/// What no case asks a component alone. Shapes are asked for their nearest hit, light sampling for what it samples.
fn not_asked_of(component: Components) -> &'static str {
    if component.intersects(Components::TRIANGLE_TEST | Components::SPHERE_TEST) {
        ", its any-hit function and what it writes on a miss"
    } else if component == Components::LIGHT_SAMPLING {
        ", the pdf that MIS takes for a direction which it has not sampled"
    } else {
        ""
    }
}

/// Causes, then what differs; but what only looks like a cause, or is a symptom, is told behind what differs below it, on
/// which it may rest.
fn behind_what_differs_below(causes: Vec<Headline>, differing: Vec<Headline>) -> Vec<Headline> {
    let below = differing.iter().filter(|one| !one.is_alone()).map(Headline::position).min();
    let stands_above = |one: &Headline| below.is_some_and(|below| below < one.position());
    let (first, unsure): (Vec<_>, Vec<_>) =
        causes.into_iter().partition(|one| one.is_sure() || !stands_above(one));
    let mut others = [differing, unsure].concat();
    others.sort_by_key(Headline::position);
    [first, others].concat()
}

fn is_refuted(refuted: &Refuted, cause: &str, case: &str) -> bool {
    refuted.iter().any(|(of, other)| *of == cause && other == case)
}

/// Headlines of one mistake become one.
fn join(headlines: &mut Vec<Headline>, others: Vec<Headline>) {
    for other in others {
        match headlines.iter_mut().find(|known| known.mistake == other.mistake) {
            Some(known) => known.absorb(other),
            None => headlines.push(other),
        }
    }
}

struct Candidate {
    cause: &'static Cause,
    evidence: Vec<String>,
    ruled_out: Vec<RuledOut>,
    /// The failing cases, how well each is explained, and how surely.
    cases: BTreeMap<String, (f64, Degree)>,
    /// Those in which it explains what no other does, and so stays, whatever else is told of them.
    own: BTreeSet<String>,
}

impl Candidate {
    /// What it explains among `failures`, of which `left` have no cause yet.
    fn explained<'a>(
        &'a self,
        failures: &'a [String],
        left: &'a [String],
    ) -> impl Iterator<Item = &'a String> {
        let is_free = |case: &String| self.own.contains(case) || left.contains(case);
        failures.iter().filter(move |case| self.cases.contains_key(*case) && is_free(case))
    }
}

/// Takes the best candidate, then the best for what is left, until nothing is left; what counts comes before what
/// does not.
pub(super) fn rank(
    evidence: &Evidence<'_>,
    suspicions: Vec<Suspicion>,
    refuted: &Refuted,
) -> Ranked {
    let mut headlines = endings::headlines(evidence, refuted);
    let endings = headlines.len();
    let mut candidates = collect(evidence, suspicions);
    let answered = |seen: &&Observation<'_>| seen.ending.is_none();
    let case = |seen: &Observation<'_>| seen.case.to_owned();
    let suspected = |case: &String| candidates.iter().any(|c| c.cases.contains_key(case));
    let failures: Vec<_> = evidence.failures().filter(answered).map(case).collect();
    let (mut left, orphans): (Vec<_>, Vec<_>) = failures.iter().cloned().partition(suspected);
    let of_robustness: Vec<_> = evidence.failures_of_robustness().map(case).collect();
    let mut beside = of_robustness.clone();
    while let Some(best) = best_of(&candidates, &failures, &left) {
        let mut candidate = candidates.swap_remove(best);
        absorb_the_vague(&mut candidate, &mut candidates);
        beside.retain(|case| !candidate.cases.contains_key(case));
        headlines.push(headline(evidence, Tier::Graded, candidate, &failures, &mut left));
    }
    let orphans = attribute(evidence, refuted, orphans, &mut headlines);
    let differing = differences::headlines(evidence, &orphans);
    let mut told_beside = Vec::new();
    while let Some(best) = best_of(&candidates, &of_robustness, &beside) {
        let candidate = candidates.swap_remove(best);
        let told = headline(evidence, Tier::Robustness, candidate, &of_robustness, &mut beside);
        told_beside.push(told);
    }
    let causes = headlines.split_off(endings);
    let refuted = refuted.clone();
    Ranked { endings: headlines, causes, differing, beside: told_beside, refuted }
}

fn collect(evidence: &Evidence<'_>, suspicions: Vec<Suspicion>) -> Vec<Candidate> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for mut suspicion in suspicions {
        let side = cause::side(suspicion.cause);
        let contradicts = |case: &str| side.is_some_and(|side| evidence.contradicts(case, side));
        suspicion.cases.retain(|case| !contradicts(case));
        if suspicion.cases.is_empty() {
            continue;
        }
        let known = candidates.iter().position(|c| c.cause.name == suspicion.cause.name);
        let number = known.unwrap_or_else(|| {
            let (evidence, ruled_out, cases, own) = Default::default();
            candidates.push(Candidate { cause: suspicion.cause, evidence, ruled_out, cases, own });
            candidates.len() - 1
        });
        let candidate = &mut candidates[number];
        candidate.evidence.extend(suspicion.evidence);
        candidate.ruled_out.extend(suspicion.ruled_out);
        if suspicion.beside {
            candidate.own.extend(suspicion.cases.iter().cloned());
        }
        for case in suspicion.cases {
            let (weight, degree) = candidate.cases.entry(case).or_default();
            *weight = weight.max(suspicion.weight);
            *degree = suspicion.degree.max(*degree);
        }
    }
    candidates
}

/// A mistake of the BVH that has a name and may lose hits explains the cases of the vague cause of the same part too.
fn absorb_the_vague(told: &mut Candidate, candidates: &mut Vec<Candidate>) {
    if cause::may_lose_hits(told.cause) {
        for vague in candidates.extract_if(.., |candidate| cause::is_vague(candidate.cause)) {
            told.cases.extend(vague.cases);
            told.evidence.extend(vague.evidence);
        }
    }
}

/// How well a candidate explains what is left: the earlier, the more exact and the more the better.
#[derive(PartialEq)]
struct Merit {
    part: u32,
    is_vague: bool,
    weight: f64,
}

impl Merit {
    /// `None` where it explains nothing.
    fn of(candidate: &Candidate, failures: &[String], left: &[String]) -> Option<Self> {
        let part = |case: &String| Part::of_case(case).map_or(u32::MAX, |part| part.number);
        let explained = || candidate.explained(failures, left);
        let earliest = explained().map(part).min()?;
        Some(Self {
            part: earliest.max(part_of_mistake(candidate.cause)),
            is_vague: cause::is_vague(candidate.cause),
            weight: explained().filter_map(|case| Some(candidate.cases.get(case)?.0)).sum(),
        })
    }

    fn compare(&self, other: &Self) -> Ordering {
        let part = other.part.cmp(&self.part);
        let exact = other.is_vague.cmp(&self.is_vague);
        part.then(exact).then(self.weight.total_cmp(&other.weight))
    }
}

fn best_of(candidates: &[Candidate], failures: &[String], left: &[String]) -> Option<usize> {
    let merits = candidates.iter().enumerate();
    let merits = merits.filter_map(|(number, c)| Some((number, Merit::of(c, failures, left)?)));
    let better = |a: &(usize, Merit), b: &(usize, Merit)| a.1.compare(&b.1).then(b.0.cmp(&a.0));
    merits.max_by(better).map(|(number, _)| number)
}

fn headline(
    evidence: &Evidence<'_>,
    tier: Tier,
    candidate: Candidate,
    failures: &[String],
    left: &mut Vec<String>,
) -> Headline {
    let explains: Vec<_> = candidate.explained(failures, left).cloned().collect();
    left.retain(|case| !explains.contains(case));
    let degree = explains.iter().filter_map(|case| Some(candidate.cases.get(case)?.1)).max();
    let Candidate { cause, evidence: sentences, ruled_out, .. } = candidate;
    let ruled_out = each_once(ruled_out);
    let degree = degree.unwrap_or_default();
    Headline {
        tier,
        degree,
        ruled_out,
        ..Headline::of(evidence, explains, sentences).because(cause)
    }
}

/// What several rules exclude, each with its own numbers, is excluded once.
fn each_once(all: Vec<RuledOut>) -> Vec<String> {
    let mut known = BTreeSet::new();
    let first = all.into_iter().filter(|one| known.insert(one.what.clone()));
    first.take(EVIDENCE).map(|RuledOut { what, why }| format!("{what} ({why})")).collect()
}

/// What several headlines exclude, each with its own numbers, is excluded by the first; what one of them tells by none.
fn rule_out_once(headlines: &mut [Headline]) {
    // As `each_once` has put it: what, and in brackets why.
    let what = |told: &str| told.split(" (").next().unwrap_or(told).to_owned();
    let mut known: BTreeSet<_> = headlines.iter().map(|one| what(&one.mistake)).collect();
    for headline in headlines {
        headline.ruled_out.retain(|told| known.insert(what(told)));
    }
}

/// What no cause explains may follow from a headline whose cases prove what it rests on and that is not refuted: of those
/// from the one that explains the most, of equals from the first. Answers what is left.
fn attribute(
    evidence: &Evidence<'_>,
    refuted: &Refuted,
    orphans: Vec<String>,
    headlines: &mut [Headline],
) -> Vec<String> {
    let proven: Vec<_> = headlines.iter().map(|told| evidence.proven_by(&told.explains)).collect();
    let mut unexplained = Vec::new();
    for case in orphans {
        let rests_on = evidence.rests_on(&case);
        let is_broken = |number: &usize| proven[*number].iter().any(|f| rests_on.contains(f));
        let may_be = |number: &usize| {
            let headline = &headlines[*number];
            headline.comes_before(&case) && !is_refuted(refuted, &headline.cause, &case)
        };
        let likely = (0..headlines.len()).rev().filter(is_broken).filter(may_be);
        match likely.max_by_key(|number| headlines[*number].explains.len()) {
            Some(number) => headlines[number].may_follow.push(case),
            None => unexplained.push(case),
        }
    }
    let shaken = evidence.proven_by(&unexplained);
    let is_shaken = |headline: &Headline| {
        let rests = |case: &String| evidence.rests_on(case).iter().any(|f| shaken.contains(f));
        !headline.explains.is_empty() && headline.explains.iter().all(rests)
    };
    // What all its cases rest on is wrong by itself, for a reason that it does not tell.
    let is_doubtful = |headline: &Headline| !headline.keeps_its_name() || is_shaken(headline);
    for headline in headlines.iter_mut().filter(|headline| is_doubtful(headline)) {
        headline.degree = headline.degree.min(Degree::LooksLike);
    }
    unexplained
}

#[cfg(test)]
mod tests {
    use crate::case::{Foundation, Tier};
    use crate::cause::{bsdf, bvh, camera, contract, image, integrator, light, shape};
    use crate::checks::law::{LOST_SAMPLES, ROUNDED};
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};
    use crate::diagnosis::{Degree, diagnose};
    use crate::image::Channel;

    #[test]
    fn nothing_failed_and_nothing_is_blamed() {
        let made = Made::new().with("bsdf/a", passing());
        assert_eq!(diagnose(&made.evidence()), super::Diagnosis::default());
    }

    #[test]
    fn samples_are_lost_in_most_of_the_light_that_fails_or_nowhere() {
        let half = || means(vec![mean("bounce 1", Channel::Red, 0.5, 0.5, 0.001)]);
        let losing = || half().knowing_laws([LOST_SAMPLES.to_owned()]);
        let told = |others: usize| {
            let mut made = Made::new().with("light/a", losing()).with("light/b", losing());
            for number in 0..others {
                made = made.with(&*format!("light/c{number}"), half());
            }
            diagnose(&made.evidence()).headlines[0].mistake.contains(LOST_SAMPLES)
        };
        assert!(told(0) && told(1));
        assert!(!told(2) && !told(9));
    }

    #[test]
    fn a_float_is_told_where_all_that_fails_is_rounded() {
        let rounded = || failing("7 wrong").knowing_laws([ROUNDED.to_owned()]);
        let told = |other| {
            let made = Made::new().with("shape/a", rounded()).with("shape/b", other);
            diagnose(&made.evidence()).headlines[0].mistake.contains(ROUNDED)
        };
        assert!(told(rounded()) && !told(failing("9 wrong")));
        let headline = |laws: &[&str]| super::Headline {
            laws: laws.iter().map(|law| (*law).to_owned()).collect(),
            ..Default::default()
        };
        let both = |laws: &[&str]| headline(&[ROUNDED]).and(headline(laws)).laws;
        assert_eq!(both(&[]), Vec::<String>::new());
        assert_eq!(both(&[ROUNDED]), [ROUNDED, ROUNDED]);
    }

    #[test]
    fn what_is_ruled_out_stands_once_and_never_beside_itself() {
        let told = |mistake: &str, out: &[&str]| super::Headline {
            mistake: mistake.to_owned(),
            ruled_out: out.iter().map(|one| (*one).to_owned()).collect(),
            ..Default::default()
        };
        let mut told = [
            told("no shadows", &["no cosine (would give 2)", "two lights (it is dark)"]),
            told("two lights", &["no cosine (would give 3)", "no shadows (x)", "no pi (grey)"]),
        ];
        super::rule_out_once(&mut told);
        assert_eq!(told[0].ruled_out, ["no cosine (would give 2)"]);
        assert_eq!(told[1].ruled_out, ["no pi (grey)"]);
    }

    #[test]
    fn a_cause_that_alone_fits_is_named_and_one_among_others_is_looked_like() {
        let both = failing("b").because(&bsdf::WITHOUT_PI, "y").because(&light::WORLD_COSINE, "z");
        let shared = Made::new().with("light/a", both);
        let degree = |made: &Made| diagnose(&made.evidence()).headlines[0].degree;
        assert_eq!(degree(&shared), Degree::LooksLike);
        let proven = shared.with("light/b", failing("a").because(&bsdf::WITHOUT_PI, "x"));
        assert_eq!(degree(&proven), Degree::Named);
    }

    #[test]
    fn that_a_number_is_nan_is_seen_and_is_no_mistake_with_a_name() {
        let made =
            Made::new().with("light/a", failing("NaN").because(&contract::NOT_A_NUMBER, "NaN"));
        let told = diagnose(&made.evidence());
        let [symptom] = &told.headlines[..] else { panic!("{told:?}") };
        assert_eq!(symptom.degree, Degree::DiffersHere);
        assert!(!symptom.fix.is_empty() && !symptom.is_alone(), "its words help all the same");
    }

    #[test]
    fn what_stands_below_a_cause_does_not_follow_from_it() {
        let made = Made::new()
            .with("bsdf/a", failing("9 of 9 samples are missing"))
            .with("bsdf/b", failing("6 of 6 samples are missing"))
            .with("integrator/c", failing("NaN").because(&contract::NOT_A_NUMBER, "NaN"))
            .proving("integrator/c", &[Foundation::Diffuse])
            .resting("bsdf/a", &[Foundation::Diffuse])
            .resting("bsdf/b", &[Foundation::Diffuse]);
        let headlines = diagnose(&made.evidence()).headlines;
        let told: Vec<_> = headlines.iter().map(|one| one.mistake.as_str()).collect();
        assert_eq!(told, ["the BSDF differs in scenes with diffuse surfaces", "an answer is NaN"]);
        assert_eq!(headlines[1].may_follow, Vec::<String>::new());
    }

    #[test]
    fn causes_beside_each_other_in_one_case_are_all_told() {
        let both = failing("a").because_all([&bsdf::WITHOUT_PI, &bsdf::COSINE_IN_F], "predict it");
        let diagnosis = diagnose(&Made::new().with("bsdf/a", both).evidence());
        let told: Vec<_> = diagnosis.headlines.iter().map(|h| (&h.cause[..], h.degree)).collect();
        let [pi, cosine] = [&bsdf::WITHOUT_PI, &bsdf::COSINE_IN_F].map(|cause| cause.name);
        assert_eq!(told, [(pi, Degree::Named), (cosine, Degree::Named)]);
    }

    #[test]
    fn a_cause_that_only_darkens_loses_what_is_too_bright() {
        let bright = |ratio| means(vec![mean("image", Channel::Red, 0.5, ratio, 0.01)]);
        let clamped = |ratio| bright(ratio).because(&image::SAMPLES_CLAMPED, "fireflies");
        let made = Made::new().with("image/a", clamped(1.12)).with("image/b", clamped(0.9));
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.headlines[0].explains, ["image/b"]);
        assert_eq!(diagnosis.unexplained, ["image/a"]);
    }

    #[test]
    fn a_cause_that_leaves_too_many_that_rest_on_it_loses_its_name() {
        let made = Made::new()
            .with("bsdf/a", failing("a").because(&bsdf::WITHOUT_PI, "x"))
            .with("light/b", failing("who knows"))
            .proving("bsdf/a", &[Foundation::Diffuse])
            .resting("light/b", &[Foundation::Diffuse]);
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.headlines[0].may_follow, ["light/b"]);
        assert_eq!(diagnosis.headlines[0].degree, Degree::LooksLike);
    }

    #[test]
    fn a_cause_whose_cases_rest_on_what_else_is_wrong_loses_its_name() {
        let made = Made::new()
            .with("light/a", failing("a").because(&light::HALF_AS_BRIGHT, "x"))
            .with("light/samples", failing("who knows"))
            .proving("light/samples", &[Foundation::MeshLight]);
        let degree = |made: &Made| diagnose(&made.evidence()).headlines[0].degree;
        assert_eq!(degree(&made), Degree::Named);
        let rests = made.resting("light/a", &[Foundation::MeshLight]);
        assert_eq!(degree(&rests), Degree::LooksLike);
    }

    #[test]
    fn failures_of_one_cause_are_one_headline_and_the_earliest_part_comes_first() {
        let without_pi = |name| failing(name).because(&bsdf::WITHOUT_PI, "3.142 times too bright");
        let made = Made::new()
            .with("integrator/z", failing("z").because(&integrator::ROULETTE_NOT_DIVIDED, "0.7"))
            .with("bsdf/a", without_pi("a"))
            .with("light/b", without_pi("b"))
            .with("light/c", failing("who knows"))
            .with("camera/d", failing("who knows"))
            .blocked("image/e", "bsdf/a")
            .proving("bsdf/a", &[Foundation::Diffuse])
            .resting("light/c", &[Foundation::Diffuse]);
        let diagnosis = diagnose(&made.evidence());
        let [first, second, third] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(first.cause, bsdf::WITHOUT_PI.name);
        assert_eq!(first.explains, ["bsdf/a", "light/b"]);
        assert_eq!(first.may_follow, ["light/c"], "nothing else rests on it");
        assert_eq!(first.blocked, 1);
        assert_eq!(second.cause, integrator::ROULETTE_NOT_DIVIDED.name);
        assert_eq!((&third.cause[..], third.degree), ("", Degree::DiffersHere));
        assert_eq!(
            (&third.explains, &diagnosis.unexplained),
            (&diagnosis.unexplained, &vec!["camera/d".to_owned()])
        );
    }

    #[test]
    fn what_nothing_explains_follows_only_from_what_it_rests_on() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&shape::SPHERE_CANCELLATION, "x"))
            .with("light/b", failing("b").because(&bsdf::WITHOUT_PI, "y"))
            .with("light/c", failing("c").because(&bsdf::WITHOUT_PI, "y"))
            .with("integrator/d", failing("who knows"))
            .with("adaptive/e", failing("who knows"))
            .proving("shape/a", &[Foundation::Spheres])
            .resting("integrator/d", &[Foundation::Spheres, Foundation::Glass]);
        let diagnosis = diagnose(&made.evidence());
        let [first, second, third] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(first.may_follow, ["integrator/d"]);
        assert!(second.may_follow.is_empty());
        assert_eq!(third.explains, ["adaptive/e"]);
    }

    #[test]
    fn what_counts_nothing_is_told_last_and_once() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&shape::SPHERE_CANCELLATION, "3 digits"))
            .beside_the_grade("shape/a")
            .with("light/b", failing("b").because(&bsdf::WITHOUT_PI, "y"))
            .with("light/c", failing("c").because(&bsdf::WITHOUT_PI, "z"))
            .beside_the_grade("light/c");
        let diagnosis = diagnose(&made.evidence());
        let [first, second] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!((&first.cause[..], first.tier), (bsdf::WITHOUT_PI.name, Tier::Graded));
        assert_eq!(second.cause, shape::SPHERE_CANCELLATION.name);
        assert_eq!((second.tier, &second.command[..]), (Tier::Robustness, "shape/a"));
    }

    #[test]
    fn a_mistake_of_the_bvh_that_has_a_name_explains_the_leaks_of_part_one() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&bvh::HITS_LOST, "the loop meets them"))
            .with("bvh/b", failing("b").because(&bvh::RANGE_OVERWRITTEN, "y"));
        let diagnosis = diagnose(&made.evidence());
        let [only] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(only.cause, bvh::RANGE_OVERWRITTEN.name);
        assert_eq!((only.explains.len(), diagnosis.unexplained.len()), (2, 0));
    }

    #[test]
    fn a_mistake_that_another_brings_along_is_not_told_beside_it() {
        let pairs = [
            (&bvh::HIT_OVERWRITTEN, &bvh::SEGMENT_NOT_SHORTENED),
            (&shape::DETERMINANT_THRESHOLD, &integrator::FIXED_LENGTH),
            (&camera::HALF_PIXEL_TWICE, &camera::HALF_A_PIXEL),
        ];
        for (cause, brought) in pairs {
            let made = || {
                Made::new()
                    .with("bvh/a", failing("a").because(cause, "x"))
                    .with("bvh/b", failing("b").because(brought, "y"))
            };
            for made in [made(), made().beside_the_grade("bvh/b")] {
                let diagnosis = diagnose(&made.evidence());
                let [only] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
                assert_eq!(only.cause, cause.name);
                assert_eq!(only.may_follow, ["bvh/b"]);
            }
        }
    }

    #[test]
    fn hits_behind_the_origin_are_told_once_though_they_lie_before_the_start_too() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&shape::HITS_BEHIND_ORIGIN, "x"))
            .with("shape/b", failing("b").because(&shape::SEGMENT_START_IGNORED, "y"));
        assert_eq!(diagnose(&made.evidence()).headlines.len(), 2, "of two graded cases both");
        let diagnosis = diagnose(&made.beside_the_grade("shape/b").evidence());
        let [only] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(only.cause, shape::HITS_BEHIND_ORIGIN.name);
        assert_eq!(only.may_follow, ["shape/b"]);
    }

    #[test]
    fn what_a_likeness_may_bring_along_is_no_surer() {
        let hit_overwritten =
            |other| failing("a").because(&bvh::HIT_OVERWRITTEN, "x").because(other, "z");
        let made = Made::new()
            .with("bvh/a", hit_overwritten(&bvh::BOX_OF_CENTROIDS))
            .with("bvh/b", hit_overwritten(&bvh::RANGE_OVERWRITTEN))
            .with("bvh/c", failing("c").because(&bvh::SEGMENT_NOT_SHORTENED, "y"));
        let diagnosis = diagnose(&made.evidence());
        let told: Vec<_> = diagnosis.headlines.iter().map(|h| (&h.cause[..], h.degree)).collect();
        let likeness = |cause: &crate::cause::Cause| (cause.name, Degree::LooksLike);
        let expected = [&bvh::HIT_OVERWRITTEN, &bvh::SEGMENT_NOT_SHORTENED].map(likeness);
        assert_eq!(told, expected);
    }

    #[test]
    fn what_only_slows_explains_no_hit_that_is_lost() {
        let lost = failing("lost").because(&bvh::HITS_LOST, "the loop meets them");
        let explained = |cause: &crate::cause::Cause| {
            let made = Made::new()
                .with("bvh/a", lost.clone())
                .with("bvh/b", failing("b").because(cause, "y"));
            let headlines = diagnose(&made.evidence()).headlines;
            headlines.into_iter().find(|told| told.cause == cause.name).unwrap().explains.len()
        };
        assert_eq!(explained(&bvh::BOX_WITHOUT_Z), 2);
        assert_eq!(explained(&bvh::SHORTEST_AXIS), 1);
    }

    #[test]
    fn leaks_that_nothing_else_explains_are_of_the_bvh() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&bvh::HITS_LOST, "the loop meets them"))
            .with("bvh/b", failing("b"));
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.first().map(|cause| cause.name), Some(bvh::HITS_LOST.name));
    }

    #[test]
    fn a_cause_that_explains_two_failures_wins_over_two_that_explain_one_each() {
        let made = Made::new()
            .with(
                "light/a",
                failing("a").because(&light::WORLD_COSINE, "x").because(&bsdf::WITHOUT_PI, "y"),
            )
            .with("light/b", failing("b").because(&bsdf::WITHOUT_PI, "z"));
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.first().map(|cause| cause.name), Some(bsdf::WITHOUT_PI.name));
        assert_eq!(diagnosis.headlines.len(), 1);
    }
}
