"""Geodesic strip: lines of a mesh that go straight ahead on it."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Ints, Places
from hookean.forces.vertex_angles import VertexAngles, around, two_fans
from hookean.values.columns import IndexRows
from hookean.values.fields import Field


class GeodesicStrip(VertexAngles):
    """Lines of a mesh that go straight ahead on it, as geodesics: E = m (sum of angles left - sum right)^2 / 2.

    The lines run along edges. At each of their interior vertices the angles of the faces on one side sum to the same as
    on the other: there a line is a straightest geodesic of the mesh, and where the angles also sum to 2 pi (use
    `developable`) it is straight once the strip about it is unrolled. On a sphere such lines are great circles. The
    ends of a line are free, unless it ends where it began. Angles of quads are those between their two sides. Forces
    and moments of each vertex sum to zero. For strips of the same width, use `equal_length` on their cross edges.
    Source: Polthier and Schmies, "Straightest geodesics on polyhedral surfaces", 1998; classic Kangaroo's GString.
    """

    kind: Literal["geodesic_strip"] = "geodesic_strip"
    path: IndexRows = Field(description="Vertices of the mesh along each line, from 0; one row or rows of one length")

    formula: ClassVar[str] = "E = m (Σθ left - Σθ right)²/2"
    creates: ClassVar[bool] = True
    shared: ClassVar[tuple[str, ...]] = ("path",)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the corners of each vertex of the lines, m, angle at rest, signs."""
        drawn, faces = places.geometry(self.mesh)[1], places.faces(self.mesh)
        corners, found, sides = around(faces), [], []
        group: list[Ints] = []
        for row in np.atleast_2d(self.path) if self.path.size else np.zeros((0, 3), np.int64):
            if row.max() > drawn.max(initial=-1):
                raise InputError(
                    "", f"vertex {row.max()} in a path; the faces of the mesh have vertices 0 to {drawn.max()}"
                )
            line = np.array([faces[drawn == vertex][0] if (drawn == vertex).any() else -1 for vertex in row])
            line = np.concatenate([line, line[1:2]]) if line[0] == line[-1] else line
            for before, here, after in zip(line[:-2], line[1:-1], line[2:], strict=True):
                own, sign = _sides(corners[corners[:, 0] == here], before, after)
                found.append(own)
                sides.append(sign)
                group.append(np.full(len(own), len(group)))
        index = np.concatenate([np.zeros((0, 3), np.int64), *found])
        links = groups.links(index, np.concatenate([np.zeros(0, np.int64), *group]))
        sign = np.concatenate([np.zeros(0), *sides])
        return Block.of(index, links=links, strength=self.strength, rest=0.0, sign=sign)

    @classmethod
    def example(cls) -> tuple[GeodesicStrip, Floats]:
        """Lines over two fans of four triangles, apart from each other (`example_faces`)."""
        return cls(mesh="skin", strength=7.0, path=[[1, 0, 3], [7, 5, 9]]), two_fans()


def _sides(corners: Ints, before: int, after: int) -> tuple[Ints, Floats]:
    """The corners (m, 3) round an interior vertex, and 1 or -1 for the side of the line on which each is (m,)."""
    onward = {int(start): (row, int(end)) for row, (_, start, end) in enumerate(corners)}
    if before not in onward or after not in onward or before == after:
        said = "a path leaves the edges of the mesh, or passes a vertex that has not faces all round"
        raise InputError("", f"{said}; give vertices along edges, within the mesh and its rim at the ends")
    sign, at = np.full(len(corners), -1.0), int(before)
    for _ in range(len(corners)):
        if at == after or at not in onward:
            break
        row, at = onward[at]
        sign[row] = 1.0
    if at != after:
        raise InputError("", "faces at a vertex of a path have different orientations; turn them alike")
    return corners, sign
