/* furnace_core.h: the C boundary between the test bench and a renderer core.
 *
 * A core is a shared library with ONE exported symbol:
 *
 *     FURNACE_EXPORT const furnace_core *furnace_core_entry(uint32_t bench_abi);
 *
 * In C++ include furnace_core.hpp instead: it asks for one function a ray at a time and makes this
 * table of them.
 *
 * Rules, once for all
 *   - Plain C99: fixed-width integers, double, no bool, no bit-fields, no hidden padding; 64-bit
 *     machines.
 *   - The caller allocates every buffer; `out[i]` answers `in[i]`, and every element must be
 *     written: what is left untouched is seen. A core keeps no pointer past the return of the call,
 *     and frees nothing it was given.
 *   - A null function means "not supported": the checks that need it are skipped, and the report
 *     says so.
 *   - One call at a time. A core may use threads inside a call (`furnace_integrator.threads` says
 *     how many).
 *   - Never let a C++ exception out. Return a status and explain it in `last_error`.
 *   - stdout and stderr belong to the core: print what you like. Answers do not travel there.
 *   - The core runs in a process of its own that may read itself and the system's libraries, write
 *     its working folder, start threads but no processes, and reach no network. If it dies, that is
 *     one trial's result.
 *   - Lengths are scene units, angles radians, colours linear RGB. Directions are unit length
 *     unless a field says otherwise. BSDF directions are in the local shading frame (normal = +z)
 *     and both point away from the surface; `f` excludes the cosine; every `pdf` is per steradian.
 *
 * What verdicts rest on
 *   - Radiance is judged by its mean: how an estimate is made, how noisy it is, and whether it is
 *     below 0 (control variates), is the core's own business, as long as its variance is finite.
 *     Where there is no light, every estimate is exactly 0; every pixel of a picture is at least 0.
 *   - What a ray sees emitted (bounces 0..0) is no estimate: it is compared without room for noise.
 *   - Different seeds give different random numbers, and the answers of one call to the same ray
 *     are independent. Whether pixels, directions and points are independent of each other is free
 *     (see the promises of furnace_core.traits).
 *   - The value of a pixel is the plain mean of its samples, which are uniform over its square (box
 *     filter). Adaptive sampling goes by 0.2126 R + 0.7152 G + 0.0722 B.
 *   - Emission leaves by the geometric normal; the shading normal gives the cosine, and what mirrors
 *     and glass reflect about. Where the two disagree about a side, either may decide.
 *
 * Growing: only structs that carry `struct_size` grow, at their end, and that field tells each side
 * how much the other knows; they always travel by pointer. Values and array elements are frozen.
 * FURNACE_ABI changes only when something existing does. Reserved fields are zero.
 */
#ifndef FURNACE_CORE_H
#define FURNACE_CORE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#pragma message("-ffast-math assumes that nothing is infinite; t_max and distances may be: add -fno-finite-math-only")
#endif

#define FURNACE_ABI 1u
#define FURNACE_NONE UINT32_MAX

#if defined(_WIN32)
#define FURNACE_EXPORT __declspec(dllexport)
#else
#define FURNACE_EXPORT __attribute__((visibility("default")))
#endif

typedef uint32_t furnace_status;
enum {
   FURNACE_OK = 0,
   FURNACE_UNSUPPORTED = 1, /* this very request, e.g. an unknown material: skipped, not failed */
   FURNACE_INVALID = 2,     /* the arguments make no sense to the core */
   FURNACE_FAILED = 3       /* anything else; `last_error` explains it, and FURNACE_INVALID too */
};

/* ---- values: frozen ------------------------------------------------------------------------ */

typedef struct furnace_vec2 { double x, y; } furnace_vec2;
typedef struct furnace_vec3 { double x, y, z; } furnace_vec3;
typedef struct furnace_rgb { double r, g, b; } furnace_rgb;

/* The points origin + t * direction with t_min < t < t_max, where 0 <= t_min. */
typedef struct furnace_ray {
   furnace_vec3 origin;
   double       t_min;
   furnace_vec3 direction; /* any length but zero; unit where a camera made it */
   double       t_max;     /* may be infinite */
} furnace_ray;

/* The nearest hit; primitive == FURNACE_NONE is a miss, and then nothing else is read. */
typedef struct furnace_hit {
   double       t;                /* in units of |direction| */
   uint32_t     shape;            /* meshes first, then spheres */
   uint32_t     primitive;        /* triangle of the mesh; 0 for a sphere */
   furnace_vec3 geometric_normal; /* unit, on the winding order's side, not flipped to the ray */
   furnace_vec3 shading_normal;   /* unit, interpolated from vertex normals where there are any */
   furnace_vec2 uv;               /* triangle: barycentric weights of vertices 1 and 2 */
} furnace_hit;

/* Where the line of a ray enters and leaves a box; read only where `hit` is 1. */
typedef struct furnace_box_hit {
   double   t_enter, t_exit;
   uint32_t hit; /* 1: the closed box meets the closed segment [t_min, t_max]; 0: it does not */
   uint32_t reserved;
} furnace_box_hit;

typedef struct furnace_direction_sample {
   furnace_vec3 direction; /* hemisphere around +z */
   double       pdf;
} furnace_direction_sample;

typedef struct furnace_bsdf_query { furnace_vec3 wo, wi; } furnace_bsdf_query;

typedef struct furnace_bsdf_value {
   furnace_rgb f;
   double      pdf; /* around wi, given wo */
} furnace_bsdf_value;

typedef struct furnace_bsdf_sample {
   furnace_vec3 wi;
   furnace_rgb  f;        /* delta lobe: such that f * |cos(wi)| / pdf is the weight of the path */
   double       pdf;      /* delta lobe: the probability of having chosen it */
   uint32_t     is_delta; /* 1: the only direction of a mirror or of glass */
   uint32_t     is_valid; /* 0: sampling failed, the sample counts as zero */
} furnace_bsdf_sample;

typedef struct furnace_light_sample {
   furnace_vec3 wi;       /* towards the light, world space */
   double       distance; /* infinite for skies and directional lights */
   furnace_rgb  radiance; /* delta light: such that radiance * f * cos is what is reflected */
   double       pdf;      /* 1 for a delta light */
   uint32_t     is_delta; /* 1: a point or directional light */
   uint32_t     is_valid; /* 0: sampling failed, the sample counts as zero, as one without radiance does */
} furnace_light_sample;

/* What the adaptive stopping rule made of one stream. */
typedef struct furnace_adaptive_mean {
   double   mean;
   uint32_t used;
   uint32_t reserved;
} furnace_adaptive_mean;

/* The luminances of one pixel's samples, in order; `count` is the sample cap. */
typedef struct furnace_stream {
   const double *values;
   uint64_t      count;
} furnace_stream;

/* Work done by one batch, summed over its rays; zero when the call begins. Leave zero what you do
 * not count. */
typedef struct furnace_traversal_stats {
   uint64_t rays, box_tests, primitive_tests;
} furnace_traversal_stats;

/* What the build made; zero when the call begins. Leave zero what you do not know. `nodes` counts inner nodes and
 * leaves; a root alone has a `max_depth` of 1. */
typedef struct furnace_build_stats {
   uint64_t nodes, leaves, max_depth, bytes;
} furnace_build_stats;

/* Random numbers in [0, 1) for each element of a batch. A core that draws its own ignores `points`
 * and `lobes`, leaves out FURNACE_CALLERS_RANDOMNESS, and seeds itself from `seed` at the beginning
 * of the call. */
typedef struct furnace_randomness {
   const furnace_vec2 *points; /* the direction, or the point on the light */
   const double       *lobes;  /* which lobe, or which triangle of a mesh light */
   uint64_t            seed;
} furnace_randomness;

enum { /* which sampler of directions */
   FURNACE_UNIFORM_HEMISPHERE = 0,
   FURNACE_COSINE_HEMISPHERE = 1
};

/* ---- the scene ----------------------------------------------------------------------------- */

/* Film point (x, y) of [0, 1]^2, (0, 0) at the bottom left, looks along
 * (2x - 1) tan(h/2) right + (2y - 1) tan(v/2) up - backward. */
typedef struct furnace_camera {
   uint32_t     struct_size, reserved;
   furnace_vec3 position;
   furnace_vec3 right, up, backward;          /* orthonormal: the columns of camera-to-world */
   double       horizontal_fov, vertical_fov; /* whole angles */
   double       near_clip, far_clip;          /* t_min and t_max of every ray */
   uint32_t     film_width, film_height;      /* pixels, where a request does not say otherwise */
} furnace_camera;

enum { /* furnace_material.kind */
   FURNACE_DIFFUSE = 0,  /* f = reflectance / pi */
   FURNACE_MIRROR = 1,   /* reflectance, the same at every angle */
   FURNACE_GLASS = 2,    /* smooth; vacuum on the side of the normal, `index` behind it */
   FURNACE_CONDUCTOR = 3, /* GGX microfacets, alpha = `roughness`, of Fresnel reflectance `reflectance` */
   /* rough dielectric: GGX microfacets, alpha = `roughness`, with the Fresnel equations; asked only of
    * cores with FURNACE_KNOWS_ROUGH_GLASS */
   FURNACE_ROUGH_GLASS = 4
};

/* Diffuse, mirror and conductor scatter on both sides; emission leaves the front side only. */
typedef struct furnace_material {
   const char  *name;           /* for messages: what it is called where it is handed over */
   uint32_t     kind;
   uint32_t     emits;          /* 1: an emitter of radiance `emission`; 0: no emission */
   furnace_rgb  reflectance;    /* fraction of light reflected; glass: times the Fresnel reflectance */
   furnace_rgb  transmittance;  /* glass, smooth or rough: times 1 - Fresnel reflectance */
   double       index;          /* glass, smooth or rough: index of refraction inside */
   double       roughness;      /* conductor, rough glass: alpha in (0, 1] */
   furnace_rgb  emission;       /* radiance in every direction of the front side */
   furnace_vec3 cap_axis;       /* on a sphere: only the cap within cap_half_angle of it emits */
   double       cap_half_angle; /* 0: all of it emits */
   double       reserved[4];
} furnace_material;

typedef struct furnace_mesh {
   const char         *name;
   const furnace_vec3 *positions; /* vertex_count, world space */
   const furnace_vec3 *normals;   /* vertex_count unit shading normals, or null for flat faces */
   const uint32_t     *indices;   /* 3 * triangle_count, counter-clockwise seen from the front */
   uint32_t            vertex_count, triangle_count;
   uint32_t            material, reserved;
} furnace_mesh;

typedef struct furnace_sphere {
   const char  *name;
   furnace_vec3 centre;
   double       radius;
   uint32_t     inward; /* 1: normals (and so the front) point to the centre: a sphere seen from inside */
   uint32_t     material;
} furnace_sphere;

enum { /* furnace_light.kind, and what its fields mean */
   FURNACE_POINT = 0,        /* place = position, radiance = watts per steradian */
   FURNACE_DIRECTIONAL = 1,  /* place = the way light travels, radiance = irradiance facing it */
   FURNACE_CONSTANT_SKY = 2, /* radiance from every direction that meets no shape */
   FURNACE_GRADIENT_SKY = 3, /* place = up; from w: radiance + (zenith - radiance) * max(0, up.w) */
   FURNACE_AREA = 4          /* the shape numbered `shape`, whose material emits */
};

typedef struct furnace_light {
   uint32_t     kind, shape;
   furnace_vec3 place;
   furnace_rgb  radiance;
   furnace_rgb  zenith;
   double       reserved[2];
} furnace_light;

/* Shapes are numbered meshes first, then spheres; lights as `lights` lists them, every shape that emits among
 * them. Every run turns and relabels its scenes by its seed, and rays, points and cameras turn along: names say
 * nothing of a case. */
typedef struct furnace_scene {
   uint32_t struct_size;
   uint32_t material_count, mesh_count, sphere_count, light_count, reserved;
   const char             *name;
   const furnace_camera   *camera; /* null if the scene names none */
   const furnace_material *materials;
   const furnace_mesh     *meshes;
   const furnace_sphere   *spheres;
   const furnace_light    *lights;
} furnace_scene;

/* ---- how a core is asked ------------------------------------------------------------------- */

enum { /* furnace_build.split */
   FURNACE_SPLIT_CORES_CHOICE = 0,
   FURNACE_SPLIT_MEDIAN = 1,            /* equal counts along the longest axis */
   FURNACE_SPLIT_MEAN_OF_CENTROIDS = 2, /* at the mean of the centroids along the longest axis */
   FURNACE_SPLIT_MIDPOINT = 3,          /* at the middle of the box of centroids along it */
   FURNACE_SPLIT_SURFACE_AREA = 4
};

/* The bench's own ray tests, which count themselves. A core with FURNACE_COUNTED_TESTS calls them, where
 * it is handed them, for every ray of `intersect` and `occluded` in place of its own, and cannot
 * miscount: a hit that none of them has found breaks the contract, and so does a counter that they have
 * not set. They live as long as the built scene, and may be called from any thread. */
typedef struct furnace_counted_tests {
   uint32_t struct_size, reserved;
   void    *bench; /* handed back as the first argument */
   /* 1 and *hit, if the ray meets that primitive strictly between t_min and t_max; else 0. */
   uint32_t (*primitive)(void *bench, uint32_t shape, uint32_t primitive, const furnace_ray *ray,
                         furnace_hit *hit);
   /* 1 and *hit, if the segment meets the closed box; else 0. */
   uint32_t (*box)(void *bench, const furnace_vec3 *min, const furnace_vec3 *max,
                   const furnace_ray *ray, furnace_box_hit *hit);
} furnace_counted_tests;

struct furnace_built;      /* below: a scene that a core, or the bench, has taken in */
struct furnace_components; /* below */

typedef struct furnace_build {
   uint32_t struct_size;
   uint32_t accelerate;    /* 0: a loop over every primitive, brute force, the baseline of every BVH */
   uint32_t split;         /* FURNACE_SPLIT_CORES_CHOICE unless the core has FURNACE_SPLIT_RULES */
   uint32_t max_leaf_size; /* primitives in a leaf, as far as they can be told apart */
   const furnace_counted_tests *counted; /* null unless the core has FURNACE_COUNTED_TESTS; with
                                          * FURNACE_OWN_TESTS null, too, where nothing is counted */
   /* The same scene as the bench has built it, for the functions of furnace_components.bench that
    * want one; it lives as long as the built scene. Null if nothing is taken. */
   struct furnace_built *bench;
} furnace_build;

typedef struct furnace_integrator {
   uint32_t struct_size;
   /* Light samples (shadow rays) to each area or environment light; a delta light always gets one.
    * Hemisphere sampling: this many directions for each light that is not a delta light. */
   uint32_t samples_per_light;
   /* Bounces added up: 0..0 emission, 1..1 direct light, 0..m everything up to depth m. */
   uint32_t first_bounce, last_bounce;
   /* 1: uniform hemisphere sampling, adding the emission that directions hit; 0: light sampling
    * (next event estimation). Delta lights are sampled either way; a mirror or glass adds the emission
    * that its one direction hits either way. */
   uint32_t by_hemisphere;
   uint32_t threads;             /* 0: as many as you like; the answer must not depend on it */
   double   roulette_stop;       /* termination probability of Russian roulette; 0: no roulette */
   uint32_t roulette_guaranteed; /* continuations before it is played: 1 is one indirect bounce */
   /* 1, of a core with FURNACE_DEPTH_LIMIT: what its renderer shows if last_bounce is its maximum
    * depth; first_bounce is 0. */
   uint32_t by_depth;
   uint64_t seed; /* the only source of randomness */
} furnace_integrator;

/* After every batch, with mean m and sample standard deviation s (n - 1) of the n luminances so
 * far: stop if 1.96 s / sqrt(n) <= max_tolerance * m. */
typedef struct furnace_adaptive {
   uint32_t struct_size;
   uint32_t samples_per_batch;
   double   max_tolerance;
} furnace_adaptive;

typedef struct furnace_render {
   uint32_t struct_size;
   uint32_t width, height;
   uint32_t samples_per_pixel; /* the maximum, if adaptive */
   const furnace_integrator *integrator;
   const furnace_adaptive   *adaptive; /* null: off */
   /* Of a core with FURNACE_REPORTED_VARIANCE, else null: where it writes width * height RGB triples,
    * top row first: the estimated variance of each value of the image, that is of the mean written
    * there and not of one sample, in radiance squared; 0 where one sample says nothing. */
   float *variances;
   /* 1, of a core with FURNACE_STRATIFIED_PIXELS: samples_per_pixel is k * k, and of a pixel's samples
    * one lies in each cell of a grid of k by k. 0: they lie as the core likes. */
   uint32_t stratified, reserved;
} furnace_render;

/* ---- the core ------------------------------------------------------------------------------ */

enum { /* furnace_core.traits: what no function pointer can say */
   FURNACE_BRUTE_FORCE = 1u << 0,         /* build honours accelerate == 0 */
   FURNACE_SPLIT_RULES = 1u << 1,         /* build honours `split` */
   FURNACE_HEMISPHERE_SAMPLING = 1u << 2, /* by_hemisphere is honoured */
   FURNACE_ISOLATED_BOUNCES = 1u << 3,    /* first_bounce > 0 is honoured */
   FURNACE_ROULETTE = 1u << 4,            /* roulette_stop is honoured; survival may have a probability of
                                           * your own, by which you divide, without PLAIN_ESTIMATORS */
   FURNACE_ADAPTIVE_SAMPLING = 1u << 5,   /* render honours `adaptive` and fills sample_counts */
   FURNACE_COUNTS_TRAVERSAL = 1u << 6,    /* traversal stats are real; needless beside COUNTED_TESTS */
   FURNACE_COUNTED_TESTS = 1u << 7,       /* traversal uses furnace_build.counted */
   FURNACE_CALLERS_RANDOMNESS = 1u << 8,  /* sampling uses the caller's numbers: replayable */
   FURNACE_DETERMINISTIC = 1u << 9,       /* the same settings and seed give the same bits */
   FURNACE_SINGLE_PRECISION = 1u << 10,   /* computes in float: tolerances are wider */
   FURNACE_KNOWS_ROUGH_GLASS = 1u << 11,  /* knows FURNACE_ROUGH_GLASS: without it, it is not shown */
   FURNACE_REPORTED_VARIANCE = 1u << 12,  /* render fills furnace_render.variances */
   FURNACE_STRATIFIED_PIXELS = 1u << 13,  /* render honours `stratified` */
   /* Promises. What follows is free: a core that promises nothing is told what was found, and not graded by it. */
   FURNACE_INDEPENDENT_PIXELS = 1u << 14,  /* the noise of one pixel says nothing of another's */
   FURNACE_INDEPENDENT_SAMPLES = 1u << 15, /* own directions, points and pixel samples are independent */
   FURNACE_PLAIN_ESTIMATORS = 1u << 16,    /* uniform hemisphere, uniform points on lights, roulette as told
                                            * and no other: the variance is the one courses derive */
   FURNACE_DEPTH_LIMIT = 1u << 17,         /* by_depth is honoured */
   FURNACE_OWN_TESTS = 1u << 18            /* beside COUNTED_TESTS: furnace_build.counted may be null, and is
                                            * but where tests are counted: then your own tests are tried */
};

enum { /* furnace_conventions; 0 is the default of every field */
   FURNACE_FALLOFF_INVERSE_SQUARE = 0,
   FURNACE_FALLOFF_NONE = 1,     /* equally bright at every distance: the course's base code */
   FURNACE_EMISSION_FRONT = 0,
   FURNACE_EMISSION_BOTH = 1,    /* surfaces emit on both sides */
   /* Of rough conductors, and of both sides of rough glass. */
   FURNACE_SMITH_SEPARABLE = 0,  /* G1(wo) G1(wi) */
   FURNACE_SMITH_CORRELATED = 1, /* 1 / (1 + L(wo) + L(wi)) */
   FURNACE_FRESNEL_EXACT = 0,
   FURNACE_FRESNEL_SCHLICK = 1,         /* with the cosine of the view on both sides, as courses teach it */
   FURNACE_FRESNEL_SCHLICK_OUTSIDE = 2, /* with the cosine on the side of lower index, from inside too */
   FURNACE_RADIANCE_SCALED = 0,  /* radiance over squared index of refraction is conserved across glass */
   FURNACE_RADIANCE_UNSCALED = 1
};

/* Components of a path tracer that a core may take from the bench (furnace_core.components): with
 * the bench's in place of a broken one, everything above it is judged as if it were right. Change nothing
 * else with it: what is left out beside a component is told as that component's mistake. A core that weights by
 * MIS goes on to, and both weights take the pdf of the bench's light samples: they are uniform over the area of a
 * mesh, of the cap of a sphere that has one, or of a sphere that is inward or seen from inside; over the cone of any
 * other sphere; over all directions for a sky. They have no normal: a shadow ray that is shortened along the normal of
 * the light is shortened along itself instead. */
enum {
   FURNACE_TAKES_RANDOM_NUMBERS = 1u << 0,     /* none: a generator that you trust, in place of yours */
   FURNACE_TAKES_CAMERA = 1u << 1,             /* generate_rays */
   FURNACE_TAKES_TRIANGLE_TEST = 1u << 2,      /* intersect_triangle */
   FURNACE_TAKES_SPHERE_TEST = 1u << 3,        /* intersect_sphere */
   FURNACE_TAKES_BOX_TEST = 1u << 4,           /* intersect_box */
   FURNACE_TAKES_TRAVERSAL = 1u << 5,          /* intersect, occluded */
   FURNACE_TAKES_DIRECTION_SAMPLING = 1u << 6, /* sample_direction, direction_pdf */
   FURNACE_TAKES_BSDF = 1u << 7,               /* eval_bsdf, sample_bsdf */
   FURNACE_TAKES_LIGHT_SAMPLING = 1u << 8,     /* sample_light */
   FURNACE_TAKES_EMISSION = 1u << 9,           /* radiance of bounces 0..0: what a ray sees emitted */
   FURNACE_TAKES_DIRECT_LIGHTING = 1u << 10,   /* radiance of bounces 1..1, along the ray that arrived */
   FURNACE_TAKES_PATH = 1u << 11,              /* radiance */
   FURNACE_TAKES_PIXEL = 1u << 12              /* adaptive_mean */
};

/* What a core has freely chosen, declared so that it is not blamed for a choice. */
typedef struct furnace_conventions {
   uint32_t point_light_falloff, emission, smith_term, glass_fresnel, glass_radiance;
   uint32_t reserved[3];
} furnace_conventions;

typedef struct furnace_built furnace_built; /* the core's own; opaque to the bench */

typedef struct furnace_core {
   uint32_t abi;         /* FURNACE_ABI this core was compiled with */
   uint32_t struct_size; /* sizeof(furnace_core) as this core knows it */
   uint32_t traits;
   uint32_t components; /* FURNACE_TAKES_...: what take_components can be asked for */
   furnace_conventions conventions;
   const char *name, *version;
   void *self; /* handed back as the first argument of every call */

   /* Why the last call did not return FURNACE_OK. */
   const char *(*last_error)(void *self);

   /* Unit directions; origin at the camera; t_min and t_max at its clip distances. */
   furnace_status (*generate_rays)(void *self, const furnace_camera *camera,
                                   const furnace_vec2 *film, furnace_ray *out, size_t count);

   /* One primitive, no scene: `shape` and `primitive` of a hit are 0. A triangle has three unit normals,
    * never null, and without area it is missed. Spheres have their normals outward. */
   furnace_status (*intersect_triangle)(void *self, const furnace_vec3 positions[3],
                                        const furnace_vec3 normals[3], const furnace_ray *rays,
                                        furnace_hit *out, size_t count);
   furnace_status (*intersect_sphere)(void *self, const furnace_vec3 *centre, double radius,
                                      const furnace_ray *rays, furnace_hit *out, size_t count);
   furnace_status (*intersect_box)(void *self, const furnace_vec3 *min, const furnace_vec3 *max,
                                   const furnace_ray *rays, furnace_box_hit *out, size_t count);

   furnace_status (*sample_direction)(void *self, uint32_t sampler,
                                      const furnace_randomness *random,
                                      furnace_direction_sample *out, size_t count);
   furnace_status (*direction_pdf)(void *self, uint32_t sampler, const furnace_vec3 *directions,
                                   double *out, size_t count);

   /* Delta lobes evaluate to zero. */
   furnace_status (*eval_bsdf)(void *self, const furnace_material *material,
                               const furnace_bsdf_query *in, furnace_bsdf_value *out, size_t count);
   furnace_status (*sample_bsdf)(void *self, const furnace_material *material,
                                 const furnace_vec3 *wo, const furnace_randomness *random,
                                 furnace_bsdf_sample *out, size_t count);

   furnace_status (*adaptive_mean)(void *self, const furnace_adaptive *settings,
                                   const furnace_stream *streams, furnace_adaptive_mean *out,
                                   size_t count);

   /* At most one built scene exists at a time; it is released before the next is built. */
   furnace_status (*build)(void *self, const furnace_scene *scene, const furnace_build *settings,
                           furnace_built **out, furnace_build_stats *stats);
   void (*release)(void *self, furnace_built *built);

   furnace_status (*intersect)(void *self, furnace_built *built, const furnace_ray *rays,
                               furnace_hit *out, size_t count, furnace_traversal_stats *stats);
   /* out[i] is 1 if anything lies strictly between t_min and t_max, else 0. */
   furnace_status (*occluded)(void *self, furnace_built *built, const furnace_ray *rays,
                              uint8_t *out, size_t count, furnace_traversal_stats *stats);
   /* A direction from each point towards light `light`; visibility is not tested. Any pdf is right that the
    * samples follow and that is above 0 wherever the light emits towards the point: a sample of what does not, such
    * as the back of a triangle or a sphere beyond its cap, is valid and has no radiance. */
   furnace_status (*sample_light)(void *self, furnace_built *built, uint32_t light,
                                  const furnace_vec3 *from, const furnace_randomness *random,
                                  furnace_light_sample *out, size_t count);
   /* One estimate a ray; equal rays of a batch get independent ones. */
   furnace_status (*radiance)(void *self, furnace_built *built, const furnace_ray *rays,
                              const furnace_integrator *settings, furnace_rgb *out, size_t count);
   /* pixels: width * height linear RGB triples, top row first. sample_counts: width * height; a
    * core without FURNACE_ADAPTIVE_SAMPLING may leave them alone. */
   furnace_status (*render)(void *self, furnace_built *built, const furnace_camera *camera,
                            const furnace_render *settings, float *pixels, uint32_t *sample_counts);
   /* From now on, work with the components named in `taken` of the bench's, and with your own for
    * all others; it comes before anything else that is asked. Your own function for a component
    * that is taken answers by the bench's too. */
   furnace_status (*take_components)(void *self, const struct furnace_components *components);
   /* appended functions go here */
} furnace_core;

/* The bench's own components: the functions that stand beside FURNACE_TAKES_... above, of a core that is
 * right and follows your conventions. Call them with bench->self, and with furnace_build.bench where
 * they want a scene, for one element or many, from any thread. Their random numbers follow from
 * furnace_integrator.seed and the element's place in the batch: give each call a seed of its own.
 * `bench` lives as long as your core; its other functions are null. */
typedef struct furnace_components {
   uint32_t struct_size;
   uint32_t taken; /* FURNACE_TAKES_... */
   const furnace_core *bench;
} furnace_components;

/* Return null if this core cannot serve a bench of that ABI. */
FURNACE_EXPORT const furnace_core *furnace_core_entry(uint32_t bench_abi);

#ifdef __cplusplus
} /* extern "C" */
#endif
#endif /* FURNACE_CORE_H */
