"""Renders a scene with LuxCore's path tracer: SCENE OUTPUT SAMPLES SEED THREADS.

What makes it the same question (each found by measurement, with pyluxcore 2.11.2): `path.pathdepth` is the last bounce
plus one; the image is shifted by one row, so that the window is moved the other way; a point light's colour
is divided by 4π; a sampler other than RANDOM, or an adaptive one, would not be independent from run to run.
"""

import os
import time

import numpy
import pyluxcore as lux

import furnace_scene as furnace

path, output, samples, seed, threads = furnace.arguments()
scene = furnace.read(path)
width, height = scene.size
described = lux.Scene()


def define(name, **values):
    properties = lux.Properties()
    for key, value in values.items():
        value = value.tolist() if isinstance(value, numpy.ndarray) else value
        properties.Set(lux.Property(f"{name}.{key.replace('__', '.')}", value))
    described.Parse(properties)


def material(name, look, radiance):
    """In one piece: what is said of a material later replaces all that was said before."""
    values = look.values
    if look.kind == "diffuse":
        described_as = dict(type="matte", kd=values["reflectance"])
    elif look.kind == "conductor":
        described_as = dict(type="mirror", kr=values["specular_reflectance"])
    elif look.kind == "dielectric":
        described_as = dict(
            type="glass",
            kr=values["specular_reflectance"],
            kt=values["specular_transmittance"],
            interiorior=values["int_ior"],
            exteriorior=values["ext_ior"],
        )
    else:
        furnace.refuse(f"material {look.kind}")
    if radiance is not None:
        described_as.update(
            emission=radiance,
            emission__gain=[1.0] * 3,
            emission__power=0.0,
            emission__efficency=0.0,
            emission__gain__normalizebycolor=False,
        )
    define(f"scene.materials.{name}", **described_as)


def mesh(name, positions, triangles, normals):
    rows = lambda array, kind: None if array is None else [tuple(map(kind, row)) for row in array]
    described.DefineMesh(
        f"{name}-mesh", rows(positions, float), rows(triangles, int), rows(normals, float), None, None, None
    )
    define(f"scene.objects.{name}", shape=f"{name}-mesh", material=f"{name}-material")


def icosphere(centre, radius, inward, subdivisions=6):
    """Triangles with the normals of the sphere, and with its volume: its silhouette is right to 1e-4."""
    golden = (1 + 5**0.5) / 2
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    corners += [(z, x, y) for x, y, z in corners] + [(y, z, x) for x, y, z in corners]
    corners = numpy.array(corners, dtype=float)
    corners /= numpy.linalg.norm(corners, axis=1)[:, None]
    from itertools import combinations

    edge = min(numpy.linalg.norm(corners[a] - corners[b]) for a, b in combinations(range(12), 2))
    near = lambda a, b: numpy.linalg.norm(corners[a] - corners[b]) < 1.1 * edge
    faces = [f for f in combinations(range(12), 3) if all(near(a, b) for a, b in combinations(f, 2))]
    outward = lambda f: numpy.dot(numpy.cross(corners[f[1]] - corners[f[0]], corners[f[2]] - corners[f[0]]), corners[f[0]])
    faces = numpy.array([f if outward(f) > 0 else (f[0], f[2], f[1]) for f in faces])
    for _ in range(subdivisions):
        middles = {}
        points = list(corners)

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                point = corners[a] + corners[b]
                middles[key] = len(points)
                points.append(point / numpy.linalg.norm(point))
            return middles[key]

        split = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        corners, faces = numpy.array(points), numpy.array(split)
    a, b, c = (corners[faces[:, i]] for i in range(3))
    volume = numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6
    scale = radius * (4 / 3 * numpy.pi / volume) ** (1 / 3)
    normals = corners
    if inward:
        faces, normals = faces[:, [0, 2, 1]], -corners
    return centre + scale * corners, faces, normals


for number, shape in enumerate(scene.meshes):
    name = f"mesh{number}"
    material(f"{name}-material", shape.material, shape.radiance)
    mesh(name, shape.positions, shape.triangles, shape.normals)
for number, shape in enumerate(scene.spheres):
    name = f"sphere{number}"
    material(f"{name}-material", shape.material, shape.radiance)
    mesh(name, *icosphere(shape.centre, shape.radius, shape.inward))
for number, (kind, values) in enumerate(scene.lights):
    name = f"scene.lights.light{number}"
    if kind == "point":
        define(
            name,
            type="point",
            position=values["position"],
            color=values["intensity"],
            gain=[4 * numpy.pi] * 3,
            gain__normalizebycolor=False,
            power=0.0,
            efficency=0.0,
        )
    elif kind == "constant":
        define(name, type="constantinfinite", color=values["radiance"], gain=[1.0] * 3)
    else:
        furnace.refuse(f"light {kind}")

camera = scene.camera
aspect = height / width
row = 2 / height
# The longer side reaches from -1 to 1, and the field of view is its own.
across, along = (1, aspect) if width >= height else (1 / aspect, 1)
define(
    "scene.camera",
    type="perspective",
    lookat__orig=camera.origin,
    lookat__target=camera.target,
    up=camera.up,
    fieldofview=camera.horizontal_fov if width >= height else 2 * numpy.degrees(
        numpy.arctan(numpy.tan(numpy.radians(camera.horizontal_fov) / 2) * aspect)
    ),
    screenwindow=[-across, across, -along - row * along, along - row * along],
    autofocus__enable=False,
    clipping__auto=False,
    cliphither=camera.near,
    clipyon=camera.far,
    shutteropen=0.0,
    shutterclose=0.0,
)

config = lux.Properties()
for name, setting in {
    "renderengine.type": "PATHCPU",
    "renderengine.seed": seed + 1,
    "native.threads.count": threads,
    "sampler.type": "RANDOM",
    "sampler.random.adaptive.strength": 0.0,
    "film.width": width,
    "film.height": height,
    "film.filter.type": "NONE",
    "film.imagepipelines.0.0.type": "NOP",
    "film.outputs.0.type": "RGB",
    "film.outputs.0.filename": "unused.exr",
    "path.pathdepth.total": scene.last_bounce + 1,
    "path.pathdepth.diffuse": scene.last_bounce + 1,
    "path.pathdepth.glossy": scene.last_bounce + 1,
    "path.pathdepth.specular": scene.last_bounce + 1,
    "path.russianroulette.depth": 1_000_000,
    "path.clamping.variance.maxvalue": 0.0,
    "lightstrategy.type": "UNIFORM",
    "batch.haltspp": samples,
}.items():
    config.Set(lux.Property(name, setting))
session = lux.RenderSession(lux.RenderConfig(config, described))
session.Start()
while not session.HasDone():
    time.sleep(0.02)
    session.UpdateStats()
pixels = numpy.zeros((height, width, 3), dtype=numpy.float32)
session.GetFilm().GetOutputFloat(lux.FilmOutputType.RGB, pixels, 0)
session.Stop()
furnace.write_pfm(output, pixels[::-1])
print("seconds", time.process_time(), flush=True)
# The module aborts when the interpreter ends in order.
os._exit(0)
