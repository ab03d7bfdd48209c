//! Mirror and glass where everything else is right: only the path itself can meet a light there.

use super::readings::fails_as;
use super::{Degree, Evidence, RuledOut, Suspicion};
use crate::case::{Role, Subject};
use crate::cause::integrator;
use crate::checks::Finding;

const MIRRORS: Role = Role::Mirrors;
const FURNACE: Role = Role::Furnace;

/// Mirrors and glass are dark, and the furnace is right: one too noisy to be judged is not.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    if evidence.failed_finding(MIRRORS).is_none() || !evidence.has_passed(FURNACE) {
        return Vec::new();
    }
    let failing: Vec<_> = evidence.failures().map(|seen| seen.case.to_owned()).collect();
    let broken = evidence.proven_by(&failing);
    // A mirror that no ray meets shows nothing, either.
    if evidence.rests_on(evidence.case(MIRRORS)).iter().any(|below| broken.contains(below)) {
        return Vec::new();
    }
    let dark = |finding: &Finding| fails_as(finding, 0.0);
    let failures = evidence.failures().filter(|seen| seen.is_about(Subject::Integrator));
    let cases: Vec<_> = failures
        .filter(|seen| seen.finding.is_some_and(dark))
        .map(|seen| seen.case.to_owned())
        .collect();
    if !cases.iter().any(|case| case == evidence.case(MIRRORS)) {
        return Vec::new();
    }
    vec![Suspicion {
        cause: &integrator::NO_EMISSION_AFTER_SPECULAR,
        cases,
        evidence: vec!["emission seen in mirrors is 0 of what it should be".to_owned()],
        ruled_out: vec![RuledOut::new("a bounce short", "the furnace is right")],
        weight: 1.0,
        degree: Degree::LooksLike,
        beside: false,
    }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Foundation;
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};
    use crate::image::Channel;
    use crate::stats::Verdict;

    #[test]
    fn mirrors_that_show_nothing_are_named_where_the_furnace_is_right() {
        let dark = || means(vec![mean("bounce 3", Channel::Red, 0.5, 0.0, 1e-4)]);
        let made = Made::new().with(MIRRORS, dark()).with(FURNACE, passing());
        assert_eq!(made.first(), Some(integrator::NO_EMISSION_AFTER_SPECULAR.name));
        let broken = |made: Made| {
            let made = made.with("shape/a", failing("nothing is hit"));
            made.proving("shape/a", &[Foundation::Hits])
        };
        let unmet = broken(made).resting("integrator/Mirrors", &[Foundation::Hits]);
        assert_ne!(unmet.first(), Some(integrator::NO_EMISSION_AFTER_SPECULAR.name));
        let open = Finding { verdict: Verdict::Inconclusive, ..passing() };
        let noisy = Made::new().with(MIRRORS, dark()).with(FURNACE, open);
        assert_eq!(noisy.first(), None);
        let dim = means(vec![mean("bounce 3", Channel::Red, 0.5, 0.7, 1e-4)]);
        let made = Made::new().with(MIRRORS, dim).with(FURNACE, passing());
        assert_eq!(made.first(), None);
    }
}
