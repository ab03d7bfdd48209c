//! What a case is to the rules of the diagnosis: a rule asks for the furnace, and never for a file.

use serde::{Deserialize, Serialize};

/// What the rules of the diagnosis ask a case for. One case has each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// A closed diffuse sphere that emits: bounce k is emission · albedo^k.
    Furnace,
    /// The same by hemisphere sampling.
    FurnaceByHemisphere,
    /// The same at several settings of Russian roulette.
    FurnaceUnderRoulette,
    /// Emission seen after three specular bounces.
    Mirrors,
    /// A cavity with an emissive cap: it sees where bounces go, which a furnace cannot.
    Cavity,
    /// A wall that does not face +z.
    SidewaysWall,
    /// Emission inside glass of index 1.5.
    LightInsideGlass,
    /// Direct light of a point light on a diffuse plane.
    PointLight,
    /// An area light seen directly, from both sides.
    VisibleLight,
    /// Direct light in general position, by light sampling with 7 samples.
    TiltedLight,
    /// Another general position, by light sampling with 5 samples.
    SlantedLight,
    /// The light of `tilted-light` by hemisphere sampling.
    TiltedLightByHemisphere,
    /// The light of `slanted-light` by hemisphere sampling.
    SlantedLightByHemisphere,
    /// Direct light that nothing occludes, by light sampling.
    OpenLight,
    /// The same by hemisphere sampling.
    OpenLightByHemisphere,
    /// An area light behind an occluder that hides a part of it.
    OccludedInPart,
    /// An area light behind an occluder that hides all of it.
    OccludedInFull,
    /// The variance of one light sample under `open-light`.
    LightSamplingVariance,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::load_all;
    use std::path::Path;

    /// Serde names all of them when it is given none.
    fn every_role() -> Vec<Role> {
        let role = |word: &str| toml::Value::from(word).try_into::<Role>();
        let message = role("none").unwrap_err().to_string();
        message.split('`').skip(3).step_by(2).map(|word| role(word).unwrap()).collect()
    }

    #[test]
    fn one_case_has_each_role() {
        let cases = load_all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")).unwrap();
        assert!(every_role().len() > 15);
        for role in every_role() {
            let holders = cases.iter().filter(|case| case.role == Some(role)).count();
            assert_eq!(holders, 1, "{role:?}");
        }
    }

    #[test]
    fn every_role_is_asked_for_by_a_rule_and_no_rule_names_a_case() {
        let rules = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/diagnosis");
        let files = walkdir::WalkDir::new(rules).into_iter().map(|file| file.unwrap().into_path());
        let texts: Vec<_> = files.filter_map(|path| std::fs::read_to_string(path).ok()).collect();
        let rules: Vec<_> =
            texts.iter().filter_map(|text| text.split("#[cfg(test)]").next()).collect();
        for role in every_role() {
            let name = format!("Role::{role:?}");
            assert!(rules.iter().any(|text| text.contains(&name)), "{name}");
        }
        for case in load_all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")).unwrap() {
            assert!(!rules.iter().any(|text| text.contains(&case.id)), "{}", case.id);
        }
    }
}
