//! Parts 3 and 4: how surfaces scatter. Directions are local and both point away from the surface.
//!
//! Diffuse, mirror and conductor surfaces are two-sided: seen from below, both directions are turned over first. Glass
//! is not: which side is outside matters there. Not here: the formulas of `glass`, of `ggx` and of `rough_glass`.

use super::glass::Glass;
use super::rough_glass::RoughGlass;
use super::steps::Steps;
use super::{ggx, sampling};
use crate::contract::{BsdfSample, BsdfValue, Sampler};
use crate::scene::{Rgb, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// A pair of directions between which nothing is scattered.
pub(crate) const NOTHING: BsdfValue = BsdfValue { f: [0.0; 3], pdf: 0.0 };

/// Whether the surface scatters each direction into finitely many: nothing else can be evaluated,
/// and no light be sampled, there.
pub(crate) fn is_delta(surface: &Surface) -> bool {
    matches!(surface, Surface::Mirror { .. } | Surface::Glass { .. })
}

/// Whether light passes: it has an inside, and light from both sides is scattered towards `wo`.
pub(crate) fn is_interface(surface: &Surface) -> bool {
    matches!(surface, Surface::Glass { .. } | Surface::RoughGlass { .. })
}

/// `f` and the pdf of [`sample`]. Zero for mirror and smooth glass, and for directions on
/// different sides of what light does not pass.
pub(crate) fn evaluate(surface: &Surface, wo: DVec3, wi: DVec3, steps: &Steps) -> BsdfValue {
    if let Some(glass) = rough_glass(surface) {
        return glass.evaluate(wo, wi, steps);
    }
    if wo.z < 0.0 {
        evaluate_from_above(surface, -wo, -wi, steps)
    } else {
        evaluate_from_above(surface, wo, wi, steps)
    }
}

fn rough_glass(surface: &Surface) -> Option<RoughGlass> {
    let Surface::RoughGlass { index, roughness, reflectance, transmittance } = *surface else {
        return None;
    };
    Some(RoughGlass { index, roughness, reflectance, transmittance })
}

fn evaluate_from_above(surface: &Surface, wo: DVec3, wi: DVec3, steps: &Steps) -> BsdfValue {
    if wo.z <= 0.0 {
        return NOTHING;
    }
    match *surface {
        Surface::Diffuse { reflectance } if steps.scatters_light_from(wi) => BsdfValue {
            f: steps.diffuse(reflectance, wi),
            pdf: sampling::pdf(steps.diffuse_pdf_sampler(), wi, steps),
        },
        Surface::Conductor { reflectance, roughness } if wi.z > 0.0 => {
            ggx::evaluate(reflectance, roughness, wo, wi, steps)
        }
        _ => NOTHING,
    }
}

/// Seen from above, a diffuse surface scatters light from above.
pub(crate) fn scatters_light_from(wi: DVec3) -> bool {
    wi.z > 0.0
}

/// Lambert's law: f = reflectance/π.
pub(crate) fn diffuse(reflectance: Rgb, _wi: DVec3) -> Rgb {
    reflectance.map(|reflectance| reflectance * FRAC_1_PI)
}

/// How the directions of a diffuse surface are drawn: in proportion to f cos θ.
pub(crate) fn diffuse_sampler() -> Sampler {
    Sampler::CosineHemisphere
}

/// The sampler whose pdf those directions have.
pub(crate) fn diffuse_pdf_sampler() -> Sampler {
    Sampler::CosineHemisphere
}

/// One incident direction for `wo`; `point` chooses the direction, `lobe` between reflection and refraction.
pub(crate) fn sample(
    surface: &Surface,
    wo: DVec3,
    point: DVec2,
    lobe: f64,
    steps: &Steps,
) -> Option<BsdfSample> {
    if let Surface::Glass { index, reflectance, transmittance } = *surface {
        return Glass { index, reflectance, transmittance }.sample(wo, lobe, steps);
    }
    if let Some(glass) = rough_glass(surface) {
        return glass.sample(wo, point, lobe, steps);
    }
    if wo.z < 0.0 {
        let sample = sample_from_above(surface, -wo, point, steps)?;
        return Some(BsdfSample { wi: -sample.wi, ..sample });
    }
    sample_from_above(surface, wo, point, steps)
}

fn sample_from_above(
    surface: &Surface,
    wo: DVec3,
    point: DVec2,
    steps: &Steps,
) -> Option<BsdfSample> {
    let wi = match *surface {
        Surface::Diffuse { .. } => sampling::direction(steps.diffuse_sampler(), point, steps),
        Surface::Conductor { roughness, .. } => ggx::sample(roughness, wo, point, steps),
        Surface::Mirror { reflectance } => return steps.mirror(wo, reflectance),
        Surface::Glass { .. } | Surface::RoughGlass { .. } => return None,
    };
    let value = evaluate_from_above(surface, wo, wi, steps);
    (value.pdf > 0.0).then(|| steps.sampled(wi, value))
}

/// A sample says of its direction what evaluation says.
pub(crate) fn sampled(wi: DVec3, BsdfValue { f, pdf }: BsdfValue) -> BsdfSample {
    BsdfSample { wi, f, pdf, is_delta: 0, is_valid: 1 }
}

/// The f that is multiplied with light is the f of the surface.
pub(crate) fn scattered(_surface: &Surface, f: Rgb) -> DVec3 {
    f.into()
}

/// All that is reflected comes from the mirrored direction.
pub(crate) fn mirror(wo: DVec3, reflectance: Rgb) -> Option<BsdfSample> {
    delta(reflect(wo), reflectance, 1.0)
}

/// `w` mirrored about the normal.
pub(crate) fn reflect(w: DVec3) -> DVec3 {
    DVec3::new(-w.x, -w.y, w.z)
}

/// The only direction of a delta lobe, chosen with `probability`, that carries `weight` of the radiance along it.
///
/// f is such that f·|cos θ| is the weight: the cosine of the rendering equation has no part in a
/// mirror. Along the surface there is no such f.
pub(crate) fn delta(wi: DVec3, weight: Rgb, probability: f64) -> Option<BsdfSample> {
    let f = weight.map(|weight| weight / wi.z.abs());
    let is_sound = probability > 0.0 && f.iter().all(|f| f.is_finite());
    is_sound.then_some(BsdfSample { wi, f, pdf: probability, is_delta: 1, is_valid: 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::stage::grey;
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::steps::LESSON;

    const ROUGHNESSES: [f64; 4] = [1e-4, 0.1, 0.3, 1.0];

    fn smooth_and_rough() -> Vec<Surface> {
        let metal =
            ROUGHNESSES.map(|roughness| Surface::Conductor { reflectance: grey(0.9), roughness });
        [Surface::Diffuse { reflectance: grey(0.6) }].into_iter().chain(metal).collect()
    }

    fn direction(random: &mut Random<'_>) -> DVec3 {
        sampling::uniform_sphere(random.point())
    }

    #[test]
    fn surfaces_look_the_same_from_both_sides_and_hide_each_side_from_the_other() {
        let mut random = Random::for_ray(3, 0);
        for surface in smooth_and_rough() {
            for _ in 0..1000 {
                let (wo, wi) = (direction(&mut random), direction(&mut random));
                assert_eq!(
                    evaluate(&surface, wo, wi, &LESSON),
                    evaluate(&surface, -wo, -wi, &LESSON)
                );
                if wo.z * wi.z < 0.0 {
                    assert_eq!(evaluate(&surface, wo, wi, &LESSON), NOTHING);
                }
            }
        }
    }

    #[test]
    fn grazing_and_perpendicular_directions_give_finite_numbers() {
        let grazing = |z: f64| DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let views = [1.0, 1e-3, 1e-20, 1e-300, 0.0].map(grazing);
        let points = [0.0, 0.5, 1.0 - f64::EPSILON / 2.0];
        for surface in smooth_and_rough() {
            for wo in views {
                for (x, y) in points.iter().flat_map(|x| points.map(|y| (*x, y))) {
                    let Some(sample) = sample(&surface, wo, DVec2::new(x, y), 0.5, &LESSON) else {
                        continue;
                    };
                    let weight = sample.f[0] * sample.wi.z / sample.pdf;
                    assert!((0.0..=1.0).contains(&weight), "{surface:?} {wo} {sample:?}");
                }
            }
        }
    }
}
