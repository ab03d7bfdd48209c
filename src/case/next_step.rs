//! What a core could implement next, by the number of cases that it would then be tried on.

use super::Case;
use crate::contract::Capabilities;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Capabilities to implement together, and what that is worth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NextStep {
    /// What is missing.
    pub missing: Capabilities,
    /// The cases that lack nothing else.
    pub cases: Vec<String>,
}

/// What is worth most for each capability comes first; each step supposes those before it.
pub fn next_steps(cases: &[Arc<Case>], has: Capabilities) -> Vec<NextStep> {
    let needs = cases.iter().map(|case| (case.id.as_str(), case.prepared.needs()));
    steps(&needs.collect::<Vec<_>>(), has)
}

fn steps(needs: &[(&str, Capabilities)], mut has: Capabilities) -> Vec<NextStep> {
    let mut steps = Vec::new();
    while let Some(step) = best_step(needs, has) {
        has |= step.missing;
        steps.push(step);
    }
    steps
}

/// The step that opens most cases for each capability; none where all are open.
fn best_step(needs: &[(&str, Capabilities)], has: Capabilities) -> Option<NextStep> {
    let lacks = |needs: &Capabilities| *needs - has;
    let open: Vec<_> = needs.iter().filter(|(_, needs)| !lacks(needs).is_empty()).collect();
    let distinct: BTreeMap<_, _> =
        open.iter().map(|(_, needs)| (lacks(needs).bits(), lacks(needs))).collect();
    let step = |missing: Capabilities| NextStep {
        missing,
        cases: open
            .iter()
            .filter(|(_, needs)| missing.contains(lacks(needs)))
            .map(|(case, _)| (*case).to_owned())
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
        let steps = steps(&needs, Can::GENERATE_RAYS);
        let told: Vec<_> = steps.iter().map(|s| (s.missing, s.cases.len())).collect();
        assert_eq!(told, [(build, 2), (Can::ISOLATED_BOUNCES, 1), (Can::RENDER, 1)]);
    }

    #[test]
    fn a_core_that_can_do_everything_has_nothing_to_do_next() {
        assert_eq!(steps(&[("camera", Can::GENERATE_RAYS)], Can::all()), []);
    }
}
