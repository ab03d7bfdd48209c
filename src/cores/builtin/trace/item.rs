//! What a BVH is built over.

use super::bounds::Bounds;
use glam::Vec3A;

/// What is sorted into the BVH.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Around the primitive.
    pub bounds: Bounds,
    /// Its number in the scene.
    pub number: u32,
    /// Triangles and spheres do not share leaves.
    pub is_ball: bool,
}

impl Item {
    /// Where the item counts as being.
    #[inline]
    pub fn centroid(&self) -> Vec3A {
        self.bounds.centre()
    }
}

/// What is to be known of a list of items before it is divided.
pub struct Summary {
    /// Around the items.
    pub bounds: Bounds,
    /// Around their centroids.
    pub centroids: Bounds,
    /// How many of them are spheres.
    pub balls: usize,
    count: usize,
}

impl Summary {
    pub fn of(items: &[Item]) -> Self {
        let empty = Self { bounds: Bounds::EMPTY, centroids: Bounds::EMPTY, balls: 0, count: 0 };
        items.iter().fold(empty, |summary, item| Self {
            bounds: summary.bounds.union(item.bounds),
            centroids: summary.centroids.with(item.centroid()),
            balls: summary.balls + usize::from(item.is_ball),
            count: summary.count + 1,
        })
    }

    /// Whether there are triangles and spheres.
    pub fn is_mixed(&self) -> bool {
        self.balls != 0 && self.balls != self.count
    }
}
