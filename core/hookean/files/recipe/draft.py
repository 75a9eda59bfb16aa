"""Drafting a recipe: what a .3dm file has on its layers, a role for each, and the recipe that these roles make.

    from hookean.files.recipe.draft import draft
    from hookean.files.rhino import threedm

    found = draft(threedm.read("roof.3dm"))
    found.rows[0].role                    # "cables", by the name of the layer
    found.recipe                          # what `hookean relax roof.3dm --recipe` accepts

A row is the objects of one family (points, curves, surfaces) on one layer. Without choices its role is that of the
convention of layer names (see `convention`), or the one that a word of the layer's name suggests, as in "Edge rope 2";
where no layer has either, the role is by the kind of objects. Loose ends and edges are held where nothing is an anchor.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hookean.errors import InputError
from hookean.files.readers import reader
from hookean.files.recipe import shapes
from hookean.files.recipe.build import Built, build
from hookean.files.recipe.compose import recipe_of
from hookean.files.recipe.drawing import Drawing, drawing
from hookean.files.recipe.foreign import drawn_in, model_of
from hookean.files.recipe.guides import PULLS
from hookean.files.recipe.notes import notes
from hookean.files.recipe.roles import ROLES, converted, role_names, usable
from hookean.files.recipe.rows import Entry, Row, fill, guess, own, rows_of
from hookean.files.recipe.select import count
from hookean.files.recipe.snapping import Floats, distances
from hookean.files.rhino.model import Model
from hookean.scene.scene import Scene
from hookean.values.columns import Model as Described
from hookean.values.fields import Field
from hookean.values.units import Units

MANY = {"face of membrane": "faces of membrane"}
NOTHING = "nothing becomes springs or a membrane yet"
CHOOSE = f"{NOTHING}; give a layer one of these roles"
UNCONNECTED = (
    "the file has points that can be anchors or loads, but no curves or surfaces that connect them; give a layer the "
    "role anchors and draw lines between its points in the studio, or draw them in Rhino"
)
TO_CONNECT = "no curves or surfaces connect the points; draw lines between them, in the panel Draw of the studio"
UNDRAWN = "the file has no points, curves or surfaces; draw lines or a mesh in Rhino, save the file, and open it again"


class RowChoice(Described):
    """The role of a row, and its values; those that are missing are at their defaults."""

    layer: str
    family: str
    role: str
    values: dict[str, Any] = Field(default={})


class ObjectChoice(Described):
    """The role of one object, and its values."""

    id: str
    role: str
    values: dict[str, Any] = Field(default={})


class Choices(Described):
    """What somebody chose for a file. `values_in` are the units of the values, `units` those of the recipe."""

    units: Units = Field(default=Units())
    values_in: Units | None = Field(default=None)
    weld_tolerance: float | None = Field(default=None, ge=0, description="Points nearer are one particle [length]")
    rows: tuple[RowChoice, ...] = Field(default=())
    objects: tuple[ObjectChoice, ...] = Field(default=())


@dataclass(eq=False)
class Draft:
    """A file with roles, and the recipe that they make. `fault` is why that cannot be solved ("" where it can), `notes`
    what a person should know; `particles` and `held` are counts (0 with a fault)."""

    drawing: Drawing
    rows: list[Row]
    weld_tolerance: float
    recipe: dict[str, Any]
    fault: str = ""
    notes: list[str] = field(default_factory=list)
    particles: int = 0
    held: int = 0
    size: str = ""

    def to_dict(self) -> dict[str, Any]:
        """It as plain values, with the roles that may be chosen."""
        units = self.drawing.units
        return {
            "name": self.drawing.model.name,
            "unit": self.drawing.unit,
            "said": self.drawing.said,
            "size": self.size,
            "units": units.model_dump(),
            "weld_tolerance": self.weld_tolerance,
            "rows": [_plain(row) for row in self.rows],
            "roles": [role.entry(units) for role in ROLES.values()],
            "recipe": self.recipe,
            "fault": self.fault,
            "notes": self.notes,
            "particles": self.particles,
            "held": self.held,
        }


def undrafted(name: str) -> dict[str, Any]:
    """A draft as plain values for a file that holds a whole model and needs no recipe: it has no rows."""
    nothing: dict[str, Any] = {"rows": [], "roles": [], "recipe": {}, "notes": [], "particles": 0, "held": 0}
    return {**nothing, "name": name, "units": Units().model_dump(), "fault": ""}


def _plain(row: Row) -> dict[str, Any]:
    objects = [
        {"id": str(e.item.ids[-1]), "name": e.item.name, "kind": e.item.kind, "role": e.role, "values": e.values}
        | ({"why": e.why} if e.why else {})
        for e in row.entries
    ]
    return {
        "layer": row.layer,
        "family": row.family,
        "kinds": shapes.counted(row.items),
        "roles": role_names(row.family),
        "role": row.role,
        "values": row.values,
        "becomes": row.becomes,
        "objects": objects,
    }


def model_in(data: bytes, name: str) -> Model | None:
    """The model of an OBJ file or of COMPAS documents; None for a file that holds a whole model. InputError for a fault
    in it."""
    drawn = drawn_in(data, reader(data, name).suffix)
    return None if drawn is None else model_of(drawn, Path(name).name or "the file")


def draft(model: Model, choices: Any = None) -> Draft:
    """The layers and objects of a file with a role for each: by guess, and where `choices` (see `Choices`) has another.

    Raises InputError for a choice that is unknown or not allowed, or user text that cannot be read. What makes the
    recipe unsolvable is no error, but the `fault` of the draft.
    """
    chosen = Choices.read({} if choices is None else choices)
    seen = drawing(model, chosen.units.model_dump())
    weld = seen.tolerance if chosen.weld_tolerance is None else chosen.weld_tolerance
    rows = rows_of(seen)
    guess(rows)
    marked = any(row.role == "anchors" for row in rows)
    picked = _picked(rows, chosen)
    for row, pick in zip(rows, picked, strict=True):
        row.role = row.role if pick is None else pick[1].role
    for row, pick in zip(rows, picked, strict=True):
        fill(row, rows, seen, None if marked else weld, pick is None)
        if pick is not None:
            row.values = _values(row.family, row.role, pick[1].values, row.values, chosen, f"/rows/{pick[0]}")
        own(row, seen.units)
    _single_out(rows, chosen)
    recipe, sources = recipe_of(rows, seen, weld)
    found = Draft(seen, rows, weld, recipe)
    _solvable(found, sources)
    return found


def _picked(rows: Sequence[Row], chosen: Choices) -> list[tuple[int, RowChoice] | None]:
    """For each row the choice of it with its number, or None. InputError for a row or a role that there is not."""
    known = {(row.layer, row.family): i for i, row in enumerate(rows)}
    found: list[tuple[int, RowChoice] | None] = [None] * len(rows)
    for number, choice in enumerate(chosen.rows):
        place = known.get((choice.layer, choice.family))
        if place is None:
            there = ", ".join(f'"{layer}" ({family or "other"})' for layer, family in known)
            given = f'no objects of the family "{choice.family}" on layer "{choice.layer}"'
            raise InputError(f"/rows/{number}/layer", f"the file has {given}; it has {there or 'none'}")
        _known_role(rows[place].family, choice.role, f"/rows/{number}/role")
        if (other := found[place]) is not None:
            said = f'the {choice.family} on layer "{choice.layer}" have a role already, by /rows/{other[0]}; give one'
            raise InputError(f"/rows/{number}", said)
        found[place] = (number, choice)
    return found


def _known_role(family: str, role: str, pointer: str) -> None:
    if role not in role_names(family):
        raise InputError(pointer, f'"{role}" given; {family or "these objects"} may be {", ".join(role_names(family))}')


def _values(
    family: str, role: str, given: Mapping[str, Any], defaults: Mapping[str, Any], chosen: Choices, pointer: str
) -> dict[str, Any]:
    """Chosen values over others. InputError for one that is unknown or not allowed, in its units or the recipe's."""
    kind = ROLES.get((family, role))
    if kind is None:
        if given:
            raise InputError(f"{pointer}/values", f'{next(iter(given))} given; the role "{role}" has no values')
        return {}
    try:
        read = kind.read(dict(given)).model_dump(include=set(given))
        values = converted(kind, read, chosen.values_in or chosen.units, chosen.units)
        kind.read(values)
    except InputError as error:
        raise InputError(f"{pointer}/values{error.pointer}".rstrip("/"), error.sentence) from None
    return {**defaults, **values}


def _single_out(rows: Sequence[Row], chosen: Choices) -> None:
    """Choices of single objects."""
    known: dict[str, list[tuple[Row, Entry]]] = {}
    for row in rows:
        for entry in row.entries:
            known.setdefault(str(entry.item.ids[-1]), []).append((row, entry))
    first: dict[str, int] = {}
    for number, choice in enumerate(chosen.objects):
        pointer = f"/objects/{number}"
        if first.setdefault(choice.id, number) != number:
            raise InputError(pointer, f"the object has a role already, by /objects/{first[choice.id]}; give one")
        if choice.id not in known:
            raise InputError(f"{pointer}/id", f'the file has no visible object "{choice.id}"; give the id of one')
        for row, entry in known[choice.id]:
            _known_role(row.family, choice.role, f"{pointer}/role")
            kind = ROLES.get((row.family, choice.role))
            defaults = row.values if row.role == choice.role else kind.defaults(chosen.units) if kind else {}
            entry.role, entry.why = choice.role, ""
            entry.values = _values(row.family, choice.role, choice.values, defaults, chosen, pointer)
            if kind is not None:
                entry.why = usable(kind.read(entry.values), entry.item)


def _solvable(found: Draft, sources: Mapping[str, list[int]]) -> None:
    """Count what the roles become, or note why that cannot be solved."""
    from hookean.running.result import held_particles
    from hookean.system.system import compile

    forces = found.recipe["forces"]
    are_points = not forces and {row.family for row in found.rows} == {"points"}
    if not are_points and all(table.get("kind", "unary") in ("unary", *PULLS) for table in forces):
        found.fault = _nothing(found.rows)
        return
    try:
        built = build(found.drawing, found.recipe)
        system = compile(built.scene, empty=are_points)
    except InputError as error:
        found.fault = _placed(error, found, sources)
        return
    found.size, report = built.size, system.report
    found.particles = len(system.points)
    found.held = len(held_particles(system, system.start()))
    found.notes = [*found.drawing.model.warnings, *notes(found.drawing, built, conventional=False)]
    found.notes += [*report.left_out(), *report.warnings, *([TO_CONNECT] if are_points else [])]
    elements = Counter[int]()
    for group in system.all_groups:
        for part in group.parts:
            elements[part.number] += part.rows.stop - part.rows.start
    _count(found, built, sources, elements)
    if found.particles == 1:
        weld, unit = found.weld_tolerance, found.drawing.units.length
        found.fault = f"all points become one particle, as weld_tolerance is {weld:g} {unit}; lower it"


def _nothing(rows: Sequence[Row]) -> str:
    """Why no object becomes springs or a membrane, and what to do."""
    families = {row.family for row in rows}
    if not families & {"curves", "surfaces"}:
        return UNCONNECTED if "points" in families else UNDRAWN
    for row in rows:
        kind = ROLES.get((row.family, row.role))
        if kind is not None and kind.elastic and row.entries[0].why:
            return f'{NOTHING}; layer "{row.layer}": {row.entries[0].why}'
    return CHOOSE


def _placed(error: InputError, found: Draft, sources: Mapping[str, list[int]]) -> str:
    """A fault of the recipe as a sentence that names the layer."""
    _, group, number, *_ = (*error.pointer.split("/"), "", "", "")
    if group in sources and number.isdigit() and int(number) < len(sources[group]):
        return f'layer "{found.rows[sources[group][int(number)]].layer}": {error.sentence}'
    return error.sentence


def _count(found: Draft, built: Built, sources: Mapping[str, list[int]], elements: Counter[int]) -> None:
    """What each row becomes, in words."""
    sums: list[Counter[str]] = [Counter() for _ in found.rows]
    for number, row in enumerate(sources["forces"]):
        force, shape = built.scene.forces[number], built.forces[number]
        if force.kind_name in PULLS:
            sums[row]["guide"] += sum(
                (entry.role or found.rows[row].role) == "guide" for entry in found.rows[row].entries
            )
        elif force.kind_name == "membrane":
            sums[row]["face of membrane"] += 0 if shape is None or shape.faces is None else len(shape.faces)
        elif force.kind_name != "shell":  # its faces are those of its membrane
            sums[row]["load" if force.kind_name == "unary" else "spring"] += elements[number]
    for number, row in enumerate(sources["anchors"]):
        shape = built.anchors[number]
        sums[row]["held point"] += 0 if shape is None else len(shape.array)
    for made, counted in zip(found.rows, sums, strict=True):
        made.becomes = [count(number, what, MANY.get(what, "")) for what, number in counted.items()]
    for number, row in enumerate(sources["anchors"]):
        if (shape := built.anchors[number]) is not None and len(shape.array):
            found.rows[row].becomes += _apart(found, built.scene, shape.array, found.recipe["anchors"][number])


def _apart(found: Draft, scene: Scene, points: Floats, table: Mapping[str, Any]) -> list[str]:
    """How far anchors are from the nearest particles, where they do not meet these."""
    far = distances(scene, points)
    unit, reach = found.drawing.units.length, float(table.get("snap", 0.0))
    moved = far[(far > found.weld_tolerance) & (far <= reach)]
    beside = far[(far > found.weld_tolerance) & (far > reach)]
    said = []
    if len(moved):
        said.append(f"{len(moved)} of them moved to the nearest particle, by {moved.max():.3g} {unit} at most")
    if len(beside):
        said.append(f"{len(beside)} of them {beside.min():.3g} {unit} or more from the nearest particle; raise snap")
    return said
