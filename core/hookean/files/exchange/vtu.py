"""VTU files, for ParaView: points with displacements, loads and reactions; lines with their forces; faces."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from hookean.atomic_write import put
from hookean.files.exchange.structure import Structure
from hookean.files.optional import needed


def write(structure: Structure, target: Path) -> None:
    """Write a structure. Numbers have their units in their names; `group` is the number of a cell's force or mesh, and
    each of these is a cell array of 0 and 1 by its name. Cells without a quantity have 0. Where there are beams, points
    have moments, too."""
    meshio = needed("meshio", "exchange", target.name)
    blocks, owners = cells(structure)
    names = [*(f"force {group.name}" for group in structure.lines), *(f"mesh {name}" for name in structure.faces)]
    data: dict[str, list[Any]] = {"group": owners}
    for number, name in enumerate(names):
        data[name] = [(owner == number).astype(float) for owner in owners]
    for column in dict.fromkeys(name for group in structure.lines for name in group.columns):
        dimension = next(g.dimensions[column] for g in structure.lines if column in g.columns)
        values = [g.columns.get(column, np.zeros(len(g.pairs))) for g in structure.lines]
        lines = np.concatenate(values)
        data[f"{column} [{structure.units.of(dimension) or '-'}]"] = [
            lines if kind == "line" else np.zeros(len(rows)) for kind, rows in blocks
        ]
    for column in dict.fromkeys(name for columns in structure.cloth.values() for name in columns):
        data[column] = _of_faces(structure, column, blocks)
    length, force, moment = (structure.units.of(unit) for unit in ("length", "force", "force length"))
    point_data = {
        f"displacement [{length}]": structure.displacements,
        f"load [{force}]": structure.loads,
        f"reaction [{force}]": structure.reactions,
        "held": structure.held.astype(float),
    }
    if len(structure.beams):
        point_data[f"load moment [{moment}]"] = structure.moments
        point_data[f"reaction moment [{moment}]"] = structure.reaction_moments
        point_data["clamped"] = structure.clamped.astype(float)
    mesh = meshio.Mesh(structure.points, blocks, point_data=point_data, cell_data=data)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "structure.vtu"
        mesh.write(place, file_format="vtu")
        put(target, place.read_bytes(), lambda back: None)


def _of_faces(structure: Structure, column: str, blocks: list[tuple[str, Any]]) -> list[Any]:
    """A column of membranes for each block of cells, in the order of `cells`."""
    whole = np.concatenate(
        [structure.cloth.get(name, {}).get(column, np.zeros(len(f))) for name, f in structure.faces.items()]
    )
    faces = np.concatenate(list(structure.faces.values()))
    three = faces[:, 2] == faces[:, 3]
    chosen = {"triangle": three, "quad": ~three}
    return [whole[chosen[kind]] if kind in chosen else np.zeros(len(rows)) for kind, rows in blocks]


def cells(structure: Structure) -> tuple[list[tuple[str, Any]], list[Any]]:
    """Blocks of cells by their type, and of each cell the number of its force or mesh."""
    blocks: list[tuple[str, Any]] = []
    owners: list[Any] = []
    if len(structure.pairs):
        blocks.append(("line", structure.pairs))
        owners.append(np.repeat(np.arange(len(structure.lines)), [len(g.pairs) for g in structure.lines]))
    whole = [np.zeros((0, 4), np.int64), *structure.faces.values()]
    faces, count = np.concatenate(whole), len(structure.lines)
    mesh = np.repeat(count + np.arange(len(structure.faces)), [len(f) for f in structure.faces.values()])
    three = faces[:, 2] == faces[:, 3]
    for kind, chosen, corners in (("triangle", three, 3), ("quad", ~three, 4)):
        if chosen.any():
            blocks.append((kind, faces[chosen, :corners]))
            owners.append(mesh[chosen])
    return blocks, owners
