//! Part 3: BSDFs.

use super::{Cause, causes};

causes! {
    WITHOUT_PI = "brdf-without-pi":
        "the diffuse BRDF lacks the factor 1/π",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π, so that the integral of f cos θ is the albedo.";
    ALBEDO_HALVED = "albedo-halved":
        "the diffuse BRDF is half of what it should be: albedo/(2π)",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π; 1/(2π) is the pdf of the uniform hemisphere.";
    WITH_PI = "brdf-divided-by-pi-twice":
        "the diffuse BRDF is divided by π twice",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π, divided once.";
    TIMES_PI = "brdf-times-pi":
        "the diffuse BRDF is multiplied by π instead of divided",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π.";
    COSINE_IN_F = "cosine-in-brdf":
        "the BRDF includes the cosine, and its caller multiplies by it again",
        at "evaluation of the BSDF",
        fix "f excludes the cosine; the integrator multiplies by it.";
    F_OVER_COSINE = "f-over-cosine":
        "the diffuse BRDF is divided by the cosine, as only a mirror's is",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π, constant over directions.";
    ALBEDO_DOUBLED = "albedo-doubled":
        "the diffuse BRDF is twice what it should be",
        at "evaluation of the diffuse BRDF",
        fix "f = albedo / π.";
    ETA_SWAPPED = "eta-swapped":
        "the dielectric swaps eta_i and eta_t: it takes entering for leaving",
        at "the dielectric, where wo.z decides which index is eta_i and which is eta_t",
        fix "wo.z > 0 is outside the dielectric: there eta_i = 1 and eta_t = the index of refraction.";
    SNELL_INVERTED = "snell-inverted":
        "refraction uses the inverse relative index: it bends away from the normal instead of towards it",
        at "refract, where the ratio of indices multiplies the sine",
        fix "Snell's law: sin θt = (eta_i / eta_t) sin θi.";
    SCHLICK_UNDECLARED = "schlick-undeclared":
        "Fresnel reflectance is Schlick's approximation in a form that the core does not declare",
        at "the Fresnel reflectance of the dielectric, or the declared conventions",
        fix "Use the Fresnel equations, or declare `glass-fresnel = \"schlick\"`, or `\"schlick-outside\"` if the cosine is always taken on the side of lower index.";
    POLARISATIONS_NOT_AVERAGED = "polarisations-not-averaged":
        "the Fresnel reflectance is not the mean of both polarisations",
        at "the Fresnel reflectance of the dielectric, where rs and rp are put together",
        fix "Unpolarised light: (rs² + rp²) / 2, the mean of the squares of both.";
    TOTAL_REFLECTION_FORGOTTEN = "total-reflection-forgotten":
        "total internal reflection is missing: beyond the critical angle light is lost",
        at "the dielectric, where refraction has no solution",
        fix "Where sin θt would exceed 1, reflect everything.";
    GLASS_RADIANCE_SCALED_BACKWARDS = "glass-radiance-scaled-backwards":
        "refracted radiance is multiplied by the squared relative index of refraction instead of divided",
        at "the weight of the transmission lobe",
        fix "Radiance scales by (eta_i / eta_t)², with eta_i on the side of wo.";
    GLASS_RADIANCE_SCALED_UNDECLARED = "glass-radiance-scaled-undeclared":
        "refracted radiance is scaled by the squared relative index of refraction, but the core declares that it is not",
        at "the weight of the transmission lobe, or the declared conventions",
        fix "Drop the factor, or declare `glass-radiance = \"scaled\"`.";
    DELTA_COSINE_FORGOTTEN = "delta-cosine-forgotten":
        "a delta lobe's f is not divided by |cos θ|, and the integrator multiplies by it",
        at "sampling the mirror or dielectric, where f is returned",
        fix "f = weight · pdf / |cos θi|: it cancels the cosine of the rendering equation.";
    DELTA_WEIGHT_TIMES_PROBABILITY = "delta-weight-not-divided":
        "the dielectric chooses reflection or transmission at random, and does not divide by the selection probability",
        at "sampling the dielectric, where f and pdf of the chosen lobe are returned",
        fix "f · |cos θ| / pdf is the tint alone: Fresnel reflectance F and selection probability F cancel.";
    DELTA_PROBABILITY_IS_ONE = "delta-probability-is-one":
        "the dielectric chooses reflection or transmission at random, but returns a selection probability of 1",
        at "sampling the dielectric, where pdf is returned",
        fix "The pdf of a delta lobe is its selection probability: F or 1 − F.";
    DELTA_COLOUR_MISSING = "delta-colour-missing":
        "the tint of the mirror or dielectric is missing from the sample's weight",
        at "sampling the mirror or dielectric, where f is returned",
        fix "Multiply by the specular reflectance, or by the specular transmittance for refraction.";
    MIRROR_RETURNS_VIEW = "mirror-returns-view":
        "the mirror reflects light back where it came from: wi = wo",
        at "sampling the mirror, where wo is reflected about the normal",
        fix "wi = (−wo.x, −wo.y, wo.z).";
    MIRROR_GOES_THROUGH = "mirror-goes-through":
        "the mirror lets light straight through: wi = −wo",
        at "sampling the mirror, where wo is reflected about the normal",
        fix "wi = (−wo.x, −wo.y, wo.z): it stays on the same side of the surface.";
    COSINE_IN_SAMPLED_F = "cosine-in-sampled-f":
        "sampling returns f with the cosine, evaluation without",
        at "sampling the BSDF, where f is returned",
        fix "Return f without the cosine, as evaluation does.";
    LIGHT_FROM_BELOW = "light-from-below":
        "light from below the surface is scattered too",
        at "evaluation of the BRDF, where the side of wi is tested",
        fix "f = 0 where cos θ ≤ 0; do not take its absolute value first.";
    ALBEDO_AVERAGED = "albedo-averaged":
        "every channel has the mean albedo: the surface is grey",
        at "evaluation of the BRDF",
        fix "Multiply each channel by its own albedo.";
    MIRROR_NOT_DELTA = "mirror-not-delta":
        "the mirror's sample is not flagged as a delta distribution",
        at "sampling the mirror, where the sample is returned",
        fix "Flag the sample as a delta distribution: light sampling cannot evaluate it.";
    GLASS_WEIGHT_WITHOUT_FRESNEL = "glass-weight-without-fresnel":
        "the dielectric divides by the lobe selection probability, but its weight lacks the Fresnel reflectance",
        at "the dielectric, where f of the chosen lobe is computed",
        fix "Reflection weighs F, transmission 1 − F; divide each by its selection probability.";
    LOBE_PROBABILITY_MISMATCH = "lobe-probability-mismatch":
        "the dielectric's lobe selection probability does not match its pdf",
        at "the dielectric, where a random number chooses reflection or transmission",
        fix "Compare the random number with the very probability that is returned as pdf.";
    ROUGHNESS_SQUARED = "roughness-squared":
        "the roughness is squared before it is used as α",
        at "the microfacet distribution, where α is computed",
        fix "Here the roughness is α itself.";
    MASKING_FORGOTTEN = "masking-forgotten":
        "the masking-shadowing term G is missing",
        at "evaluation of the rough conductor",
        fix "f = F D G / (4 cos θo cos θi), with the Smith term G.";
    PDF_OF_HALF_VECTOR = "pdf-of-half-vector":
        "the pdf is that of the half vector, not of wi: its Jacobian is missing",
        at "sampling the rough conductor, where the pdf is computed",
        fix "Divide the pdf of the half vector by 4 (wo · h).";
    FOUR_FORGOTTEN = "four-forgotten":
        "the microfacet BRDF lacks the 4 of its denominator",
        at "evaluation of the rough conductor",
        fix "f = F D G / (4 cos θo cos θi).";
    MASKING_ONE_SIDED = "masking-one-sided":
        "masking without shadowing: G has the factor for wo, not the one for wi",
        at "the masking-shadowing term G of the rough conductor",
        fix "G = G1(wo) G1(wi), or Smith's height-correlated form of both.";
    MASKING_OF_ALPHA = "masking-of-alpha":
        "the masking-shadowing term has α where α² belongs",
        at "G1 or Λ of the rough conductor, where α multiplies tan θ",
        fix "GGX: G1 = 2 / (1 + √(1 + α² tan² θ)), Λ = (−1 + √(1 + α² tan² θ)) / 2.";
    D_NOT_SQUARED = "d-not-squared":
        "the denominator of the normal distribution function D is not squared",
        at "the normal distribution function D of the rough conductor",
        fix "GGX: D = α² / (π (cos² θ (α² − 1) + 1)²).";
    PDF_OF_ALL_NORMALS = "pdf-of-all-normals":
        "visible normals are sampled, and the pdf is that of all normals",
        at "sampling the rough conductor, where the pdf is computed",
        fix "pdf = G1(wo) D / (4 cos θo) for visible normals; D cos θh / (4 wo · h) belongs to samples of D.";
    D_WITHOUT_PI = "d-without-pi":
        "the normal distribution function D lacks the factor 1/π",
        at "the normal distribution function D of the rough conductor",
        fix "D cos θ integrates to 1 over the hemisphere.";
    BECKMANN_FOR_GGX = "beckmann-for-ggx":
        "the normal distribution function D is Beckmann's, not GGX",
        at "the normal distribution function D of the rough conductor",
        fix "D = α² / (π (cos² θ (α² − 1) + 1)²).";
    HALF_NOT_NORMALISED = "half-not-normalised":
        "the half vector is not normalised",
        at "the half vector of the rough conductor",
        fix "h = (wo + wi) / |wo + wi|.";
    REFRACTION_JACOBIAN_WITHOUT_INDEX = "refraction-jacobian-without-index":
        "the Jacobian of refraction lacks the squared relative index of refraction",
        at "sampling the rough dielectric, where the pdf of the half vector becomes the pdf of wi",
        fix "Multiply by η² |wi·h| / (wo·h + η wi·h)², with η = index on the side of wi over index on the side of wo.";
    LOBE_PROBABILITY_FORGOTTEN = "lobe-probability-forgotten":
        "the rough dielectric's pdf lacks the lobe selection probability",
        at "the pdf of the rough dielectric",
        fix "Multiply by F for reflection, by 1 − F for transmission.";
    HALF_WITH_INDEX_OF_ENTERING = "half-vector-with-index-of-entering":
        "where light leaves the rough dielectric, the half vector uses the relative index of entering light",
        at "the half vector of the rough dielectric, where wo is inside",
        fix "h = −(wo + η wi), with η = index on the side of wi over index on the side of wo: below 1 from inside.";
    FRESNEL_OF_SURFACE = "fresnel-of-surface":
        "the rough dielectric evaluates Fresnel at the angle to the macrosurface, not to the microfacet",
        at "the Fresnel reflectance of the rough dielectric",
        fix "F is a function of wo·h, the angle at the microfacet.";
}
