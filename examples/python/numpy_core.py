"""Rays, shapes and a bounding volume hierarchy in NumPy: parts 1 and 2 of a path tracer.

    python3 -m venv .venv && .venv/bin/pip install ./adapters/python
    cargo furnace 1 2 --core 'exec: .venv/bin/python examples/python/numpy_core.py'

shapes.py     triangles, spheres and boxes, many pairs of a ray and a shape at a time
bvh.py        the BVH, traversed by all rays at once
this file     what the bench talks to
"""

import numpy as np
from furnace_core import BOX_HIT, Built, Core, rays, serve

import bvh
import shapes


class Scene(Built):
    """All primitives of a scene, and what stands before them."""

    def __init__(self, scene, acceleration):
        super().__init__(scene, acceleration)
        self.primitives = shapes.Primitives.of_scene(scene)
        self.tree = None
        if acceleration.kind == "bvh":
            self.tree = bvh.Tree(self.primitives, acceleration.max_leaf_size)

    def stats(self):
        return self.tree.stats() if self.tree else {}

    def nearest(self, batch, any_hit):
        """Which primitive each ray meets, at what t and where on it, and what it took."""
        if self.tree:
            return self.tree.walk(batch, any_hit)
        return bvh.brute_force(self.primitives, batch)

    def intersect(self, batch):
        found, counts = self.nearest(batch, any_hit=False)
        return self.primitives.hits(batch, *found), counts

    def occluded(self, batch):
        (primitive, *_), counts = self.nearest(batch, any_hit=True)
        return primitive >= 0, counts


class NumPy(Core):
    """The whole core."""

    name, version = "numpy", "1.0"
    traits = {"brute-force", "traversal-stats", "deterministic"}
    takes = {"camera", "traversal"}
    built = Scene

    def generate_rays(self, camera, film):
        x = (2 * film[:, 0] - 1) * np.tan(camera.horizontal_fov / 2)
        y = (2 * film[:, 1] - 1) * np.tan(camera.vertical_fov / 2)
        right, up, backward = camera.axes
        toward = x[:, None] * right + y[:, None] * up - backward
        return rays(camera.position, shapes.unit(toward), camera.near, camera.far)

    def intersect_triangle(self, positions, normals, batch):
        return self.alone(shapes.Primitives.triangle(positions, normals), batch)

    def intersect_sphere(self, centre, radius, batch):
        return self.alone(shapes.Primitives.sphere(centre, radius), batch)

    @staticmethod
    def alone(primitives, batch):
        """Hits with the one primitive that there is."""
        found, _ = bvh.brute_force(primitives, batch)
        return primitives.hits(batch, *found)

    def intersect_box(self, low, high, batch):
        enter, leave = shapes.slabs(low, high, batch["origin"], batch["direction"])
        meets = (enter <= leave) & (enter <= batch["t_max"]) & (leave >= batch["t_min"])
        hits = np.zeros(len(batch), BOX_HIT)
        hits["t_enter"], hits["t_exit"], hits["hit"] = enter, leave, meets
        return hits


if __name__ == "__main__":
    serve(NumPy())
