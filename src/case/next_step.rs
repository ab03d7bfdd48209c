//! What a core could implement next: part by part, by the number of cases that it would then be tried on.

use super::{Case, Part};
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

/// What is worth most for each capability in the earliest part comes first; each step supposes those before it.
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

/// Of cases with what a core lacks for each: the step that opens most of those of the earliest part for each capability;
/// none where all are open.
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
    let part = |case: &str| Part::of_case(case).map(|part| part.number);
    let earliest = closed().map(|(case, _)| part(case)).min()?;
    let gain = |step: &NextStep| step.cases.iter().filter(|case| part(case) == earliest).count();
    // a / b against c / d, without dividing.
    let worth = |step: &NextStep| (gain(step), step.missing.iter().count());
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
            ("rays", Can::GENERATE_RAYS),
            ("sky", build),
            ("furnace", build),
            ("bounces", build | Can::ISOLATED_BOUNCES),
            ("picture", build | Can::ISOLATED_BOUNCES | Can::RENDER),
        ];
        let steps = steps(&of(&needs), Can::GENERATE_RAYS);
        let told: Vec<_> = steps.iter().map(|s| (s.missing, s.cases.len())).collect();
        assert_eq!(told, [(build, 2), (Can::ISOLATED_BOUNCES, 1), (Can::RENDER, 1)]);
    }

    #[test]
    fn an_earlier_part_comes_first_whatever_a_later_one_would_open() {
        let needs = [
            ("shape/sphere", Can::INTERSECT_PRIMITIVE),
            ("light/point", Can::RADIANCE),
            ("light/area", Can::RADIANCE),
        ];
        let told: Vec<_> = steps(&of(&needs), Can::empty()).iter().map(|s| s.missing).collect();
        assert_eq!(told, [Can::INTERSECT_PRIMITIVE, Can::RADIANCE]);
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
