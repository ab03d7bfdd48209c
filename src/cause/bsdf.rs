//! Part 3: surfaces.

use super::Cause;

/// See its headline.
pub static WITHOUT_PI: Cause = Cause {
    name: "brdf-without-pi",
    headline: "1/π is missing in f of the diffuse surface",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π, so that the integral of f cos θ is the albedo.",
};

/// See its headline.
pub static ALBEDO_HALVED: Cause = Cause {
    name: "albedo-halved",
    headline: "f of the diffuse surface is half of what it should be: 1/2π stands where 1/π belongs",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π; 1/2π is the density of the uniform hemisphere.",
};

/// See its headline.
pub static WITH_PI: Cause = Cause {
    name: "brdf-divided-by-pi-twice",
    headline: "f of the diffuse surface is divided by π twice",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π, divided once.",
};

/// See its headline.
pub static COSINE_IN_F: Cause = Cause {
    name: "cosine-in-brdf",
    headline: "the cosine is already in f, and is multiplied once more by whoever uses it",
    look_at: "f of the surface",
    remedy: "f is without the cosine; the integrator multiplies it.",
};

/// See its headline.
pub static F_OVER_COSINE: Cause = Cause {
    name: "f-over-cosine",
    headline: "f of the diffuse surface is divided by the cosine, as only a mirror's is",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π, the same in all directions.",
};

/// See its headline.
pub static ALBEDO_DOUBLED: Cause = Cause {
    name: "albedo-doubled",
    headline: "f of the diffuse surface is twice what it should be",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π.",
};

/// See its headline.
pub static GLASS_SIDES_SWAPPED: Cause = Cause {
    name: "glass-sides-swapped",
    headline: "glass takes entering for leaving: the ratio of indices is upside down",
    look_at: "the glass surface, where wo.z decides which index stands above the other",
    remedy: "wo.z > 0 is outside: light comes from the far side with η = index beyond / index here.",
};

/// See its headline.
pub static SNELL_INVERTED: Cause = Cause {
    name: "snell-inverted",
    headline: "refraction bends by the inverse ratio of indices, away from the normal instead of towards it",
    look_at: "refract: the ratio that multiplies the sine",
    remedy: "sin θ beyond = sin θ here · (index here / index beyond).",
};

/// See its headline.
pub static SCHLICK_UNDECLARED: Cause = Cause {
    name: "schlick-undeclared",
    headline: "glass reflects by a form of Schlick's approximation that the core does not declare",
    look_at: "the reflectance of glass, or the declared conventions",
    remedy: "Use Fresnel's equations, or declare `glass-fresnel = \"schlick\"`, `\"schlick-outside\"` if the cosine is always that on the thin side.",
};

/// See its headline.
pub static TOTAL_REFLECTION_FORGOTTEN: Cause = Cause {
    name: "total-reflection-forgotten",
    headline: "beyond the critical angle light is lost instead of reflected",
    look_at: "the glass surface, where refraction has no solution",
    remedy: "Where sin θ beyond would exceed one, reflect everything.",
};

/// See its headline.
pub static GLASS_RADIANCE_SCALED_BACKWARDS: Cause = Cause {
    name: "glass-radiance-scaled-backwards",
    headline: "radiance that crosses glass is multiplied by the index squared instead of divided",
    look_at: "the weight of the refracted lobe",
    remedy: "Light that comes out of the denser side towards wo is worth 1/η², η = index beyond / index here.",
};

/// See its headline.
pub static GLASS_RADIANCE_SCALED_UNDECLARED: Cause = Cause {
    name: "glass-radiance-scaled-undeclared",
    headline: "radiance is divided by the index squared, and the core declares that it is not",
    look_at: "the weight of the refracted lobe, or the declared conventions",
    remedy: "Leave the factor out, or declare `glass-radiance = \"scaled\"`.",
};

/// See its headline.
pub static DELTA_COSINE_FORGOTTEN: Cause = Cause {
    name: "delta-cosine-forgotten",
    headline: "f of a mirror or of glass is not divided by |cos θ|, and the integrator multiplies by it",
    look_at: "sample of the mirror or glass, where f is returned",
    remedy: "f = weight · pdf / |cos θi|: the cosine of the rendering equation has no part in a mirror.",
};

/// See its headline.
pub static DELTA_WEIGHT_TIMES_PROBABILITY: Cause = Cause {
    name: "delta-weight-not-divided",
    headline: "glass chooses between its two ways by chance, and does not divide by that chance",
    look_at: "sample of the glass, where f and pdf of the chosen way are returned",
    remedy: "f · |cos θ| / pdf is the colour alone: the share F cancels against the probability F.",
};

/// See its headline.
pub static DELTA_PROBABILITY_IS_ONE: Cause = Cause {
    name: "delta-probability-is-one",
    headline: "glass chooses between its two ways by chance, and says that the chance was 1",
    look_at: "sample of the glass, where pdf is returned",
    remedy: "The pdf of a way is the probability of having chosen it: F, or 1 - F.",
};

/// See its headline.
pub static DELTA_COLOUR_MISSING: Cause = Cause {
    name: "delta-colour-missing",
    headline: "the colour of a mirror or of glass is left out of its weight",
    look_at: "sample of the mirror or glass, where f is returned",
    remedy: "Multiply by the reflectance, or by the transmittance of what passes.",
};

/// See its headline.
pub static MIRROR_RETURNS_VIEW: Cause = Cause {
    name: "mirror-returns-view",
    headline: "a mirror sends light back where it came from: wi is wo",
    look_at: "sample of the mirror, where wo is mirrored about the normal",
    remedy: "wi = (-wo.x, -wo.y, wo.z).",
};

/// See its headline.
pub static MIRROR_GOES_THROUGH: Cause = Cause {
    name: "mirror-goes-through",
    headline: "a mirror lets light straight through: all of wo is turned round, its z as well",
    look_at: "sample of the mirror, where wo is mirrored about the normal",
    remedy: "wi = (-wo.x, -wo.y, wo.z): the side of the surface stays.",
};

/// See its headline.
pub static COSINE_IN_SAMPLED_F: Cause = Cause {
    name: "cosine-in-sampled-f",
    headline: "f of a sample has the cosine in it already, f evaluated has not",
    look_at: "sampling the surface, where f is returned",
    remedy: "Return f without the cosine, as the evaluation does.",
};

/// See its headline.
pub static LIGHT_FROM_BELOW: Cause = Cause {
    name: "light-from-below",
    headline: "light from behind the surface is scattered too",
    look_at: "f of the surface, where the side of the direction is tested",
    remedy: "f is 0 where cos θ ≤ 0; do not take its absolute value first.",
};

/// See its headline.
pub static ALBEDO_AVERAGED: Cause = Cause {
    name: "albedo-averaged",
    headline: "the surface has lost its colour: all channels have the mean albedo",
    look_at: "f of the surface",
    remedy: "Multiply each channel by its own albedo.",
};

/// See its headline.
pub static MIRROR_NOT_DELTA: Cause = Cause {
    name: "mirror-not-delta",
    headline: "a mirror's only direction is not marked as such",
    look_at: "sampling the mirror, where the sample is returned",
    remedy: "Say that the sample is a delta: no light can be sampled towards it.",
};

/// See its headline.
pub static GLASS_WEIGHT_WITHOUT_FRESNEL: Cause = Cause {
    name: "glass-weight-without-fresnel",
    headline: "glass divides by the chance of a way, and leaves Fresnel's share out of its weight",
    look_at: "glass, where f of the chosen way is written",
    remedy: "The share F belongs to what is reflected, 1 − F to what passes, and each is divided by its chance.",
};

/// See its headline.
pub static GLASS_OTHER_CHANCE: Cause = Cause {
    name: "glass-other-chance",
    headline: "glass chooses its way by another chance than it divides by",
    look_at: "glass, where a random number chooses between its two ways",
    remedy: "Compare the random number with the probability that is returned.",
};

/// See its headline.
pub static ROUGHNESS_SQUARED: Cause = Cause {
    name: "roughness-squared",
    headline: "the roughness is squared before it is used as the width of the lobe",
    look_at: "the microfacet distribution, where α comes from",
    remedy: "Here the roughness is α itself.",
};

/// See its headline.
pub static MASKING_FORGOTTEN: Cause = Cause {
    name: "masking-forgotten",
    headline: "the masking term is missing",
    look_at: "f of rough metal",
    remedy: "f = F D G / (4 cos θo cos θi), with Smith's G.",
};

/// See its headline.
pub static PDF_OF_FACETS: Cause = Cause {
    name: "pdf-of-facets",
    headline: "the density is that of the facet's normal, not of the direction",
    look_at: "sampling rough metal, where the pdf is written",
    remedy: "Divide the density of the half vector by 4 (wo · h).",
};

/// See its headline.
pub static FOUR_FORGOTTEN: Cause = Cause {
    name: "four-forgotten",
    headline: "f of rough metal is four times too large: the 4 of its denominator is missing",
    look_at: "f of rough metal",
    remedy: "f = F D G / (4 cos θo cos θi).",
};

/// See its headline.
pub static MASKING_ONE_SIDED: Cause = Cause {
    name: "masking-one-sided",
    headline: "facets hidden from the eye are left out, those hidden from the light are not",
    look_at: "the masking term of rough metal",
    remedy: "G has a factor for the eye and one for the light.",
};

/// See its headline.
pub static FACETS_WITHOUT_PI: Cause = Cause {
    name: "facets-without-pi",
    headline: "1/π is missing in the density of facets",
    look_at: "the distribution of normals of rough metal",
    remedy: "The integral of D cos over the hemisphere is one.",
};

/// See its headline.
pub static BECKMANN_FACETS: Cause = Cause {
    name: "beckmann-facets",
    headline: "the density of facets is that of Beckmann, and GGX was asked for",
    look_at: "the distribution of normals of rough metal",
    remedy: "D = α² / (π (cos² (α² - 1) + 1)²).",
};

/// See its headline.
pub static HALF_NOT_NORMALISED: Cause = Cause {
    name: "half-not-normalised",
    headline: "the half vector of rough metal is not normalised",
    look_at: "the half vector of rough metal",
    remedy: "h = (wo + wi) / |wo + wi|.",
};

/// See its headline.
pub static REFRACTION_JACOBIAN_WITHOUT_INDEX: Cause = Cause {
    name: "refraction-jacobian-without-index",
    headline: "the density of refracted directions lacks the index squared",
    look_at: "sampling rough glass, where the density of the facet becomes one of directions",
    remedy: "Multiply by η² |wi·h| / (wo·h + η wi·h)², η = index beyond / index here.",
};

/// See its headline.
pub static LOBE_CHANCE_FORGOTTEN: Cause = Cause {
    name: "lobe-chance-forgotten",
    headline: "the density of rough glass lacks the chance of the way that was chosen",
    look_at: "the pdf of rough glass",
    remedy: "Multiply it by F for what is reflected, by 1 − F for what passes.",
};

/// See its headline.
pub static HALF_WITH_INDEX_OF_ENTERING: Cause = Cause {
    name: "half-vector-with-index-of-entering",
    headline: "where light leaves rough glass, the half vector is made with the index of light that enters",
    look_at: "the half vector of rough glass, where wo is inside",
    remedy: "h = -(wo + η wi), η = index on the side of wi over that on the side of wo: below 1 from inside.",
};

/// See its headline.
pub static FRESNEL_OF_SURFACE: Cause = Cause {
    name: "fresnel-of-surface",
    headline: "rough glass takes Fresnel's share at the angle with the surface, not with the facet",
    look_at: "the Fresnel term of rough glass",
    remedy: "F is a function of wo·h: light meets the facet.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &WITHOUT_PI,
    &ALBEDO_HALVED,
    &WITH_PI,
    &COSINE_IN_F,
    &F_OVER_COSINE,
    &ALBEDO_DOUBLED,
    &GLASS_SIDES_SWAPPED,
    &SNELL_INVERTED,
    &SCHLICK_UNDECLARED,
    &TOTAL_REFLECTION_FORGOTTEN,
    &GLASS_RADIANCE_SCALED_BACKWARDS,
    &GLASS_RADIANCE_SCALED_UNDECLARED,
    &DELTA_COSINE_FORGOTTEN,
    &DELTA_WEIGHT_TIMES_PROBABILITY,
    &DELTA_PROBABILITY_IS_ONE,
    &DELTA_COLOUR_MISSING,
    &MIRROR_RETURNS_VIEW,
    &MIRROR_GOES_THROUGH,
    &COSINE_IN_SAMPLED_F,
    &LIGHT_FROM_BELOW,
    &ALBEDO_AVERAGED,
    &MIRROR_NOT_DELTA,
    &GLASS_WEIGHT_WITHOUT_FRESNEL,
    &GLASS_OTHER_CHANCE,
    &ROUGHNESS_SQUARED,
    &MASKING_FORGOTTEN,
    &PDF_OF_FACETS,
    &FOUR_FORGOTTEN,
    &MASKING_ONE_SIDED,
    &FACETS_WITHOUT_PI,
    &BECKMANN_FACETS,
    &HALF_NOT_NORMALISED,
    &REFRACTION_JACOBIAN_WITHOUT_INDEX,
    &LOBE_CHANCE_FORGOTTEN,
    &HALF_WITH_INDEX_OF_ENTERING,
    &FRESNEL_OF_SURFACE,
];
