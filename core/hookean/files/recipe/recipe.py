"""Recipes: how to relax what a .3dm file holds, an OBJ file by its groups, or COMPAS documents by their names. A recipe
is a scene in TOML or JSON with selectors for coordinates.

    units = {length = "m", force = "kN"}        # of every number here; without it the file's length, N, s

    [[forces]]
    kind = "springs"
    name = "cables"
    lines = "layer:cables"                      # lines, polylines; curves with divide
    divide = 20                                 # 20 equal arcs of each curve
    stiffness = 1000

    [[forces]]
    kind = "unary"
    points = "vertices:layer:cables"            # the points of that division
    vector = [0, 0, -1.5]

    [[anchors]]
    points = "ends:layer:cables, layer:masts"

    [settings]
    tolerance = 1e-8

Everything a scene has may be given (forces, anchors, geometry, settings, weld_tolerance, strict ...), coordinates too.

Selectors: `layer:NAME` (full path or name, sublayers included), `name:NAME`, `id:UUID`, `text:KEY=VALUE` (object
user text) and `*` (all that fits; the only one that leaves out what cannot be used instead of refusing it). `*` also
stands for anything inside a name. Several are joined by commas or in a list.

* `lines`: lines and polylines give their segments, any curve with `divide = N` N equal arcs.
* `mesh`: meshes; surfaces, Breps, extrusions with `divide = [u, v]` or `divide_u`, `divide_v`. Several objects
  are one mesh, welded where they meet. A trimmed face gives its render mesh, or with `divide = [u, v, "whole"]` the
  surface below it without the cuts.
* `points`, of forces and anchors: points and point clouds; `start:`, `ends:` of curves, `loose:` for those ends that no
  other curve of the selector and no line of a force meets; `vertices:`, `inner:` of curves and meshes; `naked:`,
  `corners:` of meshes and surfaces, `rim:` for those naked ones at which no other mesh of a force goes on. How one
  table divides an object holds for all tables without another one, and so does the user text `divide` of the object.
* `snap = 0.2` of an anchor moves its points to the nearest particle, where that is no farther [length].
* `on = "layer:beams"` keeps the points that lie on these curves. `pull_to_curve` selects its `curve`; bent ones with
  `curve_divide = N`; of several each pulls the points nearest to it.
* `warp_lines` of a membrane: lines and polylines, curves with the user text `divide`.
* `[[geometry]]` rides along: kind `points`, `lines`, `mesh`, or `polyline` and `curve` with points = a curve.

`tension_only = true` on springs makes them slack below their rest length. `hidden = true` takes hidden
objects too. Where a file is read without a recipe, or with one that has no forces, anchors or geometry, see
`hookean.files.recipe.convention`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hookean.errors import InputError
from hookean.files.recipe.build import Built, build
from hookean.files.recipe.check import check
from hookean.files.recipe.drawing import NO_LAYER, Drawing, Item, drawing
from hookean.files.recipe.notes import notes
from hookean.files.recipe.select import count, listed
from hookean.files.rhino.model import Model

DRAWN = ("forces", "anchors", "geometry", "meshes", "particles")
"""The fields of a recipe that give objects a role; without them layer names do."""


@dataclass(frozen=True, eq=False)
class Understood:
    """How a file was read: the scene with where it came from, lines to print, and a sentence if the
    file has nothing to relax; `notes` on what was left out, guessed or may be misspelt."""

    built: Built
    lines: list[str]
    nothing: str = ""
    notes: tuple[str, ...] = ()


def understand(model: Model, recipe: Mapping[str, Any] | None = None) -> Understood:
    """The scene in a .3dm model, by a recipe or, with None, by the convention of layer names and user text.

    A recipe without forces, anchors, geometry, meshes and particles leaves these to the convention, and adds the rest.
    Raises InputError: a selector that finds nothing, an unsupported object, a fault of the scene.
    """
    given = {} if recipe is None else dict(recipe)
    check(given)
    hidden = given.get("hidden", False)
    if not isinstance(hidden, bool):
        raise InputError("/hidden", f"{hidden!r} given; give true or false")
    conventional = not any(group in given for group in DRAWN)
    if conventional:
        from hookean.files.recipe.convention import UNITS, by_convention

        if "units" in given:
            raise InputError("/units", "a recipe without forces uses layer names, in m, N and s; remove units")
        seen = drawing(model, UNITS, hidden=hidden)
        built, said, nothing = by_convention(seen, given)
    else:
        seen = drawing(model, given.get("units"), hidden=hidden)
        built, said, nothing = build(seen, given), "a recipe", ""
    lines = _lines(seen, built, said)
    if not conventional and "units" not in given:
        length, force = built.scene.units.length, built.scene.units.force
        lines.insert(
            2, f"no units in the recipe: its lengths are {length}, its forces {force}, stiffness {force}/{length}"
        )
    remarks = tuple(notes(seen, built, conventional=conventional))
    return Understood(built, [*lines, f"{model.name} {nothing}"] if nothing else lines, nothing, remarks)


def _lines(seen: Drawing, built: Built, said: str) -> list[str]:
    units, model = built.scene.units, seen.model
    version = model.version // 10 if model.version >= 50 else model.version
    lines = [
        f"{model.name}: {f'Rhino {version} file' if version else 'file'}, read by {said}",
        f"units: {units.length}, {units.force}, {units.time}; {seen.said}",
        f"points within {built.scene.weld_tolerance:.6g} {units.length} become one particle",
        _counts(seen),
    ]
    if built.size:
        solved = "" if seen.factor == 1.0 else f", 1 {seen.unit} read as {seen.factor:.6g} {units.length}"
        lines.append(f"size: {built.size}{solved}; stiffness and loads must suit it")
    lines += built.notes
    if not built.scene.anchors:
        lines.append("nothing is held")
    floor = built.scene.settings.floor
    if floor is not None:
        lines.append(f"floor through {', '.join(f'{c:.6g}' for c in floor.point)}")
    by_layer: dict[str, list[Item]] = {}
    for item in seen.items:
        by_layer.setdefault(item.layer or NO_LAYER, []).append(item)
    for layer, items in by_layer.items():
        lines += _layer(layer, items, built)
    if seen.hidden:
        where = listed(item.layer or NO_LAYER for item in seen.hidden)
        lines.append(f"hidden, left out: {_kinds(list(seen.hidden))} on layer {where}")
    return lines + list(model.warnings)


def _counts(seen: Drawing) -> str:
    parts = [count(len(seen.items), "visible object")]
    locked = sum(item.locked for item in seen.items)
    if locked:
        parts.append(f"{locked} of them locked (used like the others)")
    if seen.instances:
        parts.append(f"{count(seen.instances, 'block instance')} (expanded)")
    if seen.hidden:
        parts.append(f"{len(seen.hidden)} hidden (left out)")
    if seen.paper:
        parts.append(f"{seen.paper} in layouts (left out)")
    if seen.own:
        parts.append(f"{seen.own} of an earlier run (left out)")
    if seen.model.lights:
        parts.append(count(seen.model.lights, "light"))
    return ", ".join(parts)


def _layer(layer: str, items: list[Item], built: Built) -> list[str]:
    """What became of the objects of a layer, those of one fate in one line."""
    fates: dict[str, list[Item]] = {}
    for item in items:
        if item in built.uses:
            fate = " and ".join(built.uses[item])
        else:
            fate = "left out: " + built.left.get(item, "not selected")
        fates.setdefault(fate, []).append(item)
    lines = []
    for fate, same in fates.items():
        names = [item.name for item in same if item.name]
        called = f" {listed(names, 3)}" if names else ""
        lines.append(f"layer {layer}: {_kinds(same)}{called} -> {fate}")
    return lines


def _kinds(items: list[Item]) -> str:
    from hookean.files.recipe.shapes import counted

    return counted(items)
