//! Random numbers.

use super::Cause;

/// See its headline.
pub static SEED_IGNORED: Cause = Cause {
    name: "seed-ignored",
    headline: "the seed is ignored: every seed gives the same noise",
    look_at: "the random generator, where it is seeded",
    remedy: "Let every stream depend on the seed.",
};

/// See its headline.
pub static NOT_REPRODUCIBLE: Cause = Cause {
    name: "not-reproducible",
    headline: "the same seed gives other numbers each time: a clock or a shared generator is in them",
    look_at: "the random generator, where it is seeded",
    remedy: "Seed a stream of its own for each pixel and sample, from the seed and their numbers.",
};

/// See its headline.
pub static PIXELS_SHARE_NOISE: Cause = Cause {
    name: "pixels-share-noise",
    headline: "all pixels draw the same random numbers",
    look_at: "the random generator, where it is seeded",
    remedy: "Let the stream of a pixel depend on the pixel.",
};

/// See its headline.
pub static SAMPLES_REPEAT: Cause = Cause {
    name: "samples-repeat",
    headline: "all samples of a pixel draw the same random numbers",
    look_at: "the random generator, where it is seeded",
    remedy: "Seed once for each pixel, or let the stream depend on the sample too.",
};

/// See its headline.
pub static THREADS_MATTER: Cause = Cause {
    name: "threads-matter",
    headline: "the picture depends on the number of threads",
    look_at: "the random generator, where it is seeded",
    remedy: "Let the stream of a sample depend on its pixel and number, never on the thread that draws it.",
};

/// See its headline.
pub static SEED_PLUS_PIXEL: Cause = Cause {
    name: "seed-plus-pixel",
    headline: "the seed is added to the number of a pixel, so that the next seed repeats the noise one pixel further",
    look_at: "where the generator of a pixel is seeded",
    remedy: "Mix seed, pixel and sample with a hash, not with a sum.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &SEED_IGNORED,
    &NOT_REPRODUCIBLE,
    &PIXELS_SHARE_NOISE,
    &SAMPLES_REPEAT,
    &THREADS_MATTER,
    &SEED_PLUS_PIXEL,
];
