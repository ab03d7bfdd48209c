"""A renderer core for furnace in Python: subclass `Core`, and `serve` it."""

from .core import Built, Core, Unsupported
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
    "Built", "Core", "Unsupported", "misses", "rays", "serve",
]
