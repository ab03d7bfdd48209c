//! Suspicions become headlines: the earliest part that explains the most comes first, and failures that share a cause
//! are told once.

use super::{Evidence, Observation, Suspicion};
use crate::case::{Part, Tier};
use crate::cause::{self, Cause};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Sentences of evidence that a headline keeps.
const EVIDENCE: usize = 4;

/// One cause and all that it explains, as `run.json` keeps it: in the words of the furnace that found it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Headline {
    /// The name of the mistake in the glossary.
    pub(crate) cause: String,
    /// The mistake as one sentence without full stop.
    pub(crate) mistake: String,
    pub(crate) look_at: String,
    pub(crate) fix: String,
    pub(crate) tier: Tier,
    pub(crate) evidence: Vec<String>,
    /// What else could have been, and why it is not.
    pub(crate) ruled_out: Vec<String>,
    /// The failing cases that it explains, the earliest part first.
    pub(crate) explains: Vec<String>,
    /// Failing cases of the same and later parts that nothing explains: they may follow from it.
    pub(crate) may_follow: Vec<String>,
    pub(crate) blocked: usize,
    /// The command that repeats the quickest of the failing cases.
    pub(crate) command: String,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Diagnosis {
    /// The causes, the one to look at first in front.
    pub(crate) headlines: Vec<Headline>,
    pub(crate) unexplained: Vec<String>,
}

impl Diagnosis {
    pub(crate) fn first(&self) -> Option<&'static Cause> {
        cause::find(&self.headlines.first()?.cause)
    }
}

struct Candidate {
    cause: &'static Cause,
    evidence: Vec<String>,
    ruled_out: Vec<String>,
    /// The failing cases, and how well each is explained.
    cases: BTreeMap<String, f64>,
}

/// Takes the best candidate, then the best for what is left, until nothing is left; what counts comes before what
/// does not.
pub(crate) fn rank(evidence: &Evidence<'_>, suspicions: Vec<Suspicion>) -> Diagnosis {
    let mut candidates = collect(suspicions);
    let case = |seen: &Observation<'_>| seen.case.to_owned();
    let suspected = |case: &String| candidates.iter().any(|c| c.cases.contains_key(case));
    let (mut left, orphans): (Vec<_>, Vec<_>) = evidence.failures().map(case).partition(suspected);
    let mut beside: Vec<_> = evidence.failures_of_robustness().map(case).collect();
    let mut headlines = Vec::new();
    while let Some(best) = best_of(&candidates, &left) {
        let mut candidate = candidates.swap_remove(best);
        absorb_the_vague(&mut candidate, &mut candidates);
        beside.retain(|case| !candidate.cases.contains_key(case));
        headlines.push(headline(evidence, Tier::Graded, candidate, &mut left));
    }
    let unexplained = attribute(orphans, &mut headlines);
    while let Some(best) = best_of(&candidates, &beside) {
        let candidate = candidates.swap_remove(best);
        headlines.push(headline(evidence, Tier::Robustness, candidate, &mut beside));
    }
    Diagnosis { headlines, unexplained }
}

fn collect(suspicions: Vec<Suspicion>) -> Vec<Candidate> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for suspicion in suspicions {
        let known = candidates.iter().position(|c| c.cause.name == suspicion.cause.name);
        let number = known.unwrap_or_else(|| {
            let (evidence, ruled_out, cases) = Default::default();
            candidates.push(Candidate { cause: suspicion.cause, evidence, ruled_out, cases });
            candidates.len() - 1
        });
        let candidate = &mut candidates[number];
        candidate.evidence.extend(suspicion.evidence);
        candidate.ruled_out.extend(suspicion.ruled_out);
        for case in suspicion.cases {
            let weight = candidate.cases.entry(case).or_insert(0.0);
            *weight = weight.max(suspicion.weight);
        }
    }
    candidates
}

/// A mistake of the BVH that has a name explains the cases of the vague cause of the same part too.
fn absorb_the_vague(told: &mut Candidate, candidates: &mut Vec<Candidate>) {
    if cause::is_of_hierarchy(told.cause) {
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
    fn of(candidate: &Candidate, left: &[String]) -> Option<Self> {
        let part = |case: &String| Part::of_case(case).map_or(u32::MAX, |part| part.number);
        let explained = || candidate.cases.iter().filter(|(case, _)| left.contains(case));
        let earliest = explained().map(|(case, _)| part(case)).min()?;
        Some(Self {
            part: earliest.max(part_of_mistake(candidate.cause)),
            is_vague: cause::is_vague(candidate.cause),
            weight: explained().map(|(_, weight)| weight).sum(),
        })
    }

    fn compare(&self, other: &Self) -> Ordering {
        let part = other.part.cmp(&self.part);
        let exact = other.is_vague.cmp(&self.is_vague);
        part.then(exact).then(self.weight.total_cmp(&other.weight))
    }
}

/// The part that a mistake is made in, where that is not the part in which it shows first.
fn part_of_mistake(cause: &Cause) -> u32 {
    if cause::is_of_hierarchy(cause) { Part::HIERARCHY } else { 0 }
}

fn best_of(candidates: &[Candidate], left: &[String]) -> Option<usize> {
    let merits = candidates.iter().enumerate();
    let merits = merits.filter_map(|(number, c)| Some((number, Merit::of(c, left)?)));
    let better = |a: &(usize, Merit), b: &(usize, Merit)| a.1.compare(&b.1).then(b.0.cmp(&a.0));
    merits.max_by(better).map(|(number, _)| number)
}

fn headline(
    evidence: &Evidence<'_>,
    tier: Tier,
    candidate: Candidate,
    left: &mut Vec<String>,
) -> Headline {
    let explains: Vec<String> =
        left.iter().filter(|case| candidate.cases.contains_key(*case)).cloned().collect();
    left.retain(|case| !explains.contains(case));
    let blocked = evidence.blocked_by(&explains);
    let command = quickest(evidence, &explains);
    let Candidate { cause, evidence: mut sentences, mut ruled_out, .. } = candidate;
    sentences.dedup();
    sentences.truncate(EVIDENCE);
    ruled_out.dedup();
    ruled_out.truncate(EVIDENCE);
    Headline {
        cause: cause.name.to_owned(),
        mistake: cause.headline.to_owned(),
        look_at: cause.look_at.to_owned(),
        fix: cause.fix.to_owned(),
        tier,
        evidence: sentences,
        ruled_out,
        explains,
        may_follow: Vec::new(),
        blocked,
        command,
    }
}

/// What no cause explains may follow from the one that explains the most, of those that show no later than it; of equals
/// from the first. Answers what is left.
fn attribute(orphans: Vec<String>, headlines: &mut [Headline]) -> Vec<String> {
    let mut unexplained = Vec::new();
    for case in orphans {
        let shows_before = |headline: &&mut Headline| {
            headline.explains.iter().any(|other| Part::position(other) <= Part::position(&case))
        };
        let likely = headlines.iter_mut().rev().filter(shows_before);
        match likely.max_by_key(|headline| headline.explains.len()) {
            Some(headline) => headline.may_follow.push(case),
            None => unexplained.push(case),
        }
    }
    unexplained
}

fn quickest(evidence: &Evidence<'_>, cases: &[String]) -> String {
    let failures = evidence.failures().chain(evidence.failures_of_robustness());
    let failures = failures.filter(|seen| cases.iter().any(|case| case == seen.case));
    let quickest = failures.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
    quickest.map(|seen| seen.rerun.to_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::case::Tier;
    use crate::cause::{bsdf, bvh, integrator, light, shape};
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, failing, passing};

    #[test]
    fn nothing_failed_and_nothing_is_blamed() {
        let made = Made::new().with("bsdf/a", passing());
        assert_eq!(diagnose(&made.evidence()), super::Diagnosis::default());
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
            .blocked("image/e", "bsdf/a");
        let diagnosis = diagnose(&made.evidence());
        let [first, second] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(first.cause, bsdf::WITHOUT_PI.name);
        assert_eq!(first.explains, ["bsdf/a", "light/b"]);
        assert_eq!(first.may_follow, ["light/c"], "an earlier failure does not follow from it");
        assert_eq!(first.blocked, 1);
        assert_eq!(second.cause, integrator::ROULETTE_NOT_DIVIDED.name);
        assert_eq!(diagnosis.unexplained, ["camera/d"]);
    }

    #[test]
    fn what_nothing_explains_may_follow_from_what_explains_the_most() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&shape::SPHERE_CANCELLATION, "x"))
            .with("light/b", failing("b").because(&bsdf::WITHOUT_PI, "y"))
            .with("light/c", failing("c").because(&bsdf::WITHOUT_PI, "y"))
            .with("integrator/d", failing("who knows"))
            .with("bvh/e", failing("who knows"));
        let diagnosis = diagnose(&made.evidence());
        let [first, second] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(
            (&first.may_follow[..], &second.may_follow[..]),
            (&["bvh/e".to_owned()][..], &["integrator/d".to_owned()][..])
        );
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
    fn a_mistake_of_the_hierarchy_that_has_a_name_explains_the_leaks_of_part_one() {
        let made = Made::new()
            .with("shape/a", failing("a").because(&bvh::HITS_LOST, "the loop meets them"))
            .with("bvh/b", failing("b").because(&bvh::RANGE_OVERWRITTEN, "y"));
        let diagnosis = diagnose(&made.evidence());
        let [only] = &diagnosis.headlines[..] else { panic!("{diagnosis:?}") };
        assert_eq!(only.cause, bvh::RANGE_OVERWRITTEN.name);
        assert_eq!((only.explains.len(), diagnosis.unexplained.len()), (2, 0));
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
