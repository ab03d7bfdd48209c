//! The yardstick for counts: a plain BVH over triangles, split at the median of the longest axis, with leaves
//! of four, and four ways to walk it. It judges no hit; it only says how many tests a course's BVH needs.
//!
//! The counts of `bumpy sphere` and `random soup` at 32 768 triangles were computed before in Python, independently:
//! 10.0 and 48.5 tests a ray in order, 17.3 and 82.7 out of order, 25.7 and 124.5 without shortening the ray.

use crate::contract::Ray;
use crate::scene::{Aabb, Mesh};
use glam::DVec3;

const LEAF: usize = 4;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Walk {
    /// The nearer child first, and the ray ends at what was found.
    Ordered,
    /// The left child first, and the ray ends at what was found.
    Unordered,
    /// The left child first, and boxes are tested as if nothing had been found.
    Unshortened,
    AnyHit,
}

#[derive(Debug)]
pub(crate) struct ReferenceBvh {
    nodes: Vec<Node>,
    /// In the order of the leaves, with their numbers in the mesh.
    triangles: Vec<(u32, [DVec3; 3])>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// Triangles of a leaf; empty for an inner node.
    first: usize,
    end: usize,
    /// The left child comes right after its parent.
    right: usize,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Walked {
    /// The nearest t, and the number of its triangle in the mesh.
    pub(crate) nearest: Option<(f64, u32)>,
    pub(crate) tests: u64,
}

impl ReferenceBvh {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        Self::divided(mesh, true)
    }

    /// Whose nodes hold the triangles as the mesh lists them: nothing is moved to its side of a split.
    pub(crate) fn unsorted(mesh: &Mesh) -> Self {
        Self::divided(mesh, false)
    }

    fn divided(mesh: &Mesh, sorts: bool) -> Self {
        let numbers = 0..u32::try_from(mesh.indices.len()).unwrap_or(u32::MAX);
        let mut bvh = Self {
            nodes: Vec::new(),
            triangles: numbers.map(|number| (number, mesh.corners(number as usize))).collect(),
        };
        if !bvh.triangles.is_empty() {
            bvh.build(0, bvh.triangles.len(), sorts);
        }
        bvh
    }

    /// Appends the node over the triangles from `first` to `end`, and all below it.
    fn build(&mut self, first: usize, end: usize, sorts: bool) {
        let corners = self.triangles[first..end].iter().flat_map(|(_, corners)| *corners);
        let bounds = Aabb::around(corners).unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ZERO });
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, first, end, right: 0 });
        if end - first <= LEAF {
            return;
        }
        let axis = longest_axis(bounds);
        let middle = first + (end - first) / 2;
        let centre = |corners: &[DVec3; 3]| corners.iter().map(|corner| corner[axis]).sum::<f64>();
        if sorts {
            self.triangles[first..end].select_nth_unstable_by((end - first) / 2, |a, b| {
                centre(&a.1).total_cmp(&centre(&b.1))
            });
        }
        self.build(first, middle, sorts);
        self.nodes[node] = Node { bounds, first, end: first, right: self.nodes.len() };
        self.build(middle, end, sorts);
    }

    pub(crate) fn walk(&self, ray: &Ray, walk: Walk) -> Walked {
        let mut search = Search::new(ray, walk);
        if !self.nodes.is_empty() {
            self.walk_below(0, &mut search);
        }
        search.found
    }

    fn walk_below(&self, number: usize, search: &mut Search) {
        let node = self.nodes[number];
        if search.is_done() || search.entry(&node.bounds).is_none() {
            return;
        }
        if node.end > node.first {
            self.triangles[node.first..node.end].iter().for_each(|triangle| search.test(triangle));
            return;
        }
        let (left, right) = (number + 1, node.right);
        let entry = |child: usize| search.entry(&self.nodes[child].bounds);
        let swaps = search.walk == Walk::Ordered
            && matches!((entry(left), entry(right)), (Some(l), Some(r)) if r < l);
        for child in if swaps { [right, left] } else { [left, right] } {
            self.walk_below(child, search);
        }
    }

    /// Triangles tested over all rays, a ray.
    pub(crate) fn tests_per_ray(&self, rays: &[Ray], walk: Walk) -> f64 {
        let tests: u64 = rays.iter().map(|ray| self.walk(ray, walk).tests).sum();
        tests as f64 / rays.len() as f64
    }
}

#[cfg(test)]
impl ReferenceBvh {
    /// Without the BVH.
    pub(crate) fn test_all(&self, ray: &Ray) -> Walked {
        let mut search = Search::new(ray, Walk::Ordered);
        self.triangles.iter().for_each(|triangle| search.test(triangle));
        search.found
    }

    /// Without the BVH, in the order of the mesh, until something is hit.
    pub(crate) fn test_up_to_a_hit(&self, ray: &Ray) -> Walked {
        let mut search = Search::new(ray, Walk::Ordered);
        let mut triangles: Vec<_> = self.triangles.iter().collect();
        triangles.sort_by_key(|(number, _)| *number);
        for triangle in triangles {
            search.test(triangle);
            if search.found.nearest.is_some() {
                break;
            }
        }
        search.found
    }

    /// Puts other boxes in the place of all.
    pub(crate) fn change_boxes(&mut self, change: impl Fn(Aabb) -> Aabb) {
        self.nodes.iter_mut().for_each(|node| node.bounds = change(node.bounds));
    }

    /// Where a triangle stands in the order of the leaves.
    pub(crate) fn place_of(&self, number: u32) -> u32 {
        self.triangles.iter().position(|(n, _)| *n == number).unwrap_or(0) as u32
    }

    /// Nodes on the longest way from the root to a leaf.
    pub(crate) fn depth(&self) -> u64 {
        fn below(nodes: &[Node], number: usize) -> u64 {
            let Some(node) = nodes.get(number) else { return 0 };
            if node.end > node.first {
                return 1;
            }
            1 + below(nodes, number + 1).max(below(nodes, node.right))
        }
        below(&self.nodes, 0)
    }
}

fn longest_axis(bounds: Aabb) -> usize {
    let size = bounds.max - bounds.min;
    (0..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest })
}

struct Search {
    ray: Ray,
    inverse: DVec3,
    walk: Walk,
    found: Walked,
}

impl Search {
    fn new(ray: &Ray, walk: Walk) -> Self {
        Self { ray: *ray, inverse: ray.direction.recip(), walk, found: Walked::default() }
    }

    /// Where the ray ends for a box.
    fn end(&self) -> f64 {
        match (self.walk, self.found.nearest) {
            (Walk::Unshortened, _) | (_, None) => self.ray.t_max,
            (_, Some((t, _))) => t,
        }
    }

    fn is_done(&self) -> bool {
        self.walk == Walk::AnyHit && self.found.nearest.is_some()
    }

    fn entry(&self, bounds: &Aabb) -> Option<f64> {
        let low = (bounds.min - self.ray.origin) * self.inverse;
        let high = (bounds.max - self.ray.origin) * self.inverse;
        let enters = low.min(high).max_element();
        let exits = low.max(high).min_element();
        (enters <= exits && exits >= self.ray.t_min && enters <= self.end()).then_some(enters)
    }

    fn test(&mut self, (number, corners): &(u32, [DVec3; 3])) {
        self.found.tests += 1;
        let end = self.found.nearest.map_or(self.ray.t_max, |(t, _)| t);
        if let Some(t) = meets(&self.ray, corners).filter(|t| self.ray.t_min < *t && *t < end) {
            self.found.nearest = Some((t, *number));
        }
    }
}

/// Möller and Trumbore (1997).
pub(crate) fn meets(ray: &Ray, [a, b, c]: &[DVec3; 3]) -> Option<f64> {
    let (e1, e2) = (*b - *a, *c - *a);
    let p = ray.direction.cross(e2);
    let scale = e1.dot(p).recip();
    let from_a = ray.origin - *a;
    let q = from_a.cross(e1);
    let (v, w) = (from_a.dot(p) * scale, ray.direction.dot(q) * scale);
    (v >= 0.0 && w >= 0.0 && v + w <= 1.0).then(|| e2.dot(q) * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::bvh::question::generic_rays;
    use crate::math::rng::Seed;
    use crate::scene::procedural;

    fn soup() -> (Mesh, Vec<Ray>) {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        (procedural::soup(2000, Seed(1)), generic_rays(bounds, 600, &mut Seed(2).stream()))
    }

    #[test]
    fn every_walk_finds_what_the_loop_finds() {
        let (mesh, rays) = soup();
        let bvh = ReferenceBvh::new(&mesh);
        let numbers = 0..mesh.indices.len();
        for ray in &rays {
            let all = numbers.clone().filter_map(|number| meets(ray, &mesh.corners(number)));
            let nearest = all.filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
            let found = |walk| bvh.walk(ray, walk).nearest.map_or(f64::INFINITY, |(t, _)| t);
            for walk in [Walk::Ordered, Walk::Unordered, Walk::Unshortened] {
                assert_eq!(found(walk), nearest);
            }
            assert_eq!(found(Walk::AnyHit).is_finite(), nearest.is_finite());
        }
    }

    #[test]
    fn order_and_a_shortened_ray_save_tests() {
        let (mesh, rays) = soup();
        let bvh = ReferenceBvh::new(&mesh);
        let tests = |walk| bvh.tests_per_ray(&rays, walk);
        assert!(tests(Walk::Ordered) < tests(Walk::Unordered));
        assert!(tests(Walk::Unordered) < tests(Walk::Unshortened));
        assert!(tests(Walk::Unshortened) < 0.1 * 2000.0);
    }

    #[test]
    fn an_empty_mesh_is_never_hit() {
        let bvh = ReferenceBvh::new(&Mesh::default());
        assert!(bvh.walk(&Ray::new(DVec3::ZERO, DVec3::X), Walk::Ordered).nearest.is_none());
    }
}
