"""Results as tables: rows keyed by the object they came from, CSV text, and sums for each object."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.files import cells
from hookean.forces.floor import Floor
from hookean.running.result import Result
from hookean.running.utilisation import dimensions
from hookean.system.system import System
from hookean.values.units import Units

if TYPE_CHECKING:  # what reads models loads rhino3dm
    from hookean.files.recipe.build import Built
    from hookean.files.recipe.drawing import Item
    from hookean.files.recipe.shapes import Shape

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Row = dict[str, Any]

CARRIED = ("reaction", "contact")
"""The kinds of rows of what supports and floors carry."""
FLOOR = Floor.kind_name
TOUCHING = 1e-12  # height above a floor, / coordinates, that counts as 0


@dataclass(eq=False)
class Section:
    """The elements of force `number` of the scene, or what supports or floors carry (-1): `particles` (m, arity),
    `columns` (m,) or (m, 3) each with the dimension in `outputs`, and the item each element came from (`owner` -1:
    none)."""

    number: int
    name: str
    kind: str
    particles: Ints
    columns: dict[str, Floats]
    outputs: Mapping[str, str]
    items: tuple[Item, ...]
    owner: Ints
    names: list[str]

    def item(self, row: int) -> Item | None:
        """Where an element came from."""
        return self.items[self.owner[row]] if self.owner[row] >= 0 else None

    @property
    def internal(self) -> bool:
        """Whether its forces are those inside elements, with a sign."""
        force = self.columns.get("force")
        return self.kind not in CARRIED and force is not None and force.ndim == 1


def sections(system: System, result: Result, built: Built | None = None) -> list[Section]:
    """One section for each force of the scene that has elements, one of what floors carry if anything touches one, and
    the last one of reactions."""
    found: list[Section] = []
    for number, entry in enumerate(result.forces):
        if "particles" not in entry:
            continue
        particles = np.asarray(entry["particles"], dtype=np.int64)
        particles = particles[:, None] if particles.ndim == 1 else particles
        columns = {k: np.asarray(v) for k, v in entry.items() if k not in ("kind", "name", "particles")}
        shape = built.forces[number] if built is not None else None
        owner = np.full(len(particles), -1) if shape is None else _owners(system, number, particles, shape)
        items = () if shape is None else shape.items
        name = str(entry["name"] or entry["kind"])
        kind = str(entry["kind"])
        found.append(Section(number, name, kind, particles, columns, dimensions(kind), items, owner, []))
    if len(result.contacts["particles"]):
        found.append(_contacts(system, result))
    found.append(_reactions(system, result, built))
    return found


def _contacts(system: System, result: Result) -> Section:
    """The forces of floors on particles, each by the names of the floors that it lies on."""
    particles = np.asarray(result.contacts["particles"], dtype=np.int64)
    force = np.asarray(result.contacts["force"], dtype=np.float64).reshape(-1, 3)
    at, names = result.particles[particles], [list[str]() for _ in particles]
    for floor in (*system.scene.forces, system.scene.settings.floor):
        if isinstance(floor, Floor):
            height = (at - floor.point) @ (np.asarray(floor.normal) / np.linalg.norm(floor.normal))
            size = np.abs(at).max(axis=1) + np.abs(floor.point).max()
            for row in np.flatnonzero(height <= TOUCHING * size).tolist():
                names[row].append(floor.name or floor.kind)
    owner = np.full(len(particles), -1)
    said = [", ".join(dict.fromkeys(each)) for each in names]
    return Section(-1, "contacts", "contact", particles[:, None], {"force": force}, {"force": "force"}, (), owner, said)


def _owners(system: System, number: int, particles: Ints, shape: Shape) -> Ints:
    """The item of each element: by its place in the input where that is kept, else by the particles it has."""
    force, places = system.scene.forces[number], system.places
    if shape.faces is None:
        elements = places.elements(force)
        met = (elements >= 0).all(axis=1)
        if len(elements) == len(shape.owner) and np.array_equal(elements[met], particles):
            return shape.owner[met]
        at = places.meet(shape.array).reshape(len(shape.owner), -1)
        return _looked_up(at[:, 0], shape.owner, particles[:, 0])
    at = places.vertices(str(getattr(force, "mesh", "")))
    if particles.shape[1] < 2:
        return _looked_up(at, shape.owner, particles[:, 0])
    corner = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)]
    pairs = np.concatenate([shape.faces[:, list(pair)] for pair in corner])
    count = len(system.x)
    sides = np.sort(at[pairs], axis=1)
    keys, first = np.unique(sides[:, 0] * count + sides[:, 1], return_index=True)
    mine = np.sort(particles[:, :2], axis=1)
    return _looked_up(keys, shape.owner[pairs[first, 0]], mine[:, 0] * count + mine[:, 1])


def _looked_up(keys: Ints, owner: Ints, wanted: Ints) -> Ints:
    """The owner at the first of `keys` that equals each wanted one; -1 for none."""
    unique, first = np.unique(keys, return_index=True)
    if not len(unique):
        return np.full(len(wanted), -1)
    place = np.minimum(np.searchsorted(unique, wanted), len(unique) - 1)
    return np.where(unique[place] == wanted, owner[first[place]], -1)


def _reactions(system: System, result: Result, built: Built | None) -> Section:
    particles = np.asarray(result.reactions["particles"], dtype=np.int64)
    items: list[Item] = []
    keys: list[Ints] = []
    owners: list[Ints] = []
    for shape in built.anchors if built is not None else ():
        if shape is not None:
            keys.append(system.places.meet(shape.array))
            owners.append(shape.owner + len(items))
            items.extend(shape.items)
    owner = np.full(len(particles), -1)
    if keys:
        owner = _looked_up(np.concatenate(keys), np.concatenate(owners), particles)
    force = np.asarray(result.reactions["force"], dtype=np.float64).reshape(-1, 3)
    columns = {"force": force}
    if len(result.rotations["particles"]):
        columns["moment"] = np.asarray(result.reactions["moment"], dtype=np.float64).reshape(-1, 3)
    names = [str(name) for name in result.reactions["names"]]
    return Section(
        -1,
        "reactions",
        "reaction",
        particles[:, None],
        columns,
        {"force": "force", "moment": "force length"},
        tuple(items),
        owner,
        names,
    )


def rows(parts: Sequence[Section], result: Result) -> list[Row]:
    """A row for each element, contact with a floor and reaction; keys are the CSV's header, with units. Lengths and
    forces are in the scene's units, x y z the middle of the relaxed element, `particles` those it joins."""
    return [row for part in parts for row in _rows(part, result)]


def _rows(part: Section, result: Result) -> Iterator[Row]:
    units = result.units
    middle = result.particles[part.particles].mean(axis=1) if len(part.particles) else np.zeros((0, 3))
    heads = {name: _unit(units, part.outputs.get(name, "")) for name in part.columns}
    for i in range(len(part.particles)):
        item = part.item(i)
        row: Row = {
            "id": "" if item is None else str(item.id),
            "name": "" if item is None else item.name,
            "layer": "" if item is None else item.layer,
            "force": part.names[i] if part.names else part.name,
            "kind": part.kind,
            "element": i,
            "particles": " ".join(str(particle) for particle in part.particles[i]),
        }
        row.update({f"{axis} [{units.length}]": float(c) for axis, c in zip("xyz", middle[i], strict=True)})
        for name, values in part.columns.items():
            value = values[i]
            if np.ndim(value) == 0:
                row[f"{name}{heads[name]}"] = float(value)
                continue
            row[f"{name}{heads[name]}"] = float(np.linalg.norm(value))
            row.update({f"{name} {a}{heads[name]}": float(c) for a, c in zip("xyz", value, strict=False)})
        yield row


def _unit(units: Units, dimension: str) -> str:
    return f" [{units.of(dimension) or '-'}]"


def csv_text(table: Sequence[Row]) -> str:
    """The rows as CSV with a header; numbers to the last digit, lines end in CR LF as in RFC 4180. Text that begins
    like a formula has an apostrophe in front."""
    header = list(dict.fromkeys(key for row in table for key in row))
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(cells.row(header))
    writer.writerows(cells.row(row.get(key, "") for key in header) for row in table)
    return out.getvalue()


def per_object(parts: Sequence[Section], units: Units) -> list[Row]:
    """For each object and force: its elements, smallest and largest force, largest strain, total length."""
    found: list[Row] = []
    for part in parts:
        if not part.internal:
            continue
        for number in np.unique(part.owner[part.owner >= 0]):
            mine, item = part.owner == number, part.items[number]
            entry: Row = {"id": str(item.id), "name": item.name, "layer": item.layer, "force": part.name}
            entry["elements"] = int(mine.sum())
            force = part.columns["force"][mine]
            entry[f"min force [{units.force}]"] = float(force.min())
            entry[f"max force [{units.force}]"] = float(force.max())
            if "strain" in part.columns:
                entry["max strain [-]"] = float(np.abs(part.columns["strain"][mine]).max())
            if "length" in part.columns:
                entry[f"length [{units.length}]"] = float(part.columns["length"][mine].sum())
            found.append(entry)
    return found
