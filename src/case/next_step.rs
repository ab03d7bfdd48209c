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

/// What is worth most for each capability comes first.
pub fn next_steps(cases: &[Arc<Case>], has: Capabilities) -> Vec<NextStep> {
    let needs = cases.iter().map(|case| (case.id.as_str(), case.prepared.needs()));
    steps(&needs.collect::<Vec<_>>(), has)
}

fn steps(needs: &[(&str, Capabilities)], has: Capabilities) -> Vec<NextStep> {
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
    let mut steps: Vec<_> = distinct.into_values().map(step).collect();
    // a / b against c / d, without dividing.
    let worth = |step: &NextStep| (step.cases.len(), step.missing.iter().count());
    steps.sort_by(|a, b| {
        let ((gain_a, size_a), (gain_b, size_b)) = (worth(a), worth(b));
        (gain_b * size_a).cmp(&(gain_a * size_b))
    });
    steps
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
        let isolated = build | Can::ISOLATED_BOUNCES;
        assert_eq!(told, [(build, 2), (isolated, 3), (isolated | Can::RENDER, 4)]);
    }

    #[test]
    fn a_core_that_can_do_everything_has_nothing_to_do_next() {
        assert_eq!(steps(&[("camera", Can::GENERATE_RAYS)], Can::all()), []);
    }
}
