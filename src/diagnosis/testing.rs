//! Made-up findings for the tests of rules.

use super::{Ending, Evidence, Mistake, Observation, Planted, Question, Standing, diagnose};
use crate::case::{Foundation, Role, Tier};
use crate::checks::{Finding, Measure};
use crate::contract::{Circumstances, Components, Conventions};
use crate::image::Channel;
use crate::stats::Verdict;

/// What a made-up case is called, or is to the rules.
pub(crate) struct Name {
    case: String,
    role: Option<Role>,
}

impl From<&str> for Name {
    fn from(case: &str) -> Self {
        Self { case: case.to_owned(), role: None }
    }
}

impl From<Role> for Name {
    fn from(role: Role) -> Self {
        let subject = match role {
            Role::Furnace
            | Role::FurnaceByHemisphere
            | Role::FurnaceUnderRoulette
            | Role::Mirrors
            | Role::Cavity
            | Role::SidewaysWall
            | Role::LightInsideGlass => "integrator",
            _ => "light",
        };
        Self { case: format!("{subject}/{role:?}"), role: Some(role) }
    }
}

pub(crate) struct Made {
    findings: Vec<(Name, Finding)>,
    blocked: Vec<(String, String)>,
    tiers: Vec<(String, Tier)>,
    specular: Vec<String>,
    resting: Vec<(String, Vec<Foundation>)>,
    proving: Vec<(String, Vec<Foundation>)>,
    ended: Vec<(String, Ending<'static>)>,
    under: Vec<(String, Circumstances)>,
    work: u64,
    lent: Components,
    lent_to: Vec<(String, Components)>,
    pub(crate) conventions: Conventions,
}

impl Made {
    pub(crate) fn new() -> Self {
        let (findings, blocked, conventions) = Default::default();
        let (tiers, specular, resting, proving, ended, under) = Default::default();
        let (work, lent, lent_to) = (1, Components::empty(), Vec::new());
        Self {
            findings,
            blocked,
            tiers,
            specular,
            resting,
            proving,
            ended,
            under,
            work,
            lent,
            lent_to,
            conventions,
        }
    }

    pub(crate) fn with(mut self, case: impl Into<Name>, finding: Finding) -> Self {
        self.findings.push((case.into(), finding));
        self
    }

    /// The same with a case that counts nothing.
    pub(crate) fn beside_the_grade(mut self, case: &str) -> Self {
        self.tiers.push((case.to_owned(), Tier::Robustness));
        self
    }

    /// The same with a case that only informs.
    pub(crate) fn informing(mut self, case: &str) -> Self {
        self.tiers.push((case.to_owned(), Tier::Informational));
        self
    }

    /// The same with a case whose scene has a mirror or smooth glass.
    pub(crate) fn in_a_specular_scene(mut self, case: &str) -> Self {
        self.specular.push(case.to_owned());
        self
    }

    /// The same with what a case rests on.
    pub(crate) fn resting(mut self, case: &str, on: &[Foundation]) -> Self {
        self.resting.push((case.to_owned(), on.to_vec()));
        self
    }

    /// The same with what a case proves.
    pub(crate) fn proving(mut self, case: &str, foundations: &[Foundation]) -> Self {
        self.proving.push((case.to_owned(), foundations.to_vec()));
        self
    }

    /// The same with a case that the core did not answer.
    pub(crate) fn ended(mut self, case: &str, ending: Ending<'static>) -> Self {
        self.ended.push((case.to_owned(), ending));
        self
    }

    /// The same with what a case asks with.
    pub(crate) fn under(mut self, case: &str, circumstances: Circumstances) -> Self {
        self.under.push((case.to_owned(), circumstances));
        self
    }

    /// The same where each trial asked so much.
    pub(crate) fn taking(self, work: u64) -> Self {
        Self { work, ..self }
    }

    /// The same where the core has these from the bench.
    pub(crate) fn lent(self, lent: Components) -> Self {
        Self { lent, ..self }
    }

    /// The same where one case has these from the bench.
    pub(crate) fn lent_to(mut self, case: &str, lent: Components) -> Self {
        self.lent_to.push((case.to_owned(), lent));
        self
    }

    pub(crate) fn blocked(mut self, case: &str, by: &str) -> Self {
        self.blocked.push((case.to_owned(), by.to_owned()));
        self
    }

    /// The name of the cause that the rules put first.
    pub(crate) fn first(&self) -> Option<&'static str> {
        diagnose(&self.evidence()).first().map(|cause| cause.name)
    }

    pub(crate) fn evidence(&self) -> Evidence<'_> {
        let tried = self.findings.iter().map(|(Name { case, role }, finding)| {
            let standing = match finding.verdict {
                Verdict::Pass => Standing::Passed,
                Verdict::Fail => Standing::Failed,
                Verdict::Inconclusive => Standing::Unknown,
            };
            let tier = self.tiers.iter().find(|(of, _)| of == case).map(|(_, tier)| *tier);
            let tier = tier.unwrap_or_default();
            let (role, is_specular) = (*role, self.specular.contains(case));
            let finding = Some(finding);
            Observation { tier, role, is_specular, ..observation(case, standing, finding) }
        });
        let blocked = self
            .blocked
            .iter()
            .map(|(case, by)| observation(case, Standing::Blocked(by.clone()), None));
        let ended = self.ended.iter().map(|(case, ending)| Observation {
            ending: Some(*ending),
            ..observation(case, Standing::Failed, None)
        });
        let observed = tried.chain(blocked).chain(ended).map(|seen| Observation {
            rests_on: of_case(&self.resting, seen.case).to_vec(),
            proves: of_case(&self.proving, seen.case),
            work: self.work,
            with: self
                .lent_to
                .iter()
                .find(|(of, _)| of == seen.case)
                .map_or(self.lent, |(_, lent)| *lent),
            circumstances: self
                .under
                .iter()
                .find(|(of, _)| of == seen.case)
                .map_or_else(Circumstances::empty, |(_, circumstances)| *circumstances),
            ..seen
        });
        Evidence::new(observed.collect(), self.conventions)
    }
}

fn of_case<'a>(known: &'a [(String, Vec<Foundation>)], case: &str) -> &'a [Foundation] {
    known.iter().find(|(name, _)| name == case).map_or(&[], |(_, foundations)| foundations)
}

fn observation<'a>(
    case: &'a str,
    standing: Standing,
    finding: Option<&'a Finding>,
) -> Observation<'a> {
    Observation {
        case,
        tier: Tier::Graded,
        role: None,
        is_specular: false,
        rests_on: Vec::new(),
        proves: &[],
        standing,
        ending: None,
        finding,
        rerun: case,
        work: 1,
        circumstances: Circumstances::empty(),
        with: Components::empty(),
    }
}

/// A bench that can plant nothing.
pub(crate) struct Nothing;

impl Planted for Nothing {
    fn mistakes(&self) -> &[Mistake] {
        &[]
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        questions.iter().map(|_| None).collect()
    }
}

pub(crate) fn failing(statement: &str) -> Finding {
    Finding::failure(statement)
}

pub(crate) fn passing() -> Finding {
    Finding::of("right", "", vec![Measure::exact("t", 1.0, 1.0, 0.0)])
}

/// A mean of a row and a channel, of `expected`, that was measured as `ratio` of it, to a relative precision of `precision`.
pub(crate) fn mean(
    row: &str,
    channel: Channel,
    expected: f64,
    ratio: f64,
    precision: f64,
) -> Measure {
    let measured = expected * ratio;
    let half = precision * measured.abs().max(1e-3 * expected);
    let is_right = (ratio - 1.0).abs() <= precision + 1e-3;
    Measure {
        interval: Some([measured - half, measured + half]),
        verdict: Verdict::pass_if(is_right),
        ..Measure::exact("", measured, expected, 1e-3 * expected).of_row(row).of_channel(channel)
    }
}

pub(crate) fn means(measures: Vec<Measure>) -> Finding {
    Finding::of("means", "", measures)
}
