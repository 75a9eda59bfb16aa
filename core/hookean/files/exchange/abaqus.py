"""Abaqus input files: lines as trusses with axial stiffness and prestress, supports, and a step with the loads."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.files.exchange.structure import Structure, plain_names
from hookean.files.optional import needed

TRUSS = "T3D2"
SETS = 2_000  # different axial stiffnesses and stresses in a file


def write(structure: Structure, target: Path) -> None:
    """Write the lines of a structure with an axial stiffness: an element set for each force and for each section in it,
    of area 1 and Young's modulus EA, so that the stress of an element is its force; its tension as initial stress;
    supports, and a step of large displacements with the loads on its particles.

    Raises InputError where no line has an axial stiffness.
    """
    meshio = needed("meshio", "exchange", target.name)
    groups = [group for group in structure.lines if (group.axial_stiffness > 0.0).any()]
    if not groups:
        raise InputError(target.name, "the result has no springs with a rest length to write; freeze the form first")
    pairs = np.concatenate([group.pairs for group in groups])
    stiffness = np.concatenate([group.axial_stiffness for group in groups])
    tension = np.concatenate([group.force for group in groups])
    starts = np.cumsum([0, *(len(group.pairs) for group in groups)])
    sets = {
        name: [np.arange(first, last)]
        for name, first, last in zip(plain_names([g.name for g in groups]), starts[:-1], starts[1:], strict=True)
    }
    sections, which = np.unique(stiffness, return_inverse=True)
    if len(sections) > SETS:
        raise InputError(target.name, f"{len(sections)} different axial stiffnesses; at most {SETS} are supported")
    for i in range(len(sections)):
        sets[f"SECTION_{i + 1}"] = [np.flatnonzero(which == i)]
    held = np.flatnonzero(structure.held.any(axis=1))
    mesh = meshio.Mesh(
        structure.points, [("line", pairs)], cell_sets=sets, point_sets={"HELD": held} if len(held) else {}
    )
    text = io.StringIO()
    meshio.abaqus._abaqus.write(text, mesh)
    lines = text.getvalue().splitlines()
    lines[:3] = ["*HEADING", f"hookean; units {_units(structure)}"]
    kept = [f"*ELEMENT, TYPE={TRUSS}" if line.startswith("*ELEMENT") else line for line in lines]
    kept += _sections(sections.tolist(), tension.tolist())
    kept += _step(structure, held)
    put(target, ("\n".join(kept) + "\n").encode(), lambda back: None)


def _units(structure: Structure) -> str:
    units = structure.units
    return f"{units.length}, {units.force}, {units.time}, {units.mass}"


def _sections(sections: list[float], tension: list[float]) -> list[str]:
    lines = []
    for i in range(len(sections)):
        lines += [f"*SOLID SECTION, ELSET=SECTION_{i + 1}, MATERIAL=MATERIAL_{i + 1}", "1.0"]
    for i, stiffness in enumerate(sections):
        lines += [f"*MATERIAL, NAME=MATERIAL_{i + 1}", "*ELASTIC", f"{stiffness!r}, 0.0"]
    lines.append("*INITIAL CONDITIONS, TYPE=STRESS")
    return lines + [f"{element + 1}, {value!r}" for element, value in enumerate(tension)]


def _step(structure: Structure, held: np.ndarray) -> list[str]:
    lines = ["*BOUNDARY"] if len(held) else []
    for particle in held.tolist():
        lines += [f"{particle + 1}, {axis + 1}, {axis + 1}" for axis in range(3) if structure.held[particle, axis]]
    lines += ["*STEP, NLGEOM=YES", "*STATIC"]
    loaded = np.argwhere(structure.loads != 0.0).tolist()
    lines += ["*CLOAD"] if loaded else []
    lines += [f"{n + 1}, {axis + 1}, {float(structure.loads[n, axis])!r}" for n, axis in loaded]
    return [*lines, "*END STEP"]
