//! Part 2: walking a bounding volume hierarchy, and the loop over everything that must agree with it.
//!
//! Primitives lie in the order of the leaves. Without nodes every query is the loop: that is brute force.

use super::build::{Content, Node, build};
use super::intersect::{Crossing, Sphere, Triangle};
use super::slab::intersect_box;
use super::steps::Steps;
use crate::contract::{Acceleration, BuildStats, Ray, TraversalStats};
use crate::scene::Aabb;
use glam::DVec3;
use std::ops::Range;

#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    Triangle(Triangle),
    Sphere(Sphere),
}

impl Form {
    fn intersect(&self, ray: &Ray, steps: &Steps) -> Option<Crossing> {
        match self {
            Self::Triangle(triangle) => triangle.intersect(ray, steps),
            Self::Sphere(sphere) => sphere.intersect(ray, steps),
        }
    }

    fn bounds(&self) -> Aabb {
        match self {
            Self::Triangle(triangle) => triangle.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
        }
    }

    /// Its largest coordinates, in absolute value.
    pub(crate) fn reach(&self) -> DVec3 {
        let Aabb { min, max } = self.bounds();
        min.abs().max(max.abs())
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Primitive {
    pub(crate) form: Form,
    /// Number of its shape in the scene.
    pub(crate) shape: u32,
    /// Number of the triangle in its mesh, 0 for a sphere.
    pub(crate) number: u32,
}

/// All primitives of a scene, with or without a BVH over them.
#[derive(Debug)]
pub(crate) struct Bvh<'a> {
    /// The root first, each left child right after its parent. None at all for brute force.
    nodes: Vec<Node>,
    /// In the order of the leaves.
    primitives: Vec<Primitive>,
    steps: &'a Steps,
}

impl<'a> Bvh<'a> {
    pub(crate) fn new(
        primitives: Vec<Primitive>,
        acceleration: Acceleration,
        steps: &'a Steps,
    ) -> Self {
        let Acceleration::Bvh { split, max_leaf_size, .. } = acceleration else {
            return Self { nodes: Vec::new(), primitives, steps };
        };
        let boxes = primitives.iter().map(|primitive| primitive.form.bounds());
        let (nodes, order) = build(boxes, split, max_leaf_size, steps);
        Self { nodes, primitives: steps.in_leaf_order(&primitives, &order), steps }
    }

    /// The primitive with number `index` in the order of the leaves.
    pub(crate) fn primitive(&self, index: usize) -> &Primitive {
        &self.primitives[index]
    }

    /// The nearest crossing of `ray`, and the index of its primitive.
    pub(crate) fn closest(
        &self,
        ray: &Ray,
        stats: &mut TraversalStats,
    ) -> Option<(usize, Crossing)> {
        stats.rays += 1;
        let mut search = Search { ray, segment: *ray, found: None, stats, steps: self.steps };
        match self.nodes.first() {
            None => self.steps.closest_among(self, 0..self.primitives.len(), &mut search),
            Some(root) => {
                if search.enters(&root.bounds).is_some() {
                    self.closest_below(root, &mut search);
                }
            }
        }
        search.found
    }

    /// Visits the nearer child first, and the other only if it begins before what was found by then.
    fn closest_below(&self, node: &Node, search: &mut Search<'_>) {
        match &node.content {
            Content::Leaf(leaf) => {
                let tested = self.steps.tested_for_leaf(leaf, self.primitives.len());
                self.steps.closest_among(self, tested, search);
            }
            Content::Inner(children) => {
                for (enter, child) in self.near_to_far(*children, search).into_iter().flatten() {
                    if self.steps.is_worth_a_visit(search, enter) {
                        self.closest_below(child, search);
                    }
                }
            }
        }
    }

    /// The children whose boxes the segment meets, with where it enters them.
    fn near_to_far(
        &self,
        [left, right]: [usize; 2],
        search: &mut Search<'_>,
    ) -> [Option<(f64, &Node)>; 2] {
        let mut entry = |child: usize| {
            let node = &self.nodes[child];
            search.enters(&node.bounds).map(|enter| (enter, node))
        };
        let (left, right) = (entry(left), entry(right));
        let entered = |child: Option<(f64, _)>| child.map(|(enter, _)| enter);
        match self.steps.right_is_nearer(entered(left), entered(right)) {
            true => [right, left],
            false => [left, right],
        }
    }

    /// Tests one primitive against what is left of the segment.
    pub(crate) fn test(&self, primitive: usize, search: &mut Search<'_>) {
        search.stats.primitive_tests += 1;
        let form = &self.primitives[primitive].form;
        if let Some(crossing) = form.intersect(&search.segment, self.steps) {
            self.steps.keep(search, primitive, crossing);
        }
    }

    /// Whether anything lies on the segment; stops at the first that does.
    pub(crate) fn any(&self, ray: &Ray, stats: &mut TraversalStats) -> bool {
        stats.rays += 1;
        self.steps.any(self, ray, stats)
    }

    /// The same, among what is below the node of this number.
    pub(crate) fn any_below(&self, node: usize, ray: &Ray, stats: &mut TraversalStats) -> bool {
        let node = &self.nodes[node];
        stats.box_tests += 1;
        if intersect_box(&node.bounds, ray, self.steps).is_none() {
            return false;
        }
        match &node.content {
            Content::Leaf(leaf) => self.steps.any_in_leaf(self, leaf, ray, stats),
            Content::Inner(children) => self.steps.any_below_children(self, *children, ray, stats),
        }
    }

    fn any_among(&self, range: Range<usize>, ray: &Ray, stats: &mut TraversalStats) -> bool {
        self.primitives[range].iter().any(|primitive| {
            stats.primitive_tests += 1;
            primitive.form.intersect(ray, self.steps).is_some()
        })
    }

    pub(crate) fn build_stats(&self) -> BuildStats {
        let is_leaf = |node: &&Node| matches!(node.content, Content::Leaf(_));
        BuildStats {
            nodes: self.nodes.len() as u64,
            leaves: self.nodes.iter().filter(is_leaf).count() as u64,
            max_depth: self.nodes.first().map_or(0, |root| self.depth_below(root)),
            bytes: size_of_val(self.nodes.as_slice()) as u64,
        }
    }

    fn depth_below(&self, node: &Node) -> u64 {
        match &node.content {
            Content::Leaf(_) => 1,
            Content::Inner(children) => {
                let deepest = children.map(|child| self.depth_below(&self.nodes[child]));
                1 + deepest[0].max(deepest[1])
            }
        }
    }
}

/// The primitives as the leaves name them, each with its own number.
pub(crate) fn in_leaf_order(primitives: &[Primitive], order: &[usize]) -> Vec<Primitive> {
    order.iter().map(|index| primitives[*index]).collect()
}

/// One closest-hit query under way.
pub(crate) struct Search<'a> {
    /// The ray as it was asked for.
    pub(crate) ray: &'a Ray,
    /// The ray, up to the nearest crossing so far.
    pub(crate) segment: Ray,
    /// The nearest crossing so far, and the index of its primitive.
    pub(crate) found: Option<(usize, Crossing)>,
    stats: &'a mut TraversalStats,
    pub(crate) steps: &'a Steps,
}

impl Search<'_> {
    fn enters(&mut self, bounds: &Aabb) -> Option<f64> {
        self.stats.box_tests += 1;
        self.steps.enter(self, bounds)
    }
}

/// Where the segment enters the box, if it does.
pub(crate) fn enter(search: &mut Search<'_>, bounds: &Aabb) -> Option<f64> {
    intersect_box(bounds, &search.segment, search.steps).map(|(enter, _)| enter)
}

/// Whether the right child is to be visited first. For a child that is missed there is no entry.
pub(crate) fn right_is_nearer(left: Option<f64>, right: Option<f64>) -> bool {
    matches!((left, right), (Some(left), Some(right)) if right < left)
}

/// A child that begins behind what was found has nothing nearer.
pub(crate) fn is_worth_a_visit(search: &Search<'_>, enter: f64) -> bool {
    enter <= search.segment.t_max
}

/// The primitives that are tested for a leaf are its own.
pub(crate) fn tested_for_leaf(leaf: &Range<usize>, _primitives: usize) -> Range<usize> {
    leaf.clone()
}

/// Tests every primitive of a range; each one found shortens the segment for those after it.
pub(crate) fn closest_among(bvh: &Bvh<'_>, range: Range<usize>, search: &mut Search<'_>) {
    for primitive in range {
        bvh.test(primitive, search);
    }
}

/// Keeps a crossing, and what is left of the segment before it.
pub(crate) fn keep(search: &mut Search<'_>, primitive: usize, crossing: Crossing) {
    search.segment.t_max = crossing.ray_end;
    search.found = Some((primitive, crossing));
}

/// Whether anything lies on the segment.
pub(crate) fn any(bvh: &Bvh<'_>, ray: &Ray, stats: &mut TraversalStats) -> bool {
    match bvh.nodes.is_empty() {
        true => bvh.any_among(0..bvh.primitives.len(), ray, stats),
        false => bvh.any_below(0, ray, stats),
    }
}

/// Whether any primitive of a leaf lies on the segment.
pub(crate) fn any_in_leaf(
    bvh: &Bvh<'_>,
    leaf: &Range<usize>,
    ray: &Ray,
    stats: &mut TraversalStats,
) -> bool {
    bvh.any_among(bvh.steps.tested_for_leaf(leaf, bvh.primitives.len()), ray, stats)
}

/// One hit is enough: below the right child nobody looks if there is one below the left.
pub(crate) fn any_below_children(
    bvh: &Bvh<'_>,
    [left, right]: [usize; 2],
    ray: &Ray,
    stats: &mut TraversalStats,
) -> bool {
    bvh.any_below(left, ray, stats) || bvh.any_below(right, ray, stats)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::Split;
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::steps::LESSON;

    const RULES: [Split; 4] =
        [Split::Median, Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea];

    fn bvh(primitives: &[Primitive], split: Split, max_leaf_size: u32) -> Bvh<'static> {
        Bvh::new(
            primitives.to_vec(),
            Acceleration::Bvh { split, max_leaf_size, counted: false },
            &LESSON,
        )
    }

    fn vector(random: &mut Random<'_>) -> DVec3 {
        let x = random.point().extend(random.number());
        2.0 * x - 1.0
    }

    fn numbered(forms: impl Iterator<Item = Form>) -> Vec<Primitive> {
        (0..).zip(forms).map(|(number, form)| Primitive { form, shape: 0, number }).collect()
    }

    fn triangle(corners: [DVec3; 3]) -> Form {
        Form::Triangle(Triangle::new(corners).expect("it has area"))
    }

    fn soup(count: usize) -> Vec<Primitive> {
        let mut random = Random::for_ray(7, 0);
        let size = 2.0 / (count as f64).cbrt();
        let forms = (0..count).map(|index| {
            let centre = vector(&mut random);
            let corners = [(); 3].map(|()| centre + size / 2.0 * vector(&mut random));
            if index % 10 == 0 {
                Form::Sphere(Sphere { centre, radius: size / 4.0 })
            } else {
                triangle(corners)
            }
        });
        numbered(forms)
    }

    /// Many triangles around one point: no rule can tell their centroids apart.
    fn one_place(count: usize) -> Vec<Primitive> {
        let mut random = Random::for_ray(8, 0);
        let forms = (0..count).map(|_| {
            let (across, along) = (vector(&mut random), vector(&mut random));
            triangle([across, along, -across - along])
        });
        let same_box = numbered(forms.take(count / 2));
        let coincident = triangle([DVec3::X, DVec3::Y, DVec3::Z]);
        let rest = numbered(std::iter::repeat_n(coincident, count - count / 2));
        same_box.into_iter().chain(rest).collect()
    }

    /// Sizes and places from 1 down to `smallest`, each the same part of the one before.
    fn geometric(count: usize, smallest: f64) -> Vec<Primitive> {
        let ratio = smallest.powf(1.0 / count as f64);
        let sphere = |index| {
            let scale = ratio.powi(index);
            Form::Sphere(Sphere { centre: DVec3::X * scale, radius: scale / 3.0 })
        };
        numbered((0..count as i32).map(sphere))
    }

    fn rays(count: usize) -> Vec<Ray> {
        let mut random = Random::for_ray(9, 0);
        let ray = |index: usize| {
            let origin = 1.5 * vector(&mut random);
            let mut direction = vector(&mut random);
            if index.is_multiple_of(5) {
                direction = DVec3::new(0.0, -0.0, direction.z);
            }
            let t_max = if index.is_multiple_of(3) { f64::INFINITY } else { 4.0 * random.number() };
            Ray { t_max, ..Ray::new(origin, direction) }
        };
        (0..count).map(ray).collect()
    }

    #[test]
    fn every_rule_finds_what_brute_force_finds() {
        let scenes = [Vec::new(), soup(1), soup(2), soup(700), one_place(60), geometric(200, 1e-6)];
        let rays = rays(1500);
        let mut stats = TraversalStats::default();
        for primitives in scenes {
            let brute = Bvh::new(primitives.clone(), Acceleration::BruteForce, &LESSON);
            for split in RULES {
                for max_leaf_size in [1, 4] {
                    let bvh = bvh(&primitives, split, max_leaf_size);
                    for ray in &rays {
                        let t = |found: Option<(usize, Crossing)>| found.map(|(_, found)| found.t);
                        let expected = t(brute.closest(ray, &mut stats));
                        assert_eq!(t(bvh.closest(ray, &mut stats)), expected, "{split:?} {ray:?}");
                        assert_eq!(bvh.any(ray, &mut stats), expected.is_some(), "{split:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn brute_force_counts_every_primitive_and_no_box() {
        let brute = Bvh::new(soup(100), Acceleration::BruteForce, &LESSON);
        let mut stats = TraversalStats::default();
        let rays = rays(10);
        rays.iter().for_each(|ray| _ = brute.closest(ray, &mut stats));
        assert_eq!(stats, TraversalStats { rays: 10, box_tests: 0, primitive_tests: 1000 });
        assert_eq!(brute.build_stats(), BuildStats::default());
    }

    /// A traversal that visits the far child first tests 1.7 times as many, one that never shortens the ray 2.6 times.
    #[test]
    fn few_primitives_are_tested_and_growth_is_slow() {
        let rays: Vec<Ray> =
            rays(2000).into_iter().map(|ray| Ray::new(ray.origin, ray.direction)).collect();
        let tests_per_ray = |count| {
            let bvh = bvh(&soup(count), Split::Median, 4);
            let mut stats = TraversalStats::default();
            rays.iter().for_each(|ray| _ = bvh.closest(ray, &mut stats));
            stats.primitive_tests as f64 / stats.rays as f64
        };
        let (few, many) = (tests_per_ray(512), tests_per_ray(32_768));
        let slope = (many / few).ln() / 64.0_f64.ln();
        assert!(slope < 0.25, "{few} tests per ray, then {many}: slope {slope}");
        assert!(many < 60.0, "{many} tests per ray");
    }

    #[test]
    fn builds_end_with_leaves_as_small_as_asked_and_depth_within_bounds() {
        for primitives in [one_place(10_000), geometric(10_000, 1e-200), soup(10_000)] {
            for split in RULES {
                let bvh = bvh(&primitives, split, 3);
                let stats = bvh.build_stats();
                assert!(stats.max_depth <= 2 * 14 + 32, "{split:?}: {stats:?}");
                assert_eq!(stats.nodes, 2 * stats.leaves - 1, "{split:?}: {stats:?}");
                let leaves = bvh.nodes.iter().filter_map(|node| match &node.content {
                    Content::Leaf(range) => Some(range.clone()),
                    Content::Inner(_) => None,
                });
                let sizes: Vec<usize> = leaves.map(|range| range.len()).collect();
                assert!(sizes.iter().all(|size| (1..=3).contains(size)), "{split:?}");
                assert_eq!(sizes.iter().sum::<usize>(), primitives.len(), "{split:?}");
            }
        }
    }
}
