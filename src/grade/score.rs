//! What each outcome is worth.
//!
//! A pass earns the points of its case, a failure the share of its rows that pass. What is neither proven right nor proven
//! wrong (inconclusive, blocked, broken, not tried) earns nothing and loses nothing: its points stay open, and are told
//! apart, for the fault is the bench's or another case's. What the suite asks for and the core lacks is lost.

use super::suite::{Part, Partial, Selected, Suite};
use super::{CaseGrade, Entry, Grade, PartGrade, Points, Standing, Told, VERSION};
use crate::case::Case;
use crate::checks::Finding;
use crate::contract::Capabilities;
use crate::diagnosis::Headline;
use crate::report::RunTree;
use crate::run::record::{CoreRecord, Number};
use crate::run::{Outcome, TrialRecord};
use crate::stats::Verdict;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

impl Grade {
    /// What the core of a run has earned. Cases that the run has not tried are open.
    pub(crate) fn of(suite: &Suite, selected: &Selected, salt: &str, tree: &RunTree) -> Self {
        let Some(core) = tree.run.cores.first() else { return Self::absent(suite, "", "no core") };
        let trials: BTreeMap<_, _> =
            tree.trials_of(&core.spec).map(|trial| (trial.case.as_str(), trial)).collect();
        let mut hidden = BTreeSet::new();
        let mut parts = Vec::new();
        // Names that no furnace of today knows are no capabilities of today's.
        let can = Capabilities::from_names(&core.capabilities).unwrap_or_default();
        for (part, cases, lots) in selected.parts(suite, salt) {
            // Where nothing is to be replaced, what was found with something replaced is no answer.
            let is_asked = |trial: &&TrialRecord| part.transplants || trial.with.is_empty();
            let grade = |case: &Arc<Case>| {
                let trial = trials.get(case.id.as_str()).copied().filter(is_asked);
                let standing = standing(suite, case, trial, can);
                case_grade(part, case, standing, lots.contains(&case.id), trial)
            };
            let graded = cases.iter().filter(|case| case.tier.is_graded());
            parts.push(part_grade(part, graded.map(grade).collect()));
            hidden.extend(lots);
        }
        let points = parts.iter().map(|part: &PartGrade| part.points);
        Self {
            points: points.fold(Points::default(), Points::and),
            parts,
            causes: told(core, &hidden),
            leaderboard: leaderboard(core),
            problem: core.problem.clone(),
            seconds: tree.run.timing.seconds,
            ..Self::absent(suite, &core.spec, "")
        }
    }

    /// Of a core that could not be asked.
    pub(crate) fn absent(suite: &Suite, core: &str, problem: &str) -> Self {
        let points = |of| Points { of, ..Points::default() };
        let part = |part: &Part| PartGrade {
            name: part.name.clone(),
            points: points(part.points),
            cases: Vec::new(),
        };
        Self {
            version: VERSION,
            suite: suite.name.clone(),
            suite_version: suite.version.clone(),
            title: suite.title.clone(),
            core: core.to_owned(),
            points: points(suite.parts.iter().map(|part| part.points).sum()),
            parts: suite.parts.iter().map(part).collect(),
            causes: Vec::new(),
            warnings: Vec::new(),
            leaderboard: Vec::new(),
            problem: Some(problem.to_owned()),
            seconds: None,
        }
    }
}

fn part_grade(part: &Part, mut cases: Vec<CaseGrade>) -> PartGrade {
    let counting = cases.iter().filter(|case| case.standing != Standing::LeftOut).count();
    let each = part.points / counting.max(1) as f64;
    for case in &mut cases {
        case.points = Points {
            of: case.points.of * each,
            earned: case.points.earned * each,
            open: case.points.open * each,
        };
    }
    // Where everything is left out nothing can be earned, and nothing is.
    let sum = cases.iter().map(|case| case.points).fold(Points::default(), Points::and);
    let points = Points { of: part.points, ..sum };
    PartGrade { name: part.name.clone(), points, cases }
}

/// Its points are shares of one.
fn case_grade(
    part: &Part,
    case: &Case,
    standing: Standing,
    hidden: bool,
    trial: Option<&TrialRecord>,
) -> CaseGrade {
    let finding = trial.and_then(|trial| trial.outcome.finding());
    let rows = finding.map_or([0, 0], rows);
    CaseGrade {
        case: case.id.clone(),
        title: case.title.clone(),
        teaches: case.teaches.clone(),
        standing,
        points: worth(standing, rows, part.partial),
        hidden,
        rows,
        with: trial.map_or(Vec::new(), |trial| trial.with.names()),
        statement: trial.map_or_else(
            || "not tried in time, or not as the suite asks".to_owned(),
            |t| t.outcome.statement(),
        ),
        rerun: trial.map_or(String::new(), |trial| trial.rerun.clone()),
        seconds: trial.map_or(0.0, |trial| trial.timing.seconds),
    }
}

fn standing(
    suite: &Suite,
    case: &Case,
    trial: Option<&TrialRecord>,
    can: Capabilities,
) -> Standing {
    // What the core has not written is not open because something else is broken.
    let lacking = case.prepared.missing(can).names();
    let undecided = |standing| match lacking.is_empty() {
        true => standing,
        false => lacks(suite, &lacking),
    };
    let Some(trial) = trial else { return undecided(Standing::NotTried) };
    if !trial.tier.is_graded() {
        return Standing::LeftOut;
    }
    match &trial.outcome {
        Outcome::Judged { finding } => match finding.verdict {
            Verdict::Pass => Standing::Pass,
            Verdict::Fail => Standing::Fail,
            Verdict::Inconclusive => Standing::Inconclusive,
        },
        Outcome::Skipped { missing } => lacks(suite, missing),
        Outcome::Blocked { .. } => undecided(Standing::Blocked),
        Outcome::Refused { .. } => Standing::Fail,
        Outcome::Crashed { .. } => Standing::Crashed,
        Outcome::TimedOut { .. } => Standing::TimedOut,
        Outcome::Broken { .. } => Standing::Broken,
    }
}

/// Of a core that lacks this. Whole words are excused only: a core may say what it likes of what it cannot.
fn lacks(suite: &Suite, missing: &[String]) -> Standing {
    let excused = !missing.is_empty() && missing.iter().all(|word| suite.optional.contains(word));
    if excused { Standing::LeftOut } else { Standing::Missing }
}

/// How many rows pass, of how many: a row passes where all its numbers do. What sums all of them up is none.
fn rows(finding: &Finding) -> [usize; 2] {
    let mut rows: BTreeMap<&str, bool> = BTreeMap::new();
    for measure in &finding.measures {
        let passes = measure.verdict == Verdict::Pass;
        *rows.entry(&measure.row).or_insert(true) &= passes;
    }
    if rows.len() > 1 {
        rows.remove("");
    }
    [rows.values().filter(|passes| **passes).count(), rows.len()]
}

/// Of one.
fn worth(standing: Standing, [passing, rows]: [usize; 2], partial: Partial) -> Points {
    let share = match partial {
        // What passes by its rows and fails as a whole has not shown that it is right.
        Partial::Rows if passing < rows => passing as f64 / rows as f64,
        _ => 0.0,
    };
    let earned = match standing {
        Standing::Pass => 1.0,
        Standing::Fail | Standing::Inconclusive => share,
        _ => 0.0,
    };
    let open = match standing {
        Standing::Inconclusive => 1.0 - share,
        Standing::Blocked | Standing::Broken | Standing::NotTried => 1.0,
        _ => 0.0,
    };
    let of = if standing == Standing::LeftOut { 0.0 } else { 1.0 };
    Points { of, earned, open }
}

/// The causes that are told: not those that are seen by hidden cases alone.
fn told(core: &CoreRecord, hidden: &BTreeSet<String>) -> Vec<Told> {
    let headlines = core.diagnosis.iter().flat_map(|diagnosis| &diagnosis.headlines);
    let tell = |headline: &Headline| {
        let seen = headline.explains.iter().filter(|case| !hidden.contains(*case));
        let explains: Vec<_> = seen.cloned().collect();
        let may_be_told = headline.tier.is_graded() && !explains.is_empty();
        may_be_told.then(|| Told {
            cause: headline.cause.clone(),
            degree: headline.degree,
            mistake: headline.mistake.clone(),
            evidence: headline.evidence.clone(),
            look_at: headline.look_at.clone(),
            fix: headline.fix.clone(),
            command: headline.command.clone(),
            explains,
        })
    };
    headlines.filter_map(tell).collect()
}

/// The numbers that a run keeps of itself, each once.
fn leaderboard(core: &CoreRecord) -> Vec<Entry> {
    let numbers = core.score.iter().flat_map(|score| &score.numbers);
    let entry = |number: &Number| Entry {
        name: format!("{} ({})", number.what, number.case.rsplit('/').next().unwrap_or_default()),
        value: number.value,
        more_is_better: number.more_is_better,
    };
    numbers.filter(|number| number.value.is_finite()).map(entry).collect()
}
