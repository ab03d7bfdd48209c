//! Part 3: surfaces.

use super::Cause;

/// See its headline.
pub static WITHOUT_PI: Cause = Cause {
    name: "brdf-without-pi",
    headline: "1/π is missing in f of the diffuse surface",
    look_at: "f of the diffuse surface",
    remedy: "f = albedo / π, so that the integral of f cos θ is the albedo.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&WITHOUT_PI];
