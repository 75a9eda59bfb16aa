"""Beams in Abaqus input files: elements B31 of general sections, releases, and rigid links to eccentric ends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hookean.files.exchange.abaqus_blocks import Elements, row
from hookean.files.exchange.beams import Beams

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BEAM = "B31"
CODES = {"x": "T", "y": "M1", "z": "M2"}  # n1 of a section is y, n2 is z, and t is x


class BeamPart:
    """The beams of a file: `points` (n, 3) with those of eccentric ends behind the particles', `pairs` (m, 2) of them,
    how many each force has (`counts`), different `sections` (k, 11) with the direction of y, and `which` each has."""

    def __init__(self, beams: Sequence[Beams], points: Floats) -> None:
        self.beams, self.counts = tuple(beams), [len(part.pairs) for part in beams]
        ends = np.concatenate([np.zeros((0, 2), np.int64), *(part.pairs for part in beams)])
        offsets = np.concatenate([np.zeros((0, 2, 3)), *(part.offsets for part in beams)])
        away = offsets.any(axis=2)
        self.links = ends[away]  # the particle that each point behind the particles belongs to
        self.count, self.pairs = len(points), ends.copy()
        self.pairs[away] = len(points) + np.arange(len(self.links))
        self.points = np.concatenate([points, points[self.links] + offsets[away]])
        axes = np.concatenate([np.zeros((0, 3)), *(part.axes[:, 1] for part in beams)])
        rows = np.concatenate([np.zeros((0, 8)), *(part.sections for part in beams)])
        # directions that differ by rounding alone are one; no part of them is -0
        whole = np.column_stack([rows, np.round(axes, 12) + 0.0])
        self.sections, self.which = np.unique(whole, axis=0, return_inverse=True)

    def elements(self, names: Sequence[str]) -> list[Elements]:
        """The block of all beams; none without beams."""
        if not self.beams:
            return []
        sizes = np.cumsum([0, *self.counts])
        sets = [(n, np.arange(a, b)) for n, a, b in zip(names, sizes[:-1], sizes[1:], strict=False)]
        sets += [(f"BEAM_SECTION_{i + 1}", np.flatnonzero(self.which == i)) for i in range(len(self.sections))]
        return [Elements(BEAM, self.pairs, tuple(sets))]

    def lines(self, first: int) -> list[str]:
        """The text behind nodes, elements and sets; `first` is the number of the first element."""
        return [*self._sections(), *self._links(), *self._releases(first)]

    def _sections(self) -> list[str]:
        """A I11 I12 I22 J; the direction of n1; E and G; shear stiffness along n2 and n1 where shear counts."""
        lines = []
        for i, (e, g, area, about_y, about_z, torsion, along_y, along_z, *axis) in enumerate(self.sections.tolist()):
            lines += [f"*BEAM GENERAL SECTION, ELSET=BEAM_SECTION_{i + 1}, SECTION=GENERAL"]
            lines += [row((area, about_y, 0.0, about_z, torsion)), row(axis)]
            lines += [row((e, g))]
            if along_y > 0.0 or along_z > 0.0:
                # without a shear area along an axis, one so large that it does not count
                stiff = [g * (shear if shear > 0.0 else 1e6 * area) for shear in (along_z, along_y)]
                lines += ["*TRANSVERSE SHEAR STIFFNESS", row(stiff)]
        return lines

    def _links(self) -> list[str]:
        """The points of eccentric ends move with their particles."""
        rows = [f"BEAM, {self.count + i + 1}, {owner + 1}" for i, owner in enumerate(self.links.tolist())]
        return ["*MPC", *rows] if rows else []

    def _releases(self, first: int) -> list[str]:
        rows = []
        for number, ends in enumerate(ends for part in self.beams for ends in part.releases.tolist()):
            for end, axes in zip(("S1", "S2"), ends, strict=True):
                codes = sorted(CODES[axis] for axis in axes)
                code = "ALLM" if len(codes) == 3 else "-".join(codes)
                rows += [f"{first + number}, {end}, {code}"] if axes else []
        return ["*RELEASE", *rows] if rows else []
