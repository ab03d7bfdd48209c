"""A renderer core for furnace in Python: subclass `Core`, and `serve` it."""

from .bench import bench
from .core import Built, Core, Random, Unsupported
from .elements import (
    BOX_HIT,
    BSDF_SAMPLE,
    DIRECTION_SAMPLE,
    HIT,
    LIGHT_SAMPLE,
    NONE,
    RAY,
    misses,
    rays,
)
from .serve import serve

__all__ = [
    "BOX_HIT", "BSDF_SAMPLE", "DIRECTION_SAMPLE", "HIT", "LIGHT_SAMPLE", "NONE", "RAY",
    "Built", "Core", "Random", "Unsupported", "bench", "misses", "rays", "serve",
]
