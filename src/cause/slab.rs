//! Part 2: boxes.

use super::Cause;

/// See its headline.
pub static PLANES_NOT_SWAPPED: Cause = Cause {
    name: "planes-not-swapped",
    headline: "the two planes of an axis are not swapped where the direction is negative",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "The smaller of an axis' two crossings is the entry, the larger the exit.",
};

/// See its headline.
pub static PARALLEL_AXES_SKIPPED: Cause = Cause {
    name: "parallel-axes-skipped",
    headline: "an axis that the ray does not move along is skipped, wherever the ray is on it",
    look_at: "the box test, where a component of the direction is 0",
    remedy: "A ray that runs beside the two planes of an axis misses the box.",
};

/// See its headline.
pub static BOX_SEGMENT_IGNORED: Cause = Cause {
    name: "box-segment-ignored",
    headline: "the box test does not look at t_min and t_max",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.",
};

/// See its headline.
pub static BOX_START_IGNORED: Cause = Cause {
    name: "box-start-ignored",
    headline: "the box test does not look at t_min",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.",
};

/// See its headline.
pub static BOX_END_IGNORED: Cause = Cause {
    name: "box-end-ignored",
    headline: "the box test does not look at t_max",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.",
};

/// See its headline.
pub static BOX_MISSED_FROM_INSIDE: Cause = Cause {
    name: "box-missed-from-inside",
    headline: "the entry has to lie behind t_min, so that rays from inside miss",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.",
};

/// See its headline.
pub static BOX_MISSED_BY_END_INSIDE: Cause = Cause {
    name: "box-missed-by-end-inside",
    headline: "the exit has to lie before t_max, so that segments which end inside miss",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.",
};

/// See its headline.
pub static FLAT_BOX_MISSED: Cause = Cause {
    name: "flat-box-missed",
    headline: "entry < exit is asked for, so that flat boxes are never hit",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Compare with ≤: a flat box is entered and left at the same t.",
};

/// See its headline.
pub static BOX_WITHOUT_Z: Cause = Cause {
    name: "box-without-z",
    headline: "the box test does not look at the z axis",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Intersect the intervals of all three axes.",
};

/// See its headline.
pub static BOX_WITHOUT_Y: Cause = Cause {
    name: "box-without-y",
    headline: "the box test does not look at the y axis",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Intersect the intervals of all three axes.",
};

/// See its headline.
pub static BOX_WITHOUT_X: Cause = Cause {
    name: "box-without-x",
    headline: "the box test does not look at the x axis",
    look_at: "the box test, where the crossings of the slabs are put together",
    remedy: "Intersect the intervals of all three axes.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &PLANES_NOT_SWAPPED,
    &PARALLEL_AXES_SKIPPED,
    &BOX_SEGMENT_IGNORED,
    &BOX_START_IGNORED,
    &BOX_END_IGNORED,
    &BOX_MISSED_FROM_INSIDE,
    &BOX_MISSED_BY_END_INSIDE,
    &FLAT_BOX_MISSED,
    &BOX_WITHOUT_Z,
    &BOX_WITHOUT_Y,
    &BOX_WITHOUT_X,
];
