//! Part 3: directions and their pdfs.

use super::faults;
use crate::cause::sampling;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};

const UNIFORM_MAP: &str = "sampling/uniform-pdf-matches-the-jacobian";
const COSINE_MAP: &str = "sampling/cosine-pdf-matches-the-jacobian";
const UNIFORM_PDF: &str = "sampling/uniform-pdf-integrates-to-one";
const COSINE_PDF: &str = "sampling/cosine-pdf-integrates-to-one";

faults! { part 3;
    "theta-uniform": "θ = u π/2: too dense at the pole",
        fails UNIFORM_MAP, told sampling::THETA_UNIFORM,
        uniform_height = |u| (FRAC_PI_2 * u).cos();
    "half-azimuths": "φ = π u: half of the circle",
        fails UNIFORM_MAP, told sampling::HALF_OF_AZIMUTHS,
        turn = |point| point.y / 2.0;
    "number-twice": "θ and φ come from the same random number",
        fails UNIFORM_MAP, told sampling::ONE_NUMBER_TWICE,
        turn = |point| point.x;
    "cosine-without-root": "cos θ = u where √u belongs",
        fails COSINE_MAP, told sampling::UNIFORM_FOR_COSINE,
        cosine_height = |u| 1.0 - u;
    "uniform-pdf-doubled": "pdf 1/π for the uniform hemisphere",
        fails UNIFORM_PDF, told sampling::PDF_DOUBLED,
        uniform_hemisphere_pdf = || FRAC_1_PI;
    "uniform-pdf-doubled-made-good":
        "pdf 1/π, and a factor 2 in the estimator: the picture is right",
        fails UNIFORM_PDF, told sampling::PDF_DOUBLED,
        uniform_hemisphere_pdf = || FRAC_1_PI,
        hemisphere_estimate = |light, pdf| 2.0 * (light / pdf);
    "cosine-pdf-without-pi": "pdf cos θ for the cosine hemisphere",
        fails COSINE_PDF, told sampling::PDF_WITHOUT_PI,
        cosine_hemisphere_pdf = |direction| direction.z;
    "cosine-pdf-uniform": "cosine samples with pdf 1/2π",
        fails COSINE_MAP, told sampling::UNIFORM_PDF_FOR_COSINE,
        cosine_hemisphere_pdf = |_| FRAC_1_PI / 2.0;
    "pdf-below-horizon": "the pdf is |cos θ|/π below the horizon too",
        fails COSINE_PDF, told sampling::PDF_BELOW_HORIZON,
        is_below_horizon = |_| false,
        cosine_hemisphere_pdf = |direction| direction.z.abs() * FRAC_1_PI;
    "uniform-pdf-halved": "pdf 1/4π, that of the sphere, for the uniform hemisphere",
        fails UNIFORM_PDF, told sampling::PDF_HALVED,
        uniform_hemisphere_pdf = || FRAC_1_PI / 4.0;
    "uniform-pdf-inverted": "2π for 1/2π",
        fails UNIFORM_PDF, told sampling::PDF_INVERTED,
        uniform_hemisphere_pdf = || 2.0 / FRAC_1_PI;
    "uniform-is-cosine": "√u where u belongs: cosine samples for uniform ones",
        fails UNIFORM_MAP, told sampling::COSINE_FOR_UNIFORM,
        uniform_height = f64::sqrt;
}
