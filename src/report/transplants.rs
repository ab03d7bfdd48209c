//! What the bench's components have mended, in words; both reports say the same.

use crate::run::record::CoreRecord;
use crate::run::{Transplanted, Transplants};
use crate::text::number::count;

/// A sentence for each component, what they do together, and what none of them mends.
pub(crate) fn sentences(core: &CoreRecord) -> Vec<String> {
    let Some(transplants) = &core.transplants else { return Vec::new() };
    let each = transplants.components.iter().map(|one| sentence(one, transplants));
    each.chain(together(transplants)).chain(unmended(transplants)).collect()
}

/// The same, of the components that any of these failing cases needs.
pub(crate) fn proofs(core: &CoreRecord, cases: &[String]) -> Vec<String> {
    let Some(transplants) = &core.transplants else { return Vec::new() };
    let needed = |one: &&Transplanted| one.cases.iter().any(|case| cases.contains(case));
    let needed = transplants.components.iter().filter(needed);
    needed.map(|one| sentence(one, transplants)).collect()
}

/// `with the bench's box test in place of yours, 71 of 76 failures are gone`
fn sentence(one: &Transplanted, of: &Transplants) -> String {
    let component = one.component.in_words();
    let (alone, gone) = (one.alone.min(one.together), one.together);
    let failures = count(of.failures, "failure");
    let are = if alone == 1 { "is" } else { "are" };
    let mut words = match gone {
        0 => {
            format!("some failures go only where the bench's {component} stands beside the others")
        }
        _ => format!(
            "with the bench's {component} in place of yours, {alone} of {failures} {are} gone"
        ),
    };
    if alone < gone {
        words += &format!(", and {gone} where the others are the bench's, too");
    }
    if one.judged > 0 {
        words += &format!(", and {} above it could be judged", count(one.judged, "case"));
    }
    words
}

fn together(of: &Transplants) -> Option<String> {
    let set: crate::contract::Components = of.components.iter().map(|one| one.component).collect();
    (of.components.len() > 1).then(|| {
        let failures = count(of.failures, "failure");
        format!("with the bench's {}, {} of {failures} are gone", set.in_words(), of.mended)
    })
}

fn unmended(of: &Transplants) -> impl Iterator<Item = String> {
    let stay = match of.unmended.len() {
        0 => None,
        1 => Some("1 failure stays".to_owned()),
        many => Some(format!("{many} failures stay")),
    };
    let cases = of.unmended.join(", ");
    let stay = stay.map(|stay| format!("{stay}, whatever is taken from the bench: {cases}"));
    let untried = (of.untried > 0).then(|| {
        format!(
            "of {} this is not known: there was no time for more trials, their error is too small for a quick look, or the case takes nothing from the bench",
            count(of.untried, "failure")
        )
    });
    stay.into_iter().chain(untried)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{Components, CoreInfo};

    fn told(components: &[(Components, usize, usize, usize)], unmended: &[&str]) -> Vec<String> {
        let one = |&(component, alone, together, judged): &(Components, usize, usize, usize)| {
            Transplanted { component, alone, together, judged, cases: Vec::new() }
        };
        let mut core = CoreRecord::new("mine", &CoreInfo::default());
        core.transplants = Some(Transplants {
            failures: 76,
            components: components.iter().map(one).collect(),
            mended: 76 - unmended.len(),
            unmended: unmended.iter().map(|&case| case.to_owned()).collect(),
            untried: 0,
        });
        sentences(&core)
    }

    #[test]
    fn a_component_says_how_many_failures_it_takes_away() {
        assert_eq!(
            told(&[(Components::BOX_TEST, 71, 71, 12)], &["light/a", "light/b"]),
            [
                "with the bench's box test in place of yours, 71 of 76 failures are gone, and 12 cases above it could be \
                 judged",
                "2 failures stay, whatever is taken from the bench: light/a, light/b",
            ]
        );
    }

    #[test]
    fn several_are_summed_up() {
        let two = [(Components::BSDF, 70, 70, 0), (Components::BOX_TEST, 6, 6, 0)];
        let told = told(&two, &[]);
        assert_eq!(told.len(), 3);
        assert_eq!(told[2], "with the bench's box test and BSDF, 76 of 76 failures are gone");
    }

    #[test]
    fn what_goes_only_with_others_says_so() {
        let told = told(&[(Components::BSDF, 2, 5, 0), (Components::BOX_TEST, 71, 71, 0)], &[]);
        assert_eq!(
            told[0],
            "with the bench's BSDF in place of yours, 2 of 76 failures are gone, and 5 where the others are the bench's, too"
        );
    }
}
