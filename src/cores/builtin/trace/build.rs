//! BVH construction: from a list of boxes to a binary BVH, by the rules of [`Split`].
//!
//! Whatever the rule, a node that it cannot divide (equal centroids, one-sided partitions, great depth) is
//! divided into equal counts, so every build ends, and its depth is bounded.

use super::bounds::Bounds;
use super::item::{Item, Summary};
use super::surface_area;
use crate::contract::Split;

/// Below this depth every rule gives way to the median, which needs at most 32 more levels.
const RULED_DEPTH: usize = 64;
/// Subtrees at least this large are built in parallel.
const PARALLEL_SIZE: usize = 4096;

/// A node of the binary BVH. Its first child, if any, is the next node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    pub(crate) bounds: Bounds,
    pub(crate) content: Content,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// Items `first .. first + count`, all of one kind.
    Leaf {
        /// In the sorted list.
        first: usize,
        /// At least 1.
        count: usize,
    },
    /// Two children: the next node, and the one `second` further on.
    Inner { second: usize },
}

#[derive(Clone, Copy, Debug)]
pub struct Plan {
    pub split: Split,
    pub max_leaf_size: usize,
}

impl Plan {
    /// Sorts `items` and answers the nodes over them, the root first; some may be unused. Empty for no items.
    pub(crate) fn build(self, items: &mut [Item]) -> Vec<BinaryNode> {
        let unused =
            BinaryNode { bounds: Bounds::EMPTY, content: Content::Leaf { first: 0, count: 0 } };
        // A subtree over n items has at most 2 n − 1 nodes: every subtree knows its slice beforehand.
        let mut nodes = vec![unused; (2 * items.len()).saturating_sub(1)];
        if !items.is_empty() {
            self.fill(items, 0, &mut nodes, 0);
        }
        nodes
    }

    fn fill(self, items: &mut [Item], first: usize, nodes: &mut [BinaryNode], depth: usize) {
        let summary = Summary::of(items);
        let Some(middle) = self.divide(items, &summary, depth) else {
            let content = Content::Leaf { first, count: items.len() };
            nodes[0] = BinaryNode { bounds: summary.bounds, content };
            return;
        };
        let content = Content::Inner { second: 2 * middle };
        nodes[0] = BinaryNode { bounds: summary.bounds, content };
        let is_large = items.len() >= PARALLEL_SIZE;
        let (left, right) = items.split_at_mut(middle);
        let (left_nodes, right_nodes) = nodes[1..].split_at_mut(2 * middle - 1);
        let mut fill_left = || self.fill(left, first, left_nodes, depth + 1);
        let mut fill_right = || self.fill(right, first + middle, right_nodes, depth + 1);
        if is_large {
            rayon::join(fill_left, fill_right);
        } else {
            fill_left();
            fill_right();
        }
    }

    /// Sorts `items` into two parts that are not empty, and answers where the second starts; `None` for a leaf.
    fn divide(self, items: &mut [Item], summary: &Summary, depth: usize) -> Option<usize> {
        let may_be_leaf = items.len() <= self.max_leaf_size.max(1);
        if may_be_leaf && !summary.is_mixed() && self.prefers_leaf(items, summary) {
            return None;
        }
        if may_be_leaf && summary.is_mixed() {
            return Some(partition(items, |item| item.is_sphere));
        }
        let ruled = if depth < RULED_DEPTH { self.divide_by_rule(items, summary) } else { None };
        let is_proper = |middle: &usize| (1..items.len()).contains(middle);
        Some(ruled.filter(is_proper).unwrap_or_else(|| divide_equally(items, summary)))
    }

    fn prefers_leaf(self, items: &[Item], summary: &Summary) -> bool {
        match self.split {
            Split::CoresChoice | Split::SurfaceArea => surface_area::prefers_leaf(items, summary),
            Split::Median | Split::MeanOfCentroids | Split::Midpoint => true,
        }
    }

    fn divide_by_rule(self, items: &mut [Item], summary: &Summary) -> Option<usize> {
        let axis = summary.centroids.longest_axis();
        match self.split {
            Split::CoresChoice | Split::SurfaceArea => {
                let cut = surface_area::best_cut(items, summary)?;
                Some(partition(items, |item| cut.is_left(item)))
            }
            Split::Median => None,
            Split::MeanOfCentroids => {
                let sum: f64 = items.iter().map(|item| f64::from(item.centroid()[axis])).sum();
                let mean = (sum / items.len() as f64) as f32;
                Some(partition(items, |item| item.centroid()[axis] < mean))
            }
            Split::Midpoint => {
                let middle = summary.centroids.centre()[axis];
                Some(partition(items, |item| item.centroid()[axis] < middle))
            }
        }
    }
}

/// Equal counts along the longest axis of the centroids.
fn divide_equally(items: &mut [Item], summary: &Summary) -> usize {
    let axis = summary.centroids.longest_axis();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centroid()[axis].total_cmp(&b.centroid()[axis]));
    middle
}

/// Brings the items that belong left to the front, and answers how many they are.
fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let mut middle = 0;
    for index in 0..items.len() {
        if is_left(&items[index]) {
            items.swap(index, middle);
            middle += 1;
        }
    }
    middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const RULES: [Split; 5] = [
        Split::CoresChoice,
        Split::Median,
        Split::MeanOfCentroids,
        Split::Midpoint,
        Split::SurfaceArea,
    ];

    fn item(number: u32, at: DVec3) -> Item {
        Item { bounds: Bounds::around([at, at + 0.5]), number, is_sphere: number.is_multiple_of(5) }
    }

    /// Visits every node, checks that boxes enclose, and answers (depth, numbers of the items in leaves).
    fn walk(nodes: &[BinaryNode], at: usize, items: &[Item], plan: Plan) -> (usize, Vec<u32>) {
        let bounds = nodes[at].bounds;
        match nodes[at].content {
            Content::Leaf { first, count } => {
                assert!((1..=plan.max_leaf_size).contains(&count), "{plan:?}: leaf of {count}");
                let leaf = &items[first..first + count];
                assert!(leaf.iter().all(|item| bounds.union(item.bounds) == bounds));
                assert!(leaf.iter().all(|item| item.is_sphere == leaf[0].is_sphere));
                (1, leaf.iter().map(|item| item.number).collect())
            }
            Content::Inner { second } => {
                let (left, right) = (at + 1, at + second);
                assert_eq!(nodes[left].bounds.union(nodes[right].bounds), bounds);
                let (left_depth, mut numbers) = walk(nodes, left, items, plan);
                let (right_depth, more) = walk(nodes, right, items, plan);
                numbers.extend(more);
                (1 + left_depth.max(right_depth), numbers)
            }
        }
    }

    fn check(mut items: Vec<Item>, most_depth: usize) {
        for split in RULES {
            for max_leaf_size in [1, 4, 100] {
                let plan = Plan { split, max_leaf_size };
                let nodes = plan.build(&mut items);
                let (depth, mut numbers) = walk(&nodes, 0, &items, plan);
                numbers.sort_unstable();
                assert!(numbers.into_iter().eq(0..items.len() as u32), "{plan:?} lost an item");
                assert!(depth <= most_depth, "{plan:?}: depth {depth}");
            }
        }
    }

    #[test]
    fn every_item_is_in_exactly_one_leaf() {
        let mut stream = crate::cores::builtin::random::Stream::new(1, 2, 3);
        let place = |number| item(number, DVec3::from((stream.point() * 100.0, stream.unit())));
        check((0..2000).map(place).collect(), 40);
    }

    #[test]
    fn equal_centroids_end_at_logarithmic_depth() {
        check((0..10_000).map(|number| item(number, DVec3::ONE)).collect(), 17);
    }

    #[test]
    fn exponential_sizes_end_at_bounded_depth() {
        let place = |number: u32| item(number, DVec3::X * 2_f64.powi(number as i32));
        check((0..120).map(place).collect(), 64 + 7);
    }

    #[test]
    fn nothing_gives_no_nodes() {
        assert!(Plan { split: Split::Median, max_leaf_size: 4 }.build(&mut []).is_empty());
    }
}
