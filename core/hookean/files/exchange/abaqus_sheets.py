"""Membranes and shells in Abaqus input files: elements S3, and S4 of plates, with their stress."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.files.exchange.abaqus_blocks import Elements, Materials, row
from hookean.files.exchange.sheets import Sheet
from hookean.forces.membrane import AREA

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ALMOST = float(np.cos(np.radians(0.1)))  # nearer to x than by this, the normal leaves the first axis to z
ROUNDING = 1e-12  # strain that counts as 0
THIN = 1e-3  # thickness, in mean edges, of cloth that has none


@dataclass(frozen=True, eq=False)
class Piece:
    """A block of elements of a sheet: `share` is the part of its thickness that they have, `rows` their triangles, or
    their faces of a plate; `first` is the number of the first one."""

    block: Elements
    sheet: Sheet
    share: float
    rows: Ints
    first: int


class SheetPart:
    """The membranes of a file at its points, as S3 and S4, for which programs other than Abaqus have a cell, too. Cloth
    alone is of triangles, in which a quad is the mean of its two cuts: four triangles of half the thickness. Where it
    has no thickness it is so thin that it resists bending by 1e-7 of what it resists stretching. A membrane with a
    shell has one element for each face."""

    def __init__(
        self, sheets: Sequence[Sheet], names: Sequence[str], points: Floats, materials: Materials, first: int
    ) -> None:
        self.points, self.materials, self.pieces = points, materials, list[Piece]()
        for sheet, name in zip(sheets, names, strict=True):
            for kind, share, rows, nodes in _plates(sheet) if sheet.bends else _cloth(sheet):
                every = np.arange(len(nodes))
                sets = ((name, every), (f"SHEET_SECTION_{len(self.pieces) + 1}", every))
                block = Elements(kind, nodes, sets)
                self.pieces.append(Piece(block, sheet, share, rows, first))
                first += len(nodes)

    def elements(self) -> list[Elements]:
        """The blocks of elements: of each sheet one for each kind, or for each share of triangles in it."""
        return [piece.block for piece in self.pieces]

    def lines(self) -> list[str]:
        """Sections, and the directions of the warp where they count."""
        lines = list[str]()
        for number, piece in enumerate(self.pieces, start=1):
            sheet, turned = piece.sheet, ""
            thickness = self._thickness(sheet)
            warp, weft, shear = (stiffness / thickness for stiffness in sheet.stiffness[:3])
            poisson = sheet.stiffness[3]
            numbers: tuple[float, ...] = (warp, poisson)
            if not sheet.isotropic:
                lines += self._directions(number, piece)
                numbers, turned = (warp, weft, poisson, shear, shear, shear), f", ORIENTATION=WARP_{number}"
            material = self.materials.elastic(sheet.material, numbers)
            part = f"SHEET_SECTION_{number}"
            lines += [f"*SHELL SECTION, ELSET={part}, MATERIAL={material}{turned}", row([thickness * piece.share])]
        return lines

    def _thickness(self, sheet: Sheet) -> float:
        if sheet.thickness is not None or not len(sheet.corners):
            return sheet.thickness or 1.0
        edges = self.points[sheet.corners] - self.points[np.roll(sheet.corners, 1, axis=1)]
        return THIN * float(np.linalg.norm(edges, axis=2).mean()) or 1.0

    def _directions(self, number: int, piece: Piece) -> Iterator[str]:
        """Of each element, the direction of the warp and the one across it."""
        table, axes = f"WARP_TABLE_{number}", piece.sheet.axes(self.points)[piece.rows, :2].reshape(-1, 6)
        yield from (f"*DISTRIBUTION TABLE, NAME={table}", "COORD3D, COORD3D")
        yield from (f"*DISTRIBUTION, NAME=WARPS_{number}, LOCATION=ELEMENT, TABLE={table}", ", 1., 0., 0., 0., 1., 0.")
        yield from (f"{piece.first + i}, {row(each)}" for i, each in enumerate(axes.tolist()))
        yield from (f"*ORIENTATION, NAME=WARP_{number}, SYSTEM=RECTANGULAR", f"WARPS_{number}", "3, 0.")

    def stress(self) -> Iterator[str]:
        """The stress 11, 22 and 12 of each element: along and across its warp, or, where none counts, along the
        projection of x and across it."""
        for piece in self.pieces:
            sheet = piece.sheet
            stress = sheet.stress(self.points)
            if np.abs(stress).max(initial=0.0) <= ROUNDING * sheet.stiffness[0]:
                continue
            if sheet.isotropic:
                stress = _turned(stress, sheet.axes(self.points))
            if sheet.bends:
                stress = _means(stress, sheet)
            rows = (stress[piece.rows] / self._thickness(sheet)).tolist()
            yield from (f"{piece.first + i}, {row(each)}" for i, each in enumerate(rows))


Blocks = Iterator[tuple[str, float, Ints, Ints]]


def _cloth(sheet: Sheet) -> Blocks:
    """Triangles that have an area, by their share in the sheet."""
    real = sheet.block.parameters[:, AREA] != 0.0
    for share in np.unique(sheet.share).tolist():
        rows = np.flatnonzero((sheet.share == share) & real)
        if len(rows):
            yield "S3", share, rows, sheet.corners[rows]


def _plates(sheet: Sheet) -> Blocks:
    """Faces: triangles and quads."""
    used, quads = np.unique(sheet.face), sheet.faces[:, 2] != sheet.faces[:, 3]
    for kind, rows in (("S3", used[~quads[used]]), ("S4", used[quads[used]])):
        if len(rows):
            yield kind, 1.0, rows, sheet.faces[rows, : int(kind[1])]


def _turned(stress: Floats, axes: Floats) -> Floats:
    """Stress (m, 3) along axes (m, 3, 3) of warp, weft and normal, along the projection of x and across it."""
    normal = axes[:, 2]
    given = np.where(np.abs(normal[:, :1]) > ALMOST, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    along = given - (given * normal).sum(axis=1)[:, None] * normal
    size = np.linalg.norm(along, axis=1)
    cosine, sine = (np.einsum("mc,mc->m", along, axes[:, i]) / np.where(size > 0.0, size, 1.0) for i in (0, 1))
    warp, weft, shear = stress.T
    return np.column_stack([
        warp * cosine**2 + weft * sine**2 + 2.0 * shear * sine * cosine,
        warp * sine**2 + weft * cosine**2 - 2.0 * shear * sine * cosine,
        (weft - warp) * sine * cosine + shear * (cosine**2 - sine**2),
    ])  # fmt: skip


def _means(stress: Floats, sheet: Sheet) -> Floats:
    """The mean (k, 3) of the triangles of each face."""
    size = len(sheet.faces)
    whole = np.maximum(np.bincount(sheet.face, sheet.share, size), 1e-300)
    return np.stack([np.bincount(sheet.face, sheet.share * column, size) / whole for column in stress.T], axis=1)
