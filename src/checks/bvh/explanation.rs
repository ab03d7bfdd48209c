//! What a BVH does wrong, from the pattern of its wrong answers: which of the two queries errs, in which
//! direction, and whether some primitives are never found at all.

use super::comparison::{Answers, Differences, Truth};
use crate::cause::{Cause, bvh, is_vague};
use crate::contract::Hit;
use std::collections::BTreeSet;

/// Wrong answers for each primitive that is never found, on average: fewer could be chance.
const ASKED_OFTEN: usize = 2;
/// Lines that are looked along for a box that stops their segment: each takes a loop over the scene.
const LINES: usize = 200;

/// The mistake that makes just such a pattern. Nothing is said where two mistakes would. `is_free` tells whether nothing
/// lies on the line of a segment.
pub(crate) fn explain(
    found: &Answers,
    right: &Truth,
    d: &Differences,
    is_free: &dyn Fn(usize) -> bool,
) -> Option<&'static Cause> {
    let closest = d.lost + d.farther + d.invented + d.outside + d.misnamed;
    match (closest, d.unoccluded, d.occluded) {
        (0, 0, 0) => None,
        _ if right.overwritten > 0 => Some(&bvh::HIT_OVERWRITTEN),
        (0, 0, _) => shadows_stopped_by_nothing(found, right, is_free),
        (0, _, 0) => Some(&bvh::SHADOW_SECOND_CHILD_SKIPPED),
        (all, 0, 0) if all == d.misnamed => Some(&bvh::LEAF_ORDER_NUMBERS),
        (all, _, 0) if all == d.lost + d.farther => hits_lost(found, right, d),
        (all, 0, 0) if d.lost > 0 && all == d.lost + d.farther + d.outside => {
            Some(&bvh::RANGE_OVERWRITTEN)
        }
        _ => None,
    }
}

/// Boxes stop rays whose line meets nothing else; the test of a shape that forgets its segment does not.
fn shadows_stopped_by_nothing(
    found: &Answers,
    right: &Truth,
    is_free: &dyn Fn(usize) -> bool,
) -> Option<&'static Cause> {
    let mut stopped = (0..found.occluded.len())
        .filter(|segment| found.occluded[*segment] && !right.segments[*segment].is_hit());
    let mut meets_boxes = || stopped.by_ref().take(LINES).any(is_free);
    match &found.occluded {
        occluded if *occluded == right.endless => Some(&bvh::SHADOW_END_IGNORED),
        occluded if *occluded == right.from_origin => Some(&bvh::SHADOW_START_IGNORED),
        _ => meets_boxes().then_some(&bvh::SHADOWS_HIT_BOXES),
    }
}

/// Nearest hits are missed, and nothing else is wrong. A primitive that is in no leaf occludes nothing either.
fn hits_lost(found: &Answers, right: &Truth, d: &Differences) -> Option<&'static Cause> {
    if d.unoccluded > 0 && some_are_never_found(found, right) {
        Some(&bvh::PRIMITIVES_LOST)
    } else if d.lost == 0 && d.unoccluded == 0 {
        Some(&bvh::SECOND_CHILD_SKIPPED)
    } else if d.unoccluded == 0 {
        Some(&bvh::RANGE_OVERWRITTEN)
    } else if d.lost >= nearly_all(right) {
        Some(&bvh::BOX_OF_CENTROIDS)
    } else {
        Some(&bvh::HITS_LOST)
    }
}

/// Of all that is there to be hit: the box of one centroid is a point, which no ray meets.
fn nearly_all(right: &Truth) -> usize {
    let hits = right.rays.iter().chain(&right.segments).filter(|hit| hit.is_hit()).count();
    hits - hits / 20
}

/// Whether the primitives that should have been hit where others were are hit nowhere at all.
fn some_are_never_found(found: &Answers, right: &Truth) -> bool {
    let name = |hit: &Hit| (hit.shape, hit.primitive);
    let all_found = || found.rays.iter().chain(&found.segments);
    let all_right = || right.rays.iter().chain(&right.segments);
    let ever: BTreeSet<_> = all_found().filter(|hit| hit.is_hit()).map(name).collect();
    let missed: Vec<_> = all_found()
        .zip(all_right())
        .filter(|(found, right)| right.is_hit() && found.t.to_bits() != right.t.to_bits())
        .map(|(_, right)| name(right))
        .collect();
    let distinct: BTreeSet<_> = missed.iter().copied().collect();
    missed.len() >= ASKED_OFTEN * distinct.len() && distinct.is_disjoint(&ever)
}

/// The mistake that most of the wrong BVHs share, with how many they are. What merely loses hits goes with any of them.
pub(crate) fn shared(causes: &[Option<&'static Cause>]) -> Option<(&'static Cause, String)> {
    // Where large leaves lose everything too, it is not the box of one centroid.
    if causes.iter().all(|cause| *cause == Some(&bvh::BOX_OF_CENTROIDS)) && !causes.is_empty() {
        return shared(&vec![Some(&bvh::HITS_LOST); causes.len()]);
    }
    let goes_with = |cause: &Cause, other: &Cause| cause == other || is_vague(other);
    let count =
        |cause: &Cause| causes.iter().flatten().filter(|other| goes_with(cause, other)).count();
    let most = causes.iter().flatten().max_by_key(|cause| (count(cause), !is_vague(cause)))?;
    let evidence = format!(
        "predicts which answers are wrong in {} of {} wrong BVHs",
        count(most),
        causes.len()
    );
    (2 * count(most) > causes.len()).then_some((*most, evidence))
}

#[cfg(test)]
mod tests {
    use super::super::comparison::{Questions, compare};
    use super::*;
    use crate::contract::Ray;
    use glam::DVec3;

    fn hit(t: f64, primitive: u32) -> Hit {
        Hit { t, shape: 0, primitive, ..Hit::MISS }
    }

    /// Of thirty right answers and as many shadows, ten at each of three primitives, with this change.
    fn told(change: impl Fn(&mut Answers, &mut Truth)) -> Option<&'static Cause> {
        told_where(|_| false, change)
    }

    /// The same where the lines of these segments meet nothing.
    fn told_where(
        is_free: impl Fn(usize) -> bool,
        change: impl Fn(&mut Answers, &mut Truth),
    ) -> Option<&'static Cause> {
        let rays: Vec<_> = (0..30).map(|i| hit(1.0 + f64::from(i), i as u32 % 3)).collect();
        let segments = rays.clone();
        let mut answers =
            Answers { rays: rays.clone(), segments: rays.clone(), occluded: vec![true; 30] };
        let [endless, from_origin] = [(); 2].map(|()| vec![true; 30]);
        let mut truth = Truth { rays, segments, endless, from_origin, overwritten: 0 };
        change(&mut answers, &mut truth);
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        let questions = Questions { rays: vec![ray; 30], segments: vec![ray; 30] };
        let differences = compare(&questions, &answers, &truth, &|_, _| false);
        explain(&answers, &truth, &differences, &is_free)
    }

    /// Nothing is on the first segment, and all but the shadow ray say so.
    fn stopped_by_nothing(answers: &mut Answers, truth: &mut Truth) {
        truth.segments[0] = Hit::MISS;
        answers.segments[0] = Hit::MISS;
    }

    #[test]
    fn each_pattern_has_its_mistake() {
        let tell = |cause: &'static Cause, change: fn(&mut Answers, &mut Truth)| {
            assert_eq!(told(change), Some(cause));
        };
        assert_eq!(told(|_, _| ()), None);
        tell(&bvh::SECOND_CHILD_SKIPPED, |answers, _| answers.rays[3].t = 100.0);
        tell(&bvh::RANGE_OVERWRITTEN, |answers, _| answers.rays[3] = Hit::MISS);
        tell(&bvh::RANGE_OVERWRITTEN, |answers, _| {
            answers.rays[3] = Hit::MISS;
            answers.rays[4].t = -1.0;
        });
        tell(&bvh::HITS_LOST, |answers, _| {
            answers.rays[3] = Hit::MISS;
            answers.occluded[4] = false;
        });
        tell(&bvh::BOX_OF_CENTROIDS, |answers, _| {
            answers.rays[1..].fill(Hit::MISS);
            answers.segments[1..].fill(Hit::MISS);
            answers.occluded[1..].fill(false);
        });
        tell(&bvh::PRIMITIVES_LOST, |answers, _| {
            let lost = answers.rays.iter_mut().chain(&mut answers.segments);
            lost.filter(|hit| hit.primitive == 1).for_each(|hit| *hit = Hit::MISS);
            answers.occluded[1] = false;
        });
        tell(&bvh::LEAF_ORDER_NUMBERS, |answers, _| {
            answers.rays.iter_mut().for_each(|hit| hit.primitive += 1);
        });
        tell(&bvh::SHADOW_SECOND_CHILD_SKIPPED, |answers, _| answers.occluded[0] = false);
        tell(&bvh::SHADOW_END_IGNORED, stopped_by_nothing);
        tell(&bvh::SHADOW_START_IGNORED, |answers, truth| {
            stopped_by_nothing(answers, truth);
            truth.endless[0] = false;
        });
        let by_neither = |answers: &mut Answers, truth: &mut Truth| {
            stopped_by_nothing(answers, truth);
            truth.endless[0] = false;
            truth.from_origin[0] = false;
        };
        assert_eq!(told(by_neither), None, "a shape that forgets the segment, or a loop its hits");
        let told_of_free = told_where(|segment| segment == 0, by_neither);
        assert_eq!(told_of_free, Some(&bvh::SHADOWS_HIT_BOXES));
        tell(&bvh::HIT_OVERWRITTEN, |answers, truth| {
            answers.rays[0].t = 0.5;
            truth.overwritten = 2;
        });
    }

    #[test]
    fn a_mistake_is_shared_by_most_or_by_none() {
        let lost = Some(&bvh::PRIMITIVES_LOST);
        assert_eq!(shared(&[lost, lost, None]).unwrap().0, &bvh::PRIMITIVES_LOST);
        assert!(shared(&[lost, Some(&bvh::RANGE_OVERWRITTEN), None]).is_none());
        assert!(shared(&[]).is_none());
        let (point, hits) = (Some(&bvh::BOX_OF_CENTROIDS), Some(&bvh::HITS_LOST));
        assert_eq!(shared(&[point, hits, hits]).unwrap().0, &bvh::BOX_OF_CENTROIDS);
        assert_eq!(shared(&[point, point, point]).unwrap().0, &bvh::HITS_LOST, "large leaves too");
        assert_eq!(shared(&[hits, hits]).unwrap().0, &bvh::HITS_LOST);
    }
}
