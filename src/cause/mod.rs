//! The glossary of causes: every mistake that furnace can name, in the words of the field, with where to look.
//!
//! A check that recognises a mistake leaves a clue with its name; the diagnosis weighs clues and numbers into
//! causes; a planted fault says which cause must be told of it. All three name the same entry of this glossary, so
//! that a mistake is called the same everywhere.
//!
//! To add one: an entry in the table of its subject.

pub(crate) mod adaptive;
pub(crate) mod bsdf;
pub(crate) mod bvh;
pub(crate) mod camera;
pub(crate) mod contract;
pub(crate) mod convention;
pub(crate) mod image;
pub(crate) mod integrator;
pub(crate) mod light;
mod renamed;
pub(crate) mod sampling;
pub(crate) mod shape;

use std::cmp::Ordering;

/// A mistake that people make in path tracers.
#[derive(Debug, PartialEq, Eq)]
pub struct Cause {
    /// Kebab-case, unique: what files and tests call it.
    pub name: &'static str,
    /// The mistake as one sentence without full stop, in the field's words: `the film's y axis points down`.
    pub headline: &'static str,
    /// The function and the step in it where the mistake is made.
    pub look_at: &'static str,
    /// What belongs there, as one sentence.
    pub fix: &'static str,
}

/// A table of causes: `NAME = "slug": "headline", at "where to look", fix "what belongs there";`.
macro_rules! causes {
    ($($name:ident = $slug:literal: $headline:literal, at $look_at:expr, fix $fix:expr;)*) => {
        $(
            #[doc = $headline]
            pub(crate) static $name: Cause =
                Cause { name: $slug, headline: $headline, look_at: $look_at, fix: $fix };
        )*

        /// Every cause of this subject.
        pub(crate) static CAUSES: &[&Cause] = &[$(&$name),*];
    };
}
use causes;

/// Subjects whose mistakes are made in one component, or in a few, in the order in which one part rests on another.
static OF_COMPONENTS: [&[&Cause]; 8] = [
    camera::CAUSES,
    shape::CAUSES,
    bvh::CAUSES,
    sampling::CAUSES,
    bsdf::CAUSES,
    light::CAUSES,
    integrator::CAUSES,
    adaptive::CAUSES,
];

/// Every cause, subject by subject, in the same order.
pub(crate) fn all() -> impl Iterator<Item = &'static Cause> {
    let of_components = OF_COMPONENTS.into_iter().flatten();
    let of_all = contract::CAUSES.iter().chain(image::CAUSES);
    convention::CAUSES.iter().chain(of_components).chain(of_all).copied()
}

/// Whether both are of one subject whose mistakes are made in certain components: those of the contract are made in all.
pub(crate) fn are_of_one_component(one: &Cause, other: &Cause) -> bool {
    OF_COMPONENTS.iter().any(|causes| causes.contains(&one) && causes.contains(&other))
}

/// Whether the mistake is one of the BVH: closed surfaces leak by it, though every triangle is hit.
pub(crate) fn is_of_bvh(cause: &Cause) -> bool {
    bvh::CAUSES.contains(&cause)
}

/// Whether hits may be lost by a mistake of the BVH; by the others it takes longer, and every hit is right.
pub(crate) fn may_lose_hits(cause: &Cause) -> bool {
    let only_slow = [
        &bvh::BVH_NOT_USED,
        &bvh::CHILDREN_UNORDERED,
        &bvh::COUNTS_NOT_REAL,
        &bvh::SEGMENT_NOT_SHORTENED,
        &bvh::SHADOWS_SEARCH_ON,
        &bvh::SHADOWS_WITHOUT_BVH,
        &bvh::SHORTEST_AXIS,
        &bvh::UNBALANCED,
        &bvh::Z_NEVER_SPLIT,
    ];
    is_of_bvh(cause) && !only_slow.contains(&cause)
}

/// Whether the cause says what is lost and not why: any other of its kind explains more.
pub(crate) fn is_vague(cause: &Cause) -> bool {
    *cause == bvh::HITS_LOST
}

/// Whether the second is no mistake of its own where the first is made: what is lost by it, t_max that stays as it is
/// where hits do not shorten it, a length of fixed size where a threshold is one, half a pixel that the pixel takes away
/// because the camera adds it, or shadows and bounces of rays that meet nothing.
pub(crate) fn brings_along(cause: &Cause, other: &Cause) -> bool {
    may_lose_hits(cause) && !is_vague(cause) && is_vague(other)
        || *cause == bvh::HIT_OVERWRITTEN && *other == bvh::SEGMENT_NOT_SHORTENED
        || *cause == shape::DETERMINANT_THRESHOLD && *other == integrator::FIXED_LENGTH
        || *cause == camera::HALF_PIXEL_TWICE && *other == camera::HALF_A_PIXEL
        || *cause == light::SECONDARY_RAYS_LOST
            && [&light::NO_SHADOWS, &integrator::NO_INDIRECT].contains(&other)
}

/// Whether the second is how the first looks where nothing is graded: a hit behind the origin lies before t_min, too.
pub(crate) fn shows_beside(cause: &Cause, other: &Cause) -> bool {
    *cause == shape::HITS_BEHIND_ORIGIN && *other == shape::SEGMENT_START_IGNORED
}

/// Whether it tells what a number is, and not what made it so: a missing normalisation, or an answer that is never
/// written, is a mistake itself.
pub(crate) fn is_symptom(cause: &Cause) -> bool {
    [&contract::NOT_A_NUMBER, &contract::INFINITE, &contract::NEGATIVE].contains(&cause)
}

/// Whether it is a mistake of the film that only a whole image shows.
pub(crate) fn is_of_the_film_alone(cause: &Cause) -> bool {
    [&image::FACTOR, &image::STRIPE].contains(&cause)
}

/// Whether hits are lost by the cause: which of them is told by the pattern of what is lost alone.
pub(crate) fn loses_hits(cause: &Cause) -> bool {
    let patterns = [
        &bvh::BOX_OF_CENTROIDS,
        &bvh::HITS_LOST,
        &bvh::PRIMITIVES_LOST,
        &bvh::RANGE_OVERWRITTEN,
        &bvh::SECOND_CHILD_SKIPPED,
    ];
    patterns.contains(&cause)
}

static DARKENING: &[&Cause] = &[
    &image::CLAMPED,
    &image::SAMPLES_CLAMPED,
    &integrator::BOUNCE_MISSING,
    &integrator::NO_INDIRECT,
    &integrator::ONE_BOUNCE_SHORT,
    &integrator::ROULETTE_NOT_DIVIDED,
    &light::DELTA_DIVIDED,
    &light::DIVIDED_BY_LIGHTS,
    &light::LAST_LIGHT_ONLY,
];

static BRIGHTENING: &[&Cause] = &[
    &integrator::EMISSION_AGAIN,
    &integrator::ISOLATION_IGNORED,
    &integrator::ONE_BOUNCE_LONG,
    &light::NO_SHADOWS,
    &light::NOT_DIVIDED_BY_SAMPLES,
    &light::TWICE_AS_BRIGHT,
];

/// How light that is wrong by the cause compares with what is right, where it can go one way only.
pub(crate) fn side(cause: &Cause) -> Option<Ordering> {
    let sides = [(DARKENING, Ordering::Less), (BRIGHTENING, Ordering::Greater)];
    sides.into_iter().find(|(causes, _)| causes.contains(&cause)).map(|(_, side)| side)
}

/// The cause called `name`, today or before it was renamed.
pub(crate) fn find(name: &str) -> Option<&'static Cause> {
    let name = renamed::current(name);
    all().find(|cause| cause.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_kebab_case() {
        let mut seen = BTreeSet::new();
        for cause in all() {
            assert!(seen.insert(cause.name), "{} stands there twice", cause.name);
            let proper = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(cause.name.chars().all(proper), "{}", cause.name);
        }
    }

    #[test]
    fn every_cause_says_what_where_and_what_instead() {
        for cause in all() {
            for words in [cause.headline, cause.look_at, cause.fix] {
                assert!(words.len() > 10, "{}: `{words}`", cause.name);
            }
            assert!(!cause.headline.ends_with('.'), "{}", cause.name);
        }
    }
}
