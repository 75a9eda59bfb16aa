"""Abaqus input files: lines as trusses with axial stiffness and prestress, beams, cloth and shells with their sections,
supports, and a step with the loads."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.files.exchange.abaqus_beams import BeamPart
from hookean.files.exchange.abaqus_blocks import Elements, Materials, number, numbered, of_elements, row
from hookean.files.exchange.abaqus_sheets import SheetPart
from hookean.files.exchange.structure import Lines, Structure, plain_names

Floats = NDArray[np.float64]

TRUSS = "T3D2"
SETS = 2_000  # different sections and stresses in a file


def write(structure: Structure, target: Path) -> None:
    """Write the lines of a structure with an axial stiffness: an element set for each force and for each section in it,
    of area A and modulus EA / A (area 1 where no section is known), its tension as initial stress; membranes as
    elements S3, thin where they have no shell, else with S4; supports, elastic ones as springs to the ground, and a
    step of large displacements with the loads on its particles.

    Beams are elements B31 of general sections with their axes, hinges as releases, and rigid links where their ends are
    eccentric. Beams and shells lie without stress where they start, so the points of a file with some are those of the
    start, with the stresses that lines and cloth have there; else they are those of the result.

    Raises InputError where there is neither a line with an axial stiffness nor a beam nor a membrane.
    """
    groups = [group for group in structure.lines if (group.axial_stiffness > 0.0).any()]
    if not (groups or structure.beams or structure.sheets):
        said = "the result has neither beams nor membranes nor springs with a rest length to write"
        raise InputError(target.name, f"{said}; freeze the form first")
    points = structure.start if structure.started else structure.points
    beams = BeamPart(structure.beams, points)
    held = np.flatnonzero((structure.held | structure.clamped).any(axis=1))
    named = [*(g.name for g in groups), *(b.name for b in structure.beams), *(s.name for s in structure.sheets)]
    names = plain_names(named)
    materials = Materials(structure.materials)
    trusses = TrussPart(groups, materials)
    for count, what in (
        (len(trusses.sections), "sections of lines"),
        (len(beams.sections), "sections of beams and directions"),
    ):
        if count > SETS:
            raise InputError(target.name, f"{count} different {what}; at most {SETS} are supported")
    first = 1 + len(trusses.which) + len(beams.pairs)
    cloth = SheetPart(structure.sheets, names[len(groups) + len(structure.beams) :], points, materials, first)
    blocks = [*trusses.elements(names), *beams.elements(names[len(groups) :]), *cloth.elements()]
    kept = ["*HEADING", f"hookean; units {_units(structure)}", "*NODE"]
    kept += [f"{i}, {row(point)}" for i, point in enumerate(beams.points.tolist(), start=1)]
    kept += [*of_elements(blocks), *(numbered("HELD", (held + 1).tolist(), "NSET") if len(held) else [])]
    kept += _springs(structure.elastic, 1 + sum(len(block.nodes) for block in blocks))
    kept += [*trusses.lines(), *beams.lines(1 + len(trusses.which)), *cloth.lines(), *materials.lines()]
    stress = [*trusses.stress(points), *cloth.stress()]
    kept += ["*INITIAL CONDITIONS, TYPE=STRESS", *stress] if stress else []
    kept += _step(structure, held)
    put(target, ("\n".join(kept) + "\n").encode(), lambda back: None)


def _units(structure: Structure) -> str:
    units = structure.units
    return f"{units.length}, {units.force}, {units.time}, {units.mass}"


class TrussPart:
    """The lines of a file: different `sections` (k, 4) of EA, area, number of the group whose material they have, and
    way in which they go slack; and `which` of them each line has."""

    WAYS = ("", "compression", "tension")

    def __init__(self, groups: Sequence[Lines], materials: Materials) -> None:
        self.groups, self.materials = tuple(groups), materials
        made = [group.material for group in groups]
        rows = [np.zeros((0, 4))]
        for group in groups:
            way = self.WAYS.index(group.one_way) if group.one_way in self.WAYS else 0
            row = [group.area or 1.0, float(made.index(group.material)), float(way)]
            ea = group.axial_stiffness
            rows.append(np.column_stack([ea, *(np.full(len(ea), value) for value in row)]))
        self.sections, self.which = np.unique(np.concatenate(rows), axis=0, return_inverse=True)

    def elements(self, names: Sequence[str]) -> list[Elements]:
        """The block of all lines; none without lines."""
        if not self.groups:
            return []
        sizes = np.cumsum([0, *(len(group.pairs) for group in self.groups)])
        sets = [(n, np.arange(a, b)) for n, a, b in zip(names, sizes[:-1], sizes[1:], strict=False)]
        sets += [(f"SECTION_{i + 1}", np.flatnonzero(self.which == i)) for i in range(len(self.sections))]
        return [Elements(TRUSS, np.concatenate([group.pairs for group in self.groups]), tuple(sets))]

    def lines(self) -> list[str]:
        """Sections."""
        found = []
        for i, (stiffness, area, group, way) in enumerate(self.sections.tolist()):
            made = self.groups[int(group)].material
            name = self.materials.elastic(made, (stiffness / area, 0.0), self.WAYS[int(way)])
            found += [f"*SOLID SECTION, ELSET=SECTION_{i + 1}, MATERIAL={name}", number(area)]
        return found

    def stress(self, points: Floats) -> list[str]:
        """E (l - L0) / L0 of each line at the points."""
        stresses: list[float] = []
        for group in self.groups:
            length = np.linalg.norm(np.diff(points[group.pairs], axis=1)[:, 0], axis=1)
            rest = np.where(group.rest_length > 0.0, group.rest_length, 1.0)
            pull = group.axial_stiffness * (length - group.rest_length) / rest
            stresses += (pull / (group.area or 1.0)).tolist()
        return [f"{i + 1}, {number(value)}" for i, value in enumerate(stresses)]


def _springs(elastic: Floats, first: int) -> list[str]:
    """Elastic supports along and about axes: springs between a point and the ground, from a number of element on."""
    lines = list[str]()
    for axis in range(6):
        for stiffness in np.unique(elastic[:, axis][elastic[:, axis] > 0.0]).tolist():
            at = np.flatnonzero(elastic[:, axis] == stiffness).tolist()
            name = f"SUPPORT_{first}"
            lines += [f"*ELEMENT, TYPE=SPRING1, ELSET={name}", *(f"{first + i}, {p + 1}" for i, p in enumerate(at))]
            lines += [f"*SPRING, ELSET={name}", str(axis + 1), number(stiffness)]
            first += len(at)
    return lines


def _step(structure: Structure, held: Any) -> list[str]:
    """Supports, and a step with the loads; where points are those of the result, also with what elastic supports carry
    there, from where their springs count."""
    lines = ["*BOUNDARY"] if len(held) else []
    fixed = np.column_stack([structure.held, structure.clamped])
    for particle in held.tolist():
        lines += [f"{particle + 1}, {axis + 1}, {axis + 1}" for axis in range(6) if fixed[particle, axis]]
    lines += ["*STEP, NLGEOM=YES", "*STATIC"]
    acting = np.column_stack([structure.loads, structure.moments])
    if not structure.started:
        carried = np.column_stack([structure.reactions, structure.reaction_moments])
        acting = acting + np.where((structure.elastic > 0.0) & ~fixed, carried, 0.0)
    loaded = np.argwhere(acting != 0.0).tolist()
    lines += ["*CLOAD"] if loaded else []
    lines += [f"{n + 1}, {axis + 1}, {number(acting[n, axis])}" for n, axis in loaded]
    return [*lines, "*END STEP"]
