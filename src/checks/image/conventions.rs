//! What a core has declared and the references have otherwise: an image in which that matters has no expected value.

use crate::checks::Finding;
use crate::contract::Conventions;
use crate::scene::{Light, SceneDescription, Surface};
use crate::stats::ImageReport;

/// The declared conventions that change images of the scene, in words; the references have the default ones.
pub(super) fn that_matter(declared: Conventions, scene: &SceneDescription) -> Vec<&'static str> {
    let has =
        |is: fn(&Surface) -> bool| scene.materials.iter().any(|material| is(&material.surface));
    let is_lit_from_a_point = scene.lights.iter().any(|light| matches!(light, Light::Point { .. }));
    let emits = scene.materials.iter().any(|material| material.emission.is_some());
    let has_smooth_glass = has(|surface| matches!(surface, Surface::Glass { .. }));
    let has_rough_glass = has(|surface| matches!(surface, Surface::RoughGlass { .. }));
    let has_rough_metal = has(|surface| matches!(surface, Surface::Conductor { .. }));
    // Without `..`: a convention more is one more to look for.
    let Conventions { point_light_falloff, emission, smith_term, glass_fresnel, glass_radiance } =
        declared;
    let usual = Conventions::default();
    [
        (
            point_light_falloff != usual.point_light_falloff && is_lit_from_a_point,
            "point lights without falloff",
        ),
        (emission != usual.emission && emits, "emission from both sides"),
        (
            smith_term != usual.smith_term && (has_rough_metal || has_rough_glass),
            "height-correlated masking",
        ),
        (glass_fresnel != usual.glass_fresnel && has_smooth_glass, "Schlick's approximation"),
        (
            glass_radiance != usual.glass_radiance && (has_smooth_glass || has_rough_glass),
            "radiance that glass leaves unscaled",
        ),
    ]
    .into_iter()
    .filter_map(|(matters, words)| matters.then_some(words))
    .collect()
}

/// The finding of an image in which the `differing` conventions matter: what differs from the reference is open there, and
/// only what no image may have fails.
pub(super) fn regarded(
    finding: Finding,
    report: &ImageReport,
    differing: &[&'static str],
) -> Finding {
    let is_broken = report.impossible.is_some() || !report.dead_pixels.is_empty();
    if differing.is_empty() || is_broken || !finding.failed() {
        return finding;
    }
    let mut finding = finding;
    let measures = finding.measures.iter_mut().map(|measure| &mut measure.verdict);
    measures.chain([&mut finding.verdict]).for_each(|verdict| *verdict = verdict.unexpected());
    finding.statement = format!(
        "the core declares {}, the reference was rendered otherwise: {}",
        differing.join(" and "),
        finding.statement
    );
    finding
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::image::told::finding;
    use crate::contract::{Falloff, SmithTerm};
    use crate::image::Image;
    use crate::stats::{ImageEffort, Reference, Verdict, judge_image};
    use glam::DVec3;
    use std::convert::Infallible;

    #[test]
    fn a_declared_convention_matters_where_the_scene_has_what_it_is_about() {
        let light = Light::Point { position: DVec3::ZERO, intensity: [1.0; 3] };
        let lit = SceneDescription { lights: vec![light], ..SceneDescription::default() };
        let usual = Conventions::default();
        let unweakened = Conventions { point_light_falloff: Falloff::None, ..usual };
        let masked = Conventions { smith_term: SmithTerm::HeightCorrelated, ..usual };
        assert_eq!(that_matter(unweakened, &lit), ["point lights without falloff"]);
        assert!(that_matter(unweakened, &SceneDescription::default()).is_empty());
        assert!(that_matter(usual, &lit).is_empty() && that_matter(masked, &lit).is_empty());
    }

    #[test]
    fn what_no_image_may_have_fails_whatever_is_declared() {
        let [mean, standard_error] = [1.0, 0.0].map(|light| Image::new(16, 16, [light; 3]));
        let verdict = |light: f32| {
            let right = Reference { mean: &mean, standard_error: &standard_error };
            let draw = &mut |_| Ok::<_, Infallible>(Image::new(16, 16, [light; 3]));
            let report = judge_image(right, &ImageEffort::new(0.02, 1), draw).unwrap();
            regarded(finding(&report, None), &report, &["Schlick's approximation"]).verdict
        };
        assert_eq!(verdict(1.0), Verdict::Pass);
        assert_eq!(verdict(1.2), Verdict::Inconclusive);
        assert_eq!(verdict(-1.0), Verdict::Fail);
        assert_eq!(verdict(f32::NAN), Verdict::Fail);
    }
}
