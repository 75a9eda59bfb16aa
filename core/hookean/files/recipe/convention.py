"""Files without a recipe: what layer names and object user text mean.

| layer (any case; sublayers too; singular or plural) | its objects are |
| --- | --- |
| `springs` | curves and edges of meshes: springs, elastic both ways, k = 1000, rest factor 1 |
| `cables` | curves: springs that only pull, slack below their rest length |
| `membranes`, `nets` | meshes and surfaces: edges as springs of rest factor 0, which draw the sheet tight as a film |
| `anchors`, `supports` | points, ends and vertices of curves, vertices of meshes: held |
| `loads` | points: forces as the user text `load` says; lines: along the line, `load` is the size |
| `floors` | any object: a level floor at its top |
| `geometry` | curves and meshes that ride along |

User text of an object overrides: `stiffness`, `damping`, `rest_factor`, `rest_length`, `upper_cutoff`,
`lower_cutoff`, `plasticity`, `edges` (meshes), `divide` ("20", "10, 20"; curved curves are cut into 10 and surfaces
into 10 x 10 without it), `load` ("0, 0, -20", or "-20" along z; on springs and meshes it acts on every particle of
the object), `axes` and `rotations` of anchors ("xz").

The defaults and all numbers of user text are in m, N and s, whatever the file's length unit: k = 1000 is 1000 N/m, and
the same model in mm, m or inches gives the same forces.

A file without such a layer is read as drawn: curves become springs with their loose ends held, meshes
and open surfaces membranes with their naked vertices held, points anchors. Where a file names layers but no anchors,
loose ends and naked vertices are held the same way.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, get_args

import numpy as np

from hookean.discretize.duplicates import unique_points
from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.build import Built, build
from hookean.files.recipe.drawing import Drawing, Item, above, layers_of
from hookean.files.recipe.select import count, listed
from hookean.files.rhino.model import SEPARATOR
from hookean.forces.springs import Edges

ROLES = {
    "springs": ("spring", "springs"),
    "cables": ("cable", "cables"),
    "membrane": ("membrane", "membranes", "net", "nets"),
    "anchors": ("anchor", "anchors", "support", "supports"),
    "loads": ("load", "loads"),
    "floor": ("floor", "floors"),
    "geometry": ("geometry",),
}
NUMBERS = (
    "stiffness",
    "damping",
    "rest_factor",
    "rest_length",
    "upper_cutoff",
    "lower_cutoff",
    "plasticity",
)
DEFAULT_DIVIDE = 10
TEXTS = (*NUMBERS, "edges", "divide", "load", "axes", "rotations")
"""The keys of user text that mean something."""
UNITS = {"length": "m", "force": "N", "time": "s"}
FLOOR = "marks the height of the floor"


@dataclass
class _Reading:
    """What the convention makes of a drawing, as the tables of a recipe."""

    forces: dict[tuple[Any, ...], dict[str, Any]] = field(default_factory=dict)
    anchors: dict[tuple[Any, ...], dict[str, Any]] = field(default_factory=dict)
    geometry: list[dict[str, Any]] = field(default_factory=list)
    floor: float | None = None
    elastic: list[Item] = field(default_factory=list)
    left: dict[Item, str] = field(default_factory=dict)


def role_of(item: Item) -> str:
    """The role that an item's layers give it, the nearest layer first; "" for none."""
    for layer in item.layers:
        for path in above(layer):
            name = path.rpartition(SEPARATOR)[2].casefold().strip()
            for role, names in ROLES.items():
                if name in names:
                    return role
    return ""


def by_convention(drawing: Drawing, given: Mapping[str, Any]) -> tuple[Built, str, str]:
    """The scene of a file without a recipe, how it was read, and a sentence if it has nothing to relax.

    `given` has further fields of the scene, such as `weld_tolerance`, `strict` and `settings`.
    Raises InputError where a user text is not what its key asks for.
    """
    roles = {item: role_of(item) for item in drawing.items}
    named = any(roles.values())
    said = "layer names and user text"
    if not named:
        said = "no layer has a name that hookean knows: curves as springs, meshes and surfaces as membranes"
        roles = {item: _as_drawn(item) for item in drawing.items}
    reading = _Reading()
    for item, role in roles.items():
        _read(item, role, reading)
    marked = bool(reading.anchors)
    if not marked:
        weld = given.get("weld_tolerance")  # the scene refuses what is not a number
        _hold_loose(drawing, reading, weld if isinstance(weld, int | float) and weld >= 0 else drawing.tolerance)
        held = " and ".join(dict.fromkeys(str(table["name"]) for table in reading.anchors.values()))
        said += f"; nothing is marked as an anchor: {held + ' are' if held else 'nothing is'} held"
    nothing = ""
    if not reading.elastic:
        why = next((f"; {item.label}: {why}" for item, why in reading.left.items()), "")
        where = f" on layers {listed(layers_of(drawing.items))}" if drawing.items else ""
        nothing = (
            f"has nothing to relax ({count(len(drawing.items), 'visible object')}{where}{why}); put curves or meshes "
            "on a layer named springs, cables or membrane, or give a recipe"
        )
        reading.left.update({i: f"cannot be {roles[i]} without springs" for i in roles if i not in reading.left})
        reading.forces.clear()
        reading.anchors.clear()
    built = build(drawing, _recipe(drawing, reading, given), lenient=True)
    built.left = {i: why for i, why in {**reading.left, **built.left}.items() if i not in built.uses}
    built.guessed = not marked and not nothing
    return built, said, nothing


def _as_drawn(item: Item) -> str:
    if shapes.is_point(item):
        return "anchors"
    if shapes.is_curve(item):
        return "springs"
    return "membrane" if shapes.is_mesh(item) else ""


def _read(item: Item, role: str, reading: _Reading) -> None:
    """Add one item to the tables."""
    if role == "anchors":
        _anchor(item, reading)
    elif role == "loads":
        _load(item, reading)
    elif role == "floor":
        box = item.geometry.GetBoundingBox()
        reading.floor = max(box.Max.Z, -np.inf if reading.floor is None else reading.floor)
        reading.left[item] = FLOOR
    elif role == "geometry":
        _along(item, reading)
    elif role:
        _elastic(item, role, reading)
    else:
        reading.left[item] = "its layer has no meaning for hookean"


def _elastic(item: Item, role: str, reading: _Reading) -> None:
    curve = shapes.is_curve(item)
    if not curve and not shapes.is_mesh(item) or (role == "membrane" and curve) or (role == "cables" and not curve):
        reading.left[item] = f"{item.kind} cannot become {role}"
        return
    split = _division(item)
    try:
        # tried here, to distinguish usable objects from others
        _ = shapes.lines_of(item, split, "") if curve else shapes.mesh_of(item, split, "")
    except InputError as error:
        reading.left[item] = error.sentence.removeprefix(item.label).lstrip(": ")
        return
    table: dict[str, Any] = {"kind": "springs", "name": item.layer.replace(SEPARATOR, " ") or role}
    table.update({"rest_factor": 0.0} if role == "membrane" else {})
    table.update({"tension_only": True} if role == "cables" else {})
    table.update({key: number_of(item, key) for key in NUMBERS if key in item.text})
    if "edges" in item.text and not curve:
        table["edges"] = edges_of(item)
    if split is not None:
        table["divide"] = list(split)
    place = "lines" if curve else "mesh"
    entry = reading.forces.setdefault((place, *map(str, table.items())), {**table, place: []})
    entry[place].append(f"id:{item.ids[-1]}")
    reading.elastic.append(item)
    if "load" in item.text:
        _add_load(item, f"vertices:id:{item.ids[-1]}", vector_of(item, None), reading)


def edges_of(item: Item) -> str:
    """The edges of a mesh that its user text names. InputError for another word."""
    given = item.text["edges"].strip().lower()
    allowed = get_args(Edges)
    if given not in allowed:
        raise InputError(f"{item.label}, user text edges", f'"{given}" given; give one of {", ".join(allowed)}')
    return given


def _division(item: Item) -> shapes.Split | None:
    given = shapes.split_of(item.text.get("divide"), f"{item.label}, user text divide")
    if given is not None:
        return given
    curved = shapes.is_curve(item) and not shapes.straight(item)
    return (DEFAULT_DIVIDE, DEFAULT_DIVIDE) if curved or shapes.is_surface(item) else None


def _anchor(item: Item, reading: _Reading) -> None:
    axes, rotations = (
        "".join(sorted(item.text.get(name, default).strip().lower()))
        for name, default in (("axes", "xyz"), ("rotations", ""))
    )
    named = f"id:{item.ids[-1]}"
    if shapes.is_point(item):
        selector, split = named, None
    elif shapes.is_curve(item):
        split = shapes.split_of(item.text.get("divide"), f"{item.label}, user text divide")
        whole = split is not None or shapes.straight(item)
        selector = f"{'vertices' if whole else 'ends'}:{named}"
    elif shapes.is_mesh(item):
        selector, split = f"vertices:{named}", _division(item)
    else:
        reading.left[item] = f"{item.kind} cannot be an anchor"
        return
    name = item.name or item.layer
    held = {"name": name, "axes": axes, **({"rotations": rotations} if rotations else {})}
    entry = reading.anchors.setdefault((name, axes, rotations, split), {**held, "points": []})
    entry["points"].append(selector)
    if split is not None:
        entry["divide"] = list(split)


def _load(item: Item, reading: _Reading) -> None:
    if "load" not in item.text:
        reading.left[item] = 'has no user text "load", such as "0, 0, -20"'
    elif shapes.is_point(item):
        _add_load(item, f"id:{item.ids[-1]}", vector_of(item, None), reading)
    elif shapes.is_curve(item):
        _add_load(item, f"start:id:{item.ids[-1]}", vector_of(item, shapes.direction(item)), reading)
    else:
        reading.left[item] = f"{item.kind} cannot be a load; draw a point or a line"


def _add_load(item: Item, selector: str, vector: list[float], reading: _Reading) -> None:
    name = f"load {item.name or item.layer}".strip().replace(SEPARATOR, " ")
    key = ("load", name, tuple(vector))
    table = reading.forces.setdefault(key, {"kind": "unary", "name": name, "vector": vector, "points": []})
    table["points"].append(selector)


def _along(item: Item, reading: _Reading) -> None:
    name = item.name or item.layer
    if shapes.is_mesh(item):
        split = _division(item)
        table: dict[str, Any] = {"kind": "mesh", "mesh": f"id:{item.ids[-1]}"}
        if split is not None:
            table["divide"] = list(split)
    elif shapes.is_point(item):
        table = {"kind": "points", "points": f"id:{item.ids[-1]}"}
    elif shapes.is_curve(item):
        kind = "polyline" if shapes.straight(item) else "curve"
        table = {"kind": kind, "points": f"id:{item.ids[-1]}"}
    else:
        reading.left[item] = f"{item.kind} cannot be carried along"
        return
    reading.geometry.append({"name": name, **table})


def _hold_loose(drawing: Drawing, reading: _Reading, tolerance: float) -> None:
    """Hold the ends of lines that no other line meets, and the naked vertices of meshes, but for seams between them."""
    pieces = [shapes.lines_of(i, _division(i), "") for i in reading.elastic if shapes.is_curve(i)]
    if pieces:
        ends = np.concatenate(pieces).reshape(-1, 3) * drawing.factor
        kept, place = unique_points(ends, tolerance)
        alone = np.bincount(place, minlength=len(kept)) == 1
        if alone.any():
            reading.anchors[("loose",)] = {"name": "loose ends", "points": ends[kept][alone]}
    for item in [item for item in reading.elastic if not shapes.is_curve(item)]:
        split = _division(item)
        shape = shapes.joined([item], [shapes.mesh_of(item, split, "")], 1.0)
        size = float(np.ptp(shape.array, axis=0).max())
        if not len(shapes.mesh_points(shape, "naked", max(drawing.model.tolerance, 1e-9 * size)).array):
            _leave(item, reading, "closed, so it has no naked vertices to hold; anchor it or give a recipe")
            continue
        table = {"name": "naked vertices", "points": [], **({} if split is None else {"divide": list(split)})}
        reading.anchors.setdefault(("naked", split), table)["points"].append(f"rim:id:{item.ids[-1]}")


def _leave(item: Item, reading: _Reading, why: str) -> None:
    """Take an item out of the tables again."""
    reading.left[item] = why
    reading.elastic.remove(item)
    for key, table in list(reading.forces.items()):
        place = next(name for name in ("lines", "mesh", "points") if name in table)
        table[place] = [s for s in table[place] if not s.endswith(f"id:{item.ids[-1]}")]
        if not table[place]:
            del reading.forces[key]


def _recipe(drawing: Drawing, reading: _Reading, given: Mapping[str, Any]) -> dict[str, Any]:
    names: dict[str, int] = {}
    for table in reading.forces.values():
        name = str(table["name"])
        names[name] = names.get(name, 0) + 1
        table["name"] = name if names[name] == 1 else f"{name}/{names[name]}"
    recipe = {**given, "forces": list(reading.forces.values()), "anchors": list(reading.anchors.values())}
    recipe["geometry"] = reading.geometry
    settings = given.get("settings", {})
    if reading.floor is not None and isinstance(settings, Mapping):
        recipe["settings"] = {"floor": {"point": [0.0, 0.0, reading.floor * drawing.factor]}, **settings}
    return recipe


def number_of(item: Item, key: str) -> float:
    """The number of at least 0 that an item's user text gives; its comma is a decimal one.

    InputError for anything else, and for a comma that may separate thousands, such as that of 1,000.
    """
    text = item.text[key].strip()
    if re.fullmatch(r"[1-9]\d{0,2},\d{3}", text):
        whole, decimal = text.replace(",", ""), text.replace(",", ".")
        said = f'"{text}" given, which may mean {whole} or {decimal}; write one of these'
        raise InputError(f"{item.label}, user text {key}", said)
    try:
        value = float(text.replace(",", ".") if text.count(",") == 1 else text)
    except ValueError:
        value = -1.0
    if not 0 <= value < np.inf:
        raise InputError(f"{item.label}, user text {key}", f'"{text}" given; give a number of at least 0')
    return value


def _numbers(text: str) -> Iterable[float]:
    return [float(part) for part in re.split(r"[\s,;]+", text.strip(" {}()[]"))]


def vector_of(item: Item, along: Any) -> list[float]:
    """The load an item's user text gives: three components, or one along z or along its line."""
    text = item.text["load"]
    try:
        values = list(_numbers(text))
    except ValueError:
        values = []
    if len(values) not in (1, 3) or not np.isfinite(values).all():
        raise InputError(f"{item.label}, user text load", f'"{text}" given; give "x, y, z" or one number')
    if len(values) == 3:
        return values
    direction = np.array([0.0, 0.0, 1.0]) if along is None else np.asarray(along)
    return [float(c) for c in values[0] * direction]
