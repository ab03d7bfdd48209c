"""Mitsuba 3 as a core, function by function: parts 1 to 4 and 6 of a path tracer.

    python3 -m venv .venv && .venv/bin/pip install ./adapters/python mitsuba
    cargo furnace --core 'exec: .venv/bin/python adapters/python/mitsuba_core.py'

Every answer is Mitsuba's own: shapes, BSDFs, emitters, warps, its perspective camera, its `path` integrator. The
variant is `llvm_ad_rgb`, which answers a whole batch in one call (a ray at a time, `scalar_rgb` would take minutes a
case) and finds hits with Embree. There is no wheel in double precision. It needs an LLVM of version 17 or later at run
time (Debian: libllvm19), found by itself or named by DRJIT_LIBLLVM_PATH.

What this file adds, because Mitsuba has no such thing: rays begin at t_min (Mitsuba's begin at 0, so their origin is
moved), directions have any length (Mitsuba's are unit), and a bounce by itself is the difference of two depths along the
same paths.

docs/book/src/trusted-renderers.md tells what comes of it.
"""

import glob
import os
import re
import sys
import zlib
from fractions import Fraction

VARIANT = "llvm_ad_rgb"

# Older ones load, and end the process as soon as they compile (llvm-project #53353).
OLDEST_LLVM = 17


def libraries():
    """The LLVMs of this machine, by version, where packages put them."""
    places = ["/usr/lib/*/libLLVM*.so*", "/usr/lib*/libLLVM*.so*", "/usr/lib/llvm-*/lib/libLLVM*.so*",
              "/opt/homebrew/opt/llvm*/lib/libLLVM*.dylib"]
    found = {}
    for path in (path for place in places for path in glob.glob(place)):
        version = re.search(r"libLLVM[-.](?:so\.)?(\d+)", path)
        if version and int(version[1]) >= OLDEST_LLVM:
            found[int(version[1])] = path
    return found


if "DRJIT_LIBLLVM_PATH" not in os.environ and libraries():
    newest = max(libraries())
    os.environ["DRJIT_LIBLLVM_PATH"] = libraries()[newest]

try:
    import drjit as dr
    import mitsuba as mi
    import numpy as np
    from furnace_core import BOX_HIT, BSDF_SAMPLE, DIRECTION_SAMPLE, LIGHT_SAMPLE
    from furnace_core import Built, Core, Unsupported, misses, rays, serve
except ImportError as missing:
    sys.exit(f"{missing}. This core needs `pip install mitsuba` and `pip install ./adapters/python` for {sys.executable}")

try:
    mi.set_variant(VARIANT)
    # Trials run side by side already, and small batches wait for a pool longer than they compute.
    dr.set_thread_count(0)
    dr.eval(mi.Float([1]) + 1)
except Exception as error:
    sys.exit(f"Mitsuba's variant {VARIANT} does not start: {error}. It needs LLVM {OLDEST_LLVM} or later "
             "(Debian: apt install libllvm19), named by DRJIT_LIBLLVM_PATH where it is not found")

# At most so many samples a pixel go into one pass: Mitsuba adds up in single precision.
PASS = 256

# Rows of the image of a gradient environment; the middle one is the horizon.
SKY_ROWS = 1025


def floats(column):
    return mi.Float(np.ascontiguousarray(column, dtype=np.float32))


def vectors(rows, kind=None):
    """(n, 3) → an array of Mitsuba's."""
    return (kind or mi.Vector3f)(*(floats(column) for column in np.asarray(rows).T))


def points(rows):
    return mi.Point2f(*(floats(column) for column in np.asarray(rows).T))


def numbers(array, count):
    """A value of Mitsuba's, of one component or several → (n,) or (n, components) in double precision."""
    made = np.array(array, dtype=float).T
    return np.broadcast_to(made, (count, *made.shape[1:])) if made.ndim and len(made) != count else made


def rgb(values):
    return {"type": "rgb", "value": [float(value) for value in values]}


def seed_of(seed):
    """Mitsuba's seeds have 32 bits."""
    return zlib.crc32(int(seed).to_bytes(8, "little"))


# ---- materials -------------------------------------------------------------------------------

def surface(material):
    """The plugin that scatters as a material does."""
    if material.kind == "diffuse":
        return {"type": "diffuse", "reflectance": rgb(material.reflectance)}
    if material.kind == "mirror":
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(material.reflectance)}
    if material.kind == "conductor":
        return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": material.roughness,
                "specular_reflectance": rgb(material.reflectance)}
    glass = {"int_ior": material.index, "ext_ior": 1.0,
             "specular_reflectance": rgb(material.reflectance),
             "specular_transmittance": rgb(material.transmittance)}
    if material.kind == "glass":
        return {"type": "dielectric", **glass}
    if material.kind == "rough-glass":
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": material.roughness, **glass}
    raise Unsupported(f"Mitsuba's core knows no {material.kind}")


def plugin(material):
    """As `surface`, scattering on both sides where the contract says so."""
    if material.kind in ("glass", "rough-glass"):
        return surface(material)
    return {"type": "twosided", "bsdf": surface(material)}


def emitter(material):
    if material.emission.cap is not None:
        raise Unsupported("Mitsuba has no emitter that is a cap of a sphere")
    return {"type": "area", "radiance": rgb(material.emission.radiance)}


def facing(wo):
    """An interaction at the origin, in the local shading frame, seen from wo."""
    found = dr.zeros(mi.SurfaceInteraction3f, len(wo))
    found.n = mi.Normal3f(0, 0, 1)
    found.sh_frame = mi.Frame3f(mi.Normal3f(0, 0, 1))
    found.wi = vectors(wo)
    return found


def without_cosine(value, wi):
    """Mitsuba's BSDFs contain the cosine."""
    cosine = np.abs(wi[:, 2:3])
    return np.divide(value, cosine, out=np.zeros_like(value), where=cosine > 0)


# ---- scenes ----------------------------------------------------------------------------------

def properties(name, material):
    """What a mesh that is not read from a file is made of."""
    made = mi.Properties(name)
    made["bsdf"] = mi.load_dict(plugin(material))
    if material.emission is not None:
        made["emitter"] = mi.load_dict(emitter(material))
    return made


def mesh_of(mesh, material):
    made = mi.Mesh(mesh.name, len(mesh.positions), len(mesh.indices), has_vertex_normals=len(mesh.normals) > 0,
                   props=properties(mesh.name, material))
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = floats(mesh.positions.ravel())
    parameters["faces"] = mi.UInt32(np.ascontiguousarray(mesh.indices, dtype=np.uint32).ravel())
    if len(mesh.normals):
        parameters["vertex_normals"] = floats(mesh.normals.ravel())
    parameters.update()
    return made


def sphere_of(sphere, material):
    made = {"type": "sphere", "center": [float(value) for value in sphere.centre], "radius": float(sphere.radius),
            "flip_normals": bool(sphere.inward), "bsdf": plugin(material)}
    if material.emission is not None:
        made["emitter"] = emitter(material)
    return made


def light_of(light):
    """An emitter that is no shape."""
    if light.kind == "point":
        return {"type": "point", "position": list(light.position), "intensity": rgb(light.intensity)}
    if light.kind == "directional":
        return {"type": "directional", "direction": list(light.direction), "irradiance": rgb(light.irradiance)}
    if light.kind == "constant-sky":
        return {"type": "constant", "radiance": rgb(light.radiance)}
    return gradient(light)


def gradient(light):
    """A map of the environment, straight above in its first row, which is Mitsuba's +y."""
    height = np.maximum(0, np.cos(np.pi * np.arange(SKY_ROWS) / (SKY_ROWS - 1)))[:, None]
    row = light.horizon + (light.zenith - light.horizon) * height
    image = np.repeat(row[:, None, :], 4, axis=1).astype(np.float32)
    up = light.up / np.linalg.norm(light.up)
    side = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
    side /= np.linalg.norm(side)
    turned = np.eye(4)
    turned[:3, :3] = np.stack([side, up, np.cross(side, up)], axis=1)
    return {"type": "envmap", "bitmap": mi.Bitmap(image), "to_world": mi.ScalarTransform4f(turned)}


def as_mitsuba_has_them(batch, kind=mi.Ray3f):
    """Rays that begin at 0, of unit direction, as all of Mitsuba's own: its spheres are off for others."""
    ray = kind()
    length = lengths(batch)
    ray.o = vectors(batch["origin"] + batch["t_min"][:, None] * batch["direction"], mi.Point3f)
    ray.d = vectors(batch["direction"] / length[:, None])
    ray.maxt = floats((batch["t_max"] - batch["t_min"]) * length)
    ray.time, ray.wavelengths = 0, []
    return ray


def lengths(batch):
    return np.linalg.norm(batch["direction"], axis=1)


def hits_of(found, ray, batch, shapes):
    """What is told of the nearest hits, with one shape or with those of an `Order`."""
    if not isinstance(shapes, Order):
        found.shape = mi.ShapePtr(shapes)
        shapes = Order([shapes])
    there = found.compute_surface_interaction(ray)
    dr.eval(found, there.n, there.sh_frame.n)
    count = len(batch)
    t = numbers(found.t, count) / lengths(batch) + batch["t_min"]
    met = numbers(found.is_valid(), count).astype(bool) & (t > batch["t_min"]) & (t < batch["t_max"])
    hits = misses(count)
    shape = shapes.numbers(found.shape, count)[met]
    is_mesh = shapes.is_mesh[shape]
    hits["t"][met], hits["shape"][met] = t[met], shape
    hits["primitive"][met] = np.where(is_mesh, numbers(found.prim_index, count)[met], 0)
    hits["uv"][met] = np.where(is_mesh[:, None], numbers(found.prim_uv, count)[met], 0)
    hits["geometric_normal"][met] = numbers(there.n, count)[met]
    hits["shading_normal"][met] = numbers(there.sh_frame.n, count)[met]
    return hits


class Order:
    """From Mitsuba's numbers of shapes to the contract's."""

    def __init__(self, shapes):
        known = [int(dr.reinterpret_array(mi.UInt32, mi.ShapePtr(shape))[0]) for shape in shapes]
        self.table = np.zeros(max(known, default=0) + 1, dtype=np.uint32)
        self.table[known] = np.arange(len(known))
        self.is_mesh = np.array([shape.is_mesh() for shape in shapes], dtype=bool)

    def numbers(self, pointers, count):
        """Misses are numbered 0 too."""
        known = numbers(dr.reinterpret_array(mi.UInt32, pointers), count).astype(int)
        return self.table[np.minimum(known, len(self.table) - 1)]


class Scene(Built):
    """A scene as Mitsuba holds it."""

    def __init__(self, scene, acceleration):
        super().__init__(scene, acceleration)
        meshes = [mesh_of(mesh, scene.materials[mesh.material]) for mesh in scene.meshes]
        spheres = [mi.load_dict(sphere_of(sphere, scene.materials[sphere.material])) for sphere in scene.spheres]
        self.shapes = meshes + spheres
        self.lights = [self.shapes[light.shape].emitter() if light.kind == "area" else mi.load_dict(light_of(light))
                       for light in scene.lights]
        parts = {"type": "scene"}
        parts.update({f"shape-{number}": shape for number, shape in enumerate(self.shapes)})
        parts.update({f"light-{number}": made for number, (light, made) in enumerate(zip(scene.lights, self.lights))
                      if light.kind != "area"})
        self.mitsuba = mi.load_dict(parts, optimize=False)
        self.order = Order(self.shapes)

    def intersect(self, batch):
        ray = as_mitsuba_has_them(batch)
        found = self.mitsuba.ray_intersect_preliminary(ray, coherent=False)
        return hits_of(found, ray, batch, self.order), {}

    def occluded(self, batch):
        return numbers(self.mitsuba.ray_test(as_mitsuba_has_them(batch)), len(batch)).astype(bool), {}

    def sample_light(self, light, origins, random):
        count = len(origins)
        there = dr.zeros(mi.SurfaceInteraction3f, count)
        there.p = vectors(origins, mi.Point3f)
        found, weight = self.lights[light].sample_direction(there, points(random.points))
        dr.eval(found, weight)
        pdf = numbers(found.pdf, count)
        samples = np.zeros(count, LIGHT_SAMPLE)
        samples["wi"], samples["pdf"] = numbers(found.d, count), pdf
        endless = self.scene.lights[light].kind in ("directional", "constant-sky", "gradient-sky")
        samples["distance"] = np.inf if endless else numbers(found.dist, count)
        samples["radiance"] = numbers(weight, count) * pdf[:, None]
        samples["is_delta"] = numbers(found.delta, count)
        samples["is_valid"] = pdf > 0
        return samples

    def radiance(self, batch, settings):
        refuse(settings)
        ray = as_mitsuba_has_them(batch, mi.RayDifferential3f)

        def to(depth):
            if depth < 0:
                return 0
            sampler = mi.load_dict({"type": "independent"})
            sampler.seed(seed_of(settings.seed), len(batch))
            found, _, _ = integrator(settings, depth).sample(self.mitsuba, sampler, ray)
            return numbers(found, len(batch))

        return to(settings.bounces.end) - to(settings.bounces.start - 1)

    def render(self, camera, settings):
        how = settings.integrator
        refuse(how)
        size = settings.width, settings.height
        view = sensor(camera, *size) if has_square_pixels(camera, *size) else None
        samples = settings.samples_per_pixel
        total = np.zeros((settings.height, settings.width, 3))
        for number, done in enumerate(range(0, samples, PASS)):
            now = min(PASS, samples - done)
            seed = seed_of(how.seed ^ number << 48)

            def to(depth):
                if depth < 0:
                    return 0
                if view is None:
                    return self.oblong(camera, size, integrator(how, depth), now, seed)
                return np.array(mi.render(self.mitsuba, sensor=view, integrator=integrator(how, depth), spp=now,
                                          seed=seed), dtype=float)

            total += now * (to(how.bounces.end) - to(how.bounces.start - 1))
        return total / samples, np.full((settings.height, settings.width), samples)

    def oblong(self, camera, size, path, samples, seed):
        """As `mitsuba.render`, for pixels that Mitsuba's films do not have: the means are formed here."""
        count = size[0] * size[1] * samples
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, count)
        pixel = dr.arange(mi.UInt32, count) // samples
        corner = mi.Point2f(pixel % size[0], pixel // size[0])
        place = (corner + sampler.next_2d()) / mi.Vector2f(*size)
        ray, _ = of_any_aspect(camera).sample_ray_differential(0.0, 0.5, place, mi.Point2f(0.5, 0.5))
        found, _, _ = path.sample(self.mitsuba, sampler, ray)
        return numbers(found, count).reshape(size[1], size[0], samples, 3).mean(axis=2)


def refuse(settings):
    if settings.direct == "hemisphere":
        raise Unsupported("Mitsuba has no integrator that samples the hemisphere uniformly")


def integrator(settings, depth):
    """Bounces up to `depth`. Mitsuba's depth counts the emission that is seen too; its roulette survives by the
    throughput."""
    roulette = 1_000_000 if settings.roulette is None else int(settings.roulette.guaranteed) + 1
    return mi.load_dict({"type": "path", "max_depth": int(depth) + 1, "rr_depth": roulette})


def has_square_pixels(camera, width, height):
    slope = np.tan(camera.vertical_fov / 2) / np.tan(camera.horizontal_fov / 2)
    return abs(slope * width / height - 1) < 1e-6


def of_any_aspect(camera):
    """A sensor whose film has the camera's proportions, whatever its pixels are; nothing is rendered on it."""
    aspect = Fraction(np.tan(camera.horizontal_fov / 2) / np.tan(camera.vertical_fov / 2))
    aspect = aspect.limit_denominator(1 << 14)
    return sensor(camera, aspect.numerator, aspect.denominator)


def sensor(camera, width, height):
    """A camera of square pixels."""
    right, up, backward = camera.axes
    at = np.eye(4)
    at[:3, :3] = np.stack([-right, up, -backward], axis=1)
    at[:3, 3] = camera.position
    return mi.load_dict({
        "type": "perspective", "fov_axis": "x", "fov": float(np.degrees(camera.horizontal_fov)),
        "near_clip": float(camera.near), "far_clip": float(camera.far), "to_world": mi.ScalarTransform4f(at),
        "film": {"type": "hdrfilm", "width": int(width), "height": int(height), "pixel_format": "rgb",
                 "component_format": "float32", "rfilter": {"type": "box"}},
        "sampler": {"type": "independent"},
    })


# ---- the core --------------------------------------------------------------------------------

WARPS = {
    "uniform-hemisphere": (mi.warp.square_to_uniform_hemisphere, mi.warp.square_to_uniform_hemisphere_pdf),
    "cosine-hemisphere": (mi.warp.square_to_cosine_hemisphere, mi.warp.square_to_cosine_hemisphere_pdf),
}


class Alone:
    """A shape of one primitive, or what it is made of."""

    name = "alone"

    def __init__(self, **members):
        vars(self).update(members)


BLACK = Alone(kind="diffuse", reflectance=np.zeros(3), emission=None)


class Mitsuba(Core):
    """The whole core."""

    name, version = "mitsuba", mi.__version__
    precision = "single"
    traits = {"isolated-bounces", "depth-limit", "roulette", "rough-glass", "callers-randomness", "deterministic",
              "independent-pixels"}
    built = Scene

    def generate_rays(self, camera, film):
        """The directions are Mitsuba's; its rays begin on the near plane, the contract's at the camera."""
        place = points(film * [1, -1] + [0, 1])
        ray, _ = of_any_aspect(camera).sample_ray(0.0, 0.5, place, mi.Point2f(0.5, 0.5))
        return rays(camera.position, numbers(ray.d, len(film)), camera.near, camera.far)

    def intersect_triangle(self, positions, normals, batch):
        """By Mitsuba's own test: its scenes leave triangles to Embree."""
        shape = mesh_of(Alone(positions=positions, normals=normals, indices=np.array([[0, 1, 2]])), BLACK)
        ray = as_mitsuba_has_them(batch)
        return hits_of(shape.ray_intersect_triangle(0, ray), ray, batch, shape)

    def intersect_sphere(self, centre, radius, batch):
        shape = mi.load_dict(sphere_of(Alone(centre=centre, radius=radius, inward=False), BLACK))
        ray = as_mitsuba_has_them(batch)
        return hits_of(shape.ray_intersect_preliminary(ray), ray, batch, shape)

    def intersect_box(self, low, high, batch):
        """Mitsuba's test is of the line; the segment is compared here."""
        box = mi.BoundingBox3f(mi.Point3f(*map(float, low)), mi.Point3f(*map(float, high)))
        ray = mi.Ray3f(vectors(batch["origin"], mi.Point3f), vectors(batch["direction"]))
        met, enter, leave = (numbers(part, len(batch)) for part in box.ray_intersect(ray))
        hits = np.zeros(len(batch), BOX_HIT)
        hits["t_enter"], hits["t_exit"] = enter, leave
        hits["hit"] = met.astype(bool) & (enter <= batch["t_max"]) & (leave >= batch["t_min"])
        return hits

    def sample_direction(self, sampler, random):
        warp, pdf = WARPS[sampler]
        direction = warp(points(random.points))
        samples = np.zeros(len(random.points), DIRECTION_SAMPLE)
        samples["direction"] = numbers(direction, len(samples))
        samples["pdf"] = numbers(pdf(direction), len(samples))
        return samples

    def direction_pdf(self, sampler, directions):
        """Mitsuba's pdfs take it that a direction is in the hemisphere; below it there are no samples."""
        _, pdf = WARPS[sampler]
        return np.where(directions[:, 2] >= 0, numbers(pdf(vectors(directions)), len(directions)), 0)

    def eval_bsdf(self, material, wo, wi):
        bsdf = mi.load_dict(plugin(material))
        value, pdf = bsdf.eval_pdf(mi.BSDFContext(), facing(wo), vectors(wi))
        dr.eval(value, pdf)
        return without_cosine(numbers(value, len(wo)), wi), numbers(pdf, len(wo))

    def sample_bsdf(self, material, wo, random):
        bsdf = mi.load_dict(plugin(material))
        found, weight = bsdf.sample(mi.BSDFContext(), facing(wo), floats(random.lobes), points(random.points))
        dr.eval(found, weight)
        count = len(wo)
        wi, pdf, weight = (numbers(part, count) for part in (found.wo, found.pdf, weight))
        samples = np.zeros(count, BSDF_SAMPLE)
        samples["wi"], samples["pdf"] = wi, pdf
        samples["f"] = without_cosine(weight * pdf[:, None], wi)
        samples["is_delta"] = numbers(mi.has_flag(found.sampled_type, mi.BSDFFlags.Delta), count)
        samples["is_valid"] = (pdf > 0) & (weight.max(axis=1) > 0)
        return samples


if __name__ == "__main__":
    serve(Mitsuba())
