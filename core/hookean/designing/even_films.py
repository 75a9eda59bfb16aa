"""Even: of all places that the vertices of soap films may have in a film, those that differ by nothing.

The equilibrium of a film says nothing of where in it its vertices lie (see `hookean.films`), so that it has no one
shape to differentiate. One of them is where the map from the drawn mesh has the least Dirichlet energy along the film:

    r(x, u) = P f + (1 - P) g = 0,    g = -B x

with P the parts of forces f that count, and B the cotangents of the mesh as drawn (of triangles with equal sides where
that is torn). Motions y that change r by T y, T = P K + (1 - P) B - (dP/dx) (f - g), have an exact T: K and B are the
tangents of forces and of the energy, and P, which is that of the triangles around each vertex, is differenced for many
vertices at once, of which no two share a triangle. Source of the energy: Pinkall and Polthier 1993.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.films import EDGE, SLIDING
from hookean.films.proportions import conduct
from hookean.forces.base import lengths
from hookean.forces.soapfilm import SHARE, TENSION, YARNS, SoapFilm

if TYPE_CHECKING:
    from collections.abc import Callable

    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST = 20_000  # particles above which this takes more than ten seconds
STEPS = 24  # towards it: of Newton's method, and with the same factors while these are QUICK
QUICK = 0.1  # part that a step with the factors of an earlier one leaves; making them takes as long as ten
NEAR = 0.1  # part of the model's size: the longest of them
NOTHING = 1e-12  # part of it that is rounding
APART = 1e-6  # part of it by which P is differenced: to 1e-10


class Even:
    """What the vertices of a system's films are spread by."""

    def __init__(self, system: System, free: Floats) -> None:
        from scipy.sparse import coo_matrix, identity, kron

        films, block = system.films, next(g.block for g in system.groups if g.cls is SoapFilm)
        assert films is not None
        plain = block.parameters.copy()
        plain[:, TENSION], plain[:, SHARE] = plain[:, TENSION].mean(), 1.0  # the same, whatever the film is pulled by
        plain[:, YARNS : YARNS + 2] = 0.0
        numbers = np.empty((len(block.indices), 3, 3))
        torn = films.torn(system.x, free)
        dispatch.compiled(conduct)(system.x, block.indices, plain, torn, numbers)
        n, index = len(system.x), block.indices[:, :3]
        rows, columns = np.repeat(index, 3, axis=1).ravel(), np.tile(index, (1, 3)).ravel()
        self.spread = kron(coo_matrix((numbers.ravel(), (rows, columns)), (n, n)), identity(3)).tocsr()
        edge = np.flatnonzero((films.kind == EDGE) | (films.kind == SLIDING))
        ends = np.stack([edge.repeat(2), films.ends[edge].ravel()], axis=1)
        here = np.stack([np.arange(n), np.arange(n)], axis=1)
        both = np.concatenate([np.stack([rows, columns], axis=1), ends, ends[:, ::-1], here])
        self._near = coo_matrix((np.ones(len(both)), tuple(both.T)), (n, n)).tocsr()
        self._turns = _apart(self._near)

    def counts(self, system: System, x: Floats, free: Floats) -> Any:
        """P (3n, 3n) as a sparse matrix."""
        from scipy.sparse import bsr_matrix

        n = len(x)
        return bsr_matrix((_parts(system, x, free), np.arange(n), np.arange(n + 1)), (3 * n, 3 * n)).tocsr()

    def left(self, system: System, state: State) -> tuple[Floats, Floats]:
        """r (n, 3), and f - g (n, 3), of which P takes its part."""
        f = system.evaluate(state)[0] * state.free
        g = -(self.spread @ state.x.ravel()).reshape(-1, 3) * state.free
        parts = _parts(system, state.x, state.free)
        return g + np.einsum("nij,nj->ni", parts, f - g), f - g

    def tangent(self, system: System, state: State, stiffness: Any) -> Any:
        """T (3n, 3n), with the tangent stiffness K of all axes."""
        from scipy.sparse import diags

        _, apart = self.left(system, state)
        counts, free = self.counts(system, state.x, state.free), diags(state.free.ravel())
        turned = self._differences(lambda x: np.einsum("nij,nj->ni", _parts(system, x, state.free), apart), state.x)
        return (counts @ stiffness + (free - counts) @ free @ self.spread - turned).tocsc()

    def _differences(self, of: Callable[[Floats], Floats], x: Floats) -> Any:
        """The derivative (3n, 3n) of a vector (n, 3) of each particle by the places around it."""
        from scipy.sparse import coo_matrix

        near, step = self._near.tocoo(), APART * float(np.ptp(x, axis=0).max())
        rows, columns, values = [], [], []
        for turn in range(self._turns.max(initial=-1) + 1):
            moving = self._turns == turn
            seen = moving[near.col]
            for axis in range(3):
                ahead, behind = x.copy(), x.copy()
                ahead[moving, axis] += step
                behind[moving, axis] -= step
                slopes = (of(ahead) - of(behind)) / (2.0 * step)
                rows.append((3 * near.row[seen][:, None] + np.arange(3)).ravel())
                columns.append(np.repeat(3 * near.col[seen] + axis, 3))
                values.append(slopes[near.row[seen]].ravel())
        places = np.concatenate(rows), np.concatenate(columns)
        return coo_matrix((np.concatenate(values), places), (x.size, x.size)).tocsr()

    def reach(self, system: System, state: State, stiffness: Callable[[], Any]) -> bool:
        """Bring a shape at rest to this one by Newton's method; False, with the shape anywhere, if that does not lead
        there, as where a film may turn as a whole."""
        from scipy.sparse.linalg import splu

        free = np.flatnonzero(state.free.ravel() > 0.0)
        last, factor = np.inf, None
        for _ in range(STEPS):
            left, fresh = self.left(system, state)[0], factor is None
            try:
                factor = factor or splu(self.tangent(system, state, stiffness())[free][:, free])
            except RuntimeError:  # singular
                return False
            step = np.zeros(state.x.size)
            step[free] = factor.solve(left.ravel()[free])
            length = float(lengths(step.reshape(-1, 3)).max(initial=0.0)) / system.size
            if not fresh and not length <= QUICK * last:
                factor = None
                continue
            if not length <= min(NEAR, last):
                return bool(last <= np.sqrt(NOTHING))  # rounding
            state.x = state.x + step.reshape(-1, 3)
            if length <= NOTHING:
                return True
            last = length
        return bool(last <= np.sqrt(NOTHING))


def _parts(system: System, x: Floats, free: Floats) -> Floats:
    """The part (n, 3, 3) of forces on each particle that counts."""
    films = system.films
    assert films is not None
    axes, counts = films.frames(x, free)
    found = np.einsum("ni,nij,nik->njk", counts, axes, axes)
    found[films.kind == 0] = np.eye(3) * free[films.kind == 0][:, :, None]
    return np.asarray(found)


def _apart(near: Any) -> Ints:
    """Numbers (n,) of turns in which particles move: two that are both near a third move in turns of their own."""
    both = ((near.T @ near) > 0).tocsr()
    turns = np.full(both.shape[0], -1)
    for i in range(len(turns)):
        taken = set(turns[both.indices[both.indptr[i] : both.indptr[i + 1]]].tolist())
        turns[i] = next(number for number in range(len(taken) + 1) if number not in taken)
    return turns


def evenness(system: System, free: Floats) -> Even | None:
    """What spreads a system's films, if they have vertices of their own and no more than `MOST` particles."""
    films = system.films
    if films is None or len(free) > MOST or system.contacts or not (films.kind != 0).any():
        return None
    return Even(system, free)
