"""New particles, faces and forces. A force is joined to the one of its kind and name where the values allow it."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import Force, lengths
from hookean.running.drawing.edits import Add
from hookean.running.drawing.sheet import Cloth, Floats, Ints, Sheet, exist, many, remade
from hookean.system.weld import element_columns, keepers
from hookean.values import near


def add(sheet: Sheet, edit: Add) -> None:
    """Put what is new into the model. InputError for a particle or mesh that does not exist."""
    number = _numbers(sheet, np.asarray(edit.points), edit.weld)
    for name, faces in edit.faces.items():
        pointer = f"/add/faces/{name}"
        put_faces(sheet, name, _mapped(np.asarray(faces), number, pointer), pointer)
    for i, force in enumerate(edit.forces):
        pointer, particles = f"/add/forces/{i}", getattr(force, "particles", None)
        if particles is not None:
            force = force.replaced(particles=_mapped(particles, number, f"{pointer}/particles"))
        _put(sheet, force, pointer)


def _numbers(sheet: Sheet, points: Floats, weld: float) -> Ints:
    """The particle of each number that an edit may give: of those there are, then of its points, which are made or, if
    one is within `weld` [length], are that one."""
    old = np.arange(sheet.count)
    if not weld or not len(points):
        return np.concatenate([old, sheet.new(points)])
    there = np.full(len(points), -1)
    if sheet.count:
        apart, nearest = (two[:, 0] for two in near.tree(sheet.now).query(points, 2))
        there[apart <= weld] = nearest[apart <= weld]
    left = np.flatnonzero(there < 0)
    first = left[keepers(points[left], weld)]
    made = np.unique(first)
    there[made] = sheet.new(points[made])
    there[left] = there[first]
    return np.concatenate([old, there])


def _mapped(given: Ints, number: Ints, pointer: str) -> Ints:
    """Particles by the numbers of an edit. InputError for one that does not exist."""
    exist(given, len(number), pointer)
    return number[given]


def put_faces(sheet: Sheet, name: str, faces: Ints, pointer: str) -> None:
    """Give a mesh more faces, by particles; a mesh that does not exist is made."""
    sheet.exist(faces, pointer)
    new = name not in sheet.scene.meshes and name not in sheet.meshes
    empty = Cloth(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 4), np.int64))
    mesh = sheet.meshes.setdefault(name, empty) if new else sheet.mesh(name, pointer)
    wide = np.concatenate([faces, faces[:, -1:]], axis=1) if faces.shape[1] == 3 else faces
    fresh = np.setdiff1d(wide, mesh.particles)
    mesh.particles = np.concatenate([mesh.particles, fresh])
    mesh.vertices = np.concatenate([mesh.vertices, sheet.start[fresh]])
    order = np.argsort(mesh.particles, kind="stable")
    corners = order[np.searchsorted(mesh.particles, wide, sorter=order)]
    mesh.faces = np.concatenate([mesh.faces, corners])


def _put(sheet: Sheet, force: Force, pointer: str) -> None:
    for place in ("points", "lines"):
        if getattr(force, place, None) is not None:
            raise InputError(f"{pointer}/{place}", "give particles by number, or a mesh; new ones are given as points")
    mesh = getattr(force, "mesh", None)
    if mesh is not None and mesh not in sheet.meshes:
        sheet.mesh(mesh, f"{pointer}/mesh")
    taken = {other.name for other in sheet.forces if other is not None}
    for number, other in enumerate(sheet.forces):
        if other is None or other.name != force.name or type(other) is not type(force):
            continue
        joined = _joined(sheet, other, force, pointer)
        if joined is not None:
            sheet.forces[number] = joined
            return
    name, number = force.name, 2
    while name and name in taken:
        name, number = f"{force.name} {number}", number + 1
    sheet.forces.append(force if name == force.name else force.replaced(name=name))


def _joined(sheet: Sheet, old: Force, new: Force, pointer: str) -> Force | None:
    """One force with the elements of both; None where their values or places do not allow it."""
    if getattr(old, "mesh", None) is not None:
        return old if old == new else None
    first, second = getattr(old, "particles", None), getattr(new, "particles", None)
    if first is None or second is None or first.shape[1:] != second.shape[1:]:
        return None
    values: dict[str, Any] = {"particles": np.concatenate([first, second])}
    vectors = dict(element_columns(type(old)))
    for name in type(old).model_fields:
        pair: tuple[Any, ...] = getattr(old, name), getattr(new, name)
        sizes = len(first), len(second)
        vector = vectors.get(name, False)
        each = [name in vectors and many(value, size, vector) for value, size in zip(pair, sizes, strict=True)]
        if name == "particles" or (not any(each) and _same(*pair)):
            continue
        if name == "rest_length":
            pair = tuple(
                lengths(sheet.start[rows[:, 1]] - sheet.start[rows[:, 0]]) if value is None else value
                for value, rows in zip(pair, (first, second), strict=True)
            )
        if name not in vectors or not all(_number(value) for value in pair):
            return None
        values[name] = np.concatenate([_each(v, n, vector) for v, n in zip(pair, sizes, strict=True)])
    return remade(old, pointer, **values)


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    return bool(one == other)


def _number(value: Any) -> bool:
    return isinstance(value, np.ndarray) or (isinstance(value, int | float) and not isinstance(value, bool))


def _each(value: Any, count: int, vector: bool) -> Floats:
    """A column with a value for each of `count` elements."""
    if many(value, count, vector):
        return np.asarray(value)
    return np.broadcast_to(value, (count, *np.shape(value)))
