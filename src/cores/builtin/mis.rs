//! Multiple importance sampling (MIS): the weights of two techniques that can sample the same light.

use super::reach::Reach;
use glam::DVec3;

/// The power heuristic: the weight of a sample of pdf `own` where another technique has pdf `other` (Veach and
/// Guibas 1995, β = 2). Both may be infinite or zero, not both.
pub(crate) fn power_heuristic(own: f64, other: f64) -> f64 {
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// Where a BSDF sample came from, for the weight of the emission that it hits.
#[derive(Clone, Copy)]
pub(crate) struct GlossyDirection {
    pub(crate) from: DVec3,
    /// Where that takes light from.
    pub(crate) reach: Reach,
    pub(crate) pdf: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_both_techniques_add_up_to_one() {
        for (own, other) in [(1.0, 1.0), (3.0, 0.2), (1e30, 1e-30), (2.0, 0.0)] {
            assert_eq!(power_heuristic(own, other) + power_heuristic(other, own), 1.0);
        }
    }
}
