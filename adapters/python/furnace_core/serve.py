"""The channel: requests come, answers go. `docs/book/src/protocol.md` says what they are made of."""

import json
import os
import struct
import sys
import time
import traceback

import numpy as np

from .bench import bench, put_in_place
from .core import COMPONENTS, Built, Core, Random, Unsupported, capabilities, known, methods
from .elements import ELEMENTS, decode, encode
from .tables import Camera, Material, Table, table

MAGIC = b"FRN1"
PREFIX = struct.Struct("<4sIQQ")


class Channel:
    """Both directions."""

    def __init__(self):
        place = os.environ.get("FURNACE_CHANNEL", "stdio")
        if place == "stdio":
            source, sink = os.dup(0), os.dup(1)
            # What the core prints must not come between the frames.
            os.dup2(2, 1)
        else:
            source, sink = int(place), os.dup(int(place))
        self.source, self.sink = os.fdopen(source, "rb"), os.fdopen(sink, "wb")
        # Of the request that is being answered.
        self.number = 0

    def read(self):
        """The next request: its header, its arrays. None when the channel is closed."""
        prefix = self.source.read(PREFIX.size)
        if len(prefix) < PREFIX.size:
            return None
        magic, header_size, self.number, body_size = PREFIX.unpack(prefix)
        if magic != MAGIC:
            raise RuntimeError(f"a frame that begins with {magic!r}")
        header = json.loads(self.source.read(header_size))
        body = self.source.read(body_size)
        arrays, offset = {}, 0
        for name, element, count in header.pop("arrays", []):
            size = self.size(element, count)
            arrays[name] = decode(element, count, body[offset:offset + size])
            offset += size + -size % 8
        return header, arrays

    def ask(self, header, arrays):
        """What the bench answers, while it waits for an answer itself: a header, and arrays."""
        self.write(header, [(name, element, len(array), array) for name, element, array in arrays])
        answered = self.read()
        if answered is None:
            sys.exit("the bench has closed the channel")
        return answered

    @staticmethod
    def size(element, count):
        """Bytes of so many elements."""
        dtype, shape = ELEMENTS[element]
        return dtype.itemsize * int(np.prod(shape, dtype=int)) * count

    def write(self, header, arrays=()):
        """Answers, or asks: `arrays` are (name, element, count, array)."""
        parts = [(name, element, count, encode(element, count, array))
                 for name, element, count, array in arrays]
        header = dict(header, arrays=[part[:3] for part in parts])
        text = json.dumps(header).encode()
        body = b"".join(data + bytes(-len(data) % 8) for *_, data in parts)
        self.sink.write(PREFIX.pack(MAGIC, len(text), self.number, len(body)) + text + body)
        self.sink.flush()


def serve(core):
    """Answers every request until the bench closes the channel."""
    channel = Channel()
    if core.built is not None:
        core.built.core = core
    built = None
    while True:
        request = channel.read()
        if request is None:
            return
        header, arrays = request
        begun = time.process_time()
        try:
            answer, sent, built = ask(core, built, channel, header, arrays)
            answer["cpu-seconds"] = time.process_time() - begun
            channel.write(answer, sent)
        except (Unsupported, NotImplementedError) as error:
            why = str(error) or f"{header['request']} is not there"
            channel.write({"answer": "beyond", "why": why})
        except MemoryError as error:
            traceback.print_exc()
            channel.write({"answer": "refused", "why": f"MemoryError: {error}"})
        except Exception as error:  # whatever it is, it is the core's answer
            traceback.print_exc()
            sys.stderr.flush()
            why = f"{type(error).__name__}: {error}"
            channel.write({"answer": "refused", "why": why})


def ask(core, built, channel, header, arrays):
    """What the core answers: a header, its arrays, and the built scene from now on."""
    request = header["request"]
    if request == "hello":
        return introduction(core), [], built
    if request == "take-components":
        bench.take(header["components"], channel)
        put_in_place(Core, core)
        return {"answer": "done"}, [], built
    if request == "build":
        built = None  # at most one at a time
        built = core.build(Scene(header["scene"], arrays), Table(header["acceleration"]))
        put_in_place(Built, built)
        stats = {"nodes": 0, "leaves": 0, "max-depth": 0, "bytes": 0}
        return {"answer": "built", "stats": whole({**stats, **built.stats()})}, [], built
    if request == "release":
        return {"answer": "done"}, [], None
    return (*answer(core, built, header, arrays), built)


def introduction(core):
    """Who the core is."""
    return {
        "answer": "core",
        "name": core.name,
        "version": core.version,
        "precision": core.precision,
        "capabilities": capabilities(core),
        "conventions": core.conventions,
        "components": sorted(known(word, COMPONENTS, "`takes`") for word in core.takes),
    }


def answer(core, built, header, arrays):
    """What comes of a question of `Core` or `Built`."""
    request = header["request"]
    owner = Core if request in methods(Core) else Built
    asked = methods(owner).get(request)
    if asked is None:
        raise Unsupported(f"the request `{request}` is not known to this version of furnace_core")
    method = getattr(core if owner is Core else built, asked.__name__)
    told = method(*(argument(name, header, arrays) for name in asked.arguments))
    if told is None:
        raise TypeError(f"{asked.__name__} answered None: it has no `return`")
    if request == "render":
        return {"answer": "done"}, picture(core, header["settings"], told)
    name, element = asked.answer
    count = len(list(arrays.values())[-1])
    told, counts = told if asked.tells_stats else (told, {})
    sent = [(name.replace("_", "-"), element, count, fitting(asked, count, rows(told, element)))]
    if not asked.tells_stats:
        return {"answer": "done"}, sent
    stats = {"rays": count, "box-tests": 0, "primitive-tests": 0, **counts}
    return {"answer": "traced", "stats": whole(stats)}, sent


def fitting(asked, count, told):
    """An answer of the shape that was asked for; complains of any other by the name of the method."""
    _, element = asked.answer
    _, shape = ELEMENTS[element]
    if np.shape(told) != (count, *shape):
        wanted = f"{(count, *shape)} is wanted, one {element} each"
        raise ValueError(f"{asked.__name__} answered an array of shape {np.shape(told)}: {wanted}")
    return told


def rows(told, element):
    """An answer as an array: a tuple are its columns, a list of tuples its rows."""
    dtype, _ = ELEMENTS[element]
    if dtype.names is None or not isinstance(told, (tuple, list)):
        return told
    columns = told if isinstance(told, tuple) else tuple(zip(*told))
    made = np.zeros(len(columns[0]), dtype)
    for name, column in zip(dtype.names, columns):
        made[name] = column
    return made


def picture(core, settings, told):
    """The arrays of a picture."""
    count = settings["width"] * settings["height"]
    pixels, samples, *rest = told
    sent = [
        ("pixels", "rgb-f32", count, np.reshape(pixels, (count, 3))),
        ("sample-counts", "u32", count, np.reshape(samples, count)),
    ]
    if "reported-variance" in core.traits:
        [variances] = rest
        sent.append(("variances", "rgb-f32", count, np.reshape(variances, (count, 3))))
    return sent


def whole(counts):
    """Counts as JSON has them, whatever kind of integer they were."""
    return {name: int(count) for name, count in counts.items()}


# Arguments that are not simply an array or a member of their name.
ARGUMENTS = {
    "camera": lambda header, arrays: Camera(header["camera"]),
    "material": lambda header, arrays: Material(header["material"]),
    "random": lambda header, arrays: Random(arrays["points"], arrays["lobes"], header["seed"]),
    "centre": lambda header, arrays: arrays["spheres"][0][:3],
    "radius": lambda header, arrays: float(arrays["spheres"][0][3]),
    "low": lambda header, arrays: arrays["bounds"][0],
    "high": lambda header, arrays: arrays["bounds"][1],
    "wo": lambda header, arrays: arrays["queries"]["wo"] if "queries" in arrays else arrays["wo"],
    "wi": lambda header, arrays: arrays["queries"]["wi"],
    "origins": lambda header, arrays: arrays["from"],
    "streams": lambda header, arrays: np.split(
        arrays["values"], np.cumsum(arrays["lengths"]).astype(int)[:-1]
    ),
}


def argument(name, header, arrays):
    """What a method is handed under a name."""
    if name in ARGUMENTS:
        return ARGUMENTS[name](header, arrays)
    plain = name.replace("_", "-")
    return arrays[plain] if plain in arrays else table(header[plain])


class Scene:
    """A scene. Shapes are numbered meshes first, then spheres."""

    def __init__(self, header, arrays):
        self.name = header["name"]
        self.camera = header["camera"] and Camera(header["camera"])
        self.materials = [Material(material) for material in header["materials"]]
        self.lights = [Table(light) for light in header["lights"]]
        self.meshes, rest = [], {name: arrays[name] for name in ("positions", "normals", "indices")}
        for members in header["meshes"]:
            mesh = Table(members)
            normals = mesh.vertices if mesh.smooth else 0
            for name, count in (("positions", mesh.vertices), ("normals", normals),
                                ("indices", mesh.triangles)):
                setattr(mesh, name, rest[name][:count])
                rest[name] = rest[name][count:]
            self.meshes.append(mesh)
        shapes = zip(header["spheres"], arrays["spheres"], arrays["sphere-kinds"])
        self.spheres = [
            Table({"name": name, "centre": np.array(shape[:3]), "radius": float(shape[3]),
                   "inward": bool(kind[0]), "material": int(kind[1])})
            for name, shape, kind in shapes
        ]
