//! What a BVH is built over.

use super::bounds::Bounds;
use glam::Vec3A;

/// What is sorted into the BVH.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// Around the primitive.
    pub(crate) bounds: Bounds,
    /// Its number in the scene.
    pub(crate) number: u32,
    /// Triangles and spheres do not share leaves.
    pub(crate) is_sphere: bool,
}

impl Item {
    /// Where the item counts as being.
    #[inline]
    pub(crate) fn centroid(&self) -> Vec3A {
        self.bounds.centre()
    }
}

/// What is to be known of a list of items before it is divided.
pub(crate) struct Summary {
    /// Around the items.
    pub(crate) bounds: Bounds,
    /// Around their centroids.
    pub(crate) centroids: Bounds,
    /// How many of them are spheres.
    pub(crate) spheres: usize,
    count: usize,
}

impl Summary {
    pub(crate) fn of(items: &[Item]) -> Self {
        let empty = Self { bounds: Bounds::EMPTY, centroids: Bounds::EMPTY, spheres: 0, count: 0 };
        items.iter().fold(empty, |summary, item| Self {
            bounds: summary.bounds.union(item.bounds),
            centroids: summary.centroids.with(item.centroid()),
            spheres: summary.spheres + usize::from(item.is_sphere),
            count: summary.count + 1,
        })
    }

    pub(crate) fn is_mixed(&self) -> bool {
        self.spheres != 0 && self.spheres != self.count
    }
}
