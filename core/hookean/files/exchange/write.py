"""Which file is written by what, for other programs."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hookean.atomic_write import check_target

if TYPE_CHECKING:
    from hookean.files.exchange.structure import Floats, Ints, Structure
    from hookean.running.result import Result
    from hookean.system.system import System

FARTHER = 0.01
"""Part of a force by which measures of strain may differ between the points of a file and the result."""

EXCHANGED = {".dxf": "model_dxf", ".vtu": "vtu", ".inp": "abaqus", ".ifc": "ifc", ".compas.json": "compas_graph"}
"""Files for other programs by their ending, and the modules that write them."""


def ending_of(target: Path) -> str:
    """The ending of a file by which it is written, in lower case."""
    name = target.name.lower()
    return ".compas.json" if name.endswith(".compas.json") else target.suffix.lower()


def exchange(result: Result, target: Path, system: System | None = None) -> list[str]:
    """Write a result for another program, by the ending of a file; a sentence on what such a file does not hold.

    `system` is the result's scene compiled. Raises InputError where a package is missing, the file cannot be written or
    cannot hold the result.
    """
    from hookean.files.exchange.structure import Structure

    check_target(target)
    ending = ending_of(target)
    # beams and shells are without stress where their scene starts, which a system of a load case has moved to the form
    structure = Structure.of(result, None if ending == ".inp" else system)
    import_module(f"hookean.files.exchange.{EXCHANGED[ending]}").write(structure, target)
    said = [f"A {ending} file stores the shape, its lines and results, not the model; save the scene, too."]
    if ending == ".inp":
        return said + _left(structure)
    if structure.touching:
        said.append(f"The forces of floors on {structure.touching} particles are not in the file.")
    if ending in (".ifc", ".compas.json") and structure.cloth:
        said.append(f"Membranes on {', '.join(structure.cloth)}: not in the file, which has lines alone.")
    return said


def _left(structure: Structure) -> list[str]:
    """What an Abaqus file leaves out, as sentences."""
    without = [g.name for g in structure.lines if g.kind != "beam" and not (g.axial_stiffness > 0.0).any()]
    left = [*without, *structure.others]
    has = "beams, membranes, lines with an axial stiffness, and elastic supports"
    said = [f"{', '.join(left)}: not in the file, which has {has}."] if left else []
    if structure.elastic.any():
        said.append("Elastic supports are SPRING1, with which meshio does not read the file.")
    slack = [g.name for g in structure.lines if g.one_way == "other" and (g.axial_stiffness > 0.0).any()]
    said += [f"{', '.join(slack)}: trusses without their cutoffs."] if slack else []
    parts = [(part.name, part.left) for part in structure.beams] + [(part.name, part.left) for part in structure.sheets]
    said += [f"{name}: the file does not hold {what}." for name, without in parts for what in without]
    return said + (_strained(structure) if structure.started else [])


def _strained(structure: Structure) -> list[str]:
    """A sentence on what strains far from the points of the start: linear, logarithmic and Green strains differ by
    up to their square."""
    found = dict[str, float]()
    for line in structure.lines:
        strain = _stretches(structure, line.pairs)
        if (line.axial_stiffness * strain**2).max(initial=0.0) > FARTHER * abs(line.force).max(initial=0.0):
            found[line.name] = strain.max()
    for sheet in structure.sheets:
        strain = np.concatenate([_stretches(structure, sheet.corners[:, [i, i - 1]]) for i in range(3)])
        stress = np.abs(sheet.stress(structure.points)).max(initial=0.0)
        if (sheet.stiffness[0] * strain**2).max(initial=0.0) > FARTHER * stress:
            found[sheet.name] = max(strain.max(), found.get(sheet.name, 0.0))
    if not found:
        return []
    return [
        f"The points are those of the start, from which {', '.join(found)} strain by up to "
        f"{100.0 * max(found.values()):.2g} %: other programs measure such strains in other ways and will find other "
        "forces. Draw the model in its form, and save that."
    ]


def _stretches(structure: Structure, pairs: Ints) -> Floats:
    """Sizes (m,) of the strains between the start and the result along pairs (m, 2) of particles."""
    start, now = (np.linalg.norm(p[pairs[:, 1]] - p[pairs[:, 0]], axis=1) for p in (structure.start, structure.points))
    return np.asarray(np.abs(now - start) / np.where(start > 0.0, start, np.where(now > 0.0, now, 1.0)))
