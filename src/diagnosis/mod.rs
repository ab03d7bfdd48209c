//! From the findings of a whole run to causes: numbers in, sentences out.
//!
//! A failing case says that something is wrong; a cause says what. Each rule looks at the findings of one core and
//! suspects causes of the glossary ([`crate::cause`]), with the numbers that speak for them and what they rule out.
//! The suspicions are then ranked, and failures that share a cause become one headline. In a run each cause is put to the
//! proof by a core with that mistake ([`Planted`]).
//!
//! To add a rule: a file with a function from [`Evidence`] to suspicions, tested on made-up numbers, and its line in
//! [`RULES`].

mod apart;
mod bounce_laws;
mod bounces;
mod clues;
mod conventions;
mod differences;
mod directions;
mod endings;
mod evidence;
mod factor;
mod generic_position;
mod headline;
mod mirrors;
mod pictures;
mod rank;
mod readings;
mod reproduction;
mod roulette;
mod shadows;
mod shared;
#[cfg(test)]
mod testing;

pub(crate) use apart::{View, diagnose_apart};
pub(crate) use bounce_laws::Isolation;
pub(crate) use bounces::isolation;
pub(crate) use evidence::{Ending, Evidence, Observation, Standing};
pub(crate) use headline::Headline;
pub(crate) use rank::Diagnosis;
pub(crate) use reproduction::{Mistake, Planted, Question};

use crate::cause::Cause;
use rank::Ranked;
use reproduction::{MadeIn, Refuted, proven};
use serde::{Deserialize, Serialize};

/// How sure a headline is of its cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Degree {
    /// Where and by how much; no cause.
    DiffersHere,
    /// It fits, and others may too.
    #[default]
    LooksLike,
    /// It alone predicts the numbers.
    Named,
}

impl Degree {
    /// Of one among `fitting` causes that predict the numbers.
    pub(crate) const fn of_one_among(fitting: usize) -> Self {
        if fitting == 1 { Self::Named } else { Self::LooksLike }
    }

    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::DiffersHere => "differs here",
            Self::LooksLike => "looks like",
            Self::Named => "named",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Suspicion {
    pub(crate) cause: &'static Cause,
    /// The failing cases that it would explain.
    pub(crate) cases: Vec<String>,
    /// What speaks for it, a sentence each, with numbers.
    pub(crate) evidence: Vec<String>,
    pub(crate) ruled_out: Vec<RuledOut>,
    /// How well it explains a case: 1 if it is the first thing to think of, less for each that comes before it.
    pub(crate) weight: f64,
    pub(crate) degree: Degree,
    /// Whether it explains in these cases what no other does.
    pub(crate) beside: bool,
}

/// What else could have been, and why it is not.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RuledOut {
    what: String,
    why: String,
}

impl RuledOut {
    fn new(what: impl Into<String>, why: impl Into<String>) -> Self {
        Self { what: what.into(), why: why.into() }
    }
}

pub(crate) struct Rule {
    /// As `furnace list rules` shows it.
    pub(crate) name: &'static str,
    /// What it compares with what, in one line.
    pub(crate) summary: &'static str,
    run: fn(&Evidence<'_>) -> Vec<Suspicion>,
}

/// Every rule. Their order does not matter: suspicions are ranked by what they explain.
pub(crate) static RULES: &[Rule] = &[
    Rule { name: "clues", summary: "what a check itself has recognised", run: clues::suspect },
    Rule {
        name: "pictures",
        summary: "what all failing images resemble, and in one size",
        run: pictures::suspect,
    },
    Rule {
        name: "conventions",
        summary: "the choices that a core may declare: it differs from what it declares",
        run: conventions::suspect,
    },
    Rule {
        name: "generic-position",
        summary: "ratios of direct light in two scenes in general position against known mistakes",
        run: generic_position::suspect,
    },
    Rule {
        name: "bounces",
        summary: "energy bounce by bounce against laws such as q^k and albedo^k",
        run: bounces::suspect,
    },
    Rule {
        name: "directions",
        summary: "bounces that have the right energy where only directions are wrong",
        run: directions::suspect,
    },
    Rule { name: "shadows", summary: "what blocks light and what does not", run: shadows::suspect },
    Rule { name: "mirrors", summary: "mirrors and glass that show nothing", run: mirrors::suspect },
    Rule {
        name: "roulette",
        summary: "means under Russian roulette against what forgotten divisions would give",
        run: roulette::suspect,
    },
];

/// The causes of what failed, the first to look at first.
pub(crate) fn diagnose(evidence: &Evidence<'_>) -> Diagnosis {
    look_without(evidence, &Refuted::new(), Vec::new()).told()
}

/// The same, put to the proof.
pub(crate) fn diagnose_proven(evidence: &Evidence<'_>, planted: &dyn Planted) -> Diagnosis {
    proven(evidence, planted, MadeIn::Unknown).told()
}

/// What the rules suspect and is not refuted, and what was found beside.
fn look_without(evidence: &Evidence<'_>, refuted: &Refuted, found: Vec<Suspicion>) -> Ranked {
    let mut suspicions: Vec<_> = RULES.iter().flat_map(|rule| (rule.run)(evidence)).collect();
    for suspicion in &mut suspicions {
        let cause = suspicion.cause.name;
        suspicion.cases.retain(|case| !refuted.contains(&(cause, case.clone())));
    }
    suspicions.extend(each_told_once(found));
    rank::rank(evidence, suspicions, refuted)
}

/// What is found again, and in more cases, is told with these alone.
fn each_told_once(mut found: Vec<Suspicion>) -> Vec<Suspicion> {
    let tells_more = |later: &Suspicion, one: &Suspicion| {
        let has = |case: &String| later.cases.contains(case);
        later.cause.name == one.cause.name && one.cases.iter().all(has)
    };
    for number in 0..found.len() {
        let (before, after) = found.split_at_mut(number + 1);
        let one = &mut before[number];
        if after.iter().any(|later| tells_more(later, one)) {
            one.evidence.clear();
        }
    }
    found
}
