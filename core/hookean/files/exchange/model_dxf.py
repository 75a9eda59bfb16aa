"""DXF files of a result: lines and faces on layers by their names, supports and loads with their numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hookean.files import dxf
from hookean.files.exchange.structure import Structure, plain_names

SUPPORTS, FACES, LOADS = "SUPPORTS", "FACES_", "LOADS"


def write(structure: Structure, target: Path) -> None:
    """Write a structure: a LINE for each element on the layer of its force, with its numbers as extended data; a 3DFACE
    for each face on the layer of its mesh; a POINT on SUPPORTS for each particle that is held or elastically supported;
    a LINE on LOADS for each load, the largest as long as a tenth of the model, and a POINT there for each moment of a
    load. Supports, loads and moments have their numbers as extended data."""
    layers = plain_names([group.name for group in structure.lines])
    meshes = [f"{FACES}{name}" for name in plain_names(list(structure.faces))]
    colours = {name: 1 + i % 6 for i, name in enumerate(layers)} | dict.fromkeys(meshes, 8)
    made = dxf.document(target.name, str(structure.units.length), colours | {SUPPORTS: 7, LOADS: 30})
    made.appids.add("HOOKEAN")
    space, points = made.modelspace(), structure.points.tolist()
    for layer, group in zip(layers, structure.lines, strict=True):
        for row, (a, b) in enumerate(group.pairs.tolist()):
            line = space.add_line(points[a], points[b], dxfattribs={"layer": layer})
            told: list[tuple[int, str | float]] = [(1000, f"force={group.name}")]
            for name, values in group.columns.items():
                unit = structure.units.of(group.dimensions[name]) or "-"
                told += [(1000, f"{name} [{unit}]"), (1040, float(values[row]))]
            line.set_xdata("HOOKEAN", told)
    for layer, faces in zip(meshes, structure.faces.values(), strict=True):
        for face in faces.tolist():
            space.add_3dface([points[i] for i in face], dxfattribs={"layer": layer})
    force, moment = (structure.units.of(unit) for unit in ("force", "force length"))
    for particle in structure.supported.tolist():
        point = space.add_point(points[particle], dxfattribs={"layer": SUPPORTS})
        point.set_xdata("HOOKEAN", _support(structure, particle))
    for particle in np.flatnonzero(structure.moments.any(axis=1)).tolist():
        point = space.add_point(points[particle], dxfattribs={"layer": LOADS})
        point.set_xdata("HOOKEAN", _numbers(f"moment [{moment}]", structure.moments[particle]))
    sizes = np.linalg.norm(structure.loads, axis=1)
    if sizes.max(initial=0.0) > 0.0:
        long = 0.1 * float(np.linalg.norm(np.ptp(structure.points, axis=0))) / sizes.max()
        for particle in np.flatnonzero(sizes).tolist():
            tail = (structure.points[particle] - long * structure.loads[particle]).tolist()
            line = space.add_line(tail, points[particle], dxfattribs={"layer": LOADS})
            line.set_xdata("HOOKEAN", _numbers(f"load [{force}]", structure.loads[particle]))
    dxf.write(made, target)


def _support(structure: Structure, particle: int) -> list[tuple[int, str | float]]:
    """The reaction of a support, with its moment if it holds rotations, and the stiffness of an elastic one."""
    force, moment, stiffness = (structure.units.of(unit) for unit in ("force", "force length", "force/length"))
    said = _numbers(f"reaction [{force}]", structure.reactions[particle])
    along, about = np.split(structure.elastic[particle], 2)
    if structure.clamped[particle].any() or about.any():
        said += _numbers(f"reaction moment [{moment}]", structure.reaction_moments[particle])
    said += _numbers(f"stiffness [{stiffness}]", along) if along.any() else []
    return said + (_numbers(f"rotation stiffness [{moment}]", about) if about.any() else [])


def _numbers(name: str, vector: NDArray[np.float64]) -> list[tuple[int, str | float]]:
    """A vector as extended data."""
    return [(1000, name), *((1040, float(part)) for part in vector)]
