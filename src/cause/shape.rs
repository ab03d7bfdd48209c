//! Part 1: triangles, spheres, and part 2: boxes.

use super::Cause;

/// See its headline.
pub static SEGMENT_END_IGNORED: Cause = Cause {
    name: "segment-end-ignored",
    headline: "the end of the segment (t_max) is not looked at",
    look_at: "the intersection test, where t is compared",
    remedy: "A hit counts only while t_min < t < t_max.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&SEGMENT_END_IGNORED];
