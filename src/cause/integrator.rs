//! Part 4: paths of many bounces, and their random numbers.

use super::{Cause, causes};

causes! {
    ROULETTE_NOT_DIVIDED = "roulette-not-divided":
        "Russian roulette ends paths, and the survivors are not divided by their chance to survive",
        at "indirect light, after the roulette test",
        fix "Divide by the probability of going on.";
    ONE_BOUNCE_SHORT = "one-bounce-short":
        "paths end one bounce too early",
        at "indirect light, where the depth is compared with the last bounce asked for",
        fix "Bounce m is light that was scattered m times: count the first hit as depth 1.";
    BOUNCE_MISSING = "bounce-missing":
        "the accumulated picture lacks one of its bounces",
        at "where the radiance of each bounce is added to the path's",
        fix "Every bounce up to the last adds its light, weighted with the throughput so far.";
    ONE_BOUNCE_LONG = "one-bounce-long":
        "paths go one bounce too far",
        at "indirect light, where the depth is compared with the last bounce asked for",
        fix "Bounce m is light that was scattered m times: stop when m vertices were reached.";
    ALBEDO_TWICE = "albedo-twice":
        "the albedo is multiplied in twice at every bounce",
        at "indirect light, where the throughput is updated",
        fix "throughput ← throughput · f · cos θ / pdf, once a bounce.";
    ALBEDO_FORGOTTEN = "throughput-not-multiplied":
        "the throughput is not multiplied by f cos θ / pdf",
        at "indirect light, where the recursion returns or the throughput is updated",
        fix "throughput ← throughput · f · cos θ / pdf, once a bounce.";
    EMISSION_AGAIN = "emission-added-again":
        "emission met by a bounce is added although the light was sampled already",
        at "indirect light, where the next hit's own glow is added",
        fix "Add emission at the first hit and after mirror or glass only; elsewhere light sampling has counted it.";
    NO_INDIRECT = "no-indirect-light":
        "there is no indirect light at all",
        at "indirect light: the recursion is not reached, its result is dropped, or the depth is never set",
        fix "From bounce 2 on light has to arrive over the continued path.";
    INDIRECT_FOUR_THIRDS = "indirect-cosine-for-uniform":
        "bounces are drawn with the cosine and weighted with the uniform density",
        at "sampling the diffuse surface, where direction and pdf are returned together",
        fix "Cosine-distributed directions have pdf cos θ / π.";
    INDIRECT_FACTOR = "factor-per-bounce":
        "every indirect bounce has the same constant factor too much",
        at "indirect light, where f, the cosine, the pdf and the survival probability are put together",
        fix "throughput ← throughput · f · cos θ / pdf / survival.";
    GREY_THROUGHPUT = "throughput-without-colour":
        "the throughput of paths has lost its colour",
        at "indirect light, where the throughput is updated",
        fix "Keep the throughput as RGB; luminance may only steer the roulette.";
    BOUNCE_DIRECTIONS = "bounce-directions-wrong":
        "bounces go in wrong directions: how much light there is is right, where it goes is not",
        at "indirect light, where the sampled local direction becomes a ray",
        fix "Transform with the frame's local-to-world matrix (o2w), not its transpose.";
    EMISSION_LOST = "emission-lost-in-sum":
        "the accumulated picture leaves out what glows by itself",
        at "the sum of bounces, where bounce 0 is added",
        fix "Accumulating from 0 adds the emission that the camera sees.";
    LAST_BOUNCE_ONLY = "last-bounce-only":
        "the accumulated picture holds its last bounce only",
        at "the sum of bounces: a flag that isolates bounces, or = where += belongs",
        fix "Accumulating adds every bounce from the first to the last asked for.";
    ROULETTE_DIVIDED_BY_STOP = "roulette-divided-by-stop":
        "paths that survive roulette are divided by the probability of stopping",
        at "indirect light, after the roulette test",
        fix "Divide by the probability of going on, 1 − stop.";
    ROULETTE_DIVIDED_WHEN_GUARANTEED = "roulette-divided-when-guaranteed":
        "the bounces that are guaranteed are divided by the survival probability too",
        at "indirect light, where the throughput is divided",
        fix "Divide only where roulette was played.";
    ROULETTE_STOPS_DIRECT = "roulette-stops-direct-light":
        "roulette also takes the direct light of the vertex it stops at",
        at "indirect light: roulette is played before direct light is added",
        fix "Add direct light first, then play roulette for going on.";
    DEPTH_IGNORED = "depth-ignored":
        "the last bounce is not looked at: paths go on and on",
        at "the depth of a path",
        fix "Stop after the last bounce that is asked for; count up, or beware of 0 − 1 with unsigned numbers.";
    ZERO_DEPTH_LIT = "zero-depth-lit":
        "with no bounces asked for, light of the first bounce is shown all the same",
        at "the depth of a path",
        fix "Bounces 0 to 0 are what glows by itself, and nothing else.";
    MIRROR_SHOWS_NO_LIGHT = "mirror-shows-no-light":
        "what glows is not seen in mirrors and through glass",
        at "indirect light, after a mirror or glass",
        fix "No light can be sampled there: add what glows at the end of the ray.";
    ISOLATION_IGNORED = "isolation-ignored":
        "a single bounce is asked for, and those before it are added too",
        at "indirect light, where the light of a vertex is added",
        fix "Add the light of a vertex only if its bounce is asked for.";
    DIRECT_ONLY_WITH_BOUNCE = "direct-only-with-bounce":
        "direct light counts only where the path goes on and hits something",
        at "indirect light, where the light of a vertex is added",
        fix "Add the direct light of a vertex before the next ray is traced.";
    WEIGHT_REPLACED = "weight-replaced":
        "the throughput is set to the weight of the last bounce instead of multiplied by it",
        at "indirect light, where the throughput is updated",
        fix "throughput *= f cos θ / pdf.";
    BOUNCE_TIMES_PDF = "bounce-times-pdf":
        "bounces are multiplied by their density where they should be divided",
        at "indirect light, the weight of a bounce",
        fix "Weight = f cos θ / pdf.";
    BOUNCE_WITHOUT_COSINE = "bounce-without-cosine":
        "the cosine is missing in the weight of a bounce",
        at "indirect light, the weight of a bounce",
        fix "Weight = f cos θ / pdf.";
    BOUNCE_WORLD_COSINE = "bounce-world-cosine":
        "the cosine of a bounce is taken in world space",
        at "indirect light, the weight of a bounce",
        fix "Take the local direction's z.";
    ROULETTE_SURVIVES_BY_STOP = "roulette-survives-by-stop":
        "paths go on with the probability of stopping",
        at "the roulette test",
        fix "Stop if a random number is below the probability of stopping.";
    ROULETTE_GUARANTEE_FORGOTTEN = "roulette-guarantee-forgotten":
        "roulette is played also at the bounces that are guaranteed",
        at "the roulette test",
        fix "Play it only after the guaranteed bounces.";
    ROULETTE_GUARANTEES_ONE_MORE = "roulette-guarantees-one-more":
        "roulette begins one bounce too late",
        at "the roulette test, where bounces are counted",
        fix "With one guaranteed bounce, the first indirect one is spared and the second is not.";
    ROULETTE_PLAYED_ONCE = "roulette-played-once":
        "roulette is played once, and never again on the same path",
        at "the roulette test",
        fix "Play it at every bounce after the guaranteed ones.";
    ROULETTE_NOT_PLAYED = "roulette-not-played":
        "roulette never stops a path",
        at "the roulette test",
        fix "Stop with the given probability at every bounce after the guaranteed ones.";
    SEED_IGNORED = "seed-ignored":
        "the seed is ignored: every seed gives the same noise",
        at "the random generator, where it is seeded",
        fix "Let every stream depend on the seed.";
    NOT_REPRODUCIBLE = "not-reproducible":
        "the same seed gives other numbers each time: a clock or a shared generator is in them",
        at "the random generator, where it is seeded",
        fix "Seed a stream of its own for each pixel and sample, from the seed and their numbers.";
    PIXELS_SHARE_NOISE = "pixels-share-noise":
        "all pixels draw the same random numbers",
        at "the random generator, where it is seeded",
        fix "Let the stream of a pixel depend on the pixel.";
    SAMPLES_REPEAT = "samples-repeat":
        "all samples of a pixel draw the same random numbers",
        at "the random generator, where it is seeded",
        fix "Seed once for each pixel, or let the stream depend on the sample too.";
    THREADS_MATTER = "threads-matter":
        "the picture depends on the number of threads",
        at "the random generator, where it is seeded",
        fix "Let the stream of a sample depend on its pixel and number, never on the thread that draws it.";
    SEED_PLUS_PIXEL = "seed-plus-pixel":
        "the seed is added to the number of a pixel, so that the next seed repeats the noise one pixel further",
        at "where the generator of a pixel is seeded",
        fix "Mix seed, pixel and sample with a hash, not with a sum.";
}
