"""Films: which part of a force counts at the particles of soap films, whose vertices may lie anywhere in the film.

The area of a film does not depend on where in it a vertex lies. So a film has no stiffness along itself, and its
equilibrium is the balance across it: tension x sum of curvatures = pressure. The gradient of the area of a mesh also
has a part along the film, as small as the error of the mesh, that nothing balances. Where films act alone, with what
acts across them, this part does not count: at a vertex within a film the tangent plane; where a film ends, where films
meet and where one is pulled to a curve, the tangent of that edge. Where anything else acts, such as a spring, all of
the force counts, and so it does where an edge turns a corner, where the film is folded over and at faces
without area.

A solver moves each particle along the axes that count: `frames` are those of the tangent, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.films.frames import keep_what_counts, lay_frames
from hookean.films.kinds import EDGE, SLIDING, WHOLE, WITHIN, edges_of, fans_of, kinds_of, sheets_of
from hookean.films.proportions import conduct, find_torn
from hookean.forces.soapfilm import SoapFilm, halves

if TYPE_CHECKING:
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

__all__ = ["EDGE", "SLIDING", "WHOLE", "WITHIN", "Films"]


class Films:
    """The films of a system: their triangles, and what counts at each particle.

    `corners` (m, 3) of the triangles are the rows of the block of films; `signs` (m, 3) turn the normal of each to one
    side all around each corner; `sheet` (m,) numbers the connected films. `kind` (n,) is what does not count (see
    kinds.py), `ends` (n, 2) are the neighbours along an edge, `pure` (n,) the particles on which films act alone, with
    what acts across them, `rim` (n,) those where a film ends.
    """

    def __init__(self, system: System) -> None:
        from hookean.discretize.meshes import tidy_faces

        group = next(g for g in system.groups if g.cls is SoapFilm)
        faces, tension = [np.zeros((0, 4), np.int64)], [np.zeros(0)]
        for part in group.parts:
            assert isinstance(part.force, SoapFilm)
            faces.append(tidy_faces(system.places.faces(part.force.mesh)))
            tension.append(np.full(len(faces[-1]), part.force.tension))
        mesh, n = np.concatenate(faces), len(system.x)
        edges = edges_of(mesh, np.concatenate(tension))
        self.corners, _, face = halves(mesh)
        side, fans = fans_of(mesh, edges, n)
        at = (mesh[face][:, None, :] == self.corners[:, :, None]).argmax(axis=2)
        self.signs = np.ascontiguousarray(side[4 * face[:, None] + at])
        self.sheet = sheets_of(mesh, n)[face]
        self.kind, self.ends, self.pure = kinds_of(system, mesh, edges, fans)
        self.rim = np.zeros(n, bool)
        self.rim[edges.pairs[edges.faces == 1]] = True
        self._block = group.block
        self._columns = group.block.parameters[:, :3]
        self._tuned = self._columns.copy()

    @property
    def stale(self) -> bool:
        """Whether tension or yarns have changed since this was made."""
        return not np.array_equal(self._columns, self._tuned)

    def frames(self, x: Floats, free: Floats) -> tuple[Floats, Floats]:
        """Axes (n, 3, 3) of each particle, by rows, and 1 (n, 3) where forces along them count, 0 where not.

        Where nothing is left out these are x, y, z and the free ones of them.
        """
        axes, counts, room = np.empty((len(x), 3, 3)), np.empty((len(x), 3)), np.empty((len(x), 5))
        dispatch.compiled(lay_frames)(
            x, free, self.corners, self.signs, self.kind, self.ends, room, axes, counts
        )  # fmt: skip
        return axes, counts

    def across(self, x: Floats, free: Floats, f: Floats) -> None:
        """Take from forces `f` (n, 3) what does not count, in place."""
        axes, counts = self.frames(x, free)
        dispatch.compiled(keep_what_counts)(axes, counts, self.kind, f)

    def folded(self, x: Floats, free: Floats) -> Ints:
        """Particles inside films around which some triangle faces the other way than they do together."""
        axes, counts, room = np.empty((len(x), 3, 3)), np.empty((len(x), 3)), np.empty((len(x), 5))
        dispatch.compiled(lay_frames)(
            x, free, self.corners, self.signs, self.kind, self.ends, room, axes, counts
        )  # fmt: skip
        return np.flatnonzero((self.kind == WITHIN) & (free > 0.0).all(axis=1) & (room[:, 4] > 0.0))

    def along(self, x: Floats, free: Floats, vectors: Floats) -> Floats:
        """The part of vectors (n, 3) that does not count: motions that leave the films where they are."""
        moving = vectors * free
        left = moving.copy()
        self.across(x, free, left)
        return np.asarray(moving - left)

    def torn(self, x: Floats, free: Floats) -> Flags:
        """Triangles (m,) of films that have a crease where triangles differ in size, or differ a hundredfold: whose rim
        was raised alone, or an anchor moved out of them, or whose vertices lie anywhere."""
        inside = (self.kind == WITHIN) & (free > 0.0).all(axis=1)
        found = np.zeros(self.sheet.max(initial=-1) + 1, bool)
        room = np.empty((len(x), 6))
        dispatch.compiled(find_torn)(x, self.corners, self.signs, inside, self.sheet, room, found)
        return np.asarray(found[self.sheet])

    def conductances(self, x: Floats, equal: Flags | None = None) -> Floats:
        """Blocks (m, 3, 3) of the Dirichlet energy of maps from x (n, 3), a number for each pair of corners; from
        triangles of equal sides where `equal` (m,)."""
        blocks = np.empty((len(self.corners), 3, 3))
        flags = np.zeros(len(blocks), bool) if equal is None else equal
        dispatch.compiled(conduct)(x, self._block.indices, self._block.parameters, flags, blocks)
        return blocks
