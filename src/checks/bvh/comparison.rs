//! A BVH's answers against those of the loop over every primitive, ray by ray.
//!
//! The same routine of the core meets the same primitive either way, so t has to be the same to the bit, whatever the
//! precision. Two primitives at the same t are a tie; otherwise the primitive has to be the same too.

use crate::checks::{CheckError, Context};
use crate::contract::{Acceleration, BuiltScene, Hit, Ray};
use crate::scene::SceneDescription;

/// Rays asked in one call: enough to keep threads busy, and time is looked at between calls.
const RAYS_PER_CALL: usize = 4096;

/// What is asked with and without a BVH.
#[derive(Clone, Debug, Default)]
pub(crate) struct Questions {
    /// Closest hits.
    pub(crate) rays: Vec<Ray>,
    /// Closest hits and any hit.
    pub(crate) segments: Vec<Ray>,
}

#[derive(Clone, Debug)]
pub(crate) struct Answers {
    pub(crate) rays: Vec<Hit>,
    pub(crate) segments: Vec<Hit>,
    pub(crate) occluded: Vec<bool>,
}

/// What the loop answers; whether a segment is occluded follows.
#[derive(Clone, Debug)]
pub(crate) struct Truth {
    pub(crate) rays: Vec<Hit>,
    pub(crate) segments: Vec<Hit>,
    /// Whether each segment would be occluded if it had no end.
    pub(crate) endless: Vec<bool>,
    /// The same if it started at its origin.
    pub(crate) from_origin: Vec<bool>,
    /// Rays that hit something nearer than their hit, once they are told to end just before it.
    pub(crate) overwritten: usize,
}

pub(crate) fn closest_hits(
    scene: &mut dyn BuiltScene,
    rays: &[Ray],
) -> Result<Vec<Hit>, CheckError> {
    let mut hits = vec![Hit::MISS; rays.len()];
    for (rays, hits) in rays.chunks(RAYS_PER_CALL).zip(hits.chunks_mut(RAYS_PER_CALL)) {
        scene.intersect(rays, hits)?;
    }
    Ok(hits)
}

/// Which segments are occluded.
pub(super) fn occlusions(
    scene: &mut dyn BuiltScene,
    segments: &[Ray],
) -> Result<Vec<bool>, CheckError> {
    let mut occluded = vec![false; segments.len()];
    let calls = segments.chunks(RAYS_PER_CALL).zip(occluded.chunks_mut(RAYS_PER_CALL));
    for (segments, occluded) in calls {
        scene.occluded(segments, occluded)?;
    }
    Ok(occluded)
}

/// Those with or without a BVH of the core.
pub(crate) fn hits_with(
    context: &mut Context<'_>,
    scene: &SceneDescription,
    acceleration: Acceleration,
    rays: &[Ray],
) -> Result<Vec<Hit>, CheckError> {
    closest_hits(context.core.build_scene(scene, acceleration)?.as_mut(), rays)
}

impl Questions {
    pub(crate) fn ask(&self, scene: &mut dyn BuiltScene) -> Result<Answers, CheckError> {
        let rays = closest_hits(scene, &self.rays)?;
        let segments = closest_hits(scene, &self.segments)?;
        let occluded = occlusions(scene, &self.segments)?;
        Ok(Answers { rays, segments, occluded })
    }

    pub(crate) fn answers(&self) -> usize {
        self.rays.len() + 2 * self.segments.len()
    }
}

/// How the answers with a BVH differ from those without.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Differences {
    /// Brute force hits, the BVH misses.
    pub(crate) lost: usize,
    /// The BVH hits, but something nearer is there.
    pub(crate) farther: usize,
    /// The BVH hits where brute force misses, or before what is nearest.
    pub(crate) invented: usize,
    /// Outside the segment that was asked for. Its very ends are a core's own affair: brute force says what they are.
    pub(crate) outside: usize,
    /// At the right t, but another primitive, which is not there.
    pub(crate) misnamed: usize,
    /// Any-hit says free, where something is hit.
    pub(crate) unoccluded: usize,
    /// Any-hit says occluded, where nothing is hit.
    pub(crate) occluded: usize,
}

impl Differences {
    pub(crate) fn total(&self) -> usize {
        self.kinds().iter().map(|(count, _)| count).sum()
    }

    /// The most frequent first, in words.
    pub(crate) fn words(&self) -> String {
        let words = |(count, what): (usize, &str)| format!("{count} {what}");
        self.most_first().into_iter().map(words).collect::<Vec<_>>().join(", ")
    }

    /// In which ways answers differ, the most frequent first: mistakes that have none of them in common are not the same.
    pub(crate) fn ways(&self) -> impl Iterator<Item = String> {
        self.most_first().into_iter().map(|(_, what)| what.to_owned())
    }

    fn most_first(&self) -> Vec<(usize, &'static str)> {
        let mut kinds = self.kinds().to_vec();
        kinds.retain(|(count, _)| *count > 0);
        kinds.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        kinds
    }

    fn kinds(&self) -> [(usize, &'static str); 7] {
        [
            (self.lost, "hits lost"),
            (self.farther, "hits beyond the nearest one"),
            (self.invented, "hits where there is nothing"),
            (self.outside, "hits outside the segment"),
            (self.misnamed, "hits with the wrong primitive"),
            (self.unoccluded, "shadow rays that pass through something"),
            (self.occluded, "shadow rays stopped by nothing"),
        ]
    }

    /// Takes in how one closest hit differs. `is_tie` tells whether the primitive named is at that t too.
    fn take_hit(&mut self, ray: &Ray, found: &Hit, right: &Hit, is_tie: bool) {
        if !found.is_hit() {
            self.lost += usize::from(right.is_hit());
        } else if !(ray.t_min <= found.t && found.t <= ray.t_max) {
            self.outside += 1;
        } else if right.is_hit() && found.t > right.t {
            self.farther += 1;
        } else if found.t.to_bits() != right.t.to_bits() {
            self.invented += 1;
        } else if (found.shape, found.primitive) != (right.shape, right.primitive) && !is_tie {
            self.misnamed += 1;
        }
    }
}

/// Compares answers; `is_there` tells whether a ray meets the primitive of a hit at the hit's t.
pub(crate) fn compare(
    questions: &Questions,
    found: &Answers,
    right: &Truth,
    is_there: &dyn Fn(&Ray, &Hit) -> bool,
) -> Differences {
    let mut differences = Differences::default();
    let rays = questions.rays.iter().zip(found.rays.iter().zip(&right.rays));
    let segments = questions.segments.iter().zip(found.segments.iter().zip(&right.segments));
    for (ray, (found, right)) in rays.chain(segments) {
        differences.take_hit(ray, found, right, is_there(ray, found));
    }
    for (found, right) in found.occluded.iter().zip(&right.segments) {
        differences.unoccluded += usize::from(right.is_hit() && !found);
        differences.occluded += usize::from(*found && !right.is_hit());
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn hit(t: f64, primitive: u32) -> Hit {
        Hit { t, shape: 0, primitive, ..Hit::MISS }
    }

    fn differs(found: Hit, right: Hit) -> Differences {
        let ray = Ray { t_max: 10.0, ..Ray::new(DVec3::ZERO, DVec3::X) };
        let mut differences = Differences::default();
        differences.take_hit(&ray, &found, &right, false);
        differences
    }

    #[test]
    fn every_way_to_differ_has_its_own_name() {
        assert_eq!(differs(hit(2.0, 1), hit(2.0, 1)).total(), 0);
        assert_eq!(differs(Hit::MISS, Hit::MISS).total(), 0);
        assert_eq!(differs(Hit::MISS, hit(2.0, 1)).lost, 1);
        assert_eq!(differs(hit(3.0, 2), hit(2.0, 1)).farther, 1);
        assert_eq!(differs(hit(1.0, 2), hit(2.0, 1)).invented, 1);
        assert_eq!(differs(hit(1.0, 2), Hit::MISS).invented, 1);
        assert_eq!(differs(hit(11.0, 2), Hit::MISS).outside, 1);
        assert_eq!(differs(hit(10.0, 1), hit(10.0, 1)).total(), 0);
        assert_eq!(differs(hit(f64::NAN, 1), hit(1.0, 1)).outside, 1);
        assert_eq!(differs(hit(2.0, 2), hit(2.0, 1)).misnamed, 1);
        assert_eq!(differs(hit(2f64.next_up(), 1), hit(2.0, 1)).farther, 1, "by the last bit");
    }

    #[test]
    fn words_begin_with_the_most_frequent() {
        let differences = Differences { lost: 2, unoccluded: 5, ..Differences::default() };
        assert_eq!(differences.words(), "5 shadow rays that pass through something, 2 hits lost");
    }
}
