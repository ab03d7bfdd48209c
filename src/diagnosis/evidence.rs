//! What the rules see: the findings of one core in one run.

use crate::case::{Foundation, Part, Role, Subject, Tier};
use crate::checks::{Clue, Finding, Measure};
use crate::contract::{Circumstances, Components, Conventions};
use crate::image::Channel;
use std::cmp::Ordering;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    Passed,
    Failed,
    /// It was not tried, since the named case failed.
    Blocked(String),
    /// Nothing is known: inconclusive, skipped, broken.
    Unknown,
}

/// How a core stopped answering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending<'a> {
    /// In its own words.
    Refused {
        why: &'a str,
    },
    Crashed {
        how: &'a str,
        during: &'a str,
    },
    TimedOut {
        during: &'a str,
    },
}

#[derive(Clone, Debug)]
pub(crate) struct Observation<'a> {
    /// Folder and claim.
    pub(crate) case: &'a str,
    pub(crate) tier: Tier,
    /// What it shows to the rules, if they ask for it.
    pub(crate) role: Option<Role>,
    /// Whether its scene has a mirror or smooth glass.
    pub(crate) is_specular: bool,
    /// What it rests on in the core: not what it took from the bench.
    pub(crate) rests_on: Vec<Foundation>,
    pub(crate) proves: &'a [Foundation],
    pub(crate) standing: Standing,
    /// None where the core answered.
    pub(crate) ending: Option<Ending<'a>>,
    pub(crate) finding: Option<&'a Finding>,
    pub(crate) rerun: &'a str,
    /// How much the core was asked.
    pub(crate) work: u64,
    /// What was in its scenes and settings.
    pub(crate) circumstances: Circumstances,
    /// What the core took from the bench.
    pub(crate) with: Components,
}

impl Observation<'_> {
    pub(crate) fn is_about(&self, subject: Subject) -> bool {
        Subject::of_case(self.case) == Some(subject)
    }

    pub(crate) fn is_about_light(&self) -> bool {
        [Subject::Light, Subject::Integrator, Subject::Image].into_iter().any(|s| self.is_about(s))
    }

    pub(crate) fn has_failed(&self) -> bool {
        self.standing == Standing::Failed
    }

    /// Whether all that is wrong is next to nothing, or NaN.
    pub(crate) fn is_dark(&self) -> bool {
        self.is_wrong_by(Measure::is_degenerate)
    }

    /// Whether all that is wrong is less than it should be.
    pub(crate) fn is_too_weak(&self) -> bool {
        self.is_wrong_by(|measure| measure.measured < measure.expected)
    }

    /// Whether there are wrong numbers, and all of them are so.
    fn is_wrong_by(&self, is_so: impl Fn(&Measure) -> bool) -> bool {
        let mut wrong = self.finding.into_iter().flat_map(Finding::failed_measures).peekable();
        wrong.peek().is_some() && wrong.all(is_so)
    }
}

/// The findings of one core in one run, in the order of parts.
#[derive(Clone, Debug)]
pub(crate) struct Evidence<'a> {
    observations: Vec<Observation<'a>>,
    pub(crate) conventions: Conventions,
}

impl<'a> Evidence<'a> {
    /// Sorts `observations` into the order in which one part rests on another.
    pub(crate) fn new(mut observations: Vec<Observation<'a>>, conventions: Conventions) -> Self {
        observations
            .sort_by_key(|observation| (Part::position(observation.case), observation.case));
        Self { observations, conventions }
    }

    /// Graded cases that failed, the earliest part first.
    pub(crate) fn failures(&self) -> impl Iterator<Item = &Observation<'a>> {
        self.observations
            .iter()
            .filter(|seen| seen.standing == Standing::Failed && seen.tier.is_graded())
    }

    /// Failures of robustness, which count nothing, in the same order.
    pub(crate) fn failures_of_robustness(&self) -> impl Iterator<Item = &Observation<'a>> {
        self.observations
            .iter()
            .filter(|seen| seen.standing == Standing::Failed && seen.tier == Tier::Robustness)
    }

    /// What checks recognised in cases that only inform.
    pub(crate) fn informed(&self) -> impl Iterator<Item = &Clue> {
        let informs =
            |seen: &&Observation<'_>| seen.has_failed() && seen.tier == Tier::Informational;
        let findings = self.observations.iter().filter(informs).filter_map(|seen| seen.finding);
        findings.flat_map(|finding| &finding.clues)
    }

    /// Everything that failed, what counts nothing last.
    pub(crate) fn all_failures(&self) -> impl Iterator<Item = &Observation<'a>> {
        self.failures().chain(self.failures_of_robustness())
    }

    /// Everything that passed.
    pub(crate) fn passed(&self) -> impl Iterator<Item = &Observation<'a>> {
        self.observations.iter().filter(|seen| seen.standing == Standing::Passed)
    }

    /// Whether light was judged in some scene, so that it was built.
    pub(crate) fn has_lit_a_scene(&self) -> bool {
        self.observations.iter().any(|seen| seen.is_about_light() && seen.finding.is_some())
    }

    pub(crate) fn fails(&self, case: &str) -> bool {
        self.failure_of(case).is_some()
    }

    /// What was seen of a case, if it failed.
    pub(crate) fn failure_of(&self, case: &str) -> Option<&Observation<'a>> {
        self.all_failures().find(|seen| seen.case == case)
    }

    /// Whether a case was tried, or would have been if another had not failed.
    pub(crate) fn has_asked(&self, case: &str) -> bool {
        self.observations.iter().any(|seen| seen.case == case && seen.standing != Standing::Unknown)
    }

    /// The same with these alone of its failures.
    pub(crate) fn with_failures_of(&self, cases: &[&str]) -> Self {
        let stays = |seen: &&Observation<'_>| {
            seen.standing != Standing::Failed || cases.contains(&seen.case)
        };
        let observations = self.observations.iter().filter(stays).cloned().collect();
        Self { observations, ..*self }
    }

    fn of(&self, role: Role) -> Option<&Observation<'a>> {
        self.observations.iter().find(|seen| seen.role == Some(role))
    }

    /// The name of the case of a role; empty where it was not selected.
    pub(crate) fn case(&self, role: Role) -> &'a str {
        self.of(role).map_or("", |seen| seen.case)
    }

    pub(crate) fn finding(&self, role: Role) -> Option<&'a Finding> {
        self.of(role)?.finding
    }

    /// The finding of the case of a role, if it failed.
    pub(crate) fn failed_finding(&self, role: Role) -> Option<&'a Finding> {
        let seen = self.of(role)?;
        (seen.standing == Standing::Failed).then_some(seen.finding)?
    }

    pub(crate) fn has_passed(&self, role: Role) -> bool {
        self.of(role).is_some_and(|seen| seen.standing == Standing::Passed)
    }

    /// Whether it was tried and did not fail: it passed, or noise left it open.
    pub(crate) fn has_withstood(&self, role: Role) -> bool {
        self.finding(role).is_some() && self.failed_finding(role).is_none()
    }

    pub(crate) fn rests_on(&self, case: &str) -> &[Foundation] {
        self.observations.iter().find(|seen| seen.case == case).map_or(&[], |seen| &seen.rests_on)
    }

    /// Whether all light of `case` that is wrong is wrong on the other side.
    pub(crate) fn contradicts(&self, case: &str, side: Ordering) -> bool {
        let seen = self.observations.iter().find(|seen| seen.case == case);
        let Some(finding) = seen.and_then(|seen| seen.finding) else { return false };
        let of_light = |measure: &&Measure| measure.channel.is_some() && measure.expected > 0.0;
        let mut wrong = finding.failed_measures().filter(of_light).peekable();
        let other_side = Some(side.reverse());
        wrong.peek().is_some()
            && wrong.all(|measure| measure.measured.partial_cmp(&measure.expected) == other_side)
    }

    /// What is proven by any of `cases`.
    pub(crate) fn proven_by(&self, cases: &[String]) -> Vec<Foundation> {
        let of_cases = self.observations.iter().filter(|seen| cases.iter().any(|c| c == seen.case));
        of_cases.flat_map(|seen| seen.proves).copied().collect()
    }

    /// Whether the core's own `component` has passed all that prove it, alone or with what it is made of.
    pub(crate) fn has_proven(&self, component: Components) -> bool {
        let is_of_it = |foundation: &Foundation| foundation.components().contains(component);
        let proves = |seen: &&Observation<'_>| {
            seen.proves.iter().any(is_of_it) && !seen.with.intersects(component)
        };
        let mut proving = self.observations.iter().filter(proves).peekable();
        proving.peek().is_some() && proving.all(|seen| seen.standing == Standing::Passed)
    }

    /// How many graded cases rest on one of these.
    pub(crate) fn blocked_by(&self, cases: &[String]) -> usize {
        let is_blocked = |seen: &&Observation<'_>| match &seen.standing {
            Standing::Blocked(by) => seen.tier.is_graded() && cases.contains(by),
            _ => false,
        };
        self.observations.iter().filter(is_blocked).count()
    }
}

pub(crate) fn measure<'f>(
    finding: &'f Finding,
    row: &str,
    channel: Channel,
) -> Option<&'f Measure> {
    let is_it = |measure: &&Measure| measure.row == row && measure.channel == Some(channel);
    finding.measures.iter().find(is_it)
}
