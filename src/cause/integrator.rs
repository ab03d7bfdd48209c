//! Part 4: paths of many bounces, and their random numbers.

use super::{Cause, causes};

causes! {
    ROULETTE_NOT_DIVIDED = "roulette-not-divided":
        "Russian roulette ends paths, and the throughput of survivors is not divided by the survival probability",
        at "indirect light, after the Russian roulette test",
        fix "Divide the throughput by the survival probability.";
    ONE_BOUNCE_SHORT = "one-bounce-short":
        "paths end one bounce too early",
        at "indirect light, where the depth is compared with the maximum depth",
        fix "Bounce m is light scattered m times: the first hit has depth 1.";
    BOUNCE_MISSING = "bounce-missing":
        "one bounce is missing from the accumulated image",
        at "where each bounce's radiance is added to the path's",
        fix "Every bounce up to the maximum depth adds its radiance times the throughput so far.";
    ONE_BOUNCE_LONG = "one-bounce-long":
        "paths go one bounce too far",
        at "indirect light, where the depth is compared with the maximum depth",
        fix "Bounce m is light scattered m times: stop at m vertices.";
    ALBEDO_TWICE = "albedo-twice":
        "the albedo is multiplied in twice at every bounce",
        at "indirect light, where the throughput is updated",
        fix "throughput ← throughput · f · cos θ / pdf, once per bounce.";
    ALBEDO_FORGOTTEN = "throughput-not-multiplied":
        "the throughput is not multiplied by f cos θ / pdf",
        at "indirect light, where the recursion returns or the throughput is updated",
        fix "throughput ← throughput · f · cos θ / pdf, once per bounce.";
    EMISSION_AGAIN = "emission-added-again":
        "emission is counted twice: an emitter that a bounce hits is added, though light sampling has counted it",
        at "indirect light, where the emission of the next hit is added",
        fix "Without MIS, add emission at the camera's first hit and after specular bounces only; next event estimation counts it elsewhere.";
    NO_INDIRECT = "no-indirect-light":
        "there is no indirect light at all",
        at "indirect light: the recursion is not reached, its result is dropped, or the depth is never set",
        fix "From bounce 2 on, light arrives along the continued path.";
    INDIRECT_FOUR_THIRDS = "indirect-cosine-for-uniform":
        "bounces are cosine-weighted, but the pdf is that of uniform ones",
        at "sampling the diffuse BRDF, where direction and pdf are returned together",
        fix "Cosine-weighted directions have pdf cos θ / π.";
    INDIRECT_FACTOR = "factor-per-bounce":
        "every indirect bounce is off by the same constant factor",
        at "indirect light, where f, the cosine, the pdf and the survival probability are put together",
        fix "throughput ← throughput · f · cos θ / pdf / survival probability.";
    INDIRECT_FACTOR_ONCE = "factor-of-indirect-light":
        "all indirect light is off by one constant factor, the same at every bounce",
        at "indirect light, where something is divided or multiplied at the first bounce alone",
        fix "A bounce that is always taken is not divided by a survival probability.";
    GREY_THROUGHPUT = "throughput-without-colour":
        "the throughput is grey: all channels are equal",
        at "indirect light, where the throughput is updated",
        fix "Keep the throughput as RGB; luminance may only set the survival probability.";
    BOUNCE_DIRECTIONS = "bounce-directions-wrong":
        "bounces go in wrong directions: their energy is right, their distribution is not",
        at "indirect light, where the sampled local direction becomes a ray",
        fix "Transform with the local-to-world matrix of the shading frame, not its transpose.";
    FIXED_LENGTH = "fixed-length":
        "a length in the code does not grow with the scene: an offset of rays (ε), or a threshold",
        at "offsets of rays and t_min; thresholds for determinants, distances and areas",
        fix "Take ε relative to what it stands beside: the coordinates of the hit, the edges of a triangle, the distance.";
    EMISSION_LOST = "emission-lost-in-sum":
        "directly visible emission (bounce 0) is missing from the accumulated image",
        at "the sum over bounces, where bounce 0 is added",
        fix "Accumulating from bounce 0 includes the emission that the camera sees.";
    LAST_BOUNCE_ONLY = "last-bounce-only":
        "the accumulated image holds its last bounce only",
        at "the sum over bounces: a flag that isolates bounces, or = instead of +=",
        fix "Accumulate every bounce from the first to the last requested.";
    ROULETTE_DIVIDED_BY_STOP = "roulette-divided-by-stop":
        "the throughput is divided by the termination probability, not the survival probability",
        at "indirect light, after the Russian roulette test",
        fix "Divide by the survival probability, 1 − termination probability.";
    ROULETTE_DIVIDED_WHEN_GUARANTEED = "roulette-divided-when-guaranteed":
        "guaranteed bounces are divided by the survival probability too",
        at "indirect light, where the throughput is divided by the survival probability",
        fix "Divide only where Russian roulette was played.";
    ROULETTE_STOPS_DIRECT = "roulette-stops-direct-light":
        "Russian roulette also removes the direct light of the vertex where it ends the path",
        at "indirect light: Russian roulette comes before direct light is added",
        fix "Add direct light first, then let Russian roulette decide on the next bounce.";
    DEPTH_IGNORED = "depth-ignored":
        "the maximum depth is ignored: paths never end by it",
        at "the depth test of a path",
        fix "Stop after the last bounce requested; beware of 0 − 1 in unsigned integers.";
    ZERO_DEPTH_LIT = "zero-depth-lit":
        "a maximum depth of 0 still shows direct light",
        at "the depth test of a path",
        fix "Depth 0 is directly visible emission, and nothing else.";
    NO_EMISSION_AFTER_SPECULAR = "no-emission-after-specular":
        "emission is not added after a specular bounce: mirrors and glass show no light sources",
        at "indirect light, after a specular bounce (mirror or dielectric)",
        fix "Light sampling cannot reach delta lobes: add the emission at the end of the ray.";
    NO_ENVIRONMENT_AFTER_SPECULAR = "no-environment-after-specular":
        "the environment is not added where a path leaves the scene after a specular bounce",
        at "indirect light, where a ray after a mirror or dielectric hits nothing",
        fix "Light sampling cannot reach delta lobes: add the environment where such a ray escapes.";
    SPECULAR_FLAG_KEPT = "specular-flag-kept":
        "after one specular bounce all light that the path meets is added, though light sampling has counted it",
        at "indirect light, where the flag of a specular bounce is set",
        fix "The flag is of the last bounce alone: a diffuse one takes it back.";
    ISOLATION_IGNORED = "isolation-ignored":
        "a single bounce is requested, and earlier bounces are added too",
        at "indirect light, where the light of a vertex is added",
        fix "Add the light of a vertex only if its bounce is requested.";
    DIRECT_ONLY_WITH_BOUNCE = "direct-only-with-bounce":
        "direct light counts only where the path continues and hits something",
        at "indirect light, where the light of a vertex is added",
        fix "Add the direct light of a vertex before tracing the next ray.";
    WEIGHT_REPLACED = "weight-replaced":
        "the throughput is overwritten by the last bounce's weight instead of multiplied by it",
        at "indirect light, where the throughput is updated",
        fix "throughput *= f cos θ / pdf.";
    BOUNCE_TIMES_PDF = "bounce-times-pdf":
        "bounces are multiplied by their pdf instead of divided",
        at "indirect light, the weight of a bounce",
        fix "Weight = f cos θ / pdf.";
    BOUNCE_WITHOUT_COSINE = "bounce-without-cosine":
        "the weight of a bounce lacks the cosine",
        at "indirect light, the weight of a bounce",
        fix "Weight = f cos θ / pdf.";
    BOUNCE_WORLD_COSINE = "bounce-world-cosine":
        "the cosine of a bounce is taken in world space",
        at "indirect light, the weight of a bounce",
        fix "Take the z component of the local direction.";
    ROULETTE_SURVIVES_BY_STOP = "roulette-survives-by-stop":
        "survival and termination probability are swapped: paths continue with the termination probability",
        at "the Russian roulette test",
        fix "End the path if a random number is below the termination probability.";
    ROULETTE_GUARANTEE_FORGOTTEN = "roulette-guarantee-forgotten":
        "Russian roulette also ends guaranteed bounces",
        at "the Russian roulette test",
        fix "Play it only after the guaranteed bounces.";
    ROULETTE_GUARANTEES_ONE_MORE = "roulette-guarantees-one-more":
        "Russian roulette starts one bounce too late",
        at "the Russian roulette test, where bounces are counted",
        fix "With one guaranteed bounce, the first indirect bounce is spared and the second is not.";
    ROULETTE_PLAYED_ONCE = "roulette-played-once":
        "Russian roulette is played once per path, not at every bounce",
        at "the Russian roulette test",
        fix "Play it at every bounce after the guaranteed ones.";
    ROULETTE_NOT_PLAYED = "roulette-not-played":
        "Russian roulette never ends a path",
        at "the Russian roulette test",
        fix "End paths with the given probability at every bounce after the guaranteed ones.";
    SEED_IGNORED = "seed-ignored":
        "the seed is ignored: every seed gives the same noise",
        at "the random generator, where it is seeded",
        fix "Derive every random stream from the seed.";
    NOT_REPRODUCIBLE = "not-reproducible":
        "the same seed gives different images: the generator depends on a clock or is shared between threads",
        at "the random generator, where it is seeded",
        fix "Seed one stream per pixel and sample, from the seed and their indices.";
    PIXELS_SHARE_NOISE = "pixels-share-noise":
        "all pixels use the same random numbers",
        at "the random generator, where it is seeded",
        fix "Derive a pixel's stream from the pixel's index.";
    SAMPLES_REPEAT = "samples-repeat":
        "all samples of a pixel use the same random numbers",
        at "the random generator, where it is seeded",
        fix "Seed once per pixel, or derive the stream from the sample's index too.";
    THREADS_MATTER = "threads-matter":
        "the image depends on the number of threads",
        at "the random generator, where it is seeded",
        fix "Derive a sample's stream from its pixel and index, never from the thread.";
    SEED_PLUS_PIXEL = "seed-plus-pixel":
        "the seed is added to the pixel index, so the next seed repeats the noise one pixel further",
        at "where a pixel's generator is seeded",
        fix "Combine seed, pixel and sample with a hash, not a sum.";
}
