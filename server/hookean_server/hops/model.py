"""What a function of Hops is: its inputs and outputs, how they are described, how a request is read and answered."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.commands.examples import defaults
from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean_server.hops.values import SIZES, TYPES, read, size, write
from hookean_server.workers.task import Cancelled

Floats = NDArray[np.float64]

MANY = 2147483647
UNITS = {"Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km",
         "Inches": "in", "Feet": "ft", "Yards": "yd"}  # fmt: skip

_PATH = re.compile(r"\{?\s*([0-9]{1,9}(\s*;\s*[0-9]{1,9})*)?\s*\}?")


@dataclass(frozen=True)
class Parameter:
    """An input or output. `kind` is Grasshopper's name of its type; `least` and `most` how many values it takes: one
    each is an item, -1 each a tree, else a list. Numbers are from `minimum` to `maximum`; a text is one of `choices`.
    """

    name: str
    nickname: str
    kind: str
    description: str
    least: int = 1
    most: int = MANY
    default: float | bool | str | None = None
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()

    @property
    def tree(self) -> bool:
        """Whether it takes or gives a whole tree."""
        return self.most == -1

    @property
    def one(self) -> bool:
        """Whether it takes or gives one value."""
        return self.least == self.most == 1

    @property
    def key(self) -> str:
        """Its name as a parameter of Python: `length_factor` of `Length factor`."""
        return self.name.lower().replace(" ", "_")

    def described(self) -> dict[str, Any]:
        """As Hops reads it."""
        found: dict[str, Any] = {"Name": self.name, "Nickname": self.nickname, "Description": self.description,
                                 "ParamType": self.kind, "ResultType": TYPES[self.kind], "AtLeast": self.least,
                                 "AtMost": self.most}  # fmt: skip
        extra = {"Default": self.default, "Minimum": self.minimum, "Maximum": self.maximum}
        return found | {key: value for key, value in extra.items() if value is not None}

    def check(self, value: Any) -> Any:
        """A value within its bounds; InputError otherwise."""
        low, high = self.minimum, self.maximum
        if low is not None and value < low or high is not None and value > high:
            allowed = f"{low:g} to {high:g}" if None not in (low, high) else f"{low:g} and more"
            raise InputError(f"/{self.name}", f"{value:g} given; {allowed} allowed")
        if self.choices and value not in self.choices:
            raise InputError(f"/{self.name}", f"unknown text; allowed: {', '.join(self.choices)}")
        return value


def item(name: str, nickname: str, kind: str, description: str, default: Any = None, **bounds: Any) -> Parameter:
    """A parameter of one value."""
    return Parameter(name, nickname, kind, description, 1, 1, default, **bounds)


def count(name: str, nickname: str, description: str, default: int | None, most: int, least: int = 1) -> Parameter:
    """An input that is one whole number."""
    return item(name, nickname, "Integer", description, default, minimum=least, maximum=most)


def optional(parameter: Parameter) -> Parameter:
    """The same where nothing need be connected."""
    return replace(parameter, least=0)


def inputs_of(make: Callable[..., Any], *inputs: Parameter) -> tuple[Parameter, ...]:
    """Inputs of which those that are parameters of `make`, a figure's scene, have their defaults from it."""
    known = defaults(make)
    return tuple(
        replace(p, default=known[p.key]) if isinstance(known.get(p.key), bool | int | float | str) else p
        for p in inputs
    )


Run = Callable[["Inputs", Cancelled], dict[str, Any]]


@dataclass(frozen=True)
class Function:
    """One function: what Hops shows of it, and the code behind, which gives every output by its name: one value, rows
    of them, or for a tree branches by their paths."""

    title: str
    nickname: str
    description: str
    inputs: tuple[Parameter, ...]
    outputs: tuple[Parameter, ...]
    run: Run
    group: str = "Relax"

    def described(self, name: str) -> dict[str, Any]:
        """The answer to GET /<name>."""
        return {"Uri": f"/{name}", "Name": self.title, "Nickname": self.nickname, "Description": self.description,
                "Category": "Hookean", "Subcategory": self.group, "Inputs": [p.described() for p in self.inputs],
                "Outputs": [p.described() for p in self.outputs]}  # fmt: skip

    def answer(self, found: dict[str, Any], most: int) -> list[dict[str, Any]]:
        """The outputs as Hops reads them; InputError where they would be larger than `most` bytes."""
        trees = [(p, _tree(p, found[p.name])) for p in self.outputs]
        _afford(sum(size(p.kind, values) for p, tree in trees for values in tree.values()), most, "/")
        return [
            {"ParamName": p.name, "InnerTree": {path: write(p.kind, values) for path, values in tree.items()}}
            for p, tree in trees
        ]


def _tree(parameter: Parameter, value: Any) -> dict[str, Any]:
    """The values of an output by the paths of their branches."""
    return value if parameter.tree else {"{0}": [value] if parameter.one else value}


def _afford(needed: int, most: int, where: str) -> None:
    if needed > most:
        said = f"the answer would have about {needed / 1e6:.0f} MB; at most {most / 1e6:.0f} MB are allowed"
        raise InputError(where, f"{said}. Request fewer pieces, or one part at a time")


class Inputs:
    """The values of a request by the names of their inputs: every branch of a tree, in order, is one list."""

    def __init__(self, function: Function, value: dict[str, Any], seconds: float, largest: int, most: int) -> None:
        self.warnings: list[str] = []
        self.seconds, self.largest, self.bytes = seconds, largest, most
        self.function = function
        units = str(value.get("modelunits") or "Meters")
        self.units = UNITS.get(units, "m")
        if units not in UNITS:
            self.warnings.append("The unit of this model is unknown; its lengths are read as metres.")
        tolerance: Any = value.get("absolutetolerance")
        self.tolerance = float(tolerance) if type(tolerance) in (int, float) and 0 < tolerance < 1e9 else 0.001
        self._parameters = {p.name: p for p in function.inputs}
        self._given: dict[str, dict[str, list[Any]]] = {}
        for i, entry in enumerate(value["values"]):
            self._read(f"/values/{i}", entry)

    def _read(self, where: str, entry: Any) -> None:
        tree = entry.get("InnerTree") if isinstance(entry, dict) else None
        if not isinstance(tree, dict) or not all(isinstance(branch, list) for branch in tree.values()):
            raise InputError(where, "an input has ParamName and InnerTree, whose branches are lists")
        name = str(entry.get("ParamName")).removeprefix("RH_IN:").strip()
        parameter = self._parameters.get(name)
        if parameter is None:
            if any(tree.values()):  # a definition of another version, whose values would be missed in silence
                known = ", ".join(self._parameters) or "none"
                self.warnings.append(
                    f"{name[:80]} is no input of this function and is not used; its inputs: {known}. "
                    "Make the Hops component again from its path."
                )
            return
        if name in self._given:
            raise InputError(where, f"{name} is given twice")
        if not all(_PATH.fullmatch(path) for path in tree):
            raise InputError(f"/{name}", "a path is whole numbers from 0 in braces, such as {0;1}")
        self._given[name] = {
            path: [read(parameter.kind, value, f"/{name}") for value in branch] for path, branch in tree.items()
        }

    def makes(self, pieces: int, where: str) -> None:
        """InputError where so many pieces, in each output that is a list, are more than may be asked for."""
        if pieces > self.largest:
            raise InputError(where, f"this makes {pieces} pieces; at most {self.largest} are allowed")
        each = sum(SIZES[p.kind] for p in self.function.outputs if not p.one or p.kind in ("Mesh", "Curve"))
        _afford(pieces * each, self.bytes, where)

    def make(self, make: Callable[..., Scene], **more: Any) -> Scene:
        """A figure's scene with the values of the inputs that are its parameters; InputError names the input."""
        known = defaults(make)
        own = {p.key: p for p in self.function.inputs if p.key in known}
        for key, parameter in own.items():
            if parameter.least or self.many(parameter.name):
                more[key] = self._value(parameter)
        try:
            return make(**more)
        except InputError as error:
            if error.pointer not in own:
                raise
            raise InputError(f"/{own[error.pointer].name}", error.sentence) from None

    def tree(self, name: str) -> dict[str, list[Any]]:
        """The branches of an input by their paths."""
        return self._given.get(name, {})

    def many(self, name: str) -> list[Any]:
        """The values of an input, one list of all branches."""
        found = [value for branch in self.tree(name).values() for value in branch]
        parameter = self._parameters[name]
        if len(found) < parameter.least:
            raise InputError(f"/{name}", f"{name} is missing; connect at least one {parameter.kind.lower()}")
        return [parameter.check(value) for value in found] if parameter.minimum is not None else found

    def one(self, name: str) -> Any:
        """The value of an input that takes one; its default where there is none."""
        parameter = self._parameters[name]
        found = [value for branch in self.tree(name).values() for value in branch]
        if not found and parameter.default is not None:
            return parameter.default
        if not found:
            raise InputError(f"/{name}", f"{name} is missing; connect one {parameter.kind.lower()}")
        if len(found) > 1:
            raise InputError(f"/{name}", f"{name} accepts one {parameter.kind.lower()}; {len(found)} given")
        return parameter.check(found[0])

    def _value(self, parameter: Parameter) -> Any:
        """What a parameter of a figure's scene takes: one value, points as rows, or a list."""
        if parameter.one:
            return self.surface(parameter.name) if parameter.kind == "Surface" else self.one(parameter.name)
        return self.points(parameter.name) if parameter.kind == "Point" else self.many(parameter.name)

    def points(self, name: str) -> Floats:
        """The values of an input of points as rows."""
        return np.array(self.many(name), dtype=np.float64).reshape(-1, 3)

    def lines(self, name: str) -> Floats:
        """The straight pieces of an input of lines (n, 2, 3)."""
        pieces = [piece for line in self.many(name) for piece in line]
        return np.array(pieces, dtype=np.float64).reshape(-1, 2, 3)

    def surface(self, name: str) -> Any:
        """The surface of an input of one: of a Brep of one whole face, as which Grasshopper sends it, the one below."""
        from hookean.discretize.breps import is_trimmed

        found = self.one(name)
        if type(found).__name__ == "Brep" and len(found.Faces) == 1 and not is_trimmed(found.Faces[0]):
            return found.Faces[0].UnderlyingSurface()
        return found
