//! Choices that are free, and that a core has made otherwise than it declares.

use super::{Cause, causes};

causes! {
    NO_FALLOFF = "falloff-undeclared":
        "the point light does not weaken with distance, and the core declares that it does",
        at "the point light's sample, and the conventions that the core declares",
        fix "Divide the intensity by the squared distance, or declare `point-light-falloff = \"none\"`.";
    INVERSE_SQUARE = "inverse-square-undeclared":
        "the point light weakens with the squared distance, and the core declares that it does not",
        at "the point light's sample, and the conventions that the core declares",
        fix "Declare `point-light-falloff = \"inverse-square\"`.";
    TWO_SIDED_EMISSION = "two-sided-emission-undeclared":
        "lamps glow on both sides, and the core declares that they glow on their front only",
        at "the emission of a surface that is hit, and the conventions that the core declares",
        fix "Emit on the side of the geometric normal only, or declare `emission = \"both\"`.";
    UNSCALED_RADIANCE = "unscaled-radiance-undeclared":
        "radiance crosses glass unchanged, and the core declares that it is scaled by the index squared",
        at "the transmitted lobe of glass, and the conventions that the core declares",
        fix "Divide the transmitted radiance by the index ratio squared, or declare `glass-radiance = \"unscaled\"`.";
    OTHER_SMITH_TERM = "smith-term-undeclared":
        "rough metal uses another masking term than the core declares",
        at "the masking term G of the microfacet model, and the conventions that the core declares",
        fix "Declare the Smith term you use: `smith-term = \"separable\"` or `\"height-correlated\"`.";
}
