"""Goals and equilibrium together, made linear: steps of many unknowns towards many goals, without a dense Jacobian.

At rest K dx = F du on the free motions, and goals change by G dx + D du. The damped step of Gauss and Newton,
min |r + G dx + D du|² + m |du|² with equilibrium as a constraint, is one sparse symmetric system of the residuals, the
motions and the multipliers of equilibrium. In units in which all parts have one size, with A = [D; -F] and s = sqrt(m):

    [ -m I  .   G ]                      [ p ]   [ -s r ]
    [   .   .   K ] - A A^T on p and l,  [ l ] = [   0  ],    dx = d / s,  du = -A^T [p; l] / s.
    [  G^T  K^T . ]                      [ d ]   [   0  ]

Unknowns that touch many rows stay in the system, so that it is sparse. Parts of the net that no goal depends on are
left out. Source: Levenberg 1944, Marquardt 1963; the full system as in Nocedal and Wright, Numerical Optimization,
chapter 16 (2006).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium
from hookean.designing.factors import Orders
from hookean.designing.quantities.base import Quantity
from hookean.designing.unknowns import Unknowns
from hookean.linear.sparse_factors import supernodal
from hookean.system.components import linked

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

LEFT, IMPROVED = 1e-9, 12  # part of the right side that may be left, and in how many improvements
SLOWER = 0.3  # part that an improvement leaves, after which another is no use
ROUGH = 1e-4  # part of the right side that a step may leave at all
LASTING = 1  # of WAYS: one that is slower is not begun with
DENSE = 40  # entries of an unknown in the system, above which it is not eliminated


class Linearised:
    """Derivatives of residuals (k,) at an equilibrium by unknowns in units of their `scale`, as sparse parts."""

    def __init__(
        self,
        found: Equilibrium,
        unknowns: Unknowns,
        quantities: list[tuple[Quantity, str]],
        weights: Floats,
        scale: Floats,
        orders: Orders,
    ) -> None:
        from scipy.sparse import diags, vstack

        slopes = [quantity.slopes(found, unknowns, pointer) for quantity, pointer in quantities]
        by_place, direct = vstack([s[0] for s in slopes]).tocsr(), vstack([s[1] for s in slopes]).tocsr()
        forces, moves = unknowns.slopes(found)
        self.weights = weights
        centred = [quantity.centred for quantity, _ in quantities]
        self.means, self.spread = _means(centred, [s[0].shape[0] for s in slopes])
        self.found, self.orders = found, orders
        self.goals = (by_place @ found.basis).tocsr()  # G (k, r)
        pushes = found.counted(forces)
        if moves.nnz:
            direct, pushes = direct + by_place @ moves, pushes - found.response @ moves
        self.direct = (direct @ diags(scale)).tocsc()  # D (k, u)
        self.pushes = (found.basis.T @ pushes @ diags(scale)).tocsc()  # F (r, u)

    def transposed(self, r: Floats) -> Floats:
        """The Jacobian's transpose times residuals (k,): by the adjoint."""
        r = self.weights * r
        r = r - self.means.T @ (self.spread.T @ r)
        adjoint = self.found.factor.solve(self.goals.T @ r, transposed=True)
        return np.asarray(self.direct.T @ r + self.pushes.T @ adjoint)

    def forward(self, change: Floats) -> Floats:
        """The Jacobian times a change (u,) of the unknowns."""
        found = self.direct @ change + self.goals @ self.found.factor.solve(self.pushes @ change)
        return np.asarray(self.weights * (found - self.spread @ (self.means @ found)))

    def step(self, r: Floats, damping: float, free: Bools, sizes: Floats | None = None) -> Floats | None:
        """The damped step (u,) of the free unknowns for residuals r (k,), None if it has none. Changes are damped in
        parts of the `sizes` (u,) of the unknowns."""
        from scipy.sparse import bmat, diags, identity

        both, spread = self._with_means  # [G; K] and A
        by = np.ones(len(free)) if sizes is None else sizes
        own = spread if free.all() else spread[:, np.flatnonzero(free)]
        own = type(own)((own.data * np.repeat(by[free], np.diff(own.indptr)), own.indices, own.indptr), own.shape)
        k, m = len(r), both.shape[1]
        damped = diags(np.repeat([damping, 0.0], [k, m]))
        wide = np.diff(own.indptr) > DENSE
        if wide.any():
            thin, thick = own[:, np.flatnonzero(~wide)], own[:, np.flatnonzero(wide)]
            corner = -(thin @ thin.T) - damped
            unit = identity(thick.shape[1])
            system = bmat([[corner, both, thick], [both.T, None, None], [thick.T, None, unit]], format="csc")
        else:
            system = bmat([[-(own @ own.T) - damped, both], [both.T, None]], format="csc")
        right = np.concatenate([-np.sqrt(damping) * r, np.zeros(system.shape[0] - k)])
        solved = _solved(system, right, self.orders)
        if solved is None:
            return None
        step = np.zeros(len(free))
        step[free] = -(own.T @ solved[: k + m]) / np.sqrt(damping)
        step *= by
        return step if np.isfinite(step).all() else None

    @cached_property
    def _with_means(self) -> tuple[Any, Any]:
        """[G; K] and A = [D; -F] with the means of centred values as further motions, so that all stay sparse: m =
        mean(G x + D u), residuals G x + D u - m."""
        from scipy.sparse import bmat, diags, hstack, identity, vstack

        seen = self._seen()
        by, goals, tangent, pushes = diags(self.weights), self.goals, self.found.reduced, self.pushes
        if len(seen) < tangent.shape[0]:
            goals, tangent, pushes = goals[:, seen], tangent[seen][:, seen], pushes[seen]
        direct = by @ self.direct
        if not self.means.shape[0]:
            return vstack([by @ goals, tangent]), vstack([direct, -pushes], format="csc")
        size = float(np.abs(tangent.data).max(initial=0.0)) or 1.0
        rows = [[tangent, None], [-size * (self.means @ goals), size * identity(self.means.shape[0])]]
        pushes = vstack([pushes, size * (self.means @ self.direct)])
        return vstack([by @ hstack([goals, -self.spread]), bmat(rows)]), vstack([direct, -pushes], format="csc")

    def _seen(self) -> NDArray[np.int64]:
        """Free motions that a goal depends on."""
        net = self.found.reduced.tocoo()
        label = linked(np.stack([net.row, net.col], axis=1)[net.data != 0.0], net.shape[0])
        read = np.zeros(net.shape[0], dtype=bool)
        read[label[np.unique(self.goals.indices)]] = True
        return np.flatnonzero(read[label])


def _means(centred: list[bool], counts: list[int]) -> tuple[Any, Any]:
    """Matrices that take the mean (c, k) of the values of each centred quantity, and give it to each of them (k, c)."""
    from scipy.sparse import csr_matrix

    ends = np.cumsum(counts)
    parts = [(end - n, n) for end, n, some in zip(ends, counts, centred, strict=True) if some and n]
    means = csr_matrix((len(parts), int(ends[-1])))
    if not parts:
        return means, means.T
    column = np.concatenate([first + np.arange(n) for first, n in parts])
    row = np.repeat(np.arange(len(parts)), [n for _, n in parts])
    each = np.concatenate([np.full(n, 1.0 / n) for _, n in parts])
    means = csr_matrix((each, (row, column)), shape=means.shape)
    return means, (means > 0.0).astype(np.float64).T.tocsr()


def _solved(system: Any, right: Floats, orders: Orders) -> Floats | None:
    """The solution of a symmetric system with zeros on its diagonal, improved: by the first of some kinds of factors
    that leaves little of the right side, begun with the kind that did so last. None if all leave more: it is
    singular."""
    size = np.linalg.norm(right)
    for way in sorted(range(len(WAYS)), key=lambda number: number != orders.way):
        try:
            factor = WAYS[way](system, orders)
        except RuntimeError:  # singular
            continue
        if factor is None:
            continue
        found, left = _improved(system, factor, right)
        if left <= ROUGH * size:
            orders.way = min(way, LASTING)
            return found
    return None


def _in_order(system: Any, orders: Orders) -> Any:
    """Symmetric factors, of half the size, with pivots near the diagonal alone; None where these are 0."""
    return orders.factor(system) if supernodal() is not None else None


def _matched(system: Any, _: Orders) -> Any:
    """Factors with rows matched so that the diagonal is large, within blocks of columns."""
    return supernodal().analyze(system, path="lu", threads=1).factor(system.data) if supernodal() is not None else None


def _pivoted(system: Any, _: Orders) -> Any:
    """SciPy's factors, with any pivots."""
    from scipy.sparse.linalg import splu

    return splu(system)


WAYS: tuple[Callable[[Any, Orders], Any], ...] = (_in_order, _matched, _pivoted)


def _improved(system: Any, factor: Any, right: Floats) -> tuple[Floats, float]:
    """A solution, improved while that helps, and what it leaves of the right side."""
    size = last = float(np.linalg.norm(right))
    found, left = np.zeros(len(right)), right
    for _ in range(IMPROVED):
        new = found + factor.solve(left)
        over = right - system @ new
        now = float(np.linalg.norm(over))
        if not now < last:
            break
        found, left, slower, last = new, over, now > SLOWER * last, now
        if now <= LEFT * size or slower:
            break
    return found, last
