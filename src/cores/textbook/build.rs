//! Part 2: building a bounding volume hierarchy, from the root down.
//!
//! The rule that divides a node comes from `split`; that the build ends, and how deep it gets, is decided here.

use super::split::{self, Item};
use super::steps::Steps;
use crate::contract::Split;
use crate::scene::Aabb;
use std::ops::Range;

#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) bounds: Aabb,
    pub(crate) content: Content,
}

#[derive(Debug)]
pub(crate) enum Content {
    /// The primitives in this range.
    Leaf(Range<usize>),
    Inner([usize; 2]),
}

/// The nodes over `boxes`, the root first and each left child right after its parent; and the
/// numbers of the boxes in the order of the leaves. No nodes over nothing.
pub(crate) fn build(
    boxes: impl Iterator<Item = Aabb>,
    split: Split,
    max_leaf_size: u32,
    steps: &Steps,
) -> (Vec<Node>, Vec<usize>) {
    let mut items: Vec<Item> = boxes.enumerate().map(item).collect();
    let mut builder = Builder {
        split,
        max_leaf_size: max_leaf_size.max(1) as usize,
        max_rule_depth: max_rule_depth(items.len()),
        nodes: Vec::new(),
        steps,
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

pub(crate) struct Builder<'a> {
    pub(crate) split: Split,
    pub(crate) max_leaf_size: usize,
    max_rule_depth: usize,
    nodes: Vec<Node>,
    pub(crate) steps: &'a Steps,
}

impl Builder<'_> {
    /// Builds the node over `items`, the first of which stands at `first` in the order of leaves. Answers its number.
    fn node(&mut self, items: &mut [Item], first: usize, depth: usize) -> usize {
        let number = self.nodes.len();
        let content = Content::Leaf(self.steps.leaf(first, items.len()));
        self.nodes.push(Node { bounds: self.steps.node_bounds(items), content });
        if let Some(left_count) = self.steps.divide(self, items, depth) {
            let (left, right) = items.split_at_mut(left_count);
            let left = self.node(left, first, depth + 1);
            let right = self.node(right, first + left_count, depth + 1);
            self.nodes[number].content = Content::Inner([left, right]);
        }
        number
    }
}

/// The box of a node holds the boxes of all its items.
pub(crate) fn node_bounds(items: &[Item]) -> Aabb {
    split::union(items.iter().map(|item| item.bounds))
}

/// The places of a leaf's items in the order of leaves.
pub(crate) fn leaf(first: usize, count: usize) -> Range<usize> {
    first..first + count
}

/// How many items go left: at least one, and not all. `None` where they are few enough for a leaf.
pub(crate) fn divide(builder: &Builder<'_>, items: &mut [Item], depth: usize) -> Option<usize> {
    if items.len() <= builder.max_leaf_size {
        return None;
    }
    if depth >= builder.max_rule_depth {
        return Some(split::halve(items, builder.steps));
    }
    match split::partition(builder.split, items, builder.steps) {
        0 => Some(split::halve(items, builder.steps)),
        all if all == items.len() => Some(split::halve(items, builder.steps)),
        left_count => Some(left_count),
    }
}
