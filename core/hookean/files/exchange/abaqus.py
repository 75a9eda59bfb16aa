"""Abaqus input files: lines as trusses with axial stiffness and prestress, beams with their sections, supports, and a
step with the loads."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.files.exchange.abaqus_beams import BEAM, BeamPart
from hookean.files.exchange.structure import Lines, Structure, plain_names
from hookean.files.optional import needed

Floats = NDArray[np.float64]

TRUSS = "T3D2"
SETS = 2_000  # different sections and stresses in a file


def write(structure: Structure, target: Path) -> None:
    """Write the lines of a structure with an axial stiffness: an element set for each force and for each section in it,
    of area 1 and Young's modulus EA, so that the stress of an element is its force; its tension as initial stress;
    supports, and a step of large displacements with the loads on its particles.

    Beams are elements B31 of general sections with their axes, hinges as releases, and rigid links where their ends are
    eccentric. Without stress they lie where they start, so the points of a file with beams are those of the start,
    with the tensions that lines have there; without beams they are those of the result.

    Raises InputError where there is neither a line with an axial stiffness nor a beam.
    """
    meshio = needed("meshio", "exchange", target.name)
    groups = [group for group in structure.lines if (group.axial_stiffness > 0.0).any()]
    if not (groups or structure.beams):
        said = "the result has neither beams nor springs with a rest length to write; freeze the form first"
        raise InputError(target.name, said)
    points = structure.start if structure.beams else structure.points
    beams = BeamPart(structure.beams, points)
    held = np.flatnonzero((structure.held | structure.clamped).any(axis=1))
    sections, which = np.unique(_joined([g.axial_stiffness for g in groups]), return_inverse=True)
    for count, what in (
        (len(sections), "axial stiffnesses"),
        (len(beams.sections), "sections of beams and directions"),
    ):
        if count > SETS:
            raise InputError(target.name, f"{count} different {what}; at most {SETS} are supported")
    names = plain_names([*(group.name for group in groups), *(part.name for part in structure.beams)])
    sets = _sets(groups, names, which, len(sections), beams)
    blocks: list[tuple[str, Any]] = [("line", np.concatenate([g.pairs for g in groups]))] if groups else []
    blocks += [("line", beams.pairs)] if structure.beams else []
    mesh = meshio.Mesh(beams.points, blocks, cell_sets=sets, point_sets={"HELD": held} if len(held) else {})
    text = io.StringIO()
    meshio.abaqus._abaqus.write(text, mesh)
    lines = text.getvalue().splitlines()
    lines[:3] = ["*HEADING", f"hookean; units {_units(structure)}"]
    types = iter(([TRUSS] if groups else []) + [BEAM])
    kept = [f"*ELEMENT, TYPE={next(types)}" if line.startswith("*ELEMENT") else line for line in lines]
    first = 1 + sum(len(g.pairs) for g in groups)
    kept += [*_trusses(sections.tolist()), *beams.lines(first), *_stress(groups, points), *_step(structure, held)]
    put(target, ("\n".join(kept) + "\n").encode(), lambda back: None)


def _joined(parts: list[Floats]) -> Floats:
    return np.concatenate([np.zeros(0), *parts])


def _sets(groups: list[Lines], names: list[str], which: Any, count: int, beams: BeamPart) -> dict[str, list[Any]]:
    """Sets of elements for each force and each section, by the blocks of elements."""
    none = np.zeros(0, np.int64)
    parts = [[len(g.pairs) for g in groups], beams.counts]
    found: list[tuple[str, int, Any]] = []
    for block, sizes in enumerate(parts):
        ends = np.cumsum([0, *sizes])
        own = names[: len(groups)] if block == 0 else names[len(groups) :]
        found += [(name, block, np.arange(a, b)) for name, a, b in zip(own, ends[:-1], ends[1:], strict=True)]
    found += [(f"SECTION_{i + 1}", 0, np.flatnonzero(which == i)) for i in range(count)]
    found += [(f"BEAM_SECTION_{i + 1}", 1, np.flatnonzero(beams.which == i)) for i in range(len(beams.sections))]
    present = [block for block, sizes in enumerate(parts) if sizes]
    return {name: [rows if block == at else none for at in present] for name, block, rows in found}


def _units(structure: Structure) -> str:
    units = structure.units
    return f"{units.length}, {units.force}, {units.time}, {units.mass}"


def _trusses(sections: list[float]) -> list[str]:
    lines = []
    for i in range(len(sections)):
        lines += [f"*SOLID SECTION, ELSET=SECTION_{i + 1}, MATERIAL=MATERIAL_{i + 1}", "1.0"]
    for i, stiffness in enumerate(sections):
        lines += [f"*MATERIAL, NAME=MATERIAL_{i + 1}", "*ELASTIC", f"{stiffness!r}, 0.0"]
    return lines


def _stress(groups: list[Lines], points: Floats) -> list[str]:
    """The tension EA (l - L0) / L0 of each line at the points, as its initial stress."""
    if not groups:
        return []
    tension = []
    for group in groups:
        length = np.linalg.norm(np.diff(points[group.pairs], axis=1)[:, 0], axis=1)
        rest = np.where(group.rest_length > 0.0, group.rest_length, 1.0)
        tension += (group.axial_stiffness * (length - group.rest_length) / rest).tolist()
    return ["*INITIAL CONDITIONS, TYPE=STRESS", *(f"{i + 1}, {value!r}" for i, value in enumerate(tension))]


def _step(structure: Structure, held: np.ndarray) -> list[str]:
    lines = ["*BOUNDARY"] if len(held) else []
    fixed = np.column_stack([structure.held, structure.clamped])
    for particle in held.tolist():
        lines += [f"{particle + 1}, {axis + 1}, {axis + 1}" for axis in range(6) if fixed[particle, axis]]
    lines += ["*STEP, NLGEOM=YES", "*STATIC"]
    acting = np.column_stack([structure.loads, structure.moments])
    loaded = np.argwhere(acting != 0.0).tolist()
    lines += ["*CLOAD"] if loaded else []
    lines += [f"{n + 1}, {axis + 1}, {float(acting[n, axis])!r}" for n, axis in loaded]
    return [*lines, "*END STEP"]
