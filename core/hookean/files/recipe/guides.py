"""Guides of a recipe: curves (`curve`) and surfaces (`target`) that stay where they are and pull points, and `nearest`,
with which of several guides only the nearest one pulls a point."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.curves import Placed, pulled
from hookean.files.recipe.drawing import Item
from hookean.files.recipe.shapes import Floats, Shape
from hookean.scene.scene import Scene

PULLS = ("pull_to_curve", "pull_to_mesh")
GUIDE_FIELDS = ("target_divide", "nearest")
Led = Callable[[dict[str, Any], str, str], Sequence[tuple[Item, ...]]]


def pulling(placed: Placed, led: Led, factor: float, meshes: Callable[[str], Any], notes: list[str]) -> Placed:
    """Pulls to selected curves get polylines; the tables of further curves come last, for pointers count tables.

    `led` finds the curves of a table, or makes its target a mesh; `meshes` gives each of these by its name."""
    first, more = [], []
    for number, (table, shape) in enumerate(placed):
        pointer, kind = f"/forces/{number}", table.get("kind")
        parts = [(table, shape)]
        for items in led(
            table, pointer, f'{kind} "{table["name"]}"' if isinstance(table.get("name"), str) else str(kind)
        ):
            parts = pulled(table, shape, items, factor, pointer)
            notes.append(f"forces[{number}] {kind}: to {shapes.counted(items)}")
        first.append(parts[0])
        more += parts[1:]
    return _shared(first + more, meshes)


def _shared(placed: Placed, meshes: Callable[[str], Any]) -> Placed:
    """Pulls with `nearest` keep the points that no other one of them is nearer to."""
    numbers = []
    for number, (table, shape) in enumerate(placed):
        if table.get("kind") not in PULLS or "nearest" not in table:
            continue
        given = table.pop("nearest")
        if not isinstance(given, bool):
            raise InputError(f"/forces/{number}/nearest", f"{given!r} given; give true or false")
        if given and (shape is None or shape.array.ndim != 2 or shape.faces is not None):
            raise InputError(f"/forces/{number}/nearest", "needs points = a selector; give one, or nearest = false")
        numbers += [number] if given else []
    found = list(placed)
    for number in numbers:
        table, shape = placed[number]
        assert shape is not None
        apart = [_apart(shape.array, placed[other][0], meshes) for other in numbers]
        kept = np.argmin(apart, axis=0) == numbers.index(number)
        part = Shape(shape.items, shape.array[kept], shape.owner[kept])
        found[number] = {**table, "points": part.array}, part
    return found


def _apart(points: Floats, table: Mapping[str, Any], meshes: Callable[[str], Any]) -> Floats:
    """Distances (n,) of points from the guide of a pull [length]: its forces where the strength is 1."""
    from hookean.system.system import compile

    pull = {name: table[name] for name in ("kind", "curve", "closed", "vertices", "faces") if name in table}
    if table.get("target") is not None:
        mesh = meshes(table["target"])
        if mesh is None:
            return np.full(len(points), np.inf)  # the scene refuses a mesh that it does not have
        given = mesh if isinstance(mesh, Mapping) else {"vertices": mesh.array, "faces": mesh.faces}
        pull |= {name: given[name] for name in ("vertices", "faces")}
    pull |= {"particles": np.arange(len(points)), "strength": 1.0}
    system = compile(Scene.read({"particles": points, "forces": [pull], "weld_tolerance": 0.0}))
    force, *_ = system.evaluate(system.start())
    return np.asarray(np.linalg.norm(force, axis=1))
