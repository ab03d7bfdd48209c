//! What checks have in common that judge each distribution of their case for itself.

use super::distribution::{Distribution, DistributionEntry};
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::Capabilities;
use serde::de::DeserializeOwned;

/// A check of the directions that a sampler or a BSDF draws.
pub(crate) trait OfDistributions: DeserializeOwned + Send + Sync + 'static {
    /// As in [`Check`].
    const NAME: &'static str;
    /// As in [`Check`].
    const SUMMARY: &'static str;

    /// What came of one distribution.
    type Judged;

    /// The distributions of the case.
    fn distribution(&self) -> &DistributionEntry;

    /// What the core must be able to do besides.
    fn needs_besides(&self) -> Capabilities {
        Capabilities::empty()
    }

    /// Asks for one distribution.
    ///
    /// # Errors
    /// If the core does not answer.
    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Self::Judged, CheckError>;

    /// What there is to say of all of them.
    fn finding(judged: &[Self::Judged]) -> Finding;
}

impl<C: OfDistributions> Check for C {
    const NAME: &'static str = C::NAME;
    const SUMMARY: &'static str = C::SUMMARY;

    fn needs(&self) -> Capabilities {
        self.distribution().needs() | self.needs_besides()
    }

    fn validate(&self) -> Result<(), String> {
        self.distribution().validate()
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let all = self.distribution().distributions();
        let judged = all.iter().map(|distribution| self.judge(context, distribution));
        Ok(C::finding(&judged.collect::<Result<Vec<_>, _>>()?))
    }
}
