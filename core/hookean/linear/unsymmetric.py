"""The part of a tangent that is not symmetric, and solutions with it by factors of the part that is.

Moments that keep their direction, and friction, have no energy, and so their tangent is not symmetric. (A + S) x = b is
the same as (1 + A^-1 S) x = A^-1 b, which takes as many steps of GMRES as S has different eigenvalues beside A: of one
moment three. Source: Saad and Schultz, GMRES, 1986.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

EXACT = 1e-12  # part of a solution that may be missing
STEPS = 60  # of GMRES at most


def skew_part(system: System, state: State, dofs: Ints) -> Any:
    """S (u, u), sparse, of the unknowns `dofs` (u,), with all slots folded; None where the tangent is symmetric."""
    import scipy.sparse as sparse

    number = np.full(system.x.size, -1)
    number[dofs] = np.arange(len(dofs))
    places, values = [], []
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.skew is None or not len(group.block.indices):
            continue
        for index, blocks in group.cls.skew(group.block, memory, state.x):
            mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
            row, column = (np.broadcast_to(m, blocks.shape) for m in (mine[:, :, None], mine[:, None, :]))
            kept = (row >= 0) & (column >= 0) & (blocks != 0.0)
            places.append(np.stack([row[kept], column[kept]]))
            values.append(blocks[kept])
    if not sum(map(len, values)):
        return None
    entries = np.concatenate(values), np.concatenate(places, axis=1)
    return sparse.coo_matrix(entries, shape=(len(dofs), len(dofs))).tocsr()


def solve(symmetric: Callable[[Floats], Floats], skew: Any, b: Floats) -> Floats:
    """x of (A + S) x = b; `symmetric` gives A^-1 of a vector."""
    from scipy.sparse.linalg import LinearOperator, gmres

    whole = LinearOperator((len(b), len(b)), lambda x: x + symmetric(skew @ x), dtype=np.float64)
    first = symmetric(b)
    return np.asarray(gmres(whole, first, x0=first, rtol=EXACT, restart=STEPS, maxiter=1)[0])
