"""What a core can be asked. Override what you have; nothing else is asked for.

Lengths are scene units, angles radians, radiance is linear RGB. Directions are unit length. Those of
BSDFs are in the local shading frame (normal = +z) and both point away from the surface; `f` excludes
the cosine; every pdf is with respect to solid angle. An argument that is an array has one row for each element
of the batch, and so has the answer.
"""


class Unsupported(Exception):
    """Raise it for a request that the core does not support: the trial is skipped, not failed."""


class Core:
    """A renderer under test."""

    name = "a core in Python"
    version = "0"
    # "double" or "single": how wide tolerances are.
    precision = "double"
    # What no method can say: "brute-force", "split-rules", "hemisphere-sampling",
    # "isolated-bounces", "roulette", "adaptive-sampling", "rough-glass", "reported-variance",
    # "stratified-pixels", "traversal-stats", "callers-randomness", "deterministic".
    traits = frozenset()
    # What the core has freely chosen, where it is not the usual: "point-light-falloff": "none",
    # "emission": "both", "smith-term": "height-correlated", "glass-fresnel": "schlick"
    # or "schlick-outside", "glass-radiance": "unscaled".
    conventions = {}
    # The class of built scenes, if there are any.
    built = None

    def generate_rays(self, camera, film):
        """camera (position, axes = rows right, up, backward, fovs, near, far), film (n, 2) → RAY"""
        raise NotImplementedError

    def intersect_triangle(self, positions, normals, rays):
        """(3, 3), (3, 3), RAY → HIT with shape = primitive = 0"""
        raise NotImplementedError

    def intersect_sphere(self, centre, radius, rays):
        """(3,), a number, RAY → HIT with shape = primitive = 0"""
        raise NotImplementedError

    def intersect_box(self, low, high, rays):
        """(3,), (3,), RAY → BOX_HIT"""
        raise NotImplementedError

    def sample_direction(self, sampler, random):
        """"uniform-hemisphere" or "cosine-hemisphere", random (points (n, 2), lobes (n,), seed)
        → DIRECTION_SAMPLE"""
        raise NotImplementedError

    def direction_pdf(self, sampler, directions):
        """As above, (n, 3) → (n,)"""
        raise NotImplementedError

    def eval_bsdf(self, material, wo, wi):
        """material (kind, reflectance, …), (n, 3), (n, 3) → f (n, 3), pdf (n,)"""
        raise NotImplementedError

    def sample_bsdf(self, material, wo, random):
        """material, (n, 3), random → BSDF_SAMPLE"""
        raise NotImplementedError

    def adaptive_mean(self, samples_per_batch, max_tolerance, streams):
        """int, float, list of (count,) → list of (mean, used)"""
        raise NotImplementedError

    def build(self, scene, acceleration):
        """scene (camera, materials, meshes, spheres, lights), acceleration (kind "brute-force" or
        "bvh", split, max_leaf_size) → a `Built`"""
        return self.built(scene, acceleration)


class Built:
    """A scene that a core has taken in."""

    def __init__(self, scene, acceleration):
        self.scene, self.acceleration = scene, acceleration

    def stats(self):
        """{"nodes", "leaves", "max-depth", "bytes"}; leave out what you do not know"""
        return {}

    def intersect(self, rays):
        """RAY → HIT, {"box-tests", "primitive-tests"}; meshes are numbered first, then spheres"""
        raise NotImplementedError

    def occluded(self, rays):
        """RAY → (n,) of 0 and 1, counts as above"""
        raise NotImplementedError

    def sample_light(self, light, origins, random):
        """number of the light, (n, 3), random → LIGHT_SAMPLE"""
        raise NotImplementedError

    def radiance(self, rays, settings):
        """RAY, settings (samples_per_light, bounces, direct, roulette, seed, threads) → (n, 3)"""
        raise NotImplementedError

    def render(self, camera, settings):
        """camera, settings (width, height, samples_per_pixel, integrator, adaptive, stratified)
        → pixels (height, width, 3), row 0 on top, and samples (height, width); with the trait
        "reported-variance" also the variance of each value of pixels, that is of a mean and not
        of one sample"""
        raise NotImplementedError


# Capabilities that are a method's, and whose.
METHODS = {
    "generate-rays": (Core, ("generate_rays",)),
    "intersect-primitive": (Core, ("intersect_triangle", "intersect_sphere")),
    "intersect-box": (Core, ("intersect_box",)),
    "sample-direction": (Core, ("sample_direction", "direction_pdf")),
    "eval-bsdf": (Core, ("eval_bsdf",)),
    "sample-bsdf": (Core, ("sample_bsdf",)),
    "adaptive-mean": (Core, ("adaptive_mean",)),
    "intersect": (Built, ("intersect",)),
    "occluded": (Built, ("occluded",)),
    "sample-light": (Built, ("sample_light",)),
    "radiance": (Built, ("radiance",)),
    "render": (Built, ("render",)),
}


def capabilities(core):
    """What a core can be asked: the methods it has overridden, and its traits."""
    found = set(core.traits)
    if core.built is not None:
        found.add("build-scene")
    for name, (owner, methods) in METHODS.items():
        kind = type(core) if owner is Core else core.built
        if kind is not None and any(is_overridden(kind, owner, method) for method in methods):
            found.add(name)
    return sorted(found)


def is_overridden(kind, owner, method):
    """Whether a class has a method of its own."""
    return getattr(kind, method, None) is not getattr(owner, method)
