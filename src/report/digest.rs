//! What every report says first of a run: how many of what, part by part, what failed, what was
//! spent, and how large an error could still hide.

use super::tree::RunTree;
use crate::case::{PARTS, Part, Tier};
use crate::checks::Finding;
pub(crate) use crate::run::Tally;
use crate::run::record::CoreRecord;
use crate::run::{Status, TrialRecord};
use crate::stats::{Ledger, TestKind};
use std::collections::BTreeMap;

/// Some trials of one part of a path tracer.
#[derive(Clone, Debug)]
pub(crate) struct PartGroup<'a> {
    /// As the course numbers it; none for folders that belong to no part.
    pub(crate) number: Option<u32>,
    pub(crate) title: &'static str,
    pub(crate) trials: Vec<&'a TrialRecord>,
}

impl<'a> PartGroup<'a> {
    /// What the core could be asked: that it cannot says nothing about it.
    pub(crate) fn asked(&self) -> impl Iterator<Item = &'a TrialRecord> {
        let trials = self.trials.iter().copied();
        trials.filter(|trial| trial.outcome.status() != Status::Skipped)
    }

    pub(crate) fn seconds(&self) -> f64 {
        self.trials.iter().map(|trial| trial.timing.seconds).sum()
    }
}

/// Groups that are no part: folders that belong to none, and what is not graded.
const APART: [&str; 3] = ["other cases", "robustness, not graded", "informational, not graded"];

/// The group of [`APART`] that a trial belongs to if it belongs to no part.
const fn apart(tier: Tier) -> &'static str {
    match tier {
        Tier::Graded => APART[0],
        Tier::Robustness => APART[1],
        Tier::Informational => APART[2],
    }
}

/// Sorts trials into parts, in the order in which one rests on another. A folder that belongs to no
/// part is not dropped: it comes last.
pub(crate) fn by_part<'a>(trials: impl IntoIterator<Item = &'a TrialRecord>) -> Vec<PartGroup<'a>> {
    let group = |part: &Part| PartGroup {
        number: Some(part.number),
        title: part.title,
        trials: Vec::new(),
    };
    let mut groups: Vec<_> = PARTS.iter().map(group).collect();
    groups.extend(APART.map(|title| PartGroup { number: None, title, trials: Vec::new() }));
    for trial in trials {
        let number = Part::of_case(&trial.case).map(|part| part.number);
        let title = apart(trial.tier);
        let belongs = |group: &&mut PartGroup<'_>| match number {
            Some(number) if trial.tier.is_graded() => group.number == Some(number),
            _ => group.title == title,
        };
        if let Some(group) = groups.iter_mut().find(belongs) {
            group.trials.push(trial);
        }
    }
    groups.retain(|group| !group.trials.is_empty());
    groups
}

/// Trials with that status, the earliest part first, so that a cause stands before its consequences.
pub(crate) fn in_order_of_parts(tree: &RunTree, status: Status) -> Vec<&TrialRecord> {
    let mut trials: Vec<_> =
        tree.trials.iter().filter(|trial| trial.outcome.status() == status).collect();
    // Stable: of one case the cores keep their order.
    trials.sort_by_key(|trial| (Part::position(&trial.case), &trial.case));
    trials
}

/// What counts against a core, in the order in which to look at it.
pub(crate) fn failures(tree: &RunTree) -> Vec<&TrialRecord> {
    let mut trials: Vec<_> = Status::ALL
        .into_iter()
        .filter(|status| status.is_failure())
        .flat_map(|status| in_order_of_parts(tree, status))
        .filter(|trial| trial.tier.is_graded())
        .collect();
    trials.sort_by_key(|trial| (Part::position(&trial.case), &trial.case));
    trials
}

/// What went wrong beside the grade: shown, and not held against the core.
pub(crate) fn ungraded_failures(tree: &RunTree) -> Vec<&TrialRecord> {
    let failing =
        |trial: &&TrialRecord| !trial.tier.is_graded() && trial.outcome.status().is_failure();
    tree.trials.iter().filter(failing).collect()
}

/// What these trials spent of the probability of failing a correct core, hypothesis by hypothesis. What is not
/// graded cannot.
pub(crate) fn ledger<'a>(trials: impl IntoIterator<Item = &'a TrialRecord>) -> Ledger {
    let graded = trials.into_iter().filter(|trial| trial.tier.is_graded());
    graded.filter_map(|trial| trial.outcome.finding()).flat_map(Finding::hypotheses).collect()
}

/// The [`ledger`] of the core that has spent most: every core is judged for itself.
pub(crate) fn dearest_ledger(tree: &RunTree) -> Ledger {
    let of_core = |core: &CoreRecord| ledger(tree.trials_of(&core.spec));
    let ledgers = tree.run.cores.iter().map(of_core);
    ledgers.max_by(|a, b| a.spent().total_cmp(&b.spent())).unwrap_or_default()
}

/// The largest relative error that any hypothesis of a kind would have passed: what a ledger cannot
/// know. None where no hypothesis of the kind states one.
pub(crate) fn worst_resolution<'a>(
    trials: impl IntoIterator<Item = &'a TrialRecord>,
    kind: TestKind,
) -> Option<f64> {
    let findings = trials.into_iter().filter_map(|trial| trial.outcome.finding());
    let measures = findings.flat_map(|finding| &finding.measures);
    let of_kind = measures.filter(|measure| measure.hypothesis.is_some_and(|one| one.kind == kind));
    of_kind.filter_map(|measure| measure.resolution).max_by(f64::total_cmp)
}

/// The passes with the largest relative error that each would have passed, the one that proves least first.
/// Passes whose measures state no resolution are left out.
pub(crate) fn weakest_first<'a>(
    trials: impl IntoIterator<Item = &'a TrialRecord>,
) -> Vec<(&'a TrialRecord, f64)> {
    let passes = trials.into_iter().filter(|trial| trial.outcome.status() == Status::Pass);
    let mut sorted: Vec<_> = passes.filter_map(|trial| Some((trial, resolution(trial)?))).collect();
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1));
    sorted
}

/// The largest relative error that any measure of the trial would have passed; NaN is beyond every bound.
fn resolution(trial: &TrialRecord) -> Option<f64> {
    let measures = trial.outcome.finding()?.measures.iter();
    let resolutions = measures.filter_map(|measure| measure.resolution);
    resolutions.map(|r| if r.is_nan() { f64::INFINITY } else { r }).reduce(f64::max)
}

/// The smallest error that a trial would have caught, as its check words it; where there is none, why.
pub(crate) fn resolution_in_words(trial: &TrialRecord) -> String {
    match trial.outcome.finding() {
        Some(finding) if !finding.resolution.is_empty() => finding.resolution.clone(),
        Some(_) => "nothing was measured".to_owned(),
        None => format!("nothing ({})", trial.outcome.status().word()),
    }
}

pub(crate) fn slowest_first<'a>(
    trials: impl IntoIterator<Item = &'a TrialRecord>,
) -> Vec<&'a TrialRecord> {
    let mut sorted: Vec<_> = trials.into_iter().collect();
    sorted.sort_by(|a, b| b.timing.seconds.total_cmp(&a.timing.seconds));
    sorted
}

#[derive(Clone, Debug)]
pub(crate) struct CaseGroup<'a> {
    /// One trial a core that has one, in the order the cores were asked. Never empty.
    pub(crate) trials: Vec<&'a TrialRecord>,
}

impl<'a> CaseGroup<'a> {
    /// The trial that stands for what all of them share: claim, source, check.
    pub(crate) fn first(&self) -> &'a TrialRecord {
        self.trials[0]
    }
}

pub(crate) fn by_case(tree: &RunTree) -> Vec<CaseGroup<'_>> {
    let mut cases: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for trial in &tree.trials {
        cases.entry((Part::position(&trial.case), &trial.case)).or_default().push(trial);
    }
    cases.into_values().map(|trials| CaseGroup { trials }).collect()
}

/// A sentence begins with a capital.
pub(crate) fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::{Example, trial};
    use crate::run::{Counts, Outcome};

    #[test]
    fn headlines_never_call_absence_a_pass() {
        let pass = trial("builtin", "bvh/a");
        let mut skipped = trial("builtin", "bvh/b");
        skipped.outcome = Outcome::Skipped { missing: vec!["render".to_owned()] };
        let headline = |trials: &[&TrialRecord]| Counts::of(9, trials.iter().copied()).headline();
        assert_eq!(headline(&[]), "no graded trial has a result");
        assert_eq!(headline(&[&pass]), "1 trial passes");
        assert_eq!(headline(&[&pass, &pass]), "all 2 trials pass");
        assert_eq!(headline(&[&skipped]), "0 of 1 trial pass, none fails");
        assert_eq!(headline(&[&pass, &skipped]), "1 of 2 trials pass, none fails");
        skipped.tier = Tier::Informational;
        assert_eq!(headline(&[&pass, &pass, &skipped]), "all 2 graded trials pass");
    }

    #[test]
    fn every_trial_is_counted_once() {
        let mut informs = trial("builtin", "bvh/b");
        informs.tier = Tier::Informational;
        informs.outcome = Outcome::Blocked { by: "bvh/a".to_owned() };
        let counts = Counts::of(3, [&trial("builtin", "bvh/a"), &informs]);
        assert_eq!(counts.trials(), "2 of 3 trials");
        assert_eq!(counts.words(), "1 pass, 1 not graded");
    }

    #[test]
    fn a_folder_of_no_part_is_not_dropped() {
        let trials = [trial("builtin", "elsewhere/claim"), trial("builtin", "bvh/claim")];
        let groups = by_part(&trials);
        let numbers: Vec<_> = groups.iter().map(|group| group.number).collect();
        assert_eq!(numbers, [Some(2), None]);
    }

    #[test]
    fn the_earliest_part_fails_first() {
        let tree = Example::mixed().tree();
        let positions: Vec<_> =
            failures(&tree).iter().map(|trial| Part::position(&trial.case)).collect();
        assert!(positions.len() > 2 && positions.is_sorted(), "{positions:?}");
    }

    #[test]
    fn the_ledger_adds_up() {
        let tree = Example::mixed().tree();
        let builtin = ledger(tree.trials_of("builtin"));
        let textbook = ledger(tree.trials_of("textbook"));
        let both = ledger(&tree.trials);
        assert!(builtin.spent() > textbook.spent() && textbook.spent() > 0.0);
        assert!((both.spent() - builtin.spent() - textbook.spent()).abs() < 1e-18);
        assert_eq!(both.hypotheses(), builtin.hypotheses() + textbook.hypotheses());
        assert_eq!(dearest_ledger(&tree), builtin);
        let worst = worst_resolution(&tree.trials, TestKind::Mean).unwrap();
        assert!((0.012..0.016).contains(&worst), "{worst}");
    }

    #[test]
    fn every_case_appears_once_with_all_its_cores() {
        let tree = Example::mixed().tree();
        let cases = by_case(&tree);
        assert_eq!(cases.iter().map(|case| case.trials.len()).sum::<usize>(), tree.trials.len());
        assert!(cases.iter().all(|case| case.trials.iter().all(|t| t.case == case.first().case)));
    }
}
