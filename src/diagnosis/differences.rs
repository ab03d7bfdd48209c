//! Failures that no cause explains: told by what they share, their subject and the surfaces of their scenes.

use super::{Evidence, Headline, Observation};
use crate::case::{Foundation, Part, Subject};
use std::collections::BTreeMap;

const SURFACES: [Foundation; 5] = [
    Foundation::Diffuse,
    Foundation::Mirror,
    Foundation::Glass,
    Foundation::Metal,
    Foundation::RoughGlass,
];

/// A headline for each group of `cases`, the earliest part first.
pub(crate) fn headlines(evidence: &Evidence<'_>, cases: &[String]) -> Vec<Headline> {
    let mut groups: BTreeMap<_, Vec<&Observation<'_>>> = BTreeMap::new();
    for seen in evidence.failures().filter(|seen| cases.iter().any(|case| case == seen.case)) {
        groups.entry((Part::position(seen.case), surfaces(seen))).or_default().push(seen);
    }
    let told = |((_, surfaces), group): (&(usize, Vec<Foundation>), &Vec<_>)| {
        headline(evidence, surfaces, group)
    };
    groups.iter().map(told).collect()
}

fn surfaces(seen: &Observation<'_>) -> Vec<Foundation> {
    SURFACES.into_iter().filter(|surface| seen.rests_on.contains(surface)).collect()
}

fn headline(
    evidence: &Evidence<'_>,
    surfaces: &[Foundation],
    group: &[&Observation<'_>],
) -> Headline {
    let explains = group.iter().map(|seen| seen.case.to_owned()).collect();
    let sentence =
        |seen: &&Observation<'_>| Some(format!("{}: {}", seen.case, seen.finding?.statement));
    let sentences = group.iter().filter_map(sentence).collect();
    let subject = group.first().and_then(|seen| Subject::of_case(seen.case));
    let mut mistake = format!("{} {}", subject.map_or("the core", what), how(group));
    if !surfaces.is_empty() {
        let words: Vec<_> = surfaces.iter().map(|surface| surface.word()).collect();
        mistake += &format!(" in scenes with {}", words.join(", "));
    }
    Headline { mistake, ..Headline::of(evidence, explains, sentences) }
}

fn how(group: &[&Observation<'_>]) -> &'static str {
    match group.iter().all(|seen| seen.is_about_light() && seen.is_dark()) {
        true => "is 0 or NaN",
        false => "differs",
    }
}

const fn what(subject: Subject) -> &'static str {
    match subject {
        Subject::Camera => "the camera",
        Subject::Shape => "ray intersection",
        Subject::Bvh => "the BVH",
        Subject::Sampling => "direction sampling",
        Subject::Bsdf => "the BSDF",
        Subject::Light => "direct light",
        Subject::Integrator => "light of many bounces",
        Subject::Adaptive => "adaptive sampling",
        Subject::Image => "the image",
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Foundation::{Diffuse, Glass, Hits};
    use crate::diagnosis::testing::{Made, failing};
    use crate::diagnosis::{Degree, diagnose};

    #[test]
    fn what_shares_subject_and_surfaces_is_told_once_with_its_sizes() {
        let made = Made::new()
            .with("light/a", failing("2 % too dark"))
            .with("light/b", failing("3 % too dark"))
            .with("light/c", failing("lost"))
            .with("image/d", failing("no edges"))
            .resting("light/a", &[Diffuse, Hits])
            .resting("light/b", &[Diffuse])
            .resting("light/c", &[Diffuse, Glass]);
        let diagnosis = diagnose(&made.evidence());
        let mistakes: Vec<_> = diagnosis.headlines.iter().map(|h| h.mistake.as_str()).collect();
        assert_eq!(
            mistakes,
            [
                "direct light differs in scenes with diffuse surfaces",
                "direct light differs in scenes with diffuse surfaces, glass",
                "the image differs",
            ]
        );
        let first = &diagnosis.headlines[0];
        assert_eq!(first.evidence, ["light/a: 2 % too dark", "light/b: 3 % too dark"]);
        assert_eq!((first.degree, first.is_alone()), (Degree::DiffersHere, false));
        assert!(diagnosis.headlines[2].is_alone());
        assert_eq!(diagnosis.first(), None);
    }
}
