"""A running model by numbers: all its particles given, with forces, meshes and anchors that edits of what is drawn
change. A scene is made of it once, at the end."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from hookean.errors import InputError
from hookean.forces.base import PLACES, Force
from hookean.scene.scene import Anchor, Geometry, MeshData, Scene
from hookean.system.addressed import edited_scene, numbered
from hookean.system.state import State
from hookean.system.system import System
from hookean.system.two_ended import spring_ends
from hookean.system.weld import element_columns
from hookean.values.faults import first_fault

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(eq=False)
class Cloth:
    """A mesh by particles: the particle and the start of each vertex, and the faces by vertices."""

    particles: Ints
    vertices: Floats
    faces: Ints


class Sheet:
    """The model. `same` is the number that each particle has in the running system, -1 for a new one; `start` and `now`
    are where particles start and are [length]."""

    def __init__(self, system: System, state: State) -> None:
        count = system.slots.count
        self.system = system
        self.scene: Scene = numbered(system, edited_scene(system))
        self.start, self.now = system.points.copy(), state.x[:count].copy()
        self.same = np.arange(count)
        self.forces: list[Force | None] = list(self.scene.forces)
        self.anchors: list[Anchor | None] = list(self.scene.anchors)
        self.geometry: list[Geometry | None] = list(self.scene.geometry)
        self.meshes: dict[str, Cloth] = {}

    @property
    def count(self) -> int:
        """How many particles there are."""
        return len(self.same)

    def new(self, start: Floats, now: Floats | None = None) -> Ints:
        """New particles, which start there and are there, or elsewhere; their numbers."""
        first = self.count
        self.start = np.concatenate([self.start, start])
        self.now = np.concatenate([self.now, start if now is None else now])
        self.same = np.concatenate([self.same, np.full(len(start), -1)])
        return np.arange(first, self.count)

    def rows(self, number: int) -> Ints:
        """Particles (m, k) of the elements of a force of the running system; -1 where one met none."""
        return self.system.places.elements(self.system.scene.forces[number])

    def mesh(self, name: str, pointer: str) -> Cloth:
        """A mesh, to be changed. InputError for one that does not exist or whose vertices are no particles."""
        if name in self.meshes:
            return self.meshes[name]
        given = self.scene.meshes.get(name)
        if given is None:
            known = ", ".join(repr(other) for other in self.scene.meshes) or "none"
            raise InputError(pointer, f"mesh {name!r} does not exist; the scene has {known}")
        particles = self.system.places.vertices(name).copy()
        if (particles < 0).any():
            raise InputError(pointer, f"vertices of mesh {name!r} are no particles, so it cannot be changed by drawing")
        self.meshes[name] = Cloth(particles, given.vertices, given.faces)
        return self.meshes[name]

    def springs(self, numbers: Ints, pointer: str) -> dict[int, Ints]:
        """For springs of the topology: by their force the rows of it. InputError for one that does not exist."""
        pairs, forces = spring_ends(self.system)
        beyond = np.flatnonzero((numbers < 0) | (numbers >= len(pairs)))
        if len(beyond):
            given = int(numbers[beyond[0]])
            said = f"spring {given} does not exist; there are {len(pairs)}, counted from 0"
            raise InputError(f"{pointer}/{beyond[0]}", said)
        found: dict[int, Ints] = {}
        for number in np.unique(forces[numbers]).tolist():
            own = np.flatnonzero(forces == number)
            if number < 0 or not np.array_equal(self.rows(number), pairs[own]):
                raise InputError(pointer, "these springs belong to a force whose lines cannot be edited one by one")
            found[number] = np.searchsorted(own, np.unique(numbers[forces[numbers] == number]))
        return found

    def exist(self, particles: Any, pointer: str) -> None:
        """InputError for the number of a particle that does not exist."""
        exist(particles, self.count, pointer)

    def written(self) -> Scene:
        """The scene; its masses and velocities are 1 and 0 for new particles."""
        scene, known = self.scene, self.same >= 0
        changed: dict[str, Any] = {"particles": self.start, "meshes": dict(scene.meshes)}
        for name, fill in (("masses", 1.0), ("velocities", 0.0)):
            given = getattr(scene, name)
            if isinstance(given, np.ndarray):
                column = np.full((self.count, *given.shape[1:]), fill)
                column[known] = given[self.same[known]]
                changed[name] = column
        for name, mesh in self.meshes.items():
            if len(mesh.faces):
                changed["meshes"][name] = MeshData(vertices=mesh.vertices, faces=mesh.faces)
            else:
                changed["meshes"].pop(name, None)
        for group in ("forces", "anchors", "geometry"):
            changed[group] = tuple(item for item in getattr(self, group) if item is not None)
        return scene.model_copy(update=changed)


def exist(particles: Any, count: int, pointer: str) -> None:
    """InputError for the number of a particle that is not among `count`."""
    flat = np.asarray(particles).ravel()
    if len(flat) and not 0 <= int(flat.min()) <= int(flat.max()) < count:
        wrong = int(flat.max()) if int(flat.max()) >= count else int(flat.min())
        raise InputError(pointer, f"particle {wrong} does not exist; there are {count}, counted from 0")


def many(value: Any, count: int, vector: bool) -> bool:
    """Whether a column has a value for each of `count` elements; `vector`: three numbers are one value."""
    return isinstance(value, np.ndarray) and value.ndim > 0 and len(value) == count and not (vector and value.ndim == 1)


def columns(force: Force, count: int) -> dict[str, Floats]:
    """The columns of a force that have a value for each of its `count` elements."""
    found = ((name, getattr(force, name), vector) for name, vector in element_columns(type(force)))
    return {name: value for name, value, vector in found if many(value, count, vector)}


def by_face(force: Force, count: int) -> dict[str, Floats]:
    """The columns of a membrane that have a row for each of the `count` faces of its mesh."""
    found = ((name, getattr(force, name, None)) for name in ("prestress", "warp"))
    return {n: v for n, v in found if isinstance(v, np.ndarray) and v.ndim == 2 and len(v) == count}


def remade(force: Force, pointer: str, without: Iterable[str] = (), **values: Any) -> Force:
    """A force with other values of some fields, validated; its place among them, if one is given."""
    dropped = {*without, *(PLACES if any(place in values for place in PLACES) else ())}
    given: Mapping[str, Any] = {n: getattr(force, n) for n in force.model_fields_set if n not in dropped}
    try:
        return type(force).model_validate({**given, **values})
    except ValidationError as error:
        found = first_fault(error)
        raise InputError(f"{pointer}{found.pointer}", found.sentence) from None
