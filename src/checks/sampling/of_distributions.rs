//! What checks have in common that judge each distribution of their case for itself.

use super::distribution::{Distribution, DistributionEntry};
use crate::checks::{Check, Context, Declared, Finding, Result};
use crate::contract::Capabilities;

/// A check of the directions that a sampler or a BSDF draws.
pub(crate) trait OfDistributions: Declared {
    /// What came of one distribution.
    type Judged;

    /// The distributions of the case.
    fn distribution(&self) -> &DistributionEntry;

    /// Asks for one distribution.
    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution)
    -> Result<Self::Judged>;

    /// What there is to say of all of them.
    fn finding(judged: &[Self::Judged]) -> Finding;
}

impl<C: OfDistributions> Check for C {
    fn needs_besides(&self) -> Capabilities {
        self.distribution().needs()
    }

    fn validate(&self) -> Result<(), String> {
        self.distribution().validate()
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let all = self.distribution().distributions();
        let judged = all.iter().map(|distribution| self.judge(context, distribution));
        Ok(C::finding(&judged.collect::<Result<Vec<_>, _>>()?))
    }
}
