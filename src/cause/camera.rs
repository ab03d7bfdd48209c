//! Part 1: camera rays and the samples of a pixel.

use super::Cause;

/// See its headline.
pub static FILM_Y_DOWN: Cause = Cause {
    name: "film-y-down",
    headline: "the film's y axis points down",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Film coordinates begin at the bottom left: y grows upwards.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&FILM_Y_DOWN];
