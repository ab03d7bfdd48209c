//! Part 2: how a node of the BVH is divided in two.
//!
//! Every rule reorders the items of a node and answers how many of them go left. A rule may fail to separate anything
//! (all centroids in one place): then it answers 0 or all of them, and the builder halves the node instead.

use super::steps::Steps;
use crate::contract::Split;
use crate::scene::Aabb;
use glam::DVec3;
use std::ops::Range;

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// Its number in the scene.
    pub(crate) primitive: usize,
    pub(crate) bounds: Aabb,
    /// The middle of that box.
    pub(crate) centroid: DVec3,
}

/// Bins of the surface area heuristic.
const BINS: usize = 16;

/// Reorders `items` by the rule that was `asked` for, and answers how many of them go left.
pub(crate) fn partition(asked: Split, items: &mut [Item], steps: &Steps) -> usize {
    match steps.rule(asked) {
        Split::Median => halve(items, steps),
        Split::MeanOfCentroids => {
            let mean = items.iter().map(|item| item.centroid).sum::<DVec3>() / items.len() as f64;
            let axis = steps.longest_axis(extent(&centroid_bounds(items)));
            partition_by(items, |item| item.centroid[axis] < mean[axis])
        }
        Split::Midpoint => {
            let bounds = centroid_bounds(items);
            let axis = steps.longest_axis(extent(&bounds));
            let middle = (bounds.min[axis] + bounds.max[axis]) / 2.0;
            partition_by(items, |item| item.centroid[axis] < middle)
        }
        Split::SurfaceArea | Split::CoresChoice => partition_by_surface_area(items, steps),
    }
}

/// The rule that divides nodes is the one that was asked for.
pub(crate) fn rule(asked: Split) -> Split {
    asked
}

/// Equal counts along the longest axis: always separates.
pub(crate) fn halve(items: &mut [Item], steps: &Steps) -> usize {
    let axis = steps.longest_axis(extent(&centroid_bounds(items)));
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centroid[axis].total_cmp(&b.centroid[axis]));
    middle
}

pub(crate) fn longest_axis(extent: DVec3) -> usize {
    extent.max_position()
}

pub(crate) fn union(boxes: impl Iterator<Item = Aabb>) -> Aabb {
    boxes.fold(EMPTY, |all, one| Aabb { min: all.min.min(one.min), max: all.max.max(one.max) })
}

/// The box that adds nothing to a union.
const EMPTY: Aabb = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

pub(crate) fn centroid_bounds(items: &[Item]) -> Aabb {
    union(items.iter().map(|item| Aabb { min: item.centroid, max: item.centroid }))
}

fn extent(bounds: &Aabb) -> DVec3 {
    bounds.max - bounds.min
}

/// Moves the items for which `goes_left` to the front, and counts them.
fn partition_by(items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
    let mut left = 0;
    for index in 0..items.len() {
        if goes_left(&items[index]) {
            items.swap(left, index);
            left += 1;
        }
    }
    left
}

/// The division whose children cost a random ray least: sum of count times surface area (MacDonald
/// and Booth 1990), with planes between equal bins of each axis (Wald 2007).
fn partition_by_surface_area(items: &mut [Item], steps: &Steps) -> usize {
    let bounds = centroid_bounds(items);
    let axes = steps.compared_axes(extent(&bounds));
    let planes = axes.flat_map(|axis| axis_planes(items, &bounds, axis));
    let best = planes.min_by(|a, b| a.cost.total_cmp(&b.cost));
    best.map_or(0, |plane| {
        partition_by(items, |item| bin(item, &bounds, plane.axis) < plane.first_right_bin)
    })
}

/// The axes across which the surface area heuristic looks for a plane: all of them.
pub(crate) fn compared_axes(_extent: DVec3) -> Range<usize> {
    0..3
}

/// A plane between two bins.
struct Plane {
    axis: usize,
    first_right_bin: usize,
    cost: f64,
}

/// The planes of one axis with something on both sides.
fn axis_planes(items: &[Item], bounds: &Aabb, axis: usize) -> Vec<Plane> {
    let mut bins = [(0_u32, EMPTY); BINS];
    for item in items {
        let (count, around) = &mut bins[bin(item, bounds, axis)];
        *count += 1;
        *around = union([*around, item.bounds].into_iter());
    }
    (1..BINS)
        .map(|first_right_bin| (first_right_bin, bins.split_at(first_right_bin)))
        .filter(|(_, (left, right))| has_items(left) && has_items(right))
        .map(|(first_right_bin, (left, right))| Plane {
            axis,
            first_right_bin,
            cost: child_cost(left) + child_cost(right),
        })
        .collect()
}

/// The bin of `item` among equal ones along `axis` of the box of centroids.
fn bin(item: &Item, bounds: &Aabb, axis: usize) -> usize {
    let extent = bounds.max[axis] - bounds.min[axis];
    let share = (item.centroid[axis] - bounds.min[axis]) / extent;
    // Without extent the share is not a number, and the cast makes it the first bin.
    ((share * BINS as f64) as usize).min(BINS - 1)
}

fn has_items(bins: &[(u32, Aabb)]) -> bool {
    bins.iter().any(|(count, _)| *count > 0)
}

fn child_cost(bins: &[(u32, Aabb)]) -> f64 {
    let count: u32 = bins.iter().map(|(count, _)| count).sum();
    let extent = extent(&union(bins.iter().map(|(_, bounds)| *bounds)));
    f64::from(count) * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    const RULES: [Split; 4] =
        [Split::Median, Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea];

    fn items_at(places: &[f64]) -> Vec<Item> {
        let item = |(primitive, x): (usize, &f64)| {
            let centroid = DVec3::new(1.0, *x, 2.0);
            let bounds = Aabb { min: centroid - 0.1, max: centroid + 0.1 };
            Item { primitive, bounds, centroid }
        };
        places.iter().enumerate().map(item).collect()
    }

    #[test]
    fn each_rule_divides_where_its_name_says() {
        let places = [9.0, 0.0, 1.0, 2.0, 3.0, 10.0, 10.1, 10.2];
        let left = RULES.map(|rule| partition(rule, &mut items_at(&places), &LESSON));
        // Mean 5.66 and middle 5.1 both separate the four that lie low; so does the emptiest gap.
        assert_eq!(left, [4, 4, 4, 4]);
        let skewed = [0.0, 1.0, 2.0, 3.0, 4.0, 100.0];
        let left = RULES.map(|rule| partition(rule, &mut items_at(&skewed), &LESSON));
        assert_eq!(left, [3, 5, 5, 5]);
        let mean_is_not_middle = [0.0, 1.0, 4.0, 9.0];
        let left = RULES.map(|rule| partition(rule, &mut items_at(&mean_is_not_middle), &LESSON));
        assert_eq!(left[1..3], [2, 3]);
    }

    #[test]
    fn what_goes_left_lies_left() {
        for rule in RULES {
            let mut items = items_at(&[5.0, 3.0, 8.0, 1.0, 9.0, 2.0, 7.0]);
            let left = partition(rule, &mut items, &LESSON);
            let (low, high) = items.split_at(left);
            let largest = low.iter().map(|item| item.centroid.y).fold(f64::MIN, f64::max);
            assert!(high.iter().all(|item| item.centroid.y >= largest), "{rule:?}");
        }
    }

    #[test]
    fn centroids_in_one_place_are_not_separated_but_halved() {
        for rule in [Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea] {
            let left = partition(rule, &mut items_at(&[4.0; 10]), &LESSON);
            assert!(left == 0 || left == 10, "{rule:?}: {left}");
        }
        assert_eq!(halve(&mut items_at(&[4.0; 10]), &LESSON), 5);
    }
}
