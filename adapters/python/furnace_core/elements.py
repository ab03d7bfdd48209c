"""What arrays are made of: the same bytes as in furnace_core.h. Numbers are little-endian."""

import numpy as np

# `primitive` of a hit that is none.
NONE = 0xFFFFFFFF

RAY = np.dtype([("origin", "<f8", 3), ("t_min", "<f8"), ("direction", "<f8", 3), ("t_max", "<f8")])
HIT = np.dtype([
    ("t", "<f8"), ("shape", "<u4"), ("primitive", "<u4"), ("geometric_normal", "<f8", 3),
    ("shading_normal", "<f8", 3), ("uv", "<f8", 2),
])
BOX_HIT = np.dtype([("t_enter", "<f8"), ("t_exit", "<f8"), ("hit", "<u4"), ("reserved", "<u4")])
DIRECTION_SAMPLE = np.dtype([("direction", "<f8", 3), ("pdf", "<f8")])
BSDF_QUERY = np.dtype([("wo", "<f8", 3), ("wi", "<f8", 3)])
BSDF_VALUE = np.dtype([("f", "<f8", 3), ("pdf", "<f8")])
BSDF_SAMPLE = np.dtype([
    ("wi", "<f8", 3), ("f", "<f8", 3), ("pdf", "<f8"), ("is_delta", "<u4"), ("is_valid", "<u4"),
])
LIGHT_SAMPLE = np.dtype([
    ("wi", "<f8", 3), ("distance", "<f8"), ("radiance", "<f8", 3), ("pdf", "<f8"),
    ("is_delta", "<u4"), ("is_valid", "<u4"),
])
ADAPTIVE_MEAN = np.dtype([("mean", "<f8"), ("used", "<u4"), ("reserved", "<u4")])

# Elements by their names in the protocol: a type, and how many of it an element has.
ELEMENTS = {
    "u8": (np.dtype("u1"), ()),
    "u32": (np.dtype("<u4"), ()),
    "u64": (np.dtype("<u8"), ()),
    "f64": (np.dtype("<f8"), ()),
    "vec2": (np.dtype("<f8"), (2,)),
    "vec3": (np.dtype("<f8"), (3,)),
    "rgb": (np.dtype("<f8"), (3,)),
    "rgb-f32": (np.dtype("<f4"), (3,)),
    "triangle": (np.dtype("<u4"), (3,)),
    "sphere": (np.dtype("<f8"), (4,)),
    "sphere-kind": (np.dtype("<u4"), (2,)),
    "ray": (RAY, ()),
    "hit": (HIT, ()),
    "box-hit": (BOX_HIT, ()),
    "direction-sample": (DIRECTION_SAMPLE, ()),
    "bsdf-query": (BSDF_QUERY, ()),
    "bsdf-value": (BSDF_VALUE, ()),
    "bsdf-sample": (BSDF_SAMPLE, ()),
    "light-sample": (LIGHT_SAMPLE, ()),
    "adaptive-mean": (ADAPTIVE_MEAN, ()),
}


def decode(element, count, data):
    """The array of `count` elements in `data`."""
    dtype, shape = ELEMENTS[element]
    return np.frombuffer(data, dtype=dtype).reshape((count, *shape))


def encode(element, count, array):
    """The bytes of an array of `count` elements; complains where it is not of that shape."""
    dtype, shape = ELEMENTS[element]
    array = np.ascontiguousarray(array, dtype=dtype)
    if array.shape != (count, *shape):
        raise ValueError(f"an array of shape {array.shape}, not {(count, *shape)}")
    return array.tobytes()


def rays(origin, direction, t_min=0.0, t_max=np.inf):
    """Rays from one or many origins."""
    direction = np.asarray(direction, dtype=float)
    made = np.empty(len(direction), RAY)
    made["origin"], made["direction"] = origin, direction
    made["t_min"], made["t_max"] = t_min, t_max
    return made


def misses(count):
    """Hits that are none."""
    made = np.zeros(count, HIT)
    made["t"], made["shape"], made["primitive"] = np.inf, NONE, NONE
    return made
