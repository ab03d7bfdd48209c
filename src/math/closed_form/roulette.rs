//! Mean and variance of a path tracer with Russian roulette in a furnace.

/// A furnace whose paths stop by chance: emission is collected at every vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RouletteFurnace {
    /// Radiance emitted everywhere.
    pub(crate) emission: f64,
    pub(crate) albedo: f64,
    /// Survival probability at each bounce it is played at; what survives is divided by it.
    pub(crate) survival: f64,
    /// Bounces that are always traced.
    pub(crate) guaranteed: u32,
}

impl RouletteFurnace {
    /// The variance of one path; infinite from ρ² = q on.
    ///
    /// Beyond the guaranteed bounces a path adds c Σ_{j ≤ J} rʲ with r = ρ/q, c = Lₑ ρᵍ and P(J ≥
    /// j) = qʲ. Its second moment is c² Σᵢⱼ r^(i+j) q^max(i,j): a diagonal Σ dʲ with d = r²q, and
    /// twice Σ_j ρʲ Σ_{i<j} rⁱ.
    pub(crate) fn variance(&self) -> f64 {
        let (rho, q) = (self.albedo, self.survival);
        if rho * rho >= q {
            return f64::INFINITY;
        }
        let guaranteed = (0..self.guaranteed).fold(self.emission, |light, _| light * rho);
        let r = rho / q;
        let d = rho * r;
        // Σ_j ρʲ (r + … + r^(j−1)), summed over i first: rⁱ Σ_{j>i} ρʲ = (rρ)ⁱ ρ/(1 − ρ).
        let off_diagonal = 2.0 * d / (1.0 - d) * rho / (1.0 - rho);
        let second_moment = d / (1.0 - d) + off_diagonal;
        let mean = rho / (1.0 - rho);
        guaranteed * guaranteed * (second_moment - mean * mean)
    }
}

#[cfg(test)]
mod tests {
    use super::super::witness::assert_close;
    use super::*;

    /// By summing over the number of bounces that a path survives.
    fn by_summation(furnace: &RouletteFurnace) -> f64 {
        let mut throughput = furnace.emission;
        let mut light = throughput;
        for _ in 0..furnace.guaranteed {
            throughput *= furnace.albedo;
            light += throughput;
        }
        let (mut mean, mut square, mut alive) = (0.0, 0.0, 1.0);
        for _ in 0..500 {
            let ends_here = alive * (1.0 - furnace.survival);
            mean += ends_here * light;
            square += ends_here * light * light;
            alive *= furnace.survival;
            throughput *= furnace.albedo / furnace.survival;
            light += throughput;
        }
        square - mean * mean
    }

    #[test]
    fn the_variance_agrees_with_summing_over_path_lengths() {
        for (albedo, survival) in [(0.37, 0.65), (0.5, 0.7), (0.6, 0.6), (0.37, 0.3), (0.5, 0.9)] {
            for guaranteed in [0, 1, 2] {
                let furnace = RouletteFurnace { emission: 1.0, albedo, survival, guaranteed };
                assert_close(furnace.variance(), by_summation(&furnace), 1e-8);
            }
        }
    }
}
