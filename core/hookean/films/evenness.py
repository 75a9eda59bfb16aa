"""Evenness: keeps the vertices of films evenly spread while a solver's loop moves them.

Motion along a film leaves the film where it is (see `hookean.films`), so what forces do along it is taken away, and
vertices are pulled to where the map from the drawn mesh has the least Dirichlet energy, s T sum(cot(a0) l^2) / 4
with the drawn angles a0 opposite to edges l, and the evenness s; where what was drawn is torn, from triangles of equal
sides. What this does across the film is left out, so neither the shape of the film nor its equilibrium depends on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled.marks import device
from hookean.films.frames import TURN, along_edge, within
from hookean.forces.soapfilm import EVEN, SLIVER, SoapFilm

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

KIND, ENDS, FREE, BOUND, NORMAL, PULL = 0, 1, 3, 6, 7, 12  # columns of the memory, a row for each particle


def keeper(system: System, state: State) -> tuple[Any, tuple[Any, Any, Any]] | None:
    """A kernel with its arrays, to be called after those of all forces; None without films."""
    films = system.films
    if films is None:
        return None
    block = next(g.block for g in system.groups if g.cls is SoapFilm)
    drawn = films.conductances(system.x, films.torn(system.x, state.free))
    numbers = drawn * np.minimum(block.parameters[:, EVEN], 1.0)[:, None, None]
    pairs, pulls = _pairs(block.indices, numbers)
    memory = np.zeros((len(films.kind), PULL + 3))
    memory[:, KIND], memory[:, ENDS : ENDS + 2], memory[:, FREE : FREE + 3] = films.kind, films.ends, state.free
    for ends in pairs.T:
        memory[:, BOUND] += 2.0 * np.bincount(ends, np.abs(pulls), len(memory))
    indices = np.concatenate([block.indices, np.column_stack([pairs, np.full(len(pairs), -1)])])
    parameters = np.concatenate([films.signs, np.repeat(pulls[:, None], 3, axis=1)])
    return keep_even, (np.ascontiguousarray(indices), np.ascontiguousarray(parameters), memory)


def _pairs(corners: Ints, numbers: Floats) -> tuple[Ints, Floats]:
    """The pairs of particles (k, 2) that triangles join, and what each pulls per length (k,) [force/length], of numbers
    (m, 3, 3) whose rows sum to zero."""
    one, other = corners[:, [0, 1, 2]].ravel(), corners[:, [1, 2, 0]].ravel()
    size = int(corners.max(initial=0)) + 1
    keys, which = np.unique(np.minimum(one, other) * size + np.maximum(one, other), return_inverse=True)
    pulls = np.bincount(which, -numbers[:, [0, 1, 2], [1, 2, 0]].ravel(), len(keys)).astype(np.float64)
    return np.column_stack([keys // size, keys % size]), pulls


@device
def swept(x: Any, a: Any, b: Any, c: Any, n: Any) -> Any:
    """Twice the area of a triangle, as a vector in n too, which is 0 of a sliver."""
    u, v, w = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    r, s, t = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
    n[0], n[1], n[2] = v * t - w * s, w * r - u * t, u * s - v * r
    double = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    sides = 2.0 * (u * u + v * v + w * w + r * r + s * s + t * t - u * r - v * s - w * t)
    if not (double > SLIVER * sides and sides > 1e-140):
        n[:] = 0.0
    return double


def keep_even(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    """Take from f what does not count, and add the pull along films; the stiffness of that to w. Indices are corners
    of triangles, with a side for each as parameters, and then pairs of particles with what they pull."""
    memory[:, NORMAL:] = 0.0
    n = np.zeros(3)
    axes, counts, ends = np.empty((3, 3)), np.empty(3), np.empty((2, 3))
    for t in range(indices.shape[0]):
        if indices[t, 2] < 0:
            a, b = indices[t, 0], indices[t, 1]
            for k in range(3):
                pull = parameters[t, 0] * (x[b, k] - x[a, k])
                memory[a, PULL + k] += pull
                memory[b, PULL + k] -= pull
            continue
        area = swept(x, indices[t, 0], indices[t, 1], indices[t, 2], n)
        for i in range(3):
            a, side = indices[t, i], parameters[t, i]
            memory[a, NORMAL] += side * n[0]
            memory[a, NORMAL + 1] += side * n[1]
            memory[a, NORMAL + 2] += side * n[2]
            memory[a, NORMAL + 3] += area
    for a in range(memory.shape[0]):
        held = 0
        for i in range(3):
            held += memory[a, FREE + i] == 0.0
            counts[i] = memory[a, FREE + i]
            for j in range(3):
                axes[i, j] = 1.0 if i == j else 0.0
        if memory[a, KIND] == 0.0 or held == 3:
            continue
        if memory[a, KIND] == 2.0:
            within(memory[a, NORMAL : NORMAL + 5], memory[a, FREE : FREE + 3], held, axes, counts)
        else:
            for j in range(3):
                ends[0, j] = x[int(memory[a, ENDS]), j]
                ends[1, j] = x[int(memory[a, ENDS + 1]), j]
            turn = TURN if memory[a, KIND] == 1.0 else -2.0
            along_edge(ends[0], x[a], ends[1], turn, memory[a, FREE : FREE + 3], held, axes, counts)
        w[a] += memory[a, BOUND]
        for i in range(3):
            memory[a, NORMAL + i] = (f[a, i] - memory[a, PULL + i]) * memory[a, FREE + i]
            f[a, i] = memory[a, PULL + i] * memory[a, FREE + i]
        for i in range(3):
            part = 0.0
            for j in range(3):
                part += counts[i] * axes[i, j] * memory[a, NORMAL + j]
            for j in range(3):
                f[a, j] += part * axes[i, j]
    return 0.0
