"""Triangles, spheres and boxes. Every function takes many pairs of a ray and a shape at a time.

Sums are written out: `einsum` and `@` add in an order that depends on how many rows there are, and a
BVH has to find the same t as a loop, to the last bit.
"""

import numpy as np
from furnace_core import misses


def dot(a, b):
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def cross(a, b):
    return np.stack([
        a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
        a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
        a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
    ], axis=-1)


def unit(a):
    with np.errstate(invalid="ignore", divide="ignore"):
        return a / np.sqrt(dot(a, a))[..., None]


def slabs(low, high, origin, direction):
    """Where lines enter and leave boxes. A line along a pair of planes is between them for ever, or
    never."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        a, b = (low - origin) / direction, (high - origin) / direction
    between = (low <= origin) & (origin <= high)
    along = direction == 0
    near = np.where(along, np.where(between, -np.inf, np.inf), np.minimum(a, b))
    far = np.where(along, np.where(between, np.inf, -np.inf), np.maximum(a, b))
    return near.max(axis=-1), far.min(axis=-1)


class Primitives:
    """Triangles first, then spheres, in the order of their shapes."""

    def __init__(self, corners, normals, centres, radii, inward, shape, number):
        self.corners, self.normals = corners, normals
        self.centres, self.radii, self.inward = centres, radii, inward
        self.shape, self.number = shape, number
        self.triangles = len(corners)
        self.count = len(corners) + len(centres)
        self.low = np.concatenate([corners.min(axis=1), centres - radii[:, None]])
        self.high = np.concatenate([corners.max(axis=1), centres + radii[:, None]])
        self.centroid = (self.low + self.high) / 2

    @classmethod
    def of_scene(cls, scene):
        corners, normals, shape, number = [np.empty((0, 3, 3))], [np.empty((0, 3, 3))], [], []
        for index, mesh in enumerate(scene.meshes):
            of_mesh = mesh.positions[mesh.indices]
            corners.append(of_mesh)
            normals.append(mesh.normals[mesh.indices] if mesh.smooth else flat(of_mesh))
            shape += [index] * len(of_mesh)
            number += range(len(of_mesh))
        spheres = scene.spheres
        shape += range(len(scene.meshes), len(scene.meshes) + len(spheres))
        number += [0] * len(spheres)
        return cls(
            np.concatenate(corners), np.concatenate(normals),
            np.array([sphere.centre for sphere in spheres]).reshape(-1, 3),
            np.array([sphere.radius for sphere in spheres], dtype=float),
            np.array([sphere.inward for sphere in spheres], dtype=bool),
            np.array(shape, dtype=np.uint32), np.array(number, dtype=np.uint32),
        )

    @classmethod
    def triangle(cls, positions, normals):
        none = np.empty((0, 3)), np.empty(0), np.empty(0, bool)
        return cls(positions[None], normals[None], *none, np.zeros(1, int), np.zeros(1, int))

    @classmethod
    def sphere(cls, centre, radius):
        none = np.empty((0, 3, 3)), np.empty((0, 3, 3))
        sphere = centre[None], np.array([radius]), np.zeros(1, bool)
        return cls(*none, *sphere, np.zeros(1, int), np.zeros(1, int))

    def meet(self, primitive, origin, direction, t_min, t_max):
        """t, u and v of each pair of a primitive and a ray; t is infinite where they do not meet."""
        t, u, v = (np.full(len(primitive), fill) for fill in (np.inf, 0.0, 0.0))
        of_triangle = primitive < self.triangles
        for pairs, routine in ((of_triangle, self.meet_triangles), (~of_triangle, self.meet_balls)):
            if pairs.any():
                answer = routine(primitive[pairs], origin[pairs], direction[pairs],
                                 t_min[pairs], t_max[pairs])
                t[pairs], u[pairs], v[pairs] = answer
        return t, u, v

    def meet_triangles(self, primitive, origin, direction, t_min, t_max):
        """Möller and Trumbore 1997, both sides. A determinant of zero makes NaN, which is no hit; one
        that rounding has left of a triangle without area is none either."""
        a, b, c = (self.corners[primitive, corner] for corner in range(3))
        ab, ac, from_a = b - a, c - a, origin - a
        p, q = cross(direction, ac), cross(from_a, ab)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            determinant = dot(ab, p)
            u, v = dot(from_a, p) / determinant, dot(direction, q) / determinant
            t = dot(ac, q) / determinant
            meets = (u >= 0) & (v >= 0) & (u + v <= 1) & (t_min < t) & (t < t_max)
            normal = cross(ab, ac)
            meets &= dot(normal, normal) > 0
        return np.where(meets, t, np.inf), u, v

    def meet_balls(self, primitive, origin, direction, t_min, t_max):
        """The nearer root in the segment, without cancellation (Haines et al. 2019)."""
        sphere = primitive - self.triangles
        from_centre, radius = origin - self.centres[sphere], self.radii[sphere]
        a, half_b = dot(direction, direction), dot(from_centre, direction)
        nearest = from_centre - (half_b / a)[:, None] * direction
        discriminant = a * (radius * radius - dot(nearest, nearest))
        with np.errstate(divide="ignore", invalid="ignore"):
            q = -(half_b + np.copysign(np.sqrt(discriminant), half_b))
            roots = (dot(from_centre, from_centre) - radius * radius) / q, q / a
            first, second = np.minimum(*roots), np.maximum(*roots)
            inside = [(t_min < t) & (t < t_max) for t in (first, second)]
        t = np.where(inside[0], first, np.where(inside[1], second, np.inf))
        return t, np.zeros_like(t), np.zeros_like(t)

    def hits(self, batch, primitive, t, u, v):
        """What is told of the nearest hits; primitive -1 is none."""
        hits = misses(len(batch))
        met = primitive >= 0
        found = primitive[met]
        hits["t"][met], hits["uv"][met] = t[met], np.stack([u[met], v[met]], axis=1)
        hits["shape"][met], hits["primitive"][met] = self.shape[found], self.number[found]
        geometric, shading = self.normals_at(found, batch[met], t[met], u[met], v[met])
        hits["geometric_normal"][met], hits["shading_normal"][met] = geometric, shading
        return hits

    def normals_at(self, primitive, batch, t, u, v):
        geometric, shading = np.empty((2, len(primitive), 3))
        flat_ones = primitive < self.triangles
        index = primitive[flat_ones]
        geometric[flat_ones] = flat(self.corners[index])[:, 0]
        weights = np.stack([1 - u - v, u, v], axis=1)[flat_ones]
        shading[flat_ones] = unit((weights[:, :, None] * self.normals[index]).sum(axis=1))
        sphere = primitive[~flat_ones] - self.triangles
        point = batch["origin"] + t[:, None] * batch["direction"]
        outward = unit(point[~flat_ones] - self.centres[sphere])
        normal = np.where(self.inward[sphere][:, None], -outward, outward)
        geometric[~flat_ones] = shading[~flat_ones] = normal
        return geometric, shading


def flat(corners):
    """The normal of each triangle, at each of its corners."""
    normal = unit(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    return np.repeat(normal[:, None], 3, axis=1)
