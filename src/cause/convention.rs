//! Choices that are free, and that a core has made otherwise than it declares.

use super::{Cause, causes};

causes! {
    NO_FALLOFF = "falloff-undeclared":
        "the point light has no distance falloff, but the core declares inverse-square falloff",
        at "sampling the point light, and the conventions that the core declares",
        fix "Divide the intensity by the squared distance, or declare `point-light-falloff = \"none\"`.";
    INVERSE_SQUARE = "inverse-square-undeclared":
        "the point light has inverse-square falloff, but the core declares none",
        at "sampling the point light, and the conventions that the core declares",
        fix "Declare `point-light-falloff = \"inverse-square\"`.";
    TWO_SIDED_EMISSION = "two-sided-emission-undeclared":
        "emitters are two-sided, but the core declares one-sided emission",
        at "the emitted radiance of a surface that a ray hits, and the conventions that the core declares",
        fix "Emit only on the side of the geometric normal, or declare `emission = \"both\"`.";
    UNSCALED_RADIANCE = "unscaled-radiance-undeclared":
        "refraction leaves radiance unscaled, but the core declares scaling by the squared relative index of refraction",
        at "the transmission lobe of the dielectric, and the conventions that the core declares",
        fix "Divide the transmitted radiance by the squared relative index of refraction, or declare `glass-radiance = \"unscaled\"`.";
    OTHER_SMITH_TERM = "smith-term-undeclared":
        "the rough conductor uses a different Smith masking-shadowing term than the core declares",
        at "the masking-shadowing term G of the microfacet BRDF, and the conventions that the core declares",
        fix "Declare the Smith term in use: `smith-term = \"separable\"` or `\"height-correlated\"`.";
}
