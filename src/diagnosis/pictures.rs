//! Clues of whole images: the film, the camera and the depth of paths act on every image alike. What one image
//! resembles is a mistake only where nearly all failing images resemble it, and in one size.

use super::{Degree, Evidence, Observation, Suspicion};
use crate::case::Subject;
use crate::cause::{self, Cause, bsdf, image, integrator};
use crate::checks::Clue;
use crate::contract::Circumstances;
use crate::stats::misfit::tells;
use std::collections::BTreeMap;

/// The share of failing images that have to show a mistake: noise hides it in a few.
const NEARLY_ALL: f64 = 0.8;
/// The same of what moves a picture, in several images in one size: no light does that, and what comes into view beside the
/// picture no fit knows.
const MANY: f64 = 0.5;
/// So many images are several.
const SEVERAL: usize = 3;
/// How far sizes of one mistake lie apart beyond their intervals, relatively: fits interpolate.
const APART: f64 = 0.005;

pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let failing: Vec<_> =
        evidence.failures().filter(|seen| seen.is_about(Subject::Image)).collect();
    let mut shown: BTreeMap<&str, Vec<Shown<'_>>> = BTreeMap::new();
    for seen in &failing {
        for clue in seen.finding.iter().flat_map(|finding| &finding.clues) {
            shown.entry(&clue.cause).or_default().push(Shown { seen, clue });
        }
    }
    let shown = shown.into_iter().filter_map(|(name, shown)| {
        let cause = cause::find(name)?;
        let foretold = failing.iter().filter(|seen| is_foretold(cause, seen)).count();
        let alike = if counts_bounces(cause) { once(&shown) } else { alike(&shown) };
        let as_foretold = alike.iter().filter(|shown| is_foretold(cause, shown.seen)).count();
        // What no image foretells has a share of NaN, and is not told.
        Some((cause, as_foretold as f64 / foretold as f64, alike))
    });
    let are_enough = |(cause, share, alike): &(&'static Cause, f64, Vec<Shown<'_>>)| {
        *share >= if moves(cause) && alike.len() >= SEVERAL { MANY } else { NEARLY_ALL }
    };
    let mut shown: Vec<_> = shown.filter(are_enough).collect();
    let most = shown.iter().map(|(_, share, _)| *share).fold(0.0, f64::max);
    shown.retain(|(_, share, _)| *share >= most);
    let is_proven = |alike: &[Shown<'_>]| shown.len() == 1 && alike.len() > 1;
    let suspicion = |(cause, _, alike): &(&'static Cause, f64, Vec<Shown<'_>>)| Suspicion {
        cause,
        cases: alike.iter().map(|shown| shown.seen.case.to_owned()).collect(),
        evidence: alike.iter().map(Shown::words).collect(),
        ruled_out: Vec::new(),
        weight: 1.0,
        degree: if is_proven(alike) { Degree::Named } else { Degree::LooksLike },
        beside: false,
    };
    shown.iter().map(suspicion).collect()
}

/// Mistakes of diffuse surfaces say nothing of light that mirrors and glass carry, and whether a path is too short nothing
/// of an image without indirect light: its last bounce is all its direct light.
fn is_foretold(cause: &Cause, seen: &Observation<'_>) -> bool {
    let of_diffuse =
        [&bsdf::WITHOUT_PI, &bsdf::WITH_PI, &bsdf::ALBEDO_HALVED, &bsdf::ALBEDO_DOUBLED];
    match cause {
        cause if of_diffuse.contains(&cause) => !seen.is_specular,
        cause if *cause == integrator::ONE_BOUNCE_SHORT => {
            seen.circumstances.contains(Circumstances::INDIRECT_LIGHT)
        }
        _ => true,
    }
}

/// Whether a mistake shows the right picture elsewhere on the film.
fn moves(cause: &Cause) -> bool {
    use image::{DISPLACED, MAGNIFIED, MIRRORED, TRANSPOSED, TURNED, UPSIDE_DOWN};
    [&DISPLACED, &MAGNIFIED, &MIRRORED, &TRANSPOSED, &TURNED, &UPSIDE_DOWN].contains(&cause)
}

/// Whether the size of a mistake is how often the light of whole bounces is missing, or there once more.
fn counts_bounces(cause: &Cause) -> bool {
    use integrator::{EMISSION_AGAIN, EMISSION_LOST, NO_INDIRECT, ONE_BOUNCE_SHORT};
    [&EMISSION_AGAIN, &EMISSION_LOST, &NO_INDIRECT, &ONE_BOUNCE_SHORT].contains(&cause)
}

/// An image that a mistake would explain.
#[derive(Clone, Copy)]
struct Shown<'a> {
    seen: &'a Observation<'a>,
    clue: &'a Clue,
}

impl Shown<'_> {
    fn words(&self) -> String {
        format!("{}: {}", self.seen.case, self.clue.evidence)
    }
}

/// The most images that show the mistake in one size: it lies at an end of one of the intervals, or there is none.
fn alike<'a>(shown: &[Shown<'a>]) -> Vec<Shown<'a>> {
    let ends = shown.iter().filter_map(|shown| shown.clue.size).flatten().map(Some);
    let sizes = ends.chain([None]);
    sizes.map(|size| in_size(shown, size)).max_by_key(Vec::len).unwrap_or_default()
}

/// The images of which light is missing once, if all together tell that it is once and no other number of times: each
/// alone may be too noisy.
fn once<'a>(shown: &[Shown<'a>]) -> Vec<Shown<'a>> {
    let shown = in_size(shown, Some(1.0));
    let sizes = shown.iter().filter_map(|shown| shown.clue.size);
    let common = sizes.fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], [from, to]| {
        [low.max(from), high.min(to)]
    });
    if tells(common, 1.0) { shown } else { Vec::new() }
}

/// The images that show the mistake in a size, each once.
fn in_size<'a>(shown: &[Shown<'a>], size: Option<f64>) -> Vec<Shown<'a>> {
    let of_size = shown.iter().copied().filter(|shown| allows(shown.clue.size, size));
    let mut of_size: Vec<_> = of_size.collect();
    of_size.dedup_by_key(|shown| shown.seen.case);
    of_size
}

fn allows(interval: Option<[f64; 2]>, size: Option<f64>) -> bool {
    match (interval, size) {
        (Some([low, high]), Some(size)) => {
            let apart = APART * size.abs();
            low - apart <= size && size <= high + apart
        }
        (None, None) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::cause::{Cause, bsdf, image, integrator};
    use crate::checks::Finding;
    use crate::contract::Circumstances;
    use crate::diagnosis::testing::{Made, failing, passing};
    use crate::diagnosis::{Degree, diagnose};

    fn showing(cause: &Cause, size: f64) -> Finding {
        failing("differs").because_in_size(cause, "so much", Some([size - 0.01, size + 0.01]))
    }

    fn told(made: &Made) -> Vec<(String, Degree)> {
        let headlines = diagnose(&made.evidence()).headlines;
        headlines.into_iter().map(|told| (told.cause, told.degree)).collect()
    }

    #[test]
    fn one_factor_in_all_images_is_the_films() {
        let made = Made::new()
            .with("image/a", showing(&image::FACTOR, 2.0))
            .with("image/b", showing(&image::FACTOR, 2.01))
            .with("image/c", passing());
        assert_eq!(told(&made), [(image::FACTOR.name.to_owned(), Degree::Named)]);
    }

    #[test]
    fn another_factor_in_every_image_is_not() {
        let made = Made::new()
            .with("image/a", showing(&image::FACTOR, 2.0))
            .with("image/b", showing(&image::FACTOR, 1.7));
        assert_eq!(made.first(), None);
    }

    #[test]
    fn what_only_some_images_resemble_is_no_cause() {
        let made = Made::new()
            .with("image/a", failing("x").because(&integrator::NO_INDIRECT, "x"))
            .with("image/b", failing("x").because(&integrator::NO_INDIRECT, "x"))
            .with("image/c", failing("something else"));
        assert_eq!(made.first(), None);
    }

    #[test]
    fn a_picture_that_is_magnified_alike_in_half_of_the_images_is_told_and_one_too_bright_is_not() {
        let of = |cause: &Cause, sizes: [f64; 3]| {
            let made = Made::new()
                .with("image/a", failing("what comes into view is not known"))
                .with("image/b", failing("nor here"));
            let images = ["image/c", "image/d", "image/e"].into_iter().zip(sizes);
            told(&images.fold(made, |made, (name, size)| made.with(name, showing(cause, size))))
        };
        let named = (image::MAGNIFIED.name.to_owned(), Degree::Named);
        assert!(of(&image::MAGNIFIED, [0.75, 0.75, 0.755]).contains(&named));
        assert!(!of(&image::MAGNIFIED, [0.75, 0.8, 0.7]).contains(&named));
        assert!(!of(&image::FACTOR, [0.75; 3]).iter().any(|(cause, _)| !cause.is_empty()));
    }

    #[test]
    fn what_more_images_resemble_is_told() {
        let factor = |size| showing(&image::FACTOR, size).because(&image::NOT_DIVIDED, "spp");
        let factors = ["a", "b", "c", "d"].map(|name| format!("image/{name}"));
        let made = factors.iter().fold(Made::new(), |made, name| made.with(&name[..], factor(2.0)));
        let made = made.with("image/e", factor(3.0));
        assert_eq!(told(&made), [(image::NOT_DIVIDED.name.to_owned(), Degree::Named)]);
    }

    #[test]
    fn a_mistake_of_diffuse_surfaces_is_not_told_from_glass_alone() {
        let made = Made::new()
            .with("image/a", failing("x").because(&bsdf::WITHOUT_PI, "x"))
            .with("image/b", failing("x").because(&bsdf::WITHOUT_PI, "x"))
            .in_a_specular_scene("image/a")
            .in_a_specular_scene("image/b");
        assert_eq!(made.first(), None);
    }

    #[test]
    fn a_path_is_told_to_be_too_short_by_images_with_indirect_light() {
        let short = || showing(&integrator::ONE_BOUNCE_SHORT, 1.0);
        let made = ["image/a", "image/b"].into_iter().fold(Made::new(), |made, name| {
            made.with(name, short()).under(name, Circumstances::INDIRECT_LIGHT)
        });
        let made = made.with("image/c", failing("without light"));
        let named = (integrator::ONE_BOUNCE_SHORT.name.to_owned(), Degree::Named);
        assert!(told(&made).contains(&named));
        let deep =
            made.with("image/d", failing("x")).under("image/d", Circumstances::INDIRECT_LIGHT);
        assert!(!told(&deep).contains(&named));
    }

    #[test]
    fn images_that_are_too_noisy_alone_tell_a_bounce_together() {
        let of = |sizes: &[[f64; 2]]| {
            let images = (0..).map(|number| format!("image/{number}")).zip(sizes);
            let made = images.fold(Made::new(), |made, (name, size)| {
                let short = &integrator::ONE_BOUNCE_SHORT;
                let image = failing("x").because_in_size(short, "so much", Some(*size));
                made.with(&name[..], image).under(&name[..], Circumstances::INDIRECT_LIGHT)
            });
            told(&made)
        };
        let named = (integrator::ONE_BOUNCE_SHORT.name.to_owned(), Degree::Named);
        assert!(of(&[[0.9, 1.4], [0.6, 1.1], [0.5, 1.5]]).contains(&named));
        let is_silent = |sizes| of(sizes).iter().all(|(cause, _)| cause.is_empty());
        assert!(is_silent(&[[0.6, 1.4], [0.5, 1.1]]));
        assert!(is_silent(&[[1.1, 1.4], [0.5, 0.9]]));
    }

    #[test]
    fn one_image_alone_looks_like_it() {
        let made = Made::new().with("image/a", showing(&image::FACTOR, 2.0));
        assert_eq!(told(&made), [(image::FACTOR.name.to_owned(), Degree::LooksLike)]);
    }
}
