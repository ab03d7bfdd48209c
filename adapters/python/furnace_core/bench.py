"""The bench's own components, for a core that takes some (`Core.takes`).

    from furnace_core import bench

    if bench.has("bsdf"):
        f, pdf = bench.eval_bsdf(material, wo, wi)

`bench` has the methods of `Core` and `Built` but `render`, with the same arguments and answers, as a right core answers them that
follows your conventions. A call is a message and its answer, some tenths of a millisecond: ask for many elements at once.
"""

import numpy as np

from .core import COMPONENTS, Built, Core, known, methods
from .elements import BSDF_QUERY
from .tables import json_of


class Bench:
    """What the bench lends."""

    def __init__(self):
        self.taken, self.channel = frozenset(), None

    def has(self, component):
        """Whether the bench's stands in the place of yours."""
        return known(component, COMPONENTS, "bench.has") in self.taken

    def has_bounces(self, bounces):
        """Whether the bench's are all of these bounces of light."""
        of_bounce = {0: "emission", 1: "direct-lighting"}
        asked = range(bounces.start, bounces.end + 1)
        return self.has("path") or all(of_bounce.get(bounce) in self.taken for bounce in asked)

    def take(self, components, channel):
        """From now on these are the bench's, which is asked through the channel."""
        self.taken, self.channel = frozenset(components), channel

    def ask(self, question, arguments):
        """What the bench answers to a question of `Core` or `Built`."""
        name = question.__name__
        if not self.taken:
            raise RuntimeError(f"the bench lends nothing here: ask `bench.has` before `bench.{name}`")
        given = dict(zip(question.arguments, arguments))
        header = {"request": question.request, **members(given)}
        answer, told = self.channel.ask(header, arrays(given))
        if answer["answer"] not in ("done", "traced"):
            raise RuntimeError(f"`bench.{name}`: {answer.get('why', answer['answer'])}")
        return received(question, answer, list(told.values()))


def method_of(question):
    """The question as a method of `Bench`."""

    def asked(self, *arguments):
        return self.ask(question, arguments)

    asked.__name__, asked.__doc__ = question.__name__, question.__doc__
    return asked


# A picture is none of them: with the bench's as a whole nothing would be the core's own.
for question in (*methods(Core).values(), *methods(Built).values()):
    if question.component or question is Built.radiance:
        setattr(Bench, question.__name__, method_of(question))

bench = Bench()


def put_in_place(owner, mine):
    """Has a core, or a scene that it has taken in, answer by the bench's methods for what is taken."""
    for question in methods(owner).values():
        if question.component in bench.taken:
            setattr(mine, question.__name__, getattr(bench, question.__name__))
    if owner is Built and bench.taken:
        own = mine.radiance
        mine.radiance = lambda rays, settings: (
            bench.radiance if bench.has_bounces(settings.bounces) else own)(rays, settings)


# Arguments that travel as arrays: (name, element, array) of each.
ARRAYS = {
    "film": lambda given: [("film", "vec2", given["film"])],
    "rays": lambda given: [("rays", "ray", given["rays"])],
    "positions": lambda given: [("positions", "vec3", given["positions"])],
    "normals": lambda given: [("normals", "vec3", given["normals"])],
    "centre": lambda given: [("spheres", "sphere", [[*given["centre"], given["radius"]]])],
    "radius": lambda given: [],
    "low": lambda given: [("bounds", "vec3", [given["low"], given["high"]])],
    "high": lambda given: [],
    "directions": lambda given: [("directions", "vec3", given["directions"])],
    "wo": lambda given: [] if "wi" in given else [("wo", "vec3", given["wo"])],
    "wi": lambda given: [("queries", "bsdf-query", pairs(given["wo"], given["wi"]))],
    "origins": lambda given: [("from", "vec3", given["origins"])],
    "random": lambda given: [
        ("points", "vec2", given["random"].points), ("lobes", "f64", given["random"].lobes),
    ],
    "streams": lambda given: [
        ("values", "f64", np.concatenate([[], *given["streams"]])),
        ("lengths", "u64", [len(stream) for stream in given["streams"]]),
    ],
}


def arrays(given):
    """The arrays of a question, in the order of the protocol."""
    return [array for name in given if name in ARRAYS for array in ARRAYS[name](given)]


def members(given):
    """The members of a question's header."""
    plain = {name.replace("_", "-"): json_of(value) for name, value in given.items()
             if name not in ARRAYS}
    if "random" in given:
        plain["seed"] = int(getattr(given["random"], "seed", 0))
    return plain


def pairs(wo, wi):
    """Queries of a BSDF."""
    made = np.zeros(len(wo), BSDF_QUERY)
    made["wo"], made["wi"] = wo, wi
    return made


def received(question, answer, told):
    """An answer of the bench's as a core's own method gives it."""
    if question.request == "eval-bsdf":
        return told[0]["f"], told[0]["pdf"]
    return (told[0], answer["stats"]) if question.tells_stats else told[0]
