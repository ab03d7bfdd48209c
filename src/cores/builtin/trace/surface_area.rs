//! The surface area heuristic (SAH): split where the expected number of steps is least.
//!
//! A ray that meets a box meets a smaller box in it with the ratio of their areas (MacDonald and Booth 1990).
//! Candidates are the edges between equal bins of the centroids along each axis (Wald 2007), and a leaf costs
//! its blocks of four triangles, because those are tested together.

use super::bounds::Bounds;
use super::item::{Item, Summary};
use super::tree::LANES;

const MOST_BINS: usize = 16;
/// One step down in units of one block test.
const STEP_COST: f32 = 1.0;

/// Where to cut: items whose bin along `axis` is below `bin` go left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    binning: Binning,
    axis: usize,
    bin: usize,
    cost: f32,
}

impl Cut {
    #[inline]
    pub(crate) fn is_left(&self, item: &Item) -> bool {
        self.binning.bin(item, self.axis) < self.bin
    }
}

/// Whether a leaf of `items` is expected to cost no more than dividing them.
pub(crate) fn prefers_leaf(items: &[Item], summary: &Summary) -> bool {
    let area = summary.bounds.half_area();
    // One block is tested at once: dividing it cannot gain anything.
    items.len() <= LANES
        || best_cut(items, summary)
            .is_none_or(|cut| blocks(items.len()) * area <= STEP_COST * area + cut.cost)
}

/// The cheapest cut of the candidates that leave something on both sides.
pub(crate) fn best_cut(items: &[Item], summary: &Summary) -> Option<Cut> {
    let binning = Binning::new(items.len(), summary.centroids);
    let bins = binning.fill(items);
    let cuts = (0..3).filter_map(|axis| best_along(axis, binning, &bins[axis]));
    cuts.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Equal bins over the box of the centroids.
#[derive(Clone, Copy, Debug)]
struct Binning {
    count: usize,
    start: [f32; 3],
    /// Bins per unit of length; 0 along an axis without extent.
    per_length: [f32; 3],
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds::EMPTY, count: 0 };

    fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), count: self.count + other.count }
    }

    fn cost(self) -> f32 {
        blocks(self.count) * self.bounds.half_area()
    }
}

impl Binning {
    fn new(items: usize, centroids: Bounds) -> Self {
        let count = MOST_BINS.min(4 + items / 20);
        let per_length = centroids.extent().to_array().map(|extent| {
            let per_length = count as f32 / extent;
            if per_length.is_finite() { per_length } else { 0.0 }
        });
        Self { count, start: centroids.min.to_array(), per_length }
    }

    #[inline]
    fn bin(&self, item: &Item, axis: usize) -> usize {
        let offset = item.centroid()[axis] - self.start[axis];
        ((offset * self.per_length[axis]) as usize).min(self.count - 1)
    }

    fn fill(&self, items: &[Item]) -> [[Bin; MOST_BINS]; 3] {
        let mut bins = [[Bin::EMPTY; MOST_BINS]; 3];
        for item in items {
            for (axis, bins) in bins.iter_mut().enumerate() {
                let bin = &mut bins[self.bin(item, axis)];
                bin.bounds = bin.bounds.union(item.bounds);
                bin.count += 1;
            }
        }
        bins
    }
}

fn best_along(axis: usize, binning: Binning, bins: &[Bin; MOST_BINS]) -> Option<Cut> {
    let mut right = [Bin::EMPTY; MOST_BINS];
    let mut all = Bin::EMPTY;
    for bin in (1..binning.count).rev() {
        all = all.union(bins[bin]);
        right[bin] = all;
    }
    let mut left = Bin::EMPTY;
    let mut best: Option<Cut> = None;
    for bin in 1..binning.count {
        left = left.union(bins[bin - 1]);
        let cost = left.cost() + right[bin].cost();
        let is_proper = left.count > 0 && right[bin].count > 0;
        if is_proper && best.is_none_or(|best| cost < best.cost) {
            best = Some(Cut { binning, axis, bin, cost });
        }
    }
    best
}

/// Blocks that `count` triangles fill.
fn blocks(count: usize) -> f32 {
    count.div_ceil(LANES) as f32
}

#[cfg(test)]
mod tests {
    use super::super::build::{Content, Plan};
    use super::*;
    use crate::contract::Split;
    use glam::dvec3;

    fn cluster(start: u32, count: u32, x: f64) -> impl Iterator<Item = Item> {
        (0..count).map(move |index| {
            let at = dvec3(x, f64::from(index) * 0.01, 0.0);
            Item {
                bounds: Bounds::around([at, at + 0.01]),
                number: start + index,
                is_sphere: false,
            }
        })
    }

    #[test]
    fn two_clusters_of_unequal_size_are_parted_between_them() {
        let mut items: Vec<Item> = cluster(0, 90, 0.0).chain(cluster(90, 10, 50.0)).collect();
        let nodes = Plan { split: Split::SurfaceArea, max_leaf_size: 4 }.build(&mut items);
        assert_eq!(nodes[0].content, Content::Inner { second: 2 * 90 });
    }

    #[test]
    fn a_heap_in_one_place_is_left_together_if_leaves_may_be_large() {
        let bounds = Bounds::around([dvec3(0.0, 0.0, 0.0), dvec3(1.0, 1.0, 1.0)]);
        let mut items: Vec<Item> =
            (0..16).map(|number| Item { bounds, number, is_sphere: false }).collect();
        let nodes = Plan { split: Split::SurfaceArea, max_leaf_size: 16 }.build(&mut items);
        assert_eq!(nodes[0].content, Content::Leaf { first: 0, count: 16 });
    }
}
