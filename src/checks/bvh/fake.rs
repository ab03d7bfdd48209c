//! A core over the reference BVH that can be made to slip, for the tests of the checks in this folder.

use super::reference::{ReferenceBvh, Walk, Walked, meets};
use crate::checks::testing::info;
use crate::contract::{
    Acceleration, BuildStats, BuiltScene, Core, CoreInfo, Hit, Precision, Ray, Result,
    TraversalStats,
};
use crate::scene::{Aabb, Mesh, SceneDescription};
use glam::DVec3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slip {
    None,
    /// Closest hits end at the first triangle that is hit.
    KeepsTheFirstHit,
    /// Boxes miss a twentieth of what they should hold.
    ShrinksBoxes,
    /// Shadow rays do not end at their light.
    ShadowsWithoutEnd,
    ForgetsTheEnd,
    /// Hits carry the number of the triangle in the order of the leaves.
    NamesTheLeafOrder,
    IsAList,
    /// A BVH that is never asked: every triangle is tested.
    TestsEverything,
    /// The ray does not end at what was found.
    NeverShortens,
    /// The left child is always visited first.
    NeverOrders,
    /// Shadow rays look for the nearest hit among everything.
    SearchesShadows,
    /// Shadow rays are tested against one triangle after the other.
    ShadowsByTheLoop,
    /// The same, up to the first that is hit.
    ShadowsByTheLoopToTheFirst,
    ShrinksTriangles,
    CullsBack,
    LosesTheLast,
    /// No mistake: t is compared in fewer digits than it is told in.
    ComparesFewDigits,
}

impl Slip {
    /// Whether it is one of the triangles themselves, which a loop over them makes too.
    const fn is_in_triangles(self) -> bool {
        matches!(
            self,
            Self::ShrinksTriangles | Self::CullsBack | Self::LosesTheLast | Self::ComparesFewDigits
        )
    }
}

pub(crate) struct FakeCore(pub(crate) Slip);

struct FakeScene {
    slip: Slip,
    brute: bool,
    bvh: ReferenceBvh,
    mesh: Mesh,
}

impl Core for FakeCore {
    fn info(&self) -> CoreInfo {
        info(Precision::Double)
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        let mesh = scene.meshes.first().cloned().unwrap_or_default();
        let mut bvh = ReferenceBvh::new(&mesh);
        if self.0 == Slip::ShrinksBoxes {
            bvh.change_boxes(|bounds| {
                let margin = 0.025 * (bounds.max - bounds.min);
                Aabb { min: bounds.min + margin, max: bounds.max - margin }
            });
        }
        let brute = acceleration == Acceleration::BruteForce;
        let slip = if brute && !self.0.is_in_triangles() { Slip::None } else { self.0 };
        Ok(Box::new(FakeScene { slip, brute, bvh, mesh }))
    }
}

impl FakeScene {
    fn walk(&self, ray: &Ray, walk: Walk) -> Walked {
        if !self.brute && self.slip != Slip::TestsEverything {
            return self.bvh.walk(ray, walk);
        }
        self.bvh.test_all(ray)
    }

    fn closest(&self, ray: &Ray) -> Walked {
        let until = |t_max| Ray { t_max, ..*ray };
        match self.slip {
            Slip::KeepsTheFirstHit => self.walk(ray, Walk::AnyHit),
            Slip::NeverShortens => self.walk(ray, Walk::Unshortened),
            Slip::NeverOrders => self.walk(ray, Walk::Unordered),
            Slip::ForgetsTheEnd => self.walk(&until(f64::INFINITY), Walk::Ordered),
            Slip::ComparesFewDigits => self.walk(&until((1.0 + 3e-5) * ray.t_max), Walk::Ordered),
            _ => self.walk(ray, Walk::Ordered),
        }
    }

    fn any(&self, ray: &Ray) -> Walked {
        match self.slip {
            Slip::ShadowsWithoutEnd => {
                self.walk(&Ray { t_max: f64::INFINITY, ..*ray }, Walk::AnyHit)
            }
            Slip::SearchesShadows => self.walk(ray, Walk::Unshortened),
            Slip::ShadowsByTheLoop => self.bvh.test_all(ray),
            Slip::ShadowsByTheLoopToTheFirst => self.bvh.test_up_to_a_hit(ray),
            _ => self.walk(ray, Walk::AnyHit),
        }
    }

    /// Boxes tested for a ray: in a list, those of all triangles.
    fn boxes(&self, found: &Walked) -> u64 {
        match self.slip {
            Slip::IsAList => self.mesh.indices.len() as u64,
            _ => 2 * found.tests + 1,
        }
    }

    /// Whether a slip in the triangle test loses the hit.
    fn loses(&self, ray: &Ray, found: &Walked) -> bool {
        let Some((t, triangle)) = found.nearest else { return false };
        let corners = self.mesh.corners(triangle as usize);
        match self.slip {
            Slip::ShrinksTriangles => {
                let middle = corners.iter().sum::<DVec3>() / 3.0;
                let outwards = 1.001 * (ray.at(t) - middle);
                meets(&Ray::new(ray.origin, middle + outwards - ray.origin), &corners).is_none()
            }
            Slip::CullsBack => {
                let [a, b, c] = corners;
                (b - a).cross(c - a).dot(ray.direction) > 0.0
            }
            Slip::LosesTheLast => triangle as usize + 1 == self.mesh.indices.len(),
            _ => false,
        }
    }

    fn hit(&self, found: Walked) -> Hit {
        let Some((t, triangle)) = found.nearest else { return Hit::MISS };
        let [a, b, c] = self.mesh.corners(triangle as usize);
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let primitive = match self.slip {
            Slip::NamesTheLeafOrder => self.bvh.place_of(triangle),
            _ => triangle,
        };
        let (geometric_normal, shading_normal) = (normal, normal);
        Hit { t, shape: 0, primitive, geometric_normal, shading_normal, ..Hit::MISS }
    }
}

impl BuiltScene for FakeScene {
    fn stats(&self) -> BuildStats {
        let max_depth = match self.slip {
            Slip::IsAList => self.mesh.indices.len() as u64,
            _ => self.bvh.depth(),
        };
        BuildStats { max_depth, ..BuildStats::default() }
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let mut stats = TraversalStats { rays: rays.len() as u64, ..TraversalStats::default() };
        for (ray, hit) in rays.iter().zip(hits) {
            let found = self.closest(ray);
            stats.primitive_tests += found.tests;
            stats.box_tests += self.boxes(&found);
            *hit = if self.loses(ray, &found) { Hit::MISS } else { self.hit(found) };
        }
        Ok(stats)
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        let mut stats = TraversalStats { rays: rays.len() as u64, ..TraversalStats::default() };
        for (ray, occluded) in rays.iter().zip(occluded) {
            let found = self.any(ray);
            stats.primitive_tests += found.tests;
            *occluded = found.nearest.is_some();
        }
        Ok(stats)
    }
}
