"""Members of headers as Python has them, and back: objects as attributes, lists of numbers as arrays."""

import numpy as np


class Table:
    """A JSON object whose members are attributes: `settings.samples_per_light`."""

    def __init__(self, members):
        for name, value in members.items():
            setattr(self, name.replace("-", "_"), table(value))

    def __repr__(self):
        return f"{type(self).__name__}({vars(self)})"

    def but(self, **changes):
        """A copy with other members: `settings.but(bounces={"start": 0, "end": 0}, seed=7)`."""
        copy = type(self).__new__(type(self))
        vars(copy).update(vars(self), **{name: table(value) for name, value in changes.items()})
        return copy

    def members(self):
        """The JSON object again."""
        return {name.replace("_", "-"): json_of(value) for name, value in vars(self).items()}


class Camera(Table):
    """With its axes as the rows of a matrix."""

    def __init__(self, members):
        super().__init__(members)
        self.axes = self.camera_to_world.reshape(3, 3)

    def members(self):
        plain = super().members()
        del plain["axes"]
        return plain


class Material(Table):
    """The members of its surface are its own."""

    def __init__(self, members):
        super().__init__({**members["surface"], "name": members["name"]})
        emission = members["emission"]
        self.emission = emission and Table(emission)

    def members(self):
        surface = super().members()
        name, emission = surface.pop("name"), surface.pop("emission")
        return {"name": name, "surface": surface, "emission": emission}


def table(value):
    """Objects as tables, lists of numbers as arrays."""
    if isinstance(value, dict):
        return Table(value)
    if isinstance(value, list) and value and all(isinstance(v, (int, float)) for v in value):
        return np.array(value, dtype=float)
    if isinstance(value, list):
        return [table(v) for v in value]
    return value


def json_of(value):
    """A member as JSON has it; numbers that are whole without a point, wherever they came from."""
    if isinstance(value, Table):
        return value.members()
    if isinstance(value, (np.ndarray, np.generic)):
        return json_of(value.tolist())
    if isinstance(value, (list, tuple)):
        return [json_of(v) for v in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value
