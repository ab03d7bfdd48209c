//! Scenes with their triangles in another order, and how the answers to them differ.

use super::comparison::{closest_hits, occlusions};
use crate::checks::{CheckError, Context};
use crate::contract::{Acceleration, Hit, Ray};
use crate::math::Precision;
use crate::math::rng::{Stream, shuffle};
use crate::scene::SceneDescription;

/// What a core answers for one order.
pub(super) struct Answers {
    pub(super) hits: Vec<Hit>,
    pub(super) occluded: Vec<bool>,
}

impl Answers {
    pub(super) fn of(
        context: &mut Context<'_>,
        scene: &SceneDescription,
        rays: &[Ray],
        segments: Option<&[Ray]>,
    ) -> Result<Self, CheckError> {
        let segments = segments.unwrap_or_default();
        let mut built = context.core.build_scene(scene, Acceleration::DEFAULT)?;
        let hits = closest_hits(built.as_mut(), rays)?;
        let occluded = occlusions(built.as_mut(), segments)?;
        Ok(Self { hits, occluded })
    }
}

pub(super) struct Order {
    pub(super) scene: SceneDescription,
    /// For each mesh, where each triangle of the first order stands now.
    pub(super) places: Vec<Vec<u32>>,
}

impl Order {
    pub(super) fn shuffled(scene: &SceneDescription, stream: &mut Stream) -> Self {
        let mut scene = scene.clone();
        let mut places = Vec::new();
        for mesh in &mut scene.meshes {
            let mut order: Vec<usize> = (0..mesh.indices.len()).collect();
            shuffle(&mut order, stream);
            mesh.indices = order.iter().map(|number| mesh.indices[*number]).collect();
            let mut place = vec![0; order.len()];
            for (now, number) in (0..).zip(&order) {
                place[*number] = now;
            }
            places.push(place);
        }
        Self { scene, places }
    }

    /// Where the triangle of a hit in the first order stands now.
    pub(super) fn place(&self, hit: &Hit) -> u32 {
        let mesh = self.places.get(hit.shape as usize);
        let place = mesh.and_then(|mesh| mesh.get(hit.primitive as usize));
        place.copied().unwrap_or(hit.primitive)
    }
}

/// By how many roundings of the size of the scene t of one triangle may differ: a core may test it beside others or alone,
/// by other instructions. At a cosine c, t is off by 1/c roundings, and of rays from everywhere a share of c² has less: one in
/// 17 million.
const ROUNDINGS: f64 = 4096.0;

/// By how much t may differ on a core of this precision, in a scene of this extent.
pub(super) fn rounding(precision: Precision, extent: f64) -> f64 {
    ROUNDINGS * precision.epsilon() * extent
}

/// How the answers for two orders differ.
pub(super) struct Difference {
    pub(super) hits: usize,
    pub(super) occlusions: usize,
    /// Where the triangles stand that one order hits and the other does not, in the order that does
    /// not, and how many there are in all.
    pub(super) lost: Vec<(u32, usize)>,
}

impl Difference {
    pub(super) fn between(first: &Answers, other: &Answers, order: &Order, rounding: f64) -> Self {
        let mut difference = Self { hits: 0, occlusions: 0, lost: Vec::new() };
        let is_same = |a: &Hit, b: &Hit| match (a.is_hit(), b.is_hit()) {
            (true, true) => (a.t - b.t).abs() <= rounding,
            (a, b) => a == b,
        };
        for (a, b) in first.hits.iter().zip(&other.hits) {
            if is_same(a, b) {
                continue;
            }
            difference.hits += 1;
            let triangles = |hit: &Hit| order.places.get(hit.shape as usize).map_or(0, Vec::len);
            if a.is_hit() && (!b.is_hit() || a.t < b.t) {
                difference.lost.push((order.place(a), triangles(a)));
            } else if let Some(mesh) = order.places.get(b.shape as usize) {
                let number = mesh.iter().position(|now| *now == b.primitive);
                difference.lost.extend(number.map(|number| (number as u32, mesh.len())));
            }
        }
        let pairs = first.occluded.iter().zip(&other.occluded);
        difference.occlusions = pairs.filter(|(a, b)| a != b).count();
        difference
    }

    pub(super) fn total(&self) -> usize {
        self.hits + self.occlusions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_that_differ_by_rounding_are_the_same_and_those_of_two_triangles_are_not() {
        let hit = |t| Hit { t, primitive: 0, shape: 0, ..Hit::MISS };
        let answers = |t| Answers { hits: vec![hit(t)], occluded: Vec::new() };
        let order = Order { scene: SceneDescription::default(), places: vec![vec![0]] };
        let differ = |precision, t| {
            let rounding = rounding(precision, 2.0);
            Difference::between(&answers(1.0), &answers(t), &order, rounding).total()
        };
        assert_eq!(differ(Precision::Double, 1.0 + 1e-13), 0);
        assert_eq!(differ(Precision::Double, 1.0 + 1e-11), 1);
        assert_eq!(differ(Precision::Single, 1.0 + 1e-4), 0);
        assert_eq!(differ(Precision::Single, 1.01), 1);
        assert_eq!(differ(Precision::Single, f64::NAN), 1);
    }
}
