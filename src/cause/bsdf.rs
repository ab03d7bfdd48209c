//! Part 3: surfaces.

use super::{Cause, causes};

causes! {
    WITHOUT_PI = "brdf-without-pi":
        "1/π is missing in f of the diffuse surface",
        at "f of the diffuse surface",
        fix "f = albedo / π, so that the integral of f cos θ is the albedo.";
    ALBEDO_HALVED = "albedo-halved":
        "f of the diffuse surface is half of what it should be: 1/2π stands where 1/π belongs",
        at "f of the diffuse surface",
        fix "f = albedo / π; 1/2π is the density of the uniform hemisphere.";
    WITH_PI = "brdf-divided-by-pi-twice":
        "f of the diffuse surface is divided by π twice",
        at "f of the diffuse surface",
        fix "f = albedo / π, divided once.";
    COSINE_IN_F = "cosine-in-brdf":
        "the cosine is already in f, and is multiplied once more by whoever uses it",
        at "f of the surface",
        fix "f is without the cosine; the integrator multiplies it.";
    F_OVER_COSINE = "f-over-cosine":
        "f of the diffuse surface is divided by the cosine, as only a mirror's is",
        at "f of the diffuse surface",
        fix "f = albedo / π, the same in all directions.";
    ALBEDO_DOUBLED = "albedo-doubled":
        "f of the diffuse surface is twice what it should be",
        at "f of the diffuse surface",
        fix "f = albedo / π.";
    GLASS_SIDES_SWAPPED = "glass-sides-swapped":
        "glass takes entering for leaving: the ratio of indices is upside down",
        at "the glass surface, where wo.z decides which index stands above the other",
        fix "wo.z > 0 is outside: light comes from the far side with η = index beyond / index here.";
    SNELL_INVERTED = "snell-inverted":
        "refraction bends by the inverse ratio of indices, away from the normal instead of towards it",
        at "refract: the ratio that multiplies the sine",
        fix "sin θ beyond = sin θ here · (index here / index beyond).";
    SCHLICK_UNDECLARED = "schlick-undeclared":
        "glass reflects by a form of Schlick's approximation that the core does not declare",
        at "the reflectance of glass, or the declared conventions",
        fix "Use Fresnel's equations, or declare `glass-fresnel = \"schlick\"`, `\"schlick-outside\"` if the cosine is always that on the thin side.";
    TOTAL_REFLECTION_FORGOTTEN = "total-reflection-forgotten":
        "beyond the critical angle light is lost instead of reflected",
        at "the glass surface, where refraction has no solution",
        fix "Where sin θ beyond would exceed one, reflect everything.";
    GLASS_RADIANCE_SCALED_BACKWARDS = "glass-radiance-scaled-backwards":
        "radiance that crosses glass is multiplied by the index squared instead of divided",
        at "the weight of the refracted lobe",
        fix "Light that comes out of the denser side towards wo is worth 1/η², η = index beyond / index here.";
    GLASS_RADIANCE_SCALED_UNDECLARED = "glass-radiance-scaled-undeclared":
        "radiance is divided by the index squared, and the core declares that it is not",
        at "the weight of the refracted lobe, or the declared conventions",
        fix "Leave the factor out, or declare `glass-radiance = \"scaled\"`.";
    DELTA_COSINE_FORGOTTEN = "delta-cosine-forgotten":
        "f of a mirror or of glass is not divided by |cos θ|, and the integrator multiplies by it",
        at "sample of the mirror or glass, where f is returned",
        fix "f = weight · pdf / |cos θi|: the cosine of the rendering equation has no part in a mirror.";
    DELTA_WEIGHT_TIMES_PROBABILITY = "delta-weight-not-divided":
        "glass chooses between its two ways by chance, and does not divide by that chance",
        at "sample of the glass, where f and pdf of the chosen way are returned",
        fix "f · |cos θ| / pdf is the colour alone: the share F cancels against the probability F.";
    DELTA_PROBABILITY_IS_ONE = "delta-probability-is-one":
        "glass chooses between its two ways by chance, and says that the chance was 1",
        at "sample of the glass, where pdf is returned",
        fix "The pdf of a way is the probability of having chosen it: F, or 1 - F.";
    DELTA_COLOUR_MISSING = "delta-colour-missing":
        "the colour of a mirror or of glass is left out of its weight",
        at "sample of the mirror or glass, where f is returned",
        fix "Multiply by the reflectance, or by the transmittance of what passes.";
    MIRROR_RETURNS_VIEW = "mirror-returns-view":
        "a mirror sends light back where it came from: wi is wo",
        at "sample of the mirror, where wo is mirrored about the normal",
        fix "wi = (-wo.x, -wo.y, wo.z).";
    MIRROR_GOES_THROUGH = "mirror-goes-through":
        "a mirror lets light straight through: all of wo is turned round, its z as well",
        at "sample of the mirror, where wo is mirrored about the normal",
        fix "wi = (-wo.x, -wo.y, wo.z): the side of the surface stays.";
    COSINE_IN_SAMPLED_F = "cosine-in-sampled-f":
        "f of a sample has the cosine in it already, f evaluated has not",
        at "sampling the surface, where f is returned",
        fix "Return f without the cosine, as the evaluation does.";
    LIGHT_FROM_BELOW = "light-from-below":
        "light from behind the surface is scattered too",
        at "f of the surface, where the side of the direction is tested",
        fix "f is 0 where cos θ ≤ 0; do not take its absolute value first.";
    ALBEDO_AVERAGED = "albedo-averaged":
        "the surface has lost its colour: all channels have the mean albedo",
        at "f of the surface",
        fix "Multiply each channel by its own albedo.";
    MIRROR_NOT_DELTA = "mirror-not-delta":
        "a mirror's only direction is not marked as such",
        at "sampling the mirror, where the sample is returned",
        fix "Say that the sample is a delta: no light can be sampled towards it.";
    GLASS_WEIGHT_WITHOUT_FRESNEL = "glass-weight-without-fresnel":
        "glass divides by the chance of a way, and leaves Fresnel's share out of its weight",
        at "glass, where f of the chosen way is written",
        fix "The share F belongs to what is reflected, 1 − F to what passes, and each is divided by its chance.";
    GLASS_OTHER_CHANCE = "glass-other-chance":
        "glass chooses its way by another chance than it divides by",
        at "glass, where a random number chooses between its two ways",
        fix "Compare the random number with the probability that is returned.";
    ROUGHNESS_SQUARED = "roughness-squared":
        "the roughness is squared before it is used as the width of the lobe",
        at "the microfacet distribution, where α comes from",
        fix "Here the roughness is α itself.";
    MASKING_FORGOTTEN = "masking-forgotten":
        "the masking term is missing",
        at "f of rough metal",
        fix "f = F D G / (4 cos θo cos θi), with Smith's G.";
    PDF_OF_FACETS = "pdf-of-facets":
        "the density is that of the facet's normal, not of the direction",
        at "sampling rough metal, where the pdf is written",
        fix "Divide the density of the half vector by 4 (wo · h).";
    FOUR_FORGOTTEN = "four-forgotten":
        "f of rough metal is four times too large: the 4 of its denominator is missing",
        at "f of rough metal",
        fix "f = F D G / (4 cos θo cos θi).";
    MASKING_ONE_SIDED = "masking-one-sided":
        "facets hidden from the eye are left out, those hidden from the light are not",
        at "the masking term of rough metal",
        fix "G has a factor for the eye and one for the light.";
    FACETS_WITHOUT_PI = "facets-without-pi":
        "1/π is missing in the density of facets",
        at "the distribution of normals of rough metal",
        fix "The integral of D cos over the hemisphere is one.";
    BECKMANN_FACETS = "beckmann-facets":
        "the density of facets is that of Beckmann, and GGX was asked for",
        at "the distribution of normals of rough metal",
        fix "D = α² / (π (cos² (α² - 1) + 1)²).";
    HALF_NOT_NORMALISED = "half-not-normalised":
        "the half vector of rough metal is not normalised",
        at "the half vector of rough metal",
        fix "h = (wo + wi) / |wo + wi|.";
    REFRACTION_JACOBIAN_WITHOUT_INDEX = "refraction-jacobian-without-index":
        "the density of refracted directions lacks the index squared",
        at "sampling rough glass, where the density of the facet becomes one of directions",
        fix "Multiply by η² |wi·h| / (wo·h + η wi·h)², η = index beyond / index here.";
    LOBE_CHANCE_FORGOTTEN = "lobe-chance-forgotten":
        "the density of rough glass lacks the chance of the way that was chosen",
        at "the pdf of rough glass",
        fix "Multiply it by F for what is reflected, by 1 − F for what passes.";
    HALF_WITH_INDEX_OF_ENTERING = "half-vector-with-index-of-entering":
        "where light leaves rough glass, the half vector is made with the index of light that enters",
        at "the half vector of rough glass, where wo is inside",
        fix "h = -(wo + η wi), η = index on the side of wi over that on the side of wo: below 1 from inside.";
    FRESNEL_OF_SURFACE = "fresnel-of-surface":
        "rough glass takes Fresnel's share at the angle with the surface, not with the facet",
        at "the Fresnel term of rough glass",
        fix "F is a function of wo·h: light meets the facet.";
}
