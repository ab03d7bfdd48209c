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

/// Every cause of this part.
pub static CAUSES: &[&Cause] =
    &[&WITHOUT_PI, &ALBEDO_HALVED, &WITH_PI, &COSINE_IN_F, &F_OVER_COSINE, &ALBEDO_DOUBLED];
