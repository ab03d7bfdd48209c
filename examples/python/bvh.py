"""A bounding volume hierarchy (BVH) with median splits, which all rays traverse at once."""

import numpy as np
from shapes import slabs

# Pairs of a ray and a primitive that a loop over everything looks at together.
PAIRS = 1 << 20

# Boxes are widened by this much, relative, so that rounding loses no hit.
WIDER = 1 + 1e-14


def brute_force(primitives, batch):
    """Every primitive for every ray: (primitive or -1, t, u, v), counts."""
    count = len(batch)
    best = np.full(count, -1), batch["t_max"].copy(), np.zeros(count), np.zeros(count)
    rows = max(1, PAIRS // max(1, primitives.count))
    for start in range(0, count if primitives.count else 0, rows):
        part = slice(start, start + rows)
        size = len(batch[part])
        ray = np.repeat(np.arange(start, start + size), primitives.count)
        t, u, v = primitives.meet(np.tile(np.arange(primitives.count), size), *segment(batch, ray))
        t = t.reshape(size, -1)
        nearest = t.argmin(axis=1)
        pair = np.arange(size) * primitives.count + nearest
        met = np.isfinite(t.min(axis=1))
        for kept, found in zip(best, (nearest, t.ravel()[pair], u[pair], v[pair])):
            kept[part][met] = found[met]
    return best, {"primitive-tests": count * primitives.count}


def segment(batch, ray):
    return batch["origin"][ray], batch["direction"][ray], batch["t_min"][ray], batch["t_max"][ray]


class Tree:
    """Nodes in arrays. A leaf has `size` primitives from `first` on in `order`, an inner node has
    none and two children."""

    def __init__(self, primitives, leaf_size):
        self.primitives, self.leaf_size = primitives, max(1, leaf_size)
        self.order = np.arange(primitives.count)
        self.depth, nodes = 0, []
        if primitives.count:
            self.divide(nodes, 0, primitives.count, 1)
        columns = list(zip(*nodes)) or [[]] * 6
        self.low, self.high = (np.array(c, dtype=float).reshape(-1, 3) for c in columns[:2])
        self.first, self.size, self.left, self.right = (np.array(c, int) for c in columns[2:])

    def divide(self, nodes, first, last, depth):
        """Adds the node over order[first:last] and everything below it; answers its number."""
        here = self.order[first:last]
        number = len(nodes)
        self.depth = max(self.depth, depth)
        low = self.primitives.low[here].min(axis=0)
        high = self.primitives.high[here].max(axis=0)
        if last - first <= self.leaf_size:
            nodes.append((low, high, first, last - first, 0, 0))
            return number
        nodes.append(None)
        centroids = self.primitives.centroid[here]
        axis = np.argmax(np.ptp(centroids, axis=0))
        half = (last - first) // 2
        self.order[first:last] = here[np.argpartition(centroids[:, axis], half)]
        left = self.divide(nodes, first, first + half, depth + 1)
        right = self.divide(nodes, first + half, last, depth + 1)
        nodes[number] = (low, high, first, 0, left, right)
        return number

    def stats(self):
        leaves = int((self.size > 0).sum())
        return {"nodes": len(self.size), "leaves": leaves, "max-depth": self.depth}

    def walk(self, batch, any_hit):
        """As `brute_force`; every turn of the loop takes one node from the stack of each ray."""
        walk = Walk(self, batch, any_hit)
        walk.begin()
        while len(walk.active):
            walk.turn()
        counts = {"box-tests": walk.box_tests, "primitive-tests": walk.primitive_tests}
        return (walk.primitive, walk.t, walk.u, walk.v), counts


class Walk:
    """Where each ray is on its way through a tree."""

    def __init__(self, tree, batch, any_hit):
        self.tree, self.batch, self.any_hit = tree, batch, any_hit
        count = len(batch)
        self.primitive = np.full(count, -1)
        self.t, self.u, self.v = batch["t_max"].copy(), np.zeros(count), np.zeros(count)
        self.stack = np.zeros((count, tree.depth + 2), int)
        self.enters = np.zeros((count, tree.depth + 2))
        self.height = np.zeros(count, int)
        self.active = np.arange(0)
        self.box_tests = self.primitive_tests = 0

    def begin(self):
        if len(self.tree.size):
            everyone = np.arange(len(self.batch))
            meets, enter = self.look_at(everyone, np.zeros(len(everyone), int))
            self.push(everyone[meets], np.zeros(meets.sum(), int), enter[meets])
            self.active = everyone[meets]

    def look_at(self, ray, node):
        """Whether each ray meets the box of a node before what it has found, and where."""
        self.box_tests += len(ray)
        origin, direction, t_min, _ = segment(self.batch, ray)
        enter, leave = slabs(self.tree.low[node], self.tree.high[node], origin, direction)
        leave = np.where(leave > 0, leave * WIDER, leave / WIDER)
        return (enter <= leave) & (enter <= self.t[ray]) & (leave >= t_min), enter

    def push(self, ray, node, enter):
        self.stack[ray, self.height[ray]] = node
        self.enters[ray, self.height[ray]] = enter
        self.height[ray] += 1

    def turn(self):
        ray = self.active
        self.height[ray] -= 1
        node, enter = self.stack[ray, self.height[ray]], self.enters[ray, self.height[ray]]
        worth_it = enter <= self.t[ray]
        ray, node = ray[worth_it], node[worth_it]
        is_leaf = self.tree.size[node] > 0
        self.test(ray[is_leaf], node[is_leaf])
        self.descend(ray[~is_leaf], node[~is_leaf])
        if self.any_hit:
            self.height[self.primitive >= 0] = 0
        self.active = self.active[self.height[self.active] > 0]

    def test(self, ray, leaf):
        """The primitives of leaves, one of each leaf at a time."""
        for place in range(self.tree.size[leaf].max(initial=0)):
            here = place < self.tree.size[leaf]
            if self.any_hit:
                here &= self.primitive[ray] < 0
            those = ray[here]
            primitive = self.tree.order[self.tree.first[leaf[here]] + place]
            origin, direction, t_min, _ = segment(self.batch, those)
            self.primitive_tests += len(those)
            found = self.tree.primitives.meet(primitive, origin, direction, t_min, self.t[those])
            met = np.isfinite(found[0])
            self.primitive[those[met]] = primitive[met]
            for kept, new in zip((self.t, self.u, self.v), found):
                kept[those[met]] = new[met]

    def descend(self, ray, node):
        """Puts the children that are met on the stack, the nearer one on top."""
        children = self.tree.left[node], self.tree.right[node]
        (meets_a, enter_a), (meets_b, enter_b) = (self.look_at(ray, child) for child in children)
        a_is_nearer = enter_a <= enter_b
        for nearer in (False, True):
            for child, meets, enter, is_it in (
                (children[0], meets_a, enter_a, a_is_nearer == nearer),
                (children[1], meets_b, enter_b, a_is_nearer != nearer),
            ):
                those = meets & is_it
                self.push(ray[those], child[those], enter[those])
