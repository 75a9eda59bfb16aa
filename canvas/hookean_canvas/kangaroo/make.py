"""The objects that an import puts into a definition: our components, panels for typed values, and what joins them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any
from uuid import UUID

from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE, NAMES, PANEL, PARAMETERS, PYTHON3_SCRIPT, SCRIPT_LIBRARY
from hookean_canvas.archive.parts import Part, sources
from hookean_canvas.components import bundles, inline
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo import bodies, engineering, held, rare, scripts, six
from hookean_canvas.kangaroo.recipe import Recipe

LENGTH = UUID("c75b62fa-0a33-4da7-a5bd-03fd0068fd93")

SORT = '''"""Sorts what comes in one stream: forces, anchors and geometry."""

import json

from hookean_client import canvas

found = {"forces": [], "anchors": [], "geometry": []}
for path, items in canvas.geometry.branches(_goals):
    sorted_items = {"forces": [], "anchors": [], "geometry": []}
    for item in items:
        try:
            kind = json.loads(item)["kind"]
        except (TypeError, ValueError, KeyError):
            kind = "geometry"
        if item is not None:
            sorted_items[kind if kind in sorted_items else "forces"].append(item)
    for kind in found:
        if sorted_items[kind]:
            found[kind].append((path, sorted_items[kind]))
forces = canvas.geometry.to_tree(found["forces"])
anchors = canvas.geometry.to_tree(found["anchors"])
geometry = canvas.geometry.to_tree(found["geometry"])
'''

CORNERS = '''"""The corners of polylines, or of pairs of lines that meet: a point before, at and after each."""

from hookean_client import canvas


def near(p, q):
    return sum((a - b) ** 2 for a, b in zip(p, q))


point_1, point_2, point_3 = [], [], []
lines = [canvas.geometry.straight(item) for item in canvas.listed(_lines)]
others = [canvas.geometry.straight(item) for item in canvas.listed(others_)]
corners = [line[i : i + 3] for line in lines for i in range(len(line) - 2)] if not others else []
for one, other in zip(*canvas.matched(lines, others)) if others else ():
    ends = [(p, q) for p in (one[::-1], one) for q in (other, other[::-1])]
    before, after = min(ends, key=lambda pair: near(pair[0][0], pair[1][0]))
    corners.append([before[-1], before[0], after[-1]])
for corner in corners:
    for points, place in zip((point_1, point_2, point_3), corner):
        points.append(canvas.geometry.to_point(place))
'''

UPWARDS = '''"""Vertical vectors of these sizes, upwards where positive."""

from hookean_client import canvas

vectors = [canvas.geometry.to_vector([0.0, 0.0, canvas.geometry.number(size)]) for size in canvas.listed(_size)]
'''

LINES = '''"""Lines from points to points."""

from hookean_client import canvas

pairs = zip(*canvas.matched(canvas.geometry.points(_start), canvas.geometry.points(_end)))
lines = [canvas.geometry.to_line(list(pair)) for pair in pairs]
'''

HALF = '''"""Half of each number."""

from hookean_client import canvas

halves = [0.5 * canvas.geometry.number(value) for value in canvas.listed(_numbers)]
'''

PLANE = '''"""The origin and the normal of each plane."""

from hookean_client import canvas

planes = canvas.listed(_planes)
origin = [canvas.geometry.to_point([p.Origin.X, p.Origin.Y, p.Origin.Z]) for p in planes]
normal = [canvas.geometry.to_vector([p.ZAxis.X, p.ZAxis.Y, p.ZAxis.Z]) for p in planes]
'''


HELPERS = {
    "*corners": Recipe(
        "Corners",
        "Corners",
        "Points before, at and after corners",
        CORNERS,
        (Slot("_lines", "Polylines, or lines", 1), Slot("others_", "Lines that meet them, one for each", 1)),
        tuple(Slot(f"point_{i}", f"Point {i} of each corner") for i in (1, 2, 3)),
    ),
    "*sort": Recipe(
        "Sort Goals",
        "Sort",
        "Sorts forces, anchors and geometry",
        SORT,
        (Slot("_goals", "Forces, anchors and geometry in one stream", 2),),
        tuple(Slot(name, f"The {name} among them") for name in ("forces", "anchors", "geometry")),
    ),
    "*upwards": Recipe(
        "Upwards", "Upwards", "Vertical vectors", UPWARDS, (Slot("_size", "Sizes", 1),), (Slot("vectors", "Vectors"),)
    ),
    "*half": Recipe(
        "Half", "Half", "Half of each number", HALF, (Slot("_numbers", "Numbers", 1),), (Slot("halves", "Halves"),)
    ),
    "*plane": Recipe(
        "Planes",
        "Planes",
        "Origins and normals of planes",
        PLANE,
        (Slot("_planes", "Planes", 1, "plane"),),
        (Slot("origin", "Origins"), Slot("normal", "Normals")),
    ),
    "*lines": Recipe(
        "Lines",
        "Lines",
        "Lines from points to points",
        LINES,
        (Slot("_start", "Points", 1, "point"), Slot("_end", "Points", 1, "point")),
        (Slot("lines", "Lines"),),
    ),
    **scripts.HELPERS,
    **engineering.HELPERS,
    **six.HELPERS,
    **held.HELPERS,
    **rare.HELPERS,
    **bodies.HELPERS,
}
"""Small scripts where our components take other things than Kangaroo's."""


@cache
def recipe(bundle: str) -> Recipe:
    """The recipe of a bundle or a helper; InputError where there is no such bundle."""
    if bundle in HELPERS:
        return HELPERS[bundle]
    found = bundles.read(bundle)
    inputs, outputs = (
        tuple(Slot(p.name, p.description, p.access, p.hint, p.optional, p.mapping) for p in side)
        for side in (found.inputs, found.outputs)
    )
    return Recipe(found.name, found.nickname, found.description, found.code, inputs, outputs)


def component(of: Recipe, id: UUID, nickname: str, inputs: Sequence[UUID], outputs: Sequence[UUID]) -> Chunk:
    """The container of a Python 3 Script component with the client inside."""
    code = inline.inlined(of.code, "rhino8")
    given, results = (list(zip(ids, slots, strict=True)) for ids, slots in ((inputs, of.inputs), (outputs, of.outputs)))
    return containers.script(id, of.name, nickname or of.nickname, of.description, code, given, results)


def length(id: UUID, given: UUID, result: UUID) -> Chunk:
    """The container of Grasshopper's Length, which measures curves."""
    chunk = containers.container(id, "Length", "Len", "Measure the length of a curve.")
    for name, port, word, nick in (("param_input", given, "Curve", "C"), ("param_output", result, "Length", "L")):
        inner = chunk.add(name, 0).put("InstanceGuid", Type.GUID, port).put("Name", Type.STRING, word)
        inner.put("NickName", Type.STRING, nick).put("Description", Type.STRING, word)
        inner.put("Optional", Type.BOOL, False).put("SourceCount", Type.INT32, 0)
    return chunk


def stored(port: Chunk) -> list[Chunk]:
    """The items of an input's own data, without empty ones."""
    data = port.chunk("PersistentData")
    return [item for branch in (data.chunks if data is not None else ()) for item in branch.chunks if item.items]


def single(port: Chunk) -> Any:
    """The one number, text or truth typed into an input; None where there are several, or something else."""
    items = stored(port)
    if len(items) != 1 or len(items[0].items) != 1:
        return None
    value = items[0].items[0].value
    return value if isinstance(value, (bool, int, float, str)) else None


def constant(part: Part | None) -> Any:
    """The truth, number or text that a toggle, or a panel or parameter without wires, gives; None of anything else."""
    if part is None or part.container is None or sources(part.container):
        return None
    if part.guid == BOOLEAN_TOGGLE:
        return part.container.value("ToggleValue")
    text = part.container.value("UserText") if part.guid == PANEL else single(part.container)
    return {"true": True, "false": False}.get(text.strip().lower(), text) if isinstance(text, str) else text


def usual(slot: Slot, value: Any) -> bool:
    """Whether a value is what our input has by itself; from its tooltip."""
    found = re.search(r"Default: (.+?)\.(?=\s|$)", slot.description)
    if found is None:
        return False
    try:
        return math.isclose(float(found.group(1)), float(value), rel_tol=1e-6) and not isinstance(value, bool)
    except ValueError:
        return found.group(1) == str(value)


def holder(id: UUID, name: str, value: Any) -> tuple[UUID, Chunk, tuple[float, float]]:
    """A toggle or a panel that holds a value: its kind, container, width and height."""
    if isinstance(value, bool):
        return BOOLEAN_TOGGLE, containers.toggle(id, name, value), (60.0 + 6.2 * len(name), 22.0)
    whole = isinstance(value, float) and abs(value) < 1e15 and value == int(value)
    text = str(int(value) if whole else value)
    return PANEL, containers.panel(id, name, text), (max(80.0, 6.2 * max(len(name), len(text)) + 30.0), 44.0)


def keeper(id: UUID, name: str, port: Chunk, hint: str) -> tuple[UUID, Chunk, tuple[float, float]]:
    """A parameter that holds all the data of an input as it is, in its branches."""
    guid = PARAMETERS[_kind(stored(port)[0], hint)]
    title = NAMES[guid][0]
    chunk = containers.floating(id, title, name, f"Contains a collection of {title.lower()} values")
    data = port.chunk("PersistentData")
    assert data is not None
    chunk.chunks.append(data)
    return guid, chunk, (36.0 + 6.2 * len(name), 20.0)


def expressed(id: UUID, name: str, port: Chunk, hint: str) -> tuple[UUID, Chunk, tuple[float, float]]:
    """A parameter with the expression and the data of an input, which is not wired yet."""
    items = stored(port)
    guid = PARAMETERS[_kind(items[0], hint) if items else _EXPRESSED.get(hint, "Number")]
    title = NAMES[guid][0]
    chunk = containers.floating(id, title, name, f"Contains a collection of {title.lower()} values")
    chunk.put("InternalExpression", Type.STRING, port.value("InternalExpression"))
    data = port.chunk("PersistentData")
    if data is not None:
        chunk.chunks.append(data)
    return guid, chunk, (36.0 + 6.2 * len(name), 20.0)


_EXPRESSED: Mapping[str, str] = {"int": "Integer", "bool": "Boolean", "point": "Point", "vector": "Vector"}
_BY_ITEM: Mapping[str, str] = {"vector": "Vector", "Coordinate": "Point", "boolean": "Boolean", "string": "Text"}
_BY_HINT: Mapping[str, str] = {"mesh": "Mesh", "curve": "Curve", "point": "Point", "vector": "Vector"}


def _kind(item: Chunk, hint: str) -> str:
    for entry in item.items:
        if entry.name in _BY_ITEM:
            return _BY_ITEM[entry.name]
        if entry.type == Type.PLANE:
            return "Plane"
        if entry.name == "number":
            return "Integer" if entry.type == Type.INT32 else "Number"
    return _BY_HINT.get(hint, "Geometry")


def put_object(objects: Chunk, guid: UUID, container: Chunk) -> Chunk:
    """Append an object to a definition and count it."""
    thing = objects.add("Object", 1 + max((chunk.index for chunk in objects.chunks), default=-1))
    fill(thing, guid, container)
    objects.put("ObjectCount", Type.INT32, len(objects.chunks))
    return thing


def fill(thing: Chunk, guid: UUID, container: Chunk) -> None:
    """Make an object of this kind with this container out of whatever it was."""
    name = NAMES[guid][0] if guid in NAMES else str(container.value("Name"))
    thing.items = [item for item in thing.items if item.name not in ("Lib",)]
    thing.put("GUID", Type.GUID, guid).put("Name", Type.STRING, name)
    if guid == PYTHON3_SCRIPT:
        thing.put("Lib", Type.GUID, SCRIPT_LIBRARY)
    thing.chunks = [chunk for chunk in thing.chunks if chunk.name != "Container"]
    thing.chunks.append(container)
