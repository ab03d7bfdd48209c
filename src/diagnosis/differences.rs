//! Failures that no cause explains: told by what they share, their subject and the surfaces of their scenes.

use super::bounces;
use super::readings::Reading;
use super::{Evidence, Headline, Observation};
use crate::case::{Foundation, Part, Subject};
use crate::contract::Components;
use crate::text::number::figure;
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
    let bounces = Bounces::of(group);
    let sentences = bounces.in_words().into_iter().chain(group.iter().filter_map(sentence));
    let subject = group.first().and_then(|seen| Subject::of_case(seen.case));
    let of_bounces = bounces.first_wrong().filter(|_| subject == Some(Subject::Integrator));
    let what = of_bounces.unwrap_or_else(|| subject.map_or("the core", what).to_owned());
    let mut mistake = format!("{what} {}", how(group));
    if !surfaces.is_empty() {
        let words: Vec<_> = surfaces.iter().map(|surface| surface.word()).collect();
        mistake += &format!(" in scenes with {}", words.join(", "));
    }
    Headline::of(evidence, explains, sentences.collect())
        .differing(&mistake)
        .under(evidence, Components::empty())
}

/// What a group shows of single bounces, over what it should be.
struct Bounces(BTreeMap<u32, Vec<Reading>>);

impl Bounces {
    fn of(group: &[&Observation<'_>]) -> Self {
        let mut of_bounce: BTreeMap<u32, Vec<Reading>> = BTreeMap::new();
        let rows = group.iter().filter_map(|seen| seen.finding).flat_map(bounces::rows);
        for row in rows.filter(|row| row.bounces[0] == row.bounces[1]) {
            let readings = row.readings.into_iter().flatten();
            of_bounce.entry(row.bounces[0]).or_default().extend(readings);
        }
        Self(of_bounce.into_iter().filter(|(_, readings)| !readings.is_empty()).collect())
    }

    /// `light of bounce 2`, `light from bounce 2 on`, where all before are right.
    fn first_wrong(&self) -> Option<String> {
        let (mut right, wrong): (Vec<_>, Vec<_>) =
            self.0.iter().partition(|(_, readings)| readings.iter().all(|r| r.admits(1.0)));
        let (first, last) = (*wrong.first()?.0, *wrong.last()?.0);
        right.retain(|(bounce, _)| **bounce > 0);
        let (before, after): (Vec<_>, Vec<_>) = right.into_iter().partition(|r| *r.0 < first);
        match (before.is_empty(), after.iter().any(|(bounce, _)| **bounce > last)) {
            (true, _) => None,
            (_, true) if first == last => Some(format!("light of bounce {first}")),
            _ => Some(format!("light from bounce {first} on")),
        }
    }

    /// `bounce by bounce, over what it should be: 1: 1 · 2: 2.01 · 3: 0.9 to 1.1`.
    fn in_words(&self) -> Option<String> {
        let cell = |(bounce, readings): (&u32, &Vec<Reading>)| {
            let ratios = || readings.iter().map(|reading| reading.ratio);
            let (low, high) = (
                ratios().fold(f64::INFINITY, f64::min),
                ratios().fold(f64::NEG_INFINITY, f64::max),
            );
            let is_one = readings.iter().all(|reading| reading.admits(0.5 * (low + high)));
            match is_one {
                true => format!("{bounce}: {}", figure(0.5 * (low + high))),
                false => format!("{bounce}: {} to {}", figure(low), figure(high)),
            }
        };
        let cells: Vec<_> = self.0.iter().map(cell).collect();
        let words = "bounce by bounce, over what it should be";
        (cells.len() > 1).then(|| format!("{words}: {}", cells.join(" · ")))
    }
}

fn how(group: &[&Observation<'_>]) -> &'static str {
    match group.iter().all(|seen| seen.is_about_light() && seen.is_dark()) {
        true => "is dark or NaN",
        false => "differs",
    }
}

const fn what(subject: Subject) -> &'static str {
    match subject {
        Subject::Camera => "the camera or the pixel",
        Subject::Shape => "ray intersection",
        Subject::Bvh => "the BVH or its box test",
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
    use crate::diagnosis::testing::{Made, failing, mean, means};
    use crate::diagnosis::{Degree, diagnose};
    use crate::image::Channel;

    #[test]
    fn the_first_bounce_that_is_wrong_is_told() {
        let told = |of_bounce: [f64; 3]| {
            let rows = [1, 2, 3].map(|k| format!("bounce {k}"));
            let rows = rows.iter().zip(of_bounce);
            let red = rows.map(|(row, ratio)| mean(row, Channel::Red, 0.5, ratio, 0.001)).collect();
            let made = Made::new().with("integrator/a", means(red));
            let diagnosis = diagnose(&made.evidence());
            let headline = &diagnosis.headlines[0];
            (headline.mistake.clone(), headline.evidence[0].clone())
        };
        let (mistake, evidence) = told([1.0, 2.0, 1.0]);
        assert_eq!(mistake, "light of bounce 2 differs");
        assert_eq!(evidence, "bounce by bounce, over what it should be: 1: 1 · 2: 2 · 3: 1");
        assert_eq!(told([1.0, 1.0, 0.9]).0, "light from bounce 3 on differs");
        assert_eq!(told([2.0, 1.0, 1.0]).0, "light of many bounces differs");
    }

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

    #[test]
    fn a_picture_of_part_1_is_not_of_the_camera_alone() {
        let made = Made::new().with("camera/a", failing("0 instead of 1"));
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.headlines[0].mistake, "the camera or the pixel differs");
    }
}
