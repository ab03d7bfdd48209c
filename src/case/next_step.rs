//! What a core could implement next, by the number of cases that it would then be tried on.

use super::Case;
use crate::contract::Capabilities;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Capabilities to implement together, and what that is worth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NextStep {
    pub(crate) missing: Capabilities,
    /// The cases that lack nothing else.
    pub(crate) cases: Vec<String>,
}

/// What is worth most for each capability comes first; each step supposes those before it.
pub(crate) fn next_steps(cases: &[Arc<Case>], has: Capabilities) -> Vec<NextStep> {
    let lacking = |has| {
        let lacks = |case: &Arc<Case>| (case.id.clone(), case.prepared.missing(has));
        cases.iter().map(lacks).collect()
    };
    steps(&lacking, has)
}

/// Every case, and what a core lacks for it.
type Lacking = Vec<(String, Capabilities)>;

fn steps(lacking: &dyn Fn(Capabilities) -> Lacking, mut has: Capabilities) -> Vec<NextStep> {
    let mut steps = Vec::new();
    while let Some(step) = best_step(&lacking(has)) {
        has |= step.missing;
        steps.push(step);
    }
    steps
}

/// Of cases with what a core lacks for each: the step that opens most of them for each capability; none where all are open.
pub(crate) fn best_step(lacking: &[(String, Capabilities)]) -> Option<NextStep> {
    let closed = || lacking.iter().filter(|(_, lacks)| !lacks.is_empty());
    let distinct: BTreeMap<_, _> = closed().map(|(_, lacks)| (lacks.bits(), *lacks)).collect();
    let step = |missing: Capabilities| NextStep {
        missing,
        cases: closed()
            .filter(|(_, lacks)| missing.contains(*lacks))
            .map(|(case, _)| case.clone())
            .collect(),
    };
    // a / b against c / d, without dividing.
    let worth = |step: &NextStep| (step.cases.len(), step.missing.iter().count());
    distinct.into_values().map(step).max_by(|a, b| {
        let ((gain_a, size_a), (gain_b, size_b)) = (worth(a), worth(b));
        // Of equals the smaller step.
        (gain_a * size_b).cmp(&(gain_b * size_a)).then(size_b.cmp(&size_a))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use Capabilities as Can;

    /// What cases lack that need just this.
    fn of<'a>(needs: &'a [(&str, Capabilities)]) -> impl Fn(Capabilities) -> Lacking + 'a {
        |has| needs.iter().map(|(case, needs)| ((*case).to_owned(), *needs - has)).collect()
    }

    #[test]
    fn what_opens_most_cases_for_each_function_comes_first() {
        let build = Can::BUILD_SCENE | Can::RADIANCE;
        let needs = [
            ("camera", Can::GENERATE_RAYS),
            ("light", build),
            ("furnace", build),
            ("bounces", build | Can::ISOLATED_BOUNCES),
            ("picture", build | Can::ISOLATED_BOUNCES | Can::RENDER),
        ];
        let steps = steps(&of(&needs), Can::GENERATE_RAYS);
        let told: Vec<_> = steps.iter().map(|s| (s.missing, s.cases.len())).collect();
        assert_eq!(told, [(build, 2), (Can::ISOLATED_BOUNCES, 1), (Can::RENDER, 1)]);
    }

    #[test]
    fn a_core_that_can_do_everything_has_nothing_to_do_next() {
        assert_eq!(steps(&of(&[("camera", Can::GENERATE_RAYS)]), Can::all()), []);
    }

    #[test]
    fn what_is_open_another_way_is_no_step() {
        let picture = |has: Capabilities| {
            let codes = has.contains(Can::RENDER_CODES);
            let lacks = if codes { Can::empty() } else { Can::RENDER - has };
            vec![("picture".to_owned(), lacks)]
        };
        assert_eq!(steps(&picture, Can::RENDER_CODES), []);
        assert_eq!(steps(&picture, Can::empty()).len(), 1);
    }
}
