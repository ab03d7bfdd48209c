//! Part 2: building a bounding volume hierarchy, from the root down.
//!
//! The rule that divides a node comes from `split`; that the build ends, and how deep it gets, is
//! decided here.

use super::change::Change;
use super::split::{self, Item};
use crate::contract::Split;
use crate::scene::Aabb;
use std::ops::Range;

/// A node of the hierarchy.
#[derive(Debug)]
pub struct Node {
    /// Holds everything below.
    pub bounds: Aabb,
    /// What is below.
    pub content: Content,
}

/// What is below a node.
#[derive(Debug)]
pub enum Content {
    /// The primitives in this range.
    Leaf(Range<usize>),
    /// The numbers of the children.
    Inner([usize; 2]),
}

/// The nodes over `boxes`, the root first and each left child right after its parent; and the
/// numbers of the boxes in the order of the leaves. No nodes over nothing.
pub fn build(
    boxes: impl Iterator<Item = Aabb>,
    split: Split,
    max_leaf_size: u32,
    change: Change,
) -> (Vec<Node>, Vec<usize>) {
    let mut items: Vec<Item> = boxes.enumerate().map(item).collect();
    let mut builder = Builder {
        split,
        change,
        max_leaf_size: max_leaf_size.max(1) as usize,
        max_rule_depth: max_rule_depth(items.len()),
        nodes: Vec::new(),
    };
    if !items.is_empty() {
        builder.node(&mut items, 0, 0);
    }
    (builder.nodes, items.iter().map(|item| item.primitive).collect())
}

/// Boxes are larger than what they hold by this much of their largest coordinate, so that rounding
/// in the box test can never lose what the primitive's own test would have found.
const MARGIN: f64 = 1e-12;

fn item((primitive, Aabb { min, max }): (usize, Aabb)) -> Item {
    let margin = MARGIN * min.abs().max(max.abs()).max_element();
    let bounds = Aabb { min: min - margin, max: max + margin };
    Item { primitive, bounds, centroid: (min + max) / 2.0 }
}

/// Below this depth nodes are halved whatever the rule: points at 1, 1/2, 1/4, … would otherwise be
/// split off one by one. Halving adds at most log₂ n levels more.
fn max_rule_depth(primitives: usize) -> usize {
    32 + primitives.max(1).ilog2() as usize
}

/// Levels after which [`Change::SplitRepeated`] gives up.
const SPLIT_REPEATED: usize = 500;

struct Builder {
    split: Split,
    change: Change,
    max_leaf_size: usize,
    max_rule_depth: usize,
    nodes: Vec<Node>,
}

impl Builder {
    /// Builds the node over `items`, the first of which stands at `first` in the order of leaves.
    /// Answers its number.
    fn node(&mut self, items: &mut [Item], first: usize, depth: usize) -> usize {
        let bounds = match self.change {
            Change::NodeBoxOfCentroids => split::centroid_bounds(items),
            _ => split::union(items.iter().map(|item| item.bounds)),
        };
        let number = self.nodes.len();
        let end = match self.change {
            Change::LastPrimitiveLost if items.len() > 1 => first + items.len() - 1,
            _ => first + items.len(),
        };
        self.nodes.push(Node { bounds, content: Content::Leaf(first..end) });
        if items.len() > self.max_leaf_size {
            let left_count = self.divide(items, depth);
            if left_count == 0 || left_count == items.len() {
                return self.node_without_end(number, items, first, depth);
            }
            let (left, right) = items.split_at_mut(left_count);
            let left = self.node(left, first, depth + 1);
            let right = self.node(right, first + left_count, depth + 1);
            self.nodes[number].content = Content::Inner([left, right]);
        }
        number
    }

    /// [`Change::SplitRepeated`]: an empty child, and everything in the other, again and again.
    /// Here it comes to an end, so that the process lives to tell.
    fn node_without_end(
        &mut self,
        number: usize,
        items: &mut [Item],
        first: usize,
        depth: usize,
    ) -> usize {
        if depth < SPLIT_REPEATED {
            let Node { bounds, .. } = self.nodes[number];
            let empty = self.nodes.len();
            self.nodes.push(Node { bounds, content: Content::Leaf(first..first) });
            let all = self.node(items, first, depth + 1);
            self.nodes[number].content = Content::Inner([empty, all]);
        }
        number
    }

    /// How many items go left: at least one, and not all.
    fn divide(&self, items: &mut [Item], depth: usize) -> usize {
        if self.change == Change::SplitRepeated {
            return split::partition(self.split, items, self.change);
        }
        if depth >= self.max_rule_depth {
            return split::halve(items, self.change);
        }
        match split::partition(self.split, items, self.change) {
            0 => split::halve(items, self.change),
            all if all == items.len() => split::halve(items, self.change),
            left_count => left_count,
        }
    }
}
