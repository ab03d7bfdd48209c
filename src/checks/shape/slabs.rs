//! The slab test of the textbook, and the ways in which people write it wrongly.

use crate::cause::{Cause, slab};
use crate::contract::Ray;
#[cfg(test)]
use crate::contract::{BoxHit, Core, CoreInfo, Precision, Result};
use crate::scene::Aabb;
use glam::DVec3;

/// The parameters at which a line crosses the planes of a box, as the textbook divides them.
pub struct Slabs {
    lower: DVec3,
    upper: DVec3,
}

impl Slabs {
    /// Those of a ray.
    pub fn new(bounds: &Aabb, ray: &Ray) -> Self {
        Self {
            lower: (bounds.min - ray.origin) / ray.direction,
            upper: (bounds.max - ray.origin) / ray.direction,
        }
    }

    /// Where the line enters the box.
    pub fn enters(&self) -> f64 {
        self.lower.min(self.upper).max_element()
    }

    /// Where it leaves.
    pub fn exits(&self) -> f64 {
        self.lower.max(self.upper).min_element()
    }

    /// The right test, where no 0/0 occurs.
    pub fn hits(&self, ray: &Ray) -> bool {
        self.enters() <= self.exits() && self.exits() >= ray.t_min && self.enters() <= ray.t_max
    }
}

/// An implementation that people write instead.
pub struct Mistake {
    /// In the glossary.
    pub cause: &'static Cause,
    /// Whether it hits.
    pub hits: fn(&Slabs, &Ray) -> bool,
}

/// The rows and the random rays tell each from the rest.
pub const MISTAKES: &[Mistake] = &[
    Mistake {
        cause: &slab::PLANES_NOT_SWAPPED,
        hits: |slabs, ray| {
            let (enters, exits) = (slabs.lower.max_element(), slabs.upper.min_element());
            enters <= exits && exits >= ray.t_min && enters <= ray.t_max
        },
    },
    Mistake { cause: &slab::BOX_SEGMENT_IGNORED, hits: |slabs, _| slabs.enters() <= slabs.exits() },
    Mistake {
        cause: &slab::BOX_START_IGNORED,
        hits: |slabs, ray| slabs.enters() <= slabs.exits() && slabs.enters() <= ray.t_max,
    },
    Mistake {
        cause: &slab::BOX_END_IGNORED,
        hits: |slabs, ray| slabs.enters() <= slabs.exits() && slabs.exits() >= ray.t_min,
    },
    Mistake {
        cause: &slab::BOX_MISSED_FROM_INSIDE,
        hits: |slabs, ray| slabs.hits(ray) && slabs.enters() >= ray.t_min,
    },
    Mistake {
        cause: &slab::BOX_MISSED_BY_END_INSIDE,
        hits: |slabs, ray| slabs.hits(ray) && slabs.exits() <= ray.t_max,
    },
    Mistake {
        cause: &slab::FLAT_BOX_MISSED,
        hits: |slabs, ray| slabs.hits(ray) && slabs.enters() < slabs.exits(),
    },
    Mistake { cause: &slab::BOX_WITHOUT_Z, hits: |slabs, ray| without_axis(slabs, 2).hits(ray) },
    Mistake { cause: &slab::BOX_WITHOUT_Y, hits: |slabs, ray| without_axis(slabs, 1).hits(ray) },
    Mistake { cause: &slab::BOX_WITHOUT_X, hits: |slabs, ray| without_axis(slabs, 0).hits(ray) },
];

/// An axis in which the box has no end.
fn without_axis(slabs: &Slabs, axis: usize) -> Slabs {
    let (mut lower, mut upper) = (slabs.lower, slabs.upper);
    (lower[axis], upper[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
    Slabs { lower, upper }
}

/// The mistake that hits the boxes which a core hits, and no others.
pub fn mistake_that_predicts(answers: &[(Aabb, Ray, bool)]) -> Option<&'static Cause> {
    let predicts = |mistake: &&Mistake| {
        answers
            .iter()
            .all(|(bounds, ray, hit)| (mistake.hits)(&Slabs::new(bounds, ray), ray) == *hit)
    };
    MISTAKES.iter().find(predicts).map(|mistake| mistake.cause)
}

/// A core that hits boxes by a rule of its own, for tests.
#[cfg(test)]
pub struct Boxes(pub fn(&Slabs, &Ray) -> bool);

#[cfg(test)]
impl Core for Boxes {
    fn info(&self) -> CoreInfo {
        crate::checks::testing::info(Precision::Double)
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        for (ray, hit) in rays.iter().zip(hits) {
            let slabs = Slabs::new(bounds, ray);
            let (t_enter, t_exit) = (slabs.enters(), slabs.exits());
            *hit = BoxHit { t_enter, t_exit, hit: (self.0)(&slabs, ray).into(), reserved: 0 };
        }
        Ok(())
    }
}
