//! One cause and all that it explains, or what differs without one, in words.

use super::factor::Factor;
use super::shared::Shared;
use super::{Degree, Evidence, Observation};
use crate::case::{Part, Tier};
use crate::cause::{self, Cause};
use crate::checks::law::{LOST_SAMPLES, ROUNDED};
use crate::contract::Components;
use serde::{Deserialize, Serialize};

/// Sentences of evidence that a headline keeps.
pub(super) const EVIDENCE: usize = 4;
/// Of the failures that rest on what a named cause breaks and that nothing else explains, it has to explain so many.
const NAMED: f64 = 0.95;

/// One cause and all that it explains, as `run.json` keeps it: in the words of the furnace that found it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Headline {
    /// The name of the mistake in the glossary; empty where nothing in it explains these failures.
    pub cause: String,
    /// How sure that is.
    #[serde(default)]
    pub(crate) degree: Degree,
    /// Whether the core crashed there, or did not answer in time: that is seen, whatever made it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) is_ending: bool,
    /// The mistake as one sentence without full stop.
    pub mistake: String,
    /// Where in a path tracer.
    pub look_at: String,
    /// What to do about it.
    pub fix: String,
    /// What the failures count for.
    pub tier: Tier,
    /// What gives the wrong answers of single functions, where no cause does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) laws: Vec<String>,
    /// What was seen.
    pub evidence: Vec<String>,
    /// What else could have been, and why it is not.
    pub ruled_out: Vec<String>,
    /// The failing cases that it explains, the earliest part first.
    pub explains: Vec<String>,
    /// Failing cases that nothing explains and that rest on what these prove: they may follow from it.
    pub may_follow: Vec<String>,
    /// How many cases are blocked by it.
    pub blocked: usize,
    /// The command that repeats the quickest of the failing cases that the evidence is about.
    pub command: String,
}

/// The laws of what failed. A share of lost samples may be half by chance, where half of the light is lost and half of the
/// directions are dark in their own right: it is told of most of the light that failed, or not at all. What is right to single
/// precision is told where all is.
fn laws<'e, 'a: 'e>(failures: impl Iterator<Item = &'e Observation<'a>>) -> Vec<String> {
    let (mut laws, mut light, mut losing, mut are_rounded) = (Vec::new(), 0, 0, true);
    for (failure, finding) in failures.filter_map(|failure| Some((failure, failure.finding?))) {
        light += usize::from(failure.is_about_light() && !failure.is_dark());
        losing += usize::from(finding.laws.iter().any(|law| law == LOST_SAMPLES));
        are_rounded &= is_rounded(&finding.laws);
        laws.extend(finding.laws.iter().cloned());
    }
    laws.retain(|law| law != LOST_SAMPLES || 2 * losing > light);
    laws.retain(|law| law != ROUNDED || are_rounded);
    laws
}

fn is_rounded(laws: &[String]) -> bool {
    laws.iter().any(|law| law == ROUNDED)
}

impl Headline {
    /// Graded failures that differ, and no cause yet.
    pub(super) fn of(
        evidence: &Evidence<'_>,
        explains: Vec<String>,
        mut sentences: Vec<String>,
    ) -> Self {
        let command = quickest(evidence, &explains, &sentences);
        sentences.dedup();
        sentences.truncate(EVIDENCE);
        let laws = laws(explains.iter().filter_map(|case| evidence.failure_of(case)));
        Self {
            degree: Degree::DiffersHere,
            laws,
            evidence: sentences,
            blocked: evidence.blocked_by(&explains),
            command,
            explains,
            ..Self::default()
        }
    }

    /// The same with the words of a cause.
    pub(super) fn because(self, cause: &Cause) -> Self {
        Self {
            cause: cause.name.to_owned(),
            mistake: cause.headline.to_owned(),
            look_at: cause.look_at.to_owned(),
            fix: cause.fix.to_owned(),
            ..self
        }
    }

    /// The same, which differs in this way: `what differs is the core's BSDF: its f is …`.
    pub(super) fn differing(self, what: &str) -> Self {
        let mut laws: Vec<_> = self.laws.iter().map(String::as_str).collect();
        laws.dedup();
        let mistake = match &laws[..] {
            [] => what.to_owned(),
            [first] => format!("{what}: {first}"),
            [first, second, ..] => format!("{what}: {first}, {second}"),
        };
        Self { mistake, ..self }
    }

    /// The same with what these failures share, and what passes with the core's own has not.
    pub(super) fn under(mut self, evidence: &Evidence<'_>, own: Components) -> Self {
        let failures = || self.explains.iter().filter_map(|case| evidence.failure_of(case));
        let factor = Factor::of(failures()).filter(|_| self.laws.is_empty());
        let factor = factor.map(|factor| format!(": {}", factor.in_words()));
        // What passes with the bench's own says nothing; where no component is known, with any of its own.
        let may_fail = |seen: &&Observation<'_>| match own.is_empty() {
            true => seen.with.is_empty(),
            false => !seen.with.intersects(own),
        };
        let passing = evidence.passed().filter(may_fail);
        let shared = Shared::of(
            failures().filter(|seen| seen.is_about_light()),
            passing.filter(|seen| seen.is_about_light()),
        );
        if let (Some(shared), true) = (&shared, self.laws.is_empty()) {
            let place = shared.place().map(|place| format!(", {place}"));
            self.mistake += &place.unwrap_or_default();
        }
        self.mistake += &factor.unwrap_or_default();
        let Some(shared) = shared else { return self };
        self.evidence.insert(self.evidence.len().min(1), shared.in_words());
        self.evidence.truncate(EVIDENCE);
        self
    }

    /// One failure without a cause: its trial says all there is.
    pub(crate) fn is_alone(&self) -> bool {
        self.degree == Degree::DiffersHere && self.cause.is_empty() && self.explains.len() == 1
    }

    /// Whether it explains the failure, or the failure may follow from it.
    pub(crate) fn accounts_for(&self, case: &str) -> bool {
        self.explains.iter().chain(&self.may_follow).any(|known| known == case)
    }

    /// The number of the part it is told in.
    pub(crate) fn part(&self) -> u32 {
        let parts = self.explains.iter().filter_map(|case| Part::of_case(case));
        let earliest = parts.map(|part| part.number).min().unwrap_or(u32::MAX);
        earliest.max(cause::find(&self.cause).map_or(0, part_of_mistake))
    }

    /// Where the earliest case that it explains stands in the order of subjects.
    pub(super) fn position(&self) -> usize {
        self.explains.iter().map(|case| Part::position(case)).min().unwrap_or(usize::MAX)
    }

    /// Whether `case` may follow from it: what rests on nothing that it explains does not.
    pub(super) fn comes_before(&self, case: &str) -> bool {
        self.position() <= Part::position(case)
    }

    /// Whether it tells what gave the answers their numbers.
    pub(super) fn is_sure(&self) -> bool {
        self.degree == Degree::Named && !self.is_symptom()
    }

    /// Whether it tells what a number is, and not what made it so.
    pub(super) fn is_symptom(&self) -> bool {
        cause::find(&self.cause).is_some_and(cause::is_symptom)
    }

    /// Takes in another headline of the same cause.
    pub(super) fn absorb(&mut self, other: Self) {
        self.degree = self.degree.max(other.degree);
        let [is_rounded, other_is] = [&self.laws, &other.laws].map(|laws| is_rounded(laws));
        self.laws.extend(other.laws);
        self.laws.retain(|law| law != ROUNDED || is_rounded && other_is);
        self.evidence.extend(other.evidence);
        self.evidence.truncate(EVIDENCE);
        for case in other.explains {
            if !self.explains.contains(&case) {
                self.explains.push(case);
            }
        }
        self.may_follow.extend(other.may_follow);
        self.may_follow.retain(|case| !self.explains.contains(case));
        self.blocked += other.blocked;
    }

    /// Both as one.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.absorb(other);
        self
    }

    pub(super) fn keeps_its_name(&self) -> bool {
        let (explained, others) = (self.explains.len() as f64, self.may_follow.len() as f64);
        explained >= NAMED * (explained + others)
    }
}

/// The part that a mistake is made in, where that is not the part in which it shows first.
pub(super) fn part_of_mistake(cause: &Cause) -> u32 {
    if cause::is_of_bvh(cause) { Part::BVH } else { 0 }
}

/// Of the cases that the sentences are about, or else of all.
fn quickest(evidence: &Evidence<'_>, cases: &[String], sentences: &[String]) -> String {
    let failures = evidence.failures().chain(evidence.failures_of_robustness());
    let failures = failures.filter(|seen| cases.iter().any(|case| case == seen.case));
    let tells = |case: &str| sentences.iter().any(|sentence| sentence.starts_with(case));
    let quickest = failures.min_by_key(|seen| (!tells(seen.case), seen.work));
    quickest.map(|seen| seen.rerun.to_owned()).unwrap_or_default()
}
