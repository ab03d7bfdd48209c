//! Part 4: paths of many bounces.

use super::Cause;

/// See its headline.
pub static ROULETTE_NOT_DIVIDED: Cause = Cause {
    name: "roulette-not-divided",
    headline: "Russian roulette ends paths, and the survivors are not divided by their chance to survive",
    look_at: "indirect light, after the roulette test",
    remedy: "Divide by the probability of going on.",
};

/// See its headline.
pub static ONE_BOUNCE_SHORT: Cause = Cause {
    name: "one-bounce-short",
    headline: "paths end one bounce too early",
    look_at: "indirect light, where the depth is compared with the last bounce asked for",
    remedy: "Bounce m is light that was scattered m times: count the first hit as depth 1.",
};

/// See its headline.
pub static BOUNCE_MISSING: Cause = Cause {
    name: "bounce-missing",
    headline: "the accumulated picture lacks one of its bounces",
    look_at: "where the radiance of each bounce is added to the path's",
    remedy: "Every bounce up to the last adds its light, weighted with the throughput so far.",
};

/// See its headline.
pub static ONE_BOUNCE_LONG: Cause = Cause {
    name: "one-bounce-long",
    headline: "paths go one bounce too far",
    look_at: "indirect light, where the depth is compared with the last bounce asked for",
    remedy: "Bounce m is light that was scattered m times: stop when m vertices were reached.",
};

/// See its headline.
pub static ALBEDO_TWICE: Cause = Cause {
    name: "albedo-twice",
    headline: "the albedo is multiplied in twice at every bounce",
    look_at: "indirect light, where the throughput is updated",
    remedy: "throughput ← throughput · f · cos θ / pdf, once a bounce.",
};

/// See its headline.
pub static ALBEDO_FORGOTTEN: Cause = Cause {
    name: "throughput-not-multiplied",
    headline: "the throughput is not multiplied by f cos θ / pdf",
    look_at: "indirect light, where the recursion returns or the throughput is updated",
    remedy: "throughput ← throughput · f · cos θ / pdf, once a bounce.",
};

/// See its headline.
pub static EMISSION_AGAIN: Cause = Cause {
    name: "emission-added-again",
    headline: "emission met by a bounce is added although the light was sampled already",
    look_at: "indirect light, where the next hit's own glow is added",
    remedy: "Add emission at the first hit and after mirror or glass only; elsewhere light sampling has counted it.",
};

/// See its headline.
pub static NO_INDIRECT: Cause = Cause {
    name: "no-indirect-light",
    headline: "there is no indirect light at all",
    look_at: "indirect light: the recursion is not reached, its result is dropped, or the depth is never set",
    remedy: "From bounce 2 on light has to arrive over the continued path.",
};

/// See its headline.
pub static INDIRECT_FOUR_THIRDS: Cause = Cause {
    name: "indirect-cosine-for-uniform",
    headline: "bounces are drawn with the cosine and weighted with the uniform density",
    look_at: "sampling the diffuse surface, where direction and pdf are returned together",
    remedy: "Cosine-distributed directions have pdf cos θ / π.",
};

/// See its headline.
pub static INDIRECT_FACTOR: Cause = Cause {
    name: "factor-per-bounce",
    headline: "every indirect bounce has the same constant factor too much",
    look_at: "indirect light, where f, the cosine, the pdf and the survival probability are put together",
    remedy: "throughput ← throughput · f · cos θ / pdf / survival.",
};

/// See its headline.
pub static GREY_THROUGHPUT: Cause = Cause {
    name: "throughput-without-colour",
    headline: "the throughput of paths has lost its colour",
    look_at: "indirect light, where the throughput is updated",
    remedy: "Keep the throughput as RGB; luminance may only steer the roulette.",
};

/// See its headline.
pub static BOUNCE_DIRECTIONS: Cause = Cause {
    name: "bounce-directions-wrong",
    headline: "bounces go in wrong directions: how much light there is is right, where it goes is not",
    look_at: "indirect light, where the sampled local direction becomes a ray",
    remedy: "Transform with the frame's local-to-world matrix (o2w), not its transpose.",
};

/// See its headline.
pub static EMISSION_LOST: Cause = Cause {
    name: "emission-lost-in-sum",
    headline: "the accumulated picture leaves out what glows by itself",
    look_at: "the sum of bounces, where bounce 0 is added",
    remedy: "Accumulating from 0 adds the emission that the camera sees.",
};

/// See its headline.
pub static LAST_BOUNCE_ONLY: Cause = Cause {
    name: "last-bounce-only",
    headline: "the accumulated picture holds its last bounce only",
    look_at: "the sum of bounces: a flag that isolates bounces, or = where += belongs",
    remedy: "Accumulating adds every bounce from the first to the last asked for.",
};

/// See its headline.
pub static ROULETTE_DIVIDED_BY_STOP: Cause = Cause {
    name: "roulette-divided-by-stop",
    headline: "paths that survive roulette are divided by the probability of stopping",
    look_at: "indirect light, after the roulette test",
    remedy: "Divide by the probability of going on, 1 − stop.",
};

/// See its headline.
pub static ROULETTE_DIVIDED_WHEN_GUARANTEED: Cause = Cause {
    name: "roulette-divided-when-guaranteed",
    headline: "the bounces that are guaranteed are divided by the survival probability too",
    look_at: "indirect light, where the throughput is divided",
    remedy: "Divide only where roulette was played.",
};

/// See its headline.
pub static ROULETTE_STOPS_DIRECT: Cause = Cause {
    name: "roulette-stops-direct-light",
    headline: "roulette also takes the direct light of the vertex it stops at",
    look_at: "indirect light: roulette is played before direct light is added",
    remedy: "Add direct light first, then play roulette for going on.",
};

/// See its headline.
pub static DEPTH_IGNORED: Cause = Cause {
    name: "depth-ignored",
    headline: "the last bounce is not looked at: paths go on and on",
    look_at: "the depth of a path",
    remedy: "Stop after the last bounce that is asked for; count up, or beware of 0 − 1 with unsigned numbers.",
};

/// See its headline.
pub static ZERO_DEPTH_LIT: Cause = Cause {
    name: "zero-depth-lit",
    headline: "with no bounces asked for, light of the first bounce is shown all the same",
    look_at: "the depth of a path",
    remedy: "Bounces 0 to 0 are what glows by itself, and nothing else.",
};

/// See its headline.
pub static MIRROR_SHOWS_NO_LIGHT: Cause = Cause {
    name: "mirror-shows-no-light",
    headline: "what glows is not seen in mirrors and through glass",
    look_at: "indirect light, after a mirror or glass",
    remedy: "No light can be sampled there: add what glows at the end of the ray.",
};

/// See its headline.
pub static ISOLATION_IGNORED: Cause = Cause {
    name: "isolation-ignored",
    headline: "a single bounce is asked for, and those before it are added too",
    look_at: "indirect light, where the light of a vertex is added",
    remedy: "Add the light of a vertex only if its bounce is asked for.",
};

/// See its headline.
pub static DIRECT_ONLY_WITH_BOUNCE: Cause = Cause {
    name: "direct-only-with-bounce",
    headline: "direct light counts only where the path goes on and hits something",
    look_at: "indirect light, where the light of a vertex is added",
    remedy: "Add the direct light of a vertex before the next ray is traced.",
};

/// See its headline.
pub static WEIGHT_REPLACED: Cause = Cause {
    name: "weight-replaced",
    headline: "the throughput is set to the weight of the last bounce instead of multiplied by it",
    look_at: "indirect light, where the throughput is updated",
    remedy: "throughput *= f cos θ / pdf.",
};

/// See its headline.
pub static BOUNCE_TIMES_PDF: Cause = Cause {
    name: "bounce-times-pdf",
    headline: "bounces are multiplied by their density where they should be divided",
    look_at: "indirect light, the weight of a bounce",
    remedy: "Weight = f cos θ / pdf.",
};

/// See its headline.
pub static BOUNCE_WITHOUT_COSINE: Cause = Cause {
    name: "bounce-without-cosine",
    headline: "the cosine is missing in the weight of a bounce",
    look_at: "indirect light, the weight of a bounce",
    remedy: "Weight = f cos θ / pdf.",
};

/// See its headline.
pub static BOUNCE_WORLD_COSINE: Cause = Cause {
    name: "bounce-world-cosine",
    headline: "the cosine of a bounce is taken in world space",
    look_at: "indirect light, the weight of a bounce",
    remedy: "Take the local direction's z.",
};

/// See its headline.
pub static ROULETTE_SURVIVES_BY_STOP: Cause = Cause {
    name: "roulette-survives-by-stop",
    headline: "paths go on with the probability of stopping",
    look_at: "the roulette test",
    remedy: "Stop if a random number is below the probability of stopping.",
};

/// See its headline.
pub static ROULETTE_GUARANTEE_FORGOTTEN: Cause = Cause {
    name: "roulette-guarantee-forgotten",
    headline: "roulette is played also at the bounces that are guaranteed",
    look_at: "the roulette test",
    remedy: "Play it only after the guaranteed bounces.",
};

/// See its headline.
pub static ROULETTE_GUARANTEES_ONE_MORE: Cause = Cause {
    name: "roulette-guarantees-one-more",
    headline: "roulette begins one bounce too late",
    look_at: "the roulette test, where bounces are counted",
    remedy: "With one guaranteed bounce, the first indirect one is spared and the second is not.",
};

/// See its headline.
pub static ROULETTE_PLAYED_ONCE: Cause = Cause {
    name: "roulette-played-once",
    headline: "roulette is played once, and never again on the same path",
    look_at: "the roulette test",
    remedy: "Play it at every bounce after the guaranteed ones.",
};

/// See its headline.
pub static ROULETTE_NOT_PLAYED: Cause = Cause {
    name: "roulette-not-played",
    headline: "roulette never stops a path",
    look_at: "the roulette test",
    remedy: "Stop with the given probability at every bounce after the guaranteed ones.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &ROULETTE_NOT_DIVIDED,
    &ONE_BOUNCE_SHORT,
    &BOUNCE_MISSING,
    &ONE_BOUNCE_LONG,
    &ALBEDO_TWICE,
    &ALBEDO_FORGOTTEN,
    &EMISSION_AGAIN,
    &NO_INDIRECT,
    &INDIRECT_FOUR_THIRDS,
    &INDIRECT_FACTOR,
    &GREY_THROUGHPUT,
    &BOUNCE_DIRECTIONS,
    &EMISSION_LOST,
    &LAST_BOUNCE_ONLY,
    &ROULETTE_DIVIDED_BY_STOP,
    &ROULETTE_DIVIDED_WHEN_GUARANTEED,
    &ROULETTE_STOPS_DIRECT,
    &DEPTH_IGNORED,
    &ZERO_DEPTH_LIT,
    &MIRROR_SHOWS_NO_LIGHT,
    &ISOLATION_IGNORED,
    &DIRECT_ONLY_WITH_BOUNCE,
    &WEIGHT_REPLACED,
    &BOUNCE_TIMES_PDF,
    &BOUNCE_WITHOUT_COSINE,
    &BOUNCE_WORLD_COSINE,
    &ROULETTE_SURVIVES_BY_STOP,
    &ROULETTE_GUARANTEE_FORGOTTEN,
    &ROULETTE_GUARANTEES_ONE_MORE,
    &ROULETTE_PLAYED_ONCE,
    &ROULETTE_NOT_PLAYED,
];
