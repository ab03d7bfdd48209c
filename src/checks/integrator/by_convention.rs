//! Numbers that hang on what a core has freely chosen.

use crate::contract::{
    Conventions, EmissionSides, Falloff, GlassFresnel, GlassRadiance, SmithTerm,
};
use crate::text::Colour;
use serde::Deserialize;

/// `{ glass-radiance = "unscaled", radiance = 0.96 }`: what is right for a core that declares all of this.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ConventionEntry {
    point_light_falloff: Option<Falloff>,
    emission: Option<EmissionSides>,
    smith_term: Option<SmithTerm>,
    glass_fresnel: Option<GlassFresnel>,
    glass_radiance: Option<GlassRadiance>,
    /// Instead of that of the row.
    pub(crate) radiance: Colour,
}

impl ConventionEntry {
    /// Whether a core declares all that is named here.
    pub(crate) fn is_declared_by(&self, declared: &Conventions) -> bool {
        self.over(*declared) == *declared
    }

    /// These choices, and those of `others` where none is named.
    pub(crate) fn over(&self, others: Conventions) -> Conventions {
        Conventions {
            point_light_falloff: self.point_light_falloff.unwrap_or(others.point_light_falloff),
            emission: self.emission.unwrap_or(others.emission),
            smith_term: self.smith_term.unwrap_or(others.smith_term),
            glass_fresnel: self.glass_fresnel.unwrap_or(others.glass_fresnel),
            glass_radiance: self.glass_radiance.unwrap_or(others.glass_radiance),
        }
    }

    /// What is wrong with it.
    pub(crate) fn validate(&self) -> Result<(), String> {
        match self.is_declared_by(&Conventions::default()) {
            true => {
                Err("`by-convention` names no choice that differs from the usual one".to_owned())
            }
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(text: &str) -> ConventionEntry {
        crate::text::read_toml(text).unwrap()
    }

    #[test]
    fn it_holds_for_cores_that_declare_all_of_it() {
        let both =
            entry("glass-fresnel = \"schlick\"\nglass-radiance = \"unscaled\"\nradiance = 1");
        let half = Conventions { glass_fresnel: GlassFresnel::Schlick, ..Conventions::default() };
        assert!(!both.is_declared_by(&half));
        assert!(
            both.is_declared_by(&Conventions { glass_radiance: GlassRadiance::Unscaled, ..half })
        );
        assert!(both.validate().is_ok());
    }

    #[test]
    fn what_is_usual_is_no_exception() {
        assert!(entry("emission = \"front\"\nradiance = 1").validate().is_err());
        assert!(entry("radiance = 1").validate().is_err());
    }
}
