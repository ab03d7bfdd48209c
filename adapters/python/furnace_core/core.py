"""What a core can be asked. Override what you have; nothing else is asked for.

Lengths are scene units, angles radians, radiance is linear RGB. Directions are unit length. Those of
BSDFs are in the local shading frame (normal = +z) and both point away from the surface; `f` excludes
the cosine; every pdf is with respect to solid angle. An argument that is an array has one row for each element
of the batch, and so has the answer.

Geometry: a ray is the points with t_min < t < t_max, t in units of |direction|, which is of any length but zero. Of a
triangle the front is where its vertices run counter-clockwise; normals are not turned towards the ray, shading normals are
interpolated and unit, uv are the weights of vertices 1 and 2. A triangle without an area is never hit.

Surfaces: "diffuse" is reflectance / pi; "mirror" reflects the same at every angle; "glass" has vacuum where the normal points
(wo.z > 0) and `index` behind it, and reflects by Fresnel's equations; "conductor" and "rough-glass" are GGX with alpha =
`roughness`, a conductor with `reflectance` for all of its Fresnel term. All but glass scatter on both sides. A sample of a
mirror or of smooth glass is delta: `pdf` is the probability of having chosen it, and f is such that f |cos| / pdf is the weight
of the path. Glass scales radiance by the squared index, unless you say otherwise (`conventions`).

Light: emission leaves the front alone, in every direction; with `cap` (a sphere) where the outward direction is within
`half_angle` of `axis`. A gradient sky is horizon + (zenith - horizon) max(0, up . w). A delta light's `radiance` is such that
radiance f cos is what is reflected (intensity over squared distance, irradiance), and its `pdf` is 1. A pixel is the plain mean
of its samples, which are uniform over its square.

`furnace_core.h` says the same in C; `furnace explain CASE` says where the numbers of a case come from.
"""

import difflib

# What no method can say of a core (`Core.traits`), and what that means.
TRAITS = {
    "brute-force": "build without a BVH, where acceleration.kind says so",
    "split-rules": "build by acceleration.split; graded only where it is promised",
    "traversal-stats": "counts of tests are real",
    "hemisphere-sampling": "settings.direct may be \"hemisphere\"",
    "isolated-bounces": "settings.bounces may start above 0",
    "depth-limit": "settings.by_depth: what a renderer shows at the maximum depth that the bounces end with",
    "roulette": "settings.roulette",
    "adaptive-sampling": "settings.adaptive of render, with true sample counts",
    "rough-glass": "materials of kind \"rough-glass\"",
    "reported-variance": "render answers variances, too",
    "stratified-pixels": "settings.stratified: of k x k samples one in each cell of a grid over the pixel",
    "callers-randomness": "samples are made of `random` and nothing else",
    "deterministic": "the same settings and seed give the same bits",
    # Promises, graded only where they are made.
    "independent-pixels": "the noise of one pixel says nothing of another's",
    "independent-samples": "your own directions, points and pixel samples are independent",
    "plain-estimators": "the uniform hemisphere, points uniform on lights (spheres may be sampled by their cone), roulette as "
                        "told and no other: the variance that courses derive",
}

# Components that a core may take from the bench (`Core.takes`), and what stands for them.
COMPONENTS = {
    "camera": "generate_rays",
    "triangle-test": "intersect_triangle",
    "sphere-test": "intersect_sphere",
    "box-test": "intersect_box",
    "traversal": "intersect, occluded",
    "direction-sampling": "sample_direction, direction_pdf",
    "bsdf": "eval_bsdf, sample_bsdf",
    "light-sampling": "sample_light",
    "emission": "radiance of bounces 0 to 0: what a ray sees emitted",
    "direct-lighting": "radiance of bounces 1 to 1, along the ray that arrived",
    "path": "radiance",
    "pixel": "adaptive_mean",
}


def known(word, words, where):
    """The word, if it is one of these; says which it is like if not."""
    if word in words:
        return word
    like = difflib.get_close_matches(word, words, 1)
    hint = f"did you mean {like[0]!r}?" if like else f"there are {', '.join(words)}"
    raise ValueError(f"{where} has {word!r}, which is none: {hint}")


class Unsupported(Exception):
    """Raise it for a request that the core does not support: the trial is skipped, not failed."""


class Random:
    """The caller's random numbers for one batch, in [0, 1): points (n, 2), lobes (n,); a seed for who draws their own."""

    def __init__(self, points, lobes, seed=0):
        self.points, self.lobes, self.seed = points, lobes, seed


def question(capability, component=None, tells_stats=False, **answer):
    """A method that answers a request of its own name: which capability that is, which component of
    a path tracer it alone makes up, and of which elements its answer is made, as `hits="hit"`.
    `furnace_core.serve` hands it its arguments by their names."""

    def declare(method):
        def unanswered(*_):
            raise NotImplementedError

        unanswered.__doc__, unanswered.__name__ = method.__doc__, method.__name__
        unanswered.arguments = method.__code__.co_varnames[1:method.__code__.co_argcount]
        unanswered.capability, unanswered.tells_stats = capability, tells_stats
        unanswered.component, unanswered.request = component, method.__name__.replace("_", "-")
        [unanswered.answer] = answer.items()
        return unanswered

    return declare


class Core:
    """A renderer under test."""

    name = "a core in Python"
    version = "0"
    # "double" or "single": how wide tolerances are.
    precision = "double"
    # What no method can say: words of TRAITS.
    traits = frozenset()
    # What the core has freely chosen, where it is not the usual: "point-light-falloff": "none",
    # "emission": "both", "smith-term": "height-correlated", "glass-fresnel": "schlick"
    # or "schlick-outside", "glass-radiance": "unscaled".
    conventions = {}
    # Words of COMPONENTS that may be the bench's in place of yours, so that it can tell which of yours is broken. Name one if
    # all your code that needs it calls the method for it (`self.intersect(...)`, `self.core.eval_bsdf(...)`), or asks
    # `bench.has` before it uses its own.
    takes = frozenset()
    # The class of built scenes, if there are any.
    built = None

    @question("generate-rays", "camera", rays="ray")
    def generate_rays(self, camera, film):
        """camera (position, axes = rows right, up, backward, fovs, near, far), film (n, 2) → RAY"""

    @question("intersect-primitive", "triangle-test", hits="hit")
    def intersect_triangle(self, positions, normals, rays):
        """(3, 3), (3, 3), RAY → HIT with shape = primitive = 0"""

    @question("intersect-primitive", "sphere-test", hits="hit")
    def intersect_sphere(self, centre, radius, rays):
        """(3,), a number, RAY → HIT with shape = primitive = 0"""

    @question("intersect-box", "box-test", box_hits="box-hit")
    def intersect_box(self, low, high, rays):
        """(3,), (3,), RAY → BOX_HIT"""

    @question("sample-direction", "direction-sampling", samples="direction-sample")
    def sample_direction(self, sampler, random):
        """"uniform-hemisphere" or "cosine-hemisphere", random (points (n, 2), lobes (n,), seed)
        → DIRECTION_SAMPLE"""

    @question("sample-direction", "direction-sampling", pdf="f64")
    def direction_pdf(self, sampler, directions):
        """As above, (n, 3) → (n,)"""

    @question("eval-bsdf", "bsdf", values="bsdf-value")
    def eval_bsdf(self, material, wo, wi):
        """material (kind, reflectance, …), (n, 3), (n, 3) → f (n, 3), pdf (n,)"""

    @question("sample-bsdf", "bsdf", samples="bsdf-sample")
    def sample_bsdf(self, material, wo, random):
        """material, (n, 3), random → BSDF_SAMPLE"""

    @question("adaptive-mean", "pixel", means="adaptive-mean")
    def adaptive_mean(self, samples_per_batch, max_tolerance, streams):
        """int, float, list of (count,) → list of (mean, used): the adaptive rule on luminances; a stream is as long as the
        cap of samples, and its last batch may be a part of one. After each batch: stop where 1.96 s / sqrt(n) <= max_tolerance
        times the mean, s the standard deviation over n - 1."""

    def build(self, scene, acceleration):
        """scene, acceleration (kind "brute-force" or "bvh", split, max_leaf_size) → a `Built`

        scene.materials: as for eval_bsdf, and emission (None, or radiance (3) and cap: None, or axis and half_angle).
        scene.meshes: positions (vertices, 3), indices (triangles, 3), normals (vertices, 3) if smooth else (0, 3),
        material (its number). scene.spheres: centre (3,), radius, inward, material.
        scene.lights: kind "point" (position, intensity), "directional" (direction in which it travels, irradiance),
        "constant-sky" (radiance), "gradient-sky" (up, horizon, zenith) or "area" (shape: meshes are numbered first, then
        spheres); every shape that emits is one of them. scene.camera: as for generate_rays, or None."""
        return self.built(scene, acceleration)


class Built:
    """A scene that a core has taken in."""

    # The core that it belongs to; set by `serve`.
    core = None

    def __init__(self, scene, acceleration):
        self.scene, self.acceleration = scene, acceleration

    def stats(self):
        """{"nodes", "leaves", "max-depth", "bytes"}: leaves are nodes too, a root alone has a depth of 1;
        leave out what you do not know"""
        return {}

    @question("intersect", "traversal", tells_stats=True, hits="hit")
    def intersect(self, rays):
        """RAY → HIT, {"box-tests", "primitive-tests"}; meshes are numbered first, then spheres"""

    @question("occluded", "traversal", tells_stats=True, occluded="u8")
    def occluded(self, rays):
        """RAY → (n,) of 0 and 1, counts as above"""

    @question("sample-light", "light-sampling", samples="light-sample")
    def sample_light(self, light, origins, random):
        """number of the light, (n, 3), random → LIGHT_SAMPLE; visibility is not tested; random.lobes: which triangle"""

    @question("radiance", radiance="rgb")
    def radiance(self, rays, settings):
        """RAY, settings → (n, 3): one estimate a ray, of random numbers of its own

        settings.bounces.start and .end, both included: 0 is emission that is seen, 1 direct light, a mirror or glass counts as a
        bounce; .direct "lights" or "hemisphere"; .samples_per_light: to each light that is not delta, or so many directions of
        the hemisphere for each of them; a delta light always gets one; .roulette: None, or .stop, the probability to end, and
        .guaranteed, the continuations before it is played; .seed: 64 bits; .threads; of a core with "depth-limit" .by_depth."""

    @question("render", pixels="rgb-f32")
    def render(self, camera, settings):
        """camera, settings (width, height, samples_per_pixel, integrator, adaptive, stratified)
        → pixels (height, width, 3), row 0 on top, and samples (height, width); with the trait
        "reported-variance" also the variance of each value of pixels, that is of a mean and not
        of one sample"""


def methods(owner):
    """The questions of `Core` or `Built`, by the names of their requests."""
    found = {name.replace("_", "-"): method for name, method in vars(owner).items()}
    return {name: method for name, method in found.items() if hasattr(method, "capability")}


def capabilities(core):
    """What a core can be asked: the methods it has overridden, and its traits."""
    found = {known(word, TRAITS, "`traits`") for word in core.traits}
    if core.built is not None:
        found.add("build-scene")
    for owner, kind in ((Core, type(core)), (Built, core.built)):
        for method in methods(owner).values():
            if kind is not None and getattr(kind, method.__name__, method) is not method:
                found.add(method.capability)
    return sorted(found)
