//! Choices that are free, and that a core has made otherwise than it declares.

use super::Cause;

/// See its headline.
pub static NO_FALLOFF: Cause = Cause {
    name: "falloff-undeclared",
    headline: "the point light does not weaken with distance, and the core declares that it does",
    look_at: "the point light's sample, and the conventions that the core declares",
    remedy: "Divide the intensity by the squared distance, or declare `point-light-falloff = \"none\"`.",
};

/// See its headline.
pub static INVERSE_SQUARE: Cause = Cause {
    name: "inverse-square-undeclared",
    headline: "the point light weakens with the squared distance, and the core declares that it does not",
    look_at: "the point light's sample, and the conventions that the core declares",
    remedy: "Declare `point-light-falloff = \"inverse-square\"`.",
};

/// See its headline.
pub static TWO_SIDED_EMISSION: Cause = Cause {
    name: "two-sided-emission-undeclared",
    headline: "lamps glow on both sides, and the core declares that they glow on their front only",
    look_at: "the emission of a surface that is hit, and the conventions that the core declares",
    remedy: "Emit on the side of the geometric normal only, or declare `emission = \"both\"`.",
};

/// See its headline.
pub static UNSCALED_RADIANCE: Cause = Cause {
    name: "unscaled-radiance-undeclared",
    headline: "radiance crosses glass unchanged, and the core declares that it is scaled by the index squared",
    look_at: "the transmitted lobe of glass, and the conventions that the core declares",
    remedy: "Divide the transmitted radiance by the index ratio squared, or declare `glass-radiance = \"unscaled\"`.",
};

/// See its headline.
pub static OTHER_SMITH_TERM: Cause = Cause {
    name: "smith-term-undeclared",
    headline: "rough metal uses another masking term than the core declares",
    look_at: "the masking term G of the microfacet model, and the conventions that the core declares",
    remedy: "Declare the Smith term you use: `smith-term = \"separable\"` or `\"height-correlated\"`.",
};

/// Every cause of this kind.
pub static CAUSES: &[&Cause] =
    &[&NO_FALLOFF, &INVERSE_SQUARE, &TWO_SIDED_EMISSION, &UNSCALED_RADIANCE, &OTHER_SMITH_TERM];
