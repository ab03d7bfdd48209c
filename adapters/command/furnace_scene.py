"""Reads the Mitsuba scenes that `furnace` writes, for drivers of renderers that have a Python module.

Only what `furnace export --format mitsuba` writes is understood; anything else ends with a message.
"""

import os
import sys
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field

import numpy


@dataclass
class Camera:
    origin: numpy.ndarray
    target: numpy.ndarray
    up: numpy.ndarray
    horizontal_fov: float
    near: float
    far: float


@dataclass
class Material:
    kind: str
    two_sided: bool
    values: dict


@dataclass
class Mesh:
    """Triangles; `normals` is None where faces are flat."""

    positions: numpy.ndarray
    triangles: numpy.ndarray
    normals: object
    material: Material
    radiance: object


@dataclass
class Sphere:
    centre: numpy.ndarray
    radius: float
    inward: bool
    material: Material
    radiance: object


@dataclass
class Scene:
    camera: Camera
    size: tuple
    last_bounce: int
    meshes: list = field(default_factory=list)
    spheres: list = field(default_factory=list)
    lights: list = field(default_factory=list)


def refuse(what):
    sys.exit(f"beyond this driver: {what}")


def read(path):
    root = xml.parse(path).getroot()
    sensor = root.find("sensor")
    look = sensor.find("transform/lookat")
    film = values(sensor.find("film"))
    camera = values(sensor)
    scene = Scene(
        camera=Camera(
            *(numbers(look.get(name)) for name in ("origin", "target", "up")),
            horizontal_fov=camera["fov"],
            near=camera["near_clip"],
            far=camera["far_clip"],
        ),
        size=(film["width"], film["height"]),
        last_bounce=values(root.find("integrator"))["max_depth"] - 1,
    )
    folder = os.path.dirname(path)
    for element in root.findall("shape"):
        shape = read_shape(element, folder)
        (scene.spheres if isinstance(shape, Sphere) else scene.meshes).append(shape)
    for element in root.findall("emitter"):
        scene.lights.append((element.get("type"), values(element)))
    return scene


def read_shape(element, folder):
    material = read_material(element.find("bsdf"))
    emitter = element.find("emitter")
    radiance = None if emitter is None else values(emitter)["radiance"]
    kind, own = element.get("type"), values(element)
    if kind == "sphere":
        return Sphere(own["center"], own["radius"], own["flip_normals"], material, radiance)
    if kind == "rectangle":
        matrix = numbers(element.find("transform/matrix").get("value")).reshape(4, 4)
        corners = numpy.array([[-1, -1, 0, 1], [1, -1, 0, 1], [1, 1, 0, 1], [-1, 1, 0, 1]])
        positions = (corners @ matrix.T)[:, :3]
        return Mesh(positions, numpy.array([[0, 1, 2], [0, 2, 3]]), None, material, radiance)
    if kind == "ply":
        positions, normals, triangles = read_ply(os.path.join(folder, own["filename"]))
        return Mesh(positions, triangles, normals, material, radiance)
    return refuse(f"shape {kind}")


def read_material(element):
    if element.get("type") == "twosided":
        inner = read_material(element.find("bsdf"))
        return Material(inner.kind, True, inner.values)
    return Material(element.get("type"), False, values(element))


def values(element):
    """The children that have a name and a value."""
    return {child.get("name"): value(child) for child in element if child.get("name") and child.tag != "transform"}


def value(element):
    text = element.get("value")
    if element.tag in ("point", "vector"):
        return numpy.array([float(element.get(axis)) for axis in "xyz"])
    if element.tag == "rgb":
        return numbers(text)
    return {"integer": int, "float": float, "string": str, "boolean": "true".__eq__}[element.tag](text)


def numbers(text):
    return numpy.array([float(word) for word in text.replace(",", " ").split()])


def read_ply(path):
    with open(path, "rb") as file:
        data = file.read()
    header, _, body = data.partition(b"end_header\n")
    header = header.decode().splitlines()
    count = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    columns = sum(line.startswith("property float") for line in header)
    vertices = numpy.frombuffer(body, "<f4", count["vertex"] * columns).reshape(-1, columns).astype(float)
    face = numpy.dtype([("corners", "u1"), ("indices", "<u4", 3)])
    faces = numpy.frombuffer(body, face, count["face"], vertices.size * 4)
    return vertices[:, :3], vertices[:, 3:6] if columns == 6 else None, faces["indices"].astype(int)


def write_pfm(path, pixels):
    """Rows from the top, three channels of radiance."""
    height, width, _ = pixels.shape
    with open(path, "wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode())
        file.write(numpy.ascontiguousarray(pixels[::-1], dtype="<f4").tobytes())


def arguments():
    """SCENE OUTPUT SAMPLES SEED THREADS, in this order."""
    scene, output, *rest = sys.argv[1:]
    samples, seed, threads = map(int, rest)
    return scene, output, samples, seed, threads
