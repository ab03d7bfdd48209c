//! Multiple importance sampling: what two techniques that can find the same light count each.

use super::reach::Reach;
use glam::DVec3;

/// The share of a sample drawn with density `own` where another technique draws with density `other` (Veach and
/// Guibas 1995, β = 2). Both may be infinite or zero, not both.
pub fn power_heuristic(own: f64, other: f64) -> f64 {
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// Where a direction of a glossy surface came from, for the share that its find gets.
#[derive(Clone, Copy)]
pub struct GlossyDirection {
    /// The vertex that it left.
    pub from: DVec3,
    /// Where that takes light from.
    pub reach: Reach,
    /// The density of the direction.
    pub pdf: f64,
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
