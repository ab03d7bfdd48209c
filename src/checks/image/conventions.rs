//! What a core has declared and the references have otherwise: an image in which that matters has no expected value.

use crate::checks::Finding;
use crate::contract::Conventions;
use crate::scene::{Light, SceneDescription, Surface};
use crate::stats::Verdict;

/// The declared conventions that change images of the scene, in words; the references have the default ones.
fn that_matter(declared: Conventions, scene: &SceneDescription) -> Vec<&'static str> {
    let has =
        |is: fn(&Surface) -> bool| scene.materials.iter().any(|material| is(&material.surface));
    let has_glass = has(|surface| matches!(surface, Surface::Glass { .. }));
    let has_rough_glass = has(|surface| matches!(surface, Surface::RoughGlass { .. }));
    let has_metal = has(|surface| matches!(surface, Surface::Conductor { .. }));
    let usual = Conventions::default();
    let rows = [
        (
            declared.point_light_falloff != usual.point_light_falloff
                && scene.lights.iter().any(|light| matches!(light, Light::Point { .. })),
            "another falloff of point lights",
        ),
        (
            declared.emission != usual.emission
                && scene.materials.iter().any(|material| material.emission.is_some()),
            "emission from both sides",
        ),
        (
            declared.smith_term != usual.smith_term && (has_metal || has_rough_glass),
            "another masking term",
        ),
        (declared.glass_fresnel != usual.glass_fresnel && has_glass, "another Fresnel reflectance"),
        (
            declared.glass_radiance != usual.glass_radiance && (has_glass || has_rough_glass),
            "radiance that glass does not scale",
        ),
    ];
    rows.into_iter().filter_map(|(matters, words)| matters.then_some(words)).collect()
}

/// A failure of an image in which a declared convention matters is open: nobody knows what it should be.
pub(super) fn regarded(
    finding: Finding,
    declared: Conventions,
    scene: &SceneDescription,
) -> Finding {
    let differing = that_matter(declared, scene);
    if differing.is_empty() || !finding.failed() {
        return finding;
    }
    let open = |verdict| if verdict == Verdict::Fail { Verdict::Inconclusive } else { verdict };
    let mut finding = finding;
    finding.measures.iter_mut().for_each(|measure| measure.verdict = open(measure.verdict));
    finding.clues.clear();
    finding.verdict = open(finding.verdict);
    let words = differing.join(" and ");
    let statement = &finding.statement;
    finding.statement =
        format!("not judged: the core declares {words}, the reference has the usual; {statement}");
    finding
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::Falloff;
    use glam::DVec3;

    fn scene(lights: Vec<Light>) -> SceneDescription {
        SceneDescription { lights, ..SceneDescription::default() }
    }

    #[test]
    fn a_failure_is_open_only_where_a_declared_convention_matters() {
        let intensity = [1.0; 3];
        let lit = scene(vec![Light::Point { position: DVec3::ZERO, intensity }]);
        let declared = Conventions { point_light_falloff: Falloff::None, ..Conventions::default() };
        let verdict =
            |declared, scene| regarded(Finding::failure("too bright"), declared, scene).verdict;
        assert_eq!(verdict(declared, &lit), Verdict::Inconclusive);
        assert_eq!(verdict(Conventions::default(), &lit), Verdict::Fail);
        assert_eq!(verdict(declared, &scene(Vec::new())), Verdict::Fail);
    }
}
