//! Part 3: surfaces.

use super::faults;
use crate::cause::{bsdf, convention, sampling};
use crate::contract::{BsdfSample, BsdfValue, Sampler};
use crate::cores::textbook as lesson;
use crate::scene::Surface;
use glam::DVec3;
use lesson::bsdf::mirror;
use lesson::different;
use lesson::ggx::Microfacets;
use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, PI};

const ALBEDO: &str = "bsdf/diffuse-conserves-energy";
const ITSELF: &str = "bsdf/sampling-agrees-with-evaluation";
const DIFFUSE: &str = "bsdf/diffuse-samples-match-their-pdf";

faults! { part 3;
    "brdf-without-pi": "f = albedo, without 1/π",
        fails ALBEDO, told bsdf::WITHOUT_PI,
        diffuse = |reflectance, _| reflectance;
    "brdf-over-two-pi": "f = albedo/2π",
        fails ALBEDO, told bsdf::ALBEDO_HALVED,
        diffuse = |reflectance, _| reflectance.map(|r| r * FRAC_1_PI / 2.0);
    "pi-divided-later": "f = albedo, and the integrator divides by π: the picture is right",
        fails ALBEDO, told bsdf::WITHOUT_PI,
        diffuse = |reflectance, _| reflectance,
        scattered = |surface, f| match surface {
            Surface::Diffuse { .. } => DVec3::from(f) * FRAC_1_PI,
            _ => f.into(),
        };
    "cosine-in-brdf": "f = albedo cos θ/π",
        fails ALBEDO, told bsdf::COSINE_IN_F,
        diffuse = |reflectance, wi| reflectance.map(|r| r * FRAC_1_PI * wi.z);
    "cosine-in-sampled-f": "sample_f returns f cos θ",
        fails ITSELF, told bsdf::COSINE_IN_SAMPLED_F,
        sampled = |wi, value| {
            let f = value.f.map(|f| f * wi.z);
            lesson::bsdf::sampled(wi, BsdfValue { f, ..value })
        };
    "backlit-surface": "no test for cos θ > 0: light from behind is scattered too",
        fails ITSELF, told bsdf::LIGHT_FROM_BELOW,
        scatters_light_from = |_| true;
    "diffuse-pdf-uniform": "cosine samples of the diffuse surface, pdf 1/2π",
        fails DIFFUSE, told sampling::UNIFORM_PDF_FOR_COSINE,
        diffuse_pdf_sampler = || Sampler::UniformHemisphere;
    "albedo-averaged": "all channels have the mean albedo: right for grey scenes",
        fails ALBEDO, told bsdf::ALBEDO_AVERAGED,
        diffuse = |reflectance, _| [reflectance.iter().sum::<f64>() / 3.0 * FRAC_1_PI; 3];
    "mirror-without-cosine": "f of the mirror is R, not R/cos θ",
        fails "bsdf/mirror-reflects-its-reflectance", told bsdf::DELTA_COSINE_FORGOTTEN,
        mirror = |wo, reflectance| {
            mirror(wo, reflectance).map(|sample| BsdfSample { f: reflectance, ..sample })
        };
    "mirror-turns-back": "wi = wo",
        fails "bsdf/mirror-reflects-its-reflectance", told bsdf::MIRROR_RETURNS_VIEW,
        mirror = |wo, reflectance| lesson::bsdf::delta(wo, reflectance, 1.0);
    "mirror-not-delta": "the mirror's sample is not marked as a delta",
        fails ITSELF, told bsdf::MIRROR_NOT_DELTA,
        mirror = |wo, reflectance| {
            mirror(wo, reflectance).map(|sample| BsdfSample { is_delta: 0, ..sample })
        };
    "glass-indices-swapped": "entering is taken for leaving",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::ETA_SWAPPED,
        relative_index = |index, wo| if wo.z < 0.0 { index } else { 1.0 / index };
    "glass-without-total-reflection": "beyond the critical angle nothing is sampled",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::TOTAL_REFLECTION_FORGOTTEN,
        fresnel = |cosine, ratio| {
            let beyond = lesson::glass::refracted_cosine(cosine, ratio);
            beyond.map_or(0.0, |_| lesson::glass::fresnel(cosine, ratio))
        };
    "glass-weight-without-fresnel": "f is not multiplied by the share that its probability is",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::GLASS_WEIGHT_WITHOUT_FRESNEL,
        shares = |_| (1.0, 1.0);
    "glass-coin-toss": "each way is taken half of the time, whatever its probability",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::LOBE_PROBABILITY_MISMATCH,
        reflects = |lobe, fresnel| lobe < 0.5 && fresnel > 0.0;
    "glass-schlick-undeclared": "Schlick's approximation, while Fresnel's equations are declared",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::SCHLICK_UNDECLARED,
        fresnel = different::schlick_outside;
    "glass-fresnel-of-one-polarisation": "the reflectance of perpendicular light alone, not the mean of both",
        fails "bsdf/glass-follows-snell-and-fresnel", told bsdf::POLARISATIONS_NOT_AVERAGED,
        fresnel = |cosine, ratio| {
            let refracted = lesson::glass::refracted_cosine(cosine, ratio);
            refracted.map_or(1.0, |refracted| {
                ((cosine - ratio * refracted) / (cosine + ratio * refracted)).powi(2)
            })
        };
    "glass-unscaled-undeclared":
        "radiance is not scaled by the index squared, while that is declared",
        fails "bsdf/glass-follows-snell-and-fresnel", told convention::UNSCALED_RADIANCE,
        radiance_scale = |_| 1.0,
        rough_radiance_scale = |ratio| ratio * ratio;
    "metal-roughness-squared": "α = roughness², while α is given",
        fails "bsdf/rough-conductor-conserves-energy", told bsdf::ROUGHNESS_SQUARED,
        alpha = |roughness| roughness * roughness;
    "metal-without-masking": "G = 1",
        fails "bsdf/rough-conductor-conserves-energy", told bsdf::MASKING_FORGOTTEN,
        metal_f = |microfacets| microfacets.distribution / (4.0 * microfacets.wo.z * microfacets.wi.z);
    "metal-masking-of-alpha": "α in place of α² in the masking term",
        fails "bsdf/rough-conductor-matches-ggx", told bsdf::MASKING_OF_ALPHA,
        metal_f = |microfacets| lesson::ggx::metal_f(&masked_by_root(microfacets)),
        metal_pdf = |microfacets| lesson::ggx::metal_pdf(&masked_by_root(microfacets));
    "metal-distribution-not-squared": "the denominator of D is not squared",
        fails "bsdf/rough-conductor-matches-ggx", told bsdf::D_NOT_SQUARED,
        metal_f = |microfacets| lesson::ggx::metal_f(&with_unsquared_distribution(microfacets)),
        metal_pdf = |microfacets| lesson::ggx::metal_pdf(&with_unsquared_distribution(microfacets));
    "metal-pdf-of-all-normals": "visible normals are sampled, and the pdf is that of all: D cos θh / (4 wo·h)",
        fails "bsdf/rough-conductor-samples-match-their-pdf", told bsdf::PDF_OF_ALL_NORMALS,
        metal_pdf = |Microfacets { distribution, wo, normal, .. }| {
            distribution * normal.z / (4.0 * wo.dot(*normal))
        };
    "metal-pdf-of-half-vector": "the pdf of the half vector, without 1/(4 wo·h)",
        fails "bsdf/rough-conductor-pdf-matches-the-jacobian", told bsdf::PDF_OF_HALF_VECTOR,
        metal_pdf = |Microfacets { distribution, masking_over_cosine: [masked, _], wo, normal, .. }| {
            distribution * masked * wo.dot(*normal).max(0.0)
        };
    "metal-without-four": "the 4 in the denominator of f is missing",
        fails "bsdf/rough-conductor-conserves-energy", told bsdf::FOUR_FORGOTTEN,
        metal_f = |Microfacets { distribution, masking_over_cosine: [wo, wi], .. }| distribution * wo * wi;
    "rough-glass-jacobian-without-index": "the Jacobian of refraction lacks η²",
        fails "bsdf/rough-glass-pdf-matches-the-jacobian",
        told bsdf::REFRACTION_JACOBIAN_WITHOUT_INDEX,
        refraction_jacobian = |_, i_m, denominator| i_m.abs() / denominator;
    "rough-glass-lobe-probability-forgotten": "the Fresnel reflectance is in f, and not in the pdf",
        fails "bsdf/rough-glass-pdf-integrates-to-its-valid-samples",
        told bsdf::LOBE_PROBABILITY_FORGOTTEN,
        lobe_probability = |_| 1.0;
    "rough-glass-half-of-entering":
        "the half vector of refraction has the index of entering when light leaves",
        fails "bsdf/rough-glass-conserves-energy", told bsdf::HALF_WITH_INDEX_OF_ENTERING,
        refraction_microfacet = |glass, wo, wi| {
            lesson::rough_glass::upward((-(wo + glass.index * wi)).normalize())
        };
    "rough-glass-fresnel-of-surface":
        "the Fresnel reflectance is that of the surface's cosine, not of the microfacet's",
        fails "bsdf/rough-glass-conserves-energy", told bsdf::FRESNEL_OF_SURFACE,
        fresnel_cosine = |wo, _| wo.z.abs();
    "brdf-times-pi": "f = albedo · π",
        fails ALBEDO, told bsdf::TIMES_PI,
        diffuse = |reflectance, _| reflectance.map(|r| r * PI);
    "brdf-over-pi-twice": "f = albedo/π, divided by π again",
        fails ALBEDO, told bsdf::WITH_PI,
        diffuse = |reflectance, _| reflectance.map(|r| r * FRAC_1_PI * FRAC_1_PI);
    "brdf-doubled": "f = 2 albedo/π",
        fails ALBEDO, told bsdf::ALBEDO_DOUBLED,
        diffuse = |reflectance, _| reflectance.map(|r| r * FRAC_2_PI);
    "brdf-over-cosine": "f = albedo/(π cos θ)",
        fails ALBEDO, told bsdf::F_OVER_COSINE,
        diffuse = |reflectance, wi| reflectance.map(|r| r * FRAC_1_PI / wi.z);
    "mirror-without-colour": "the mirror reflects everything, whatever its reflectance",
        fails "bsdf/mirror-reflects-its-reflectance", told bsdf::DELTA_COLOUR_MISSING,
        mirror = |wo, _| mirror(wo, [1.0; 3]);
    "mirror-goes-through": "wi = −wo",
        fails "bsdf/mirror-reflects-its-reflectance", told bsdf::MIRROR_GOES_THROUGH,
        mirror = |wo, reflectance| lesson::bsdf::delta(-wo, reflectance, 1.0);
    "metal-masking-one-sided": "G is G1 of wo alone",
        fails "bsdf/rough-conductor-matches-ggx", told bsdf::MASKING_ONE_SIDED,
        metal_f = |Microfacets { distribution, masking_over_cosine: [masked, _], wi, .. }| {
            distribution * masked / (4.0 * wi.z)
        };
}

/// With √α in place of α in the masking term.
fn masked_by_root(microfacets: &Microfacets) -> Microfacets {
    let Microfacets { roughness, wo, wi, .. } = *microfacets;
    let masking_over_cosine =
        [wo, wi].map(|w| lesson::ggx::masking_over_cosine(roughness.sqrt(), w));
    Microfacets { masking_over_cosine, ..*microfacets }
}

/// With D = α²/(π s) in place of α²/(π s²).
fn with_unsquared_distribution(microfacets: &Microfacets) -> Microfacets {
    let Microfacets { roughness, distribution, .. } = *microfacets;
    let alpha_squared = roughness * roughness;
    let distribution = (distribution * alpha_squared * FRAC_1_PI).sqrt();
    Microfacets { distribution, ..*microfacets }
}
