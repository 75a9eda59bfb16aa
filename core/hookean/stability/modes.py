"""Modes: what the tangent stiffness of a shape resists least.

Everything is scaled by the stiffness W that particles feel: W^-1/2 K W^-1/2 has eigenvalues from below 0 to about 1,
however stiff one part is beside another. Their signs come from factors of K - sW and K + sW (Sylvester's law of
inertia), s what rounding, and forces not quite in balance, leave uncertain of an eigenvalue; between the two the
softest modes themselves decide, by the energy that each element gains along them.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.linear.block_kernels import multiply
from hookean.linear.sparse_factors import Factors
from hookean.system.balance import Balance, balance, wholes

if TYPE_CHECKING:
    from hookean.linear.tangent import Tangent
    from hookean.system.group import Group
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDING = 1e-14  # part of the stiffness that an eigenvalue may be off by
INEXACT = 1e-14  # part of a motion that may be wrong
SEVERAL = 12  # modes that are worked out one by one
SPARE, INVERSE = 4, 12  # more of them than are asked for, and steps of inverse iteration
STEPS = 60  # of conjugate gradients
STIRRED = 0.2  # noise beside what is out of balance
SOFT = 1e-3  # a lowest Ritz value below this part of the highest is not known to be positive
HIDING = 1e-6  # residual up to which what is out of balance says too little of a mode to look closer
HIDDEN = "the softest mode is so soft that the forces still out of balance hide its sign: lower the tolerance"
LEAST_SHIFT, LARGEST_SHIFT = 1e-6, 1e2  # of the tangent's Laplacian


@dataclass(frozen=True)
class Modes:
    """How many modes of a shape are `unstable` and how many `loose` (nothing resists them), the softest `mode` (n, 3),
    its largest part 1, where there is one of these, and the movement (n, 3) [length] that one more exact step would
    make, None where that is not known: `unsettled` has the reason. `reason`: why nothing is known. Not `counted`: there
    may be more such modes. `hidden`: what is out of balance, and not rounding, hides whether a mode is loose."""

    unstable: int = 0
    loose: int = 0
    mode: Floats | None = None
    moved: Floats | None = None
    unsettled: str = ""
    reason: str = ""
    counted: bool = True
    hidden: bool = False


@dataclass(frozen=True)
class Scaled:
    """The scaled tangent of the free axes `dofs` of a shape: what turns scaled motions into motions, the uncertainty of
    its eigenvalues [-], what is out of balance in its terms, and the elements themselves. With soap films the axes of
    particles are their own, `axes` (n, 3, 3) by rows."""

    system: System
    state: State
    dofs: Ints
    scale: Floats  # W^-1/2
    uncertain: float
    turning: float  # what of this comes from forces that are out of balance
    left: Floats
    axes: Floats | None = None

    @classmethod
    def of(cls, system: System, state: State, found: Balance) -> Scaled:
        axes, free = (None, state.free) if system.films is None else system.films.frames(state.x, state.free)
        dofs = np.flatnonzero(free.ravel() > 0.0)
        w = found.stiffness
        w = np.maximum(w, 1e-9 * w.max()) if w.max() > 0.0 else np.ones_like(w)
        apart = wholes(system, state) * w
        turning = np.abs(found.forces).max(axis=1) / np.where(apart > 0.0, apart, np.inf)
        scale = 1.0 / np.sqrt(np.repeat(w, 3)[dofs])
        left = found.forces if axes is None else np.einsum("nij,nj->ni", axes, found.forces)
        turns = 4.0 * float(turning.max())
        uncertain = max(ROUNDING, _blurred(system, state, w)) + turns
        return cls(system, state, dofs, scale, uncertain, turns, left.ravel()[dofs] * scale, axes)

    def motion(self, scaled: Floats) -> Floats:
        """A scaled motion as one of all particles (n, 3)."""
        whole = np.zeros(self.state.x.size)
        whole[self.dofs] = scaled * self.scale
        parts = whole.reshape(-1, 3)
        return parts if self.axes is None else np.einsum("nij,ni->nj", self.axes, parts)

    def energies(self, modes: Floats) -> tuple[Floats, float]:
        """U^T K U of scaled motions (unknowns, k), element by element, and what of it may be rounding.

        A motion that all particles of an element share is taken out first: where nothing acts from outside it costs no
        energy, and would hide what little the rest costs.
        """
        moved = np.stack([self.motion(mode) for mode in modes.T])
        total, noise = np.zeros((len(moved), len(moved))), 0.0
        elements = _stiff(self.system, self.state, sparse=True)
        moved = _completed(elements, moved)
        for group, blocks in elements:
            whole = own = moved[:, group.block.indices]
            if group.cls.role == "internal":
                own = own - own[:, :, :1] * (group.block.indices < self.system.slots.count)[:, :, None]
            own = own.reshape(len(moved), len(blocks), -1)
            total += np.einsum("ame,mef,bmf->ab", own, blocks, own, optimize=True)
            sizes = np.abs(blocks).max(axis=(1, 2), initial=0.0)
            known = np.finfo(float).eps if group.cls.hessian is not None else group.cls.blur
            # what is left of a shared motion is rounding of the motion itself
            size = (own**2).sum(axis=2) * known + (whole**2).sum(axis=(2, 3)) * INEXACT**2
            noise += float((sizes * size).sum(axis=1).max())
        return total, noise


def _blurred(system: System, state: State, w: Floats) -> float:
    """The largest part of the stiffness `w` (n,) of a particle by which forces without a hessian may be wrong."""
    most, still = 0.0, np.zeros_like(state.x)
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.constant or group.cls.hessian is not None or not len(group.block.indices):
            continue
        f, own = np.zeros_like(state.x), np.zeros(len(w))
        dispatch.compiled(group.cls.kernel, "force")(state.x, still, *group.cls.whole(group.block, memory), f, own)
        most = max(most, group.cls.blur * float((own / w).max()))
    return most


def _stiff(system: System, state: State, *, sparse: bool = False) -> list[tuple[Group, Floats]]:
    """All elements that have a tangent, with it (see `System.elements`)."""
    return [
        (group, system.stiffness_blocks(group, state, memory))
        for group, memory in system.elements(state.x, state.memory, sparse=sparse)
        if not group.cls.constant and len(group.block.indices)
    ]


def _completed(elements: list[tuple[Group, Floats]], moved: Floats) -> Floats:
    """Motions (k, n, 3) with those (k, more, 3) of the unknowns that elements have of their own: of least energy."""
    import scipy.sparse as sparse
    from scipy.sparse.linalg import splu

    n = moved.shape[1]
    own = max((int(group.block.indices.max()) + 1 for group, _ in elements), default=0) - n
    if own <= 0:
        return moved
    left, entries = np.zeros((own, len(moved))), [(np.zeros(0), np.zeros((2, 0), np.int64))]
    for group, blocks in elements:
        index = group.block.indices
        first = blocks.reshape(len(index), index.shape[1], 3, -1)[:, :, 0]  # such unknowns have one axis
        element, place = np.nonzero(index >= n)
        mine, known = index[element, place] - n, np.repeat(index < n, 3, axis=1)
        along = moved[:, np.where(index < n, index, 0)].reshape(len(moved), len(index), -1) * known
        np.subtract.at(left, mine, np.einsum("ej,aej->ea", first[element, place], along[:, element]))
        entry, other = np.nonzero(index[element] >= n)
        row, column = mine[entry], index[element[entry], other] - n
        entries.append((first[element[entry], place[entry], 3 * other], np.array([row, column])))
    values, places = (np.concatenate(part, axis=-1) for part in zip(*entries, strict=True))
    found = splu(sparse.csc_matrix((values, places), shape=(own, own))).solve(left)
    return np.concatenate([moved, found.T[:, :, None] * [1.0, 0.0, 0.0]], axis=1)


def settled(system: System, state: State, found: Balance, free: Floats, dense: int) -> Modes:
    """Modes by factors, `free` (n, 3) what may move; where what is out of balance hides them, those of a shape nearby,
    to which exact steps lead."""
    modes, there, now = factored(system, replace(state, free=free), found, dense), found, state.copy()
    while modes.hidden and there.residual > HIDING:
        if modes.moved is None:
            return Modes(reason=HIDDEN)
        now.x += modes.moved
        before, there = there, balance(system, now)
        if not there.residual < 0.5 * before.residual:
            return Modes(reason=HIDDEN)
        modes = factored(system, replace(now, free=free), there, dense)
    if there is found or modes.moved is None:
        return modes
    return replace(modes, moved=now.x - state.x + modes.moved)


def factored(system: System, state: State, found: Balance, dense: int) -> Modes:
    """Modes by factors: of a dense matrix up to so many unknowns, of a sparse one else, or where groups are large."""
    scaled = Scaled.of(system, state, found)
    few = len(scaled.dofs) <= dense and not system.no_tangent(sparse=False)
    return _dense(scaled) if few else _sparse(scaled)


def _dense(scaled: Scaled) -> Modes:
    matrix = _matrix(scaled)
    try:
        np.linalg.cholesky(matrix - scaled.uncertain * np.eye(len(matrix)))
        return Modes(moved=scaled.motion(np.asarray(np.linalg.solve(matrix, scaled.left))))
    except np.linalg.LinAlgError:
        pass
    values, vectors = np.linalg.eigh(matrix)
    below = int((values < -scaled.uncertain).sum())
    near = int((values <= scaled.uncertain).sum()) - below

    def solve() -> Floats:
        kept = np.abs(values) > scaled.uncertain
        return np.asarray(vectors @ (np.where(kept, vectors.T @ scaled.left, 0.0) / np.where(kept, values, 1.0)))

    return _decided(scaled, below, near, lambda count: vectors[:, :count], solve)


def _matrix(scaled: Scaled) -> Floats:
    """The scaled tangent, dense."""
    from hookean.linear.film_tangent import turn_blocks

    system, state, size = scaled.system, scaled.state, len(scaled.dofs)
    number = np.full(state.x.size, -1)
    number[scaled.dofs] = np.arange(size)
    matrix = np.zeros(size * size)
    for group, blocks in _stiff(system, state):
        index = group.block.indices
        mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
        place = mine[:, :, None] * size + mine[:, None, :]
        kept = (mine[:, :, None] >= 0) & (mine[:, None, :] >= 0)
        if scaled.axes is not None:
            dispatch.compiled(turn_blocks)(scaled.axes, index, blocks)
        matrix += np.bincount(place[kept], blocks[kept], size * size)
    return np.asarray(matrix.reshape(size, size) * scaled.scale * scaled.scale[:, None])


def _sparse(scaled: Scaled) -> Modes:
    from hookean.linear.film_tangent import patterned

    pattern = patterned(scaled.system, scaled.state, scaled.state.free)
    tangent = pattern.tangent(scaled.system, scaled.state)  # first, since it may work out the pattern again
    rows, starts = pattern.factors.rows, pattern.factors.starts
    column = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    own = np.zeros(len(starts) - 1 - len(scaled.dofs))  # unknowns of elements, which nothing pushes
    scale = np.append(scaled.scale, own + 1.0)
    values = tangent * scale[rows] * scale[column]

    def shifted(shift: float) -> Floats:
        moved = values.copy()
        moved[pattern.diagonal] += shift
        return moved

    low = pattern.factors.factor(shifted(-scaled.uncertain))
    if low is not None and not low.negatives:
        # the shift makes it a little softer: once more, by what is left
        left = np.append(scaled.left, own)
        first = low.solve(left)
        more = low.solve(left - _times(rows, column, values, first))
        return Modes(moved=scaled.motion((first + more)[: len(scaled.dofs)]))
    high = pattern.factors.factor(shifted(scaled.uncertain))
    if low is None or high is None:
        return Modes(reason="the tangent has no factors at this shape")
    below = high.negatives

    def solve() -> Floats:
        factor = pattern.factors.factor(values)
        return (factor or high).solve(scaled.left)

    softest = partial(_softest, shifted, pattern.factors, len(scaled.dofs))
    return _decided(scaled, below, low.negatives - below, softest, solve)


def _times(rows: NDArray[np.int32], column: Ints, values: Floats, x: Floats) -> Floats:
    """A x of a matrix whose lower triangle is given."""
    size, off = len(x), rows != column
    lower = np.bincount(rows, values * x[column], size)
    return np.asarray(lower + np.bincount(column[off], (values * x[rows])[off], size))


def _softest(shifted: Callable[[float], Floats], factors: Factors, size: int, count: int) -> Floats:
    """Motions (`size`, `count`) that hold the softest modes, by inverse iteration from below them."""
    shift = 1e-9
    found = factors.factor(shifted(shift))
    while found is None or found.negatives:
        shift *= 10.0
        found = factors.factor(shifted(shift))
    wide = min(count + SPARE, size)
    modes = np.sin(12.9898 * np.arange(1.0, wide * size + 1.0)).reshape(wide, size).T
    for _ in range(INVERSE):
        modes = np.linalg.qr(np.column_stack([found.solve(mode) for mode in modes.T.copy()]))[0]
    return np.asarray(modes)


def _decided(
    scaled: Scaled, below: int, near: int, softest: Callable[[int], Floats], solve: Callable[[], Floats]
) -> Modes:
    """The verdict of the softest modes: `below` are below zero for certain, and `near` so near that rounding may hide
    it."""
    several = below + near <= SEVERAL
    energies, noise = scaled.energies(modes := softest(below + near if several else 1))
    values, turned = np.linalg.eigh(energies)
    mode = scaled.motion(modes @ turned[:, 0])
    mode /= np.abs(mode).max()
    # of motions whose sizes are measured by W, as eigenvalues are
    limit = noise + scaled.turning
    hidden = several and bool(((np.abs(values) <= limit) & (np.abs(values) > noise)).any())
    if several:
        below, near = int((values < -limit).sum()), int((np.abs(values) <= limit).sum())
    found = solve()
    if near:  # what is left once nothing moves along these
        soft = modes @ turned[:, np.abs(values) <= limit]
        found = found - soft @ (soft.T @ found)
    moved = scaled.motion(found) if np.isfinite(found).all() else None
    if below or near:
        return Modes(below, near, mode, moved, hidden=hidden and not below)
    return Modes(moved=moved)


def iterated(system: System, state: State, found: Balance, tangent: Tangent | None = None) -> Modes:
    """Modes of a large net by multigrid, `tangent` one that was made on the way.

    Conjugate gradients meet any motion that gains energy, as soon as the preconditioned tangent's lowest Ritz value is
    near its lowest eigenvalue; noise beside what is out of balance leaves no motion out.
    """
    from hookean.linear.block_cg import Steps
    from hookean.linear.tangent import Tangent

    tangent = tangent or Tangent(system, state)
    if not tangent.hierarchy.coarse:
        return Modes(reason=f"{len(state.x)} particles are too many to factor, and their net cannot be coarsened")
    positive = tangent.take_up(system, state, 0.0)
    if positive:
        moved, steps, positive = tangent.settle(_stirred(found.forces * state.free, state.free), STEPS, Steps())
    if not positive:
        return _lowest(system, state, found, tangent)
    if not steps.settled:
        said = f"the tangent is nearly singular: the error has not settled after {STEPS} steps of conjugate gradients"
        return Modes(unsettled=said, reason="" if steps.softness() > SOFT else "the tangent is nearly singular")
    return Modes(moved=moved)


def _stirred(left: Floats, free: Floats) -> Floats:
    """What is out of balance, and a little noise; noise alone where nothing is."""
    noise = np.sin(12.9898 * np.arange(left.size)).reshape(left.shape) * free
    size = float(np.sqrt((left**2).sum() / max(float((noise**2).sum()), 1.0)))
    return np.asarray(left + STIRRED * (size or 1.0) * noise)


def _lowest(system: System, state: State, found: Balance, tangent: Tangent) -> Modes:
    """The softest mode of a tangent that is not positive definite: by conjugate gradients for eigenvalues (LOBPCG),
    with the cycle of the tangent shifted until that is positive."""
    from scipy.sparse.linalg import LinearOperator, lobpcg

    scaled, size = Scaled.of(system, state, found), state.x.size
    tangent.take_up(system, state, 0.0)
    level = tangent.hierarchy.levels[0]
    matrix = (level.starts, level.columns, level.values.copy())
    shift = LEAST_SHIFT
    while not tangent.take_up(system, state, shift):
        shift *= 10.0
        if shift > LARGEST_SHIFT:
            return Modes(reason="the tangent is not positive definite, and no shift makes it so")

    def times(x: Floats) -> Floats:
        y = np.empty((size // 3, 3))
        dispatch.compiled(multiply)(*matrix, np.ascontiguousarray(x.reshape(-1, 3)), y)
        return y.ravel()

    def cycle(b: Floats) -> Floats:
        return np.array(tangent.hierarchy.cycle(np.ascontiguousarray(b.reshape(-1, 3)))[:, :3], np.float64).ravel()

    def operator(act: Callable[[Floats], Floats]) -> LinearOperator:
        return LinearOperator((size, size), matvec=act, dtype=np.float64)

    weight = np.ones(size)
    weight[scaled.dofs] = 1.0 / scaled.scale**2
    start = _stirred(np.zeros_like(state.x), state.free).reshape(-1, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it need not converge: energies along its mode decide
        _, vectors = lobpcg(
            operator(times), start, B=operator(lambda x: weight * np.ravel(x)), M=operator(cycle), largest=False,
            tol=1e-6, maxiter=STEPS,
        )  # fmt: skip
    own = vectors[scaled.dofs, 0] / scaled.scale
    own /= np.linalg.norm(own)
    energies, noise = scaled.energies(own[:, None])
    limit = noise + scaled.turning
    mode = scaled.motion(own)
    mode /= np.abs(mode).max()
    if energies[0, 0] > limit:
        return Modes(reason="the tangent is nearly singular")
    falls = energies[0, 0] < -limit
    if not falls and abs(energies[0, 0]) > noise and found.residual > HIDING:
        return Modes(reason=HIDDEN)
    unsettled = "the tangent has negative eigenvalues, and multigrid solves only without them"
    return Modes(int(falls), int(not falls), mode, unsettled=unsettled, counted=False)
