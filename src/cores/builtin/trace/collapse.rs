//! From a binary BVH to nodes of eight children: the child of largest area is opened until there are
//! eight (as Embree does), and leaves are packed into blocks.

use super::build::{BinaryNode, Content, Plan};
use super::geometry::Geometry;
use super::item::Item;
use super::tree::{Child, LANES, PackedSphere, Tree, TriangleBlock, WIDTH, WideNode};

/// Builds the tree over everything solid in `geometry`.
pub(crate) fn build_bvh(geometry: &Geometry, plan: Plan) -> Tree {
    let mut items = geometry.items();
    let binary = plan.build(&mut items);
    let mut collapse = Collapse { geometry, binary: &binary, items: &items, tree: Tree::default() };
    if !binary.is_empty() {
        let root = collapse.child(0, 1);
        collapse.tree.roots.push(root);
    }
    collapse.tree
}

/// One leaf of all triangles and one of all spheres, in the order of the scene.
pub(crate) fn brute_force(geometry: &Geometry) -> Tree {
    let items = geometry.items();
    let mut collapse = Collapse { geometry, binary: &[], items: &items, tree: Tree::default() };
    let first_sphere = items.partition_point(|item| !item.is_sphere);
    for (first, end) in [(0, first_sphere), (first_sphere, items.len())] {
        if first < end {
            let leaf = collapse.leaf(first, end - first, 1);
            collapse.tree.roots.push(leaf);
        }
    }
    collapse.tree
}

struct Collapse<'a> {
    geometry: &'a Geometry,
    binary: &'a [BinaryNode],
    items: &'a [Item],
    tree: Tree,
}

impl Collapse<'_> {
    /// Turns the binary subtree at `at` into a child, `depth` nodes from the root.
    fn child(&mut self, at: usize, depth: u64) -> Child {
        match self.binary[at].content {
            Content::Leaf { first, count } => self.leaf(first, count, depth),
            Content::Inner { .. } => self.node(at, depth),
        }
    }

    fn node(&mut self, at: usize, depth: u64) -> Child {
        let index = self.tree.nodes.len();
        self.tree.nodes.push(WideNode::EMPTY);
        let (below, count) = self.up_to_eight_below(at);
        for (slot, &at) in below[..count].iter().enumerate() {
            let child = self.child(at, depth + 1);
            self.tree.nodes[index].set(slot, self.binary[at].bounds, child);
        }
        Child::node(index)
    }

    /// Opens the largest inner node until there are eight or only leaves.
    fn up_to_eight_below(&self, at: usize) -> ([usize; WIDTH], usize) {
        let mut below = [at; WIDTH];
        let mut count = 1;
        while count < WIDTH {
            let Some((slot, second)) = self.largest_inner(&below[..count]) else { break };
            let opened = below[slot];
            below[slot] = opened + 1;
            below[count] = opened + second;
            count += 1;
        }
        (below, count)
    }

    /// Which of some nodes is the largest inner one, and how far on its second child is.
    fn largest_inner(&self, nodes: &[usize]) -> Option<(usize, usize)> {
        let inner =
            nodes.iter().enumerate().filter_map(|(slot, &at)| match self.binary[at].content {
                Content::Inner { second } => {
                    Some((self.binary[at].bounds.half_area(), slot, second))
                }
                Content::Leaf { .. } => None,
            });
        inner.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, slot, second)| (slot, second))
    }

    fn leaf(&mut self, first: usize, count: usize, depth: u64) -> Child {
        self.tree.leaves += 1;
        self.tree.depth = self.tree.depth.max(depth);
        let items = self.items;
        let leaf = &items[first..first + count];
        if leaf[0].is_sphere { self.pack_spheres(leaf) } else { self.pack_triangles(leaf) }
    }

    fn pack_triangles(&mut self, leaf: &[Item]) -> Child {
        let first = self.tree.blocks.len();
        let block_count = leaf.len().div_ceil(LANES);
        for (index, lanes) in leaf.chunks(LANES).enumerate() {
            let corners = |item: &Item| (item.number, self.geometry.corners32(item.number));
            let more = index + 1 < block_count;
            self.tree.blocks.push(TriangleBlock::new(lanes.iter().map(corners), more));
        }
        Child::triangles(first)
    }

    fn pack_spheres(&mut self, leaf: &[Item]) -> Child {
        let first = self.tree.spheres.len();
        for (index, item) in leaf.iter().enumerate() {
            let sphere = self.geometry.sphere(item.number);
            let more = index + 1 < leaf.len();
            self.tree.spheres.push(PackedSphere::new(
                item.number,
                sphere.centre,
                sphere.radius,
                more,
            ));
        }
        Child::spheres(first)
    }
}
