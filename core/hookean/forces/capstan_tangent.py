"""The tangent of cables with friction: of whole cables, the part that is symmetric and the part that is not.

Between two saddles that hold, all lines i have the strain t_i = R_i d / c of what all of them together are longer than
at rest, d, and c = sum R_i c_i; R_i is the product of exp(+-mu phi) over the saddles that slip before i (see
`capstan`). So with rho_i = ln R_i

    dt_i = R_i / c sum dl_j + t_i (drho_i - sum_j R_j c_j drho_j / c),   drho_i = sum +-mu dphi,

and K = sum over i of T_i l_i'' + l_i' dT_i, T_i = EA t_i. At the edge of slipping it has a step.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from hookean.compiled import dispatch
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Ints
from hookean.forces.capstan import (
    FRICTION,
    LENGTH,
    OWN,
    RATIO,
    REST,
    RUN_WAY,
    STEEPEST,
    STIFFNESS,
    STRAIN,
    TABLE,
    WAY,
    tensed,
)
from hookean.forces.groups import begins


def states(x, indices, parameters, memory, found):  # type: ignore[no-untyped-def]
    """The rows of the table of each line, by its row."""
    table = np.zeros((indices.shape[0], TABLE))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        count = tensed(x, indices, parameters, memory, first, table)
        for i in range(count):
            found[int(table[i, 0])] = table[i]


def tangents(block: Block, memory: Floats, x: Floats) -> list[tuple[Ints, Floats]]:
    """Particles (k, 2 m) and tangents (k, 6 m, 6 m) -df/dx of cables of as many lines, in the order of the cables."""
    found = np.zeros((len(block.indices), TABLE))
    dispatch.compiled(states)(x, block.indices, block.parameters, memory, found)
    return [
        (
            np.ascontiguousarray(block.indices[rows].reshape(len(rows), -1)),
            np.array([_cable(block, found[own], own, x) for own in rows]),
        )
        for rows in groups.by_size(block)
    ]


def _cable(block: Block, table: Floats, rows: Ints, x: Floats) -> Floats:
    """The tangent of one cable, by both ends of its lines in their order."""
    count, p = len(rows), block.parameters[rows]
    axial, strain = float(p[0, STIFFNESS] * p[0, REST]), table[:, STRAIN]
    apart = x[block.indices[rows, 1]] - x[block.indices[rows, 0]]
    length = table[:, LENGTH]
    u = apart / np.where(length > 0.0, length, 1.0)[:, None]
    slope = np.zeros((count, count, 6))  # of lengths, and further below of the logarithms rho
    slope[range(count), range(count)] = np.column_stack([-u, u])
    longer, spins = slope.reshape(count, -1), _angles(p, table, u).reshape(count, -1)
    rho = np.zeros((count, 6 * count))
    change = np.zeros((count, 6 * count))
    edges = [0, *(np.flatnonzero(table[1:, RUN_WAY] == 0.0) + 1).tolist(), count]
    for start, stop in pairwise(edges):
        some = slice(start, stop)
        if not strain[start] > 0.0:
            continue  # slack
        rho[some] = np.cumsum(np.vstack([np.zeros((1, 6 * count)), spins[start + 1 : stop]]), axis=0)
        part = strain[some] * table[some, OWN] / (strain[some] @ table[some, OWN])
        whole = longer[some].sum(axis=0) / (strain[some] @ table[some, OWN])
        change[some] = strain[some, None] * (whole + rho[some] - part @ rho[some])
    tangent = axial * (longer.T @ change)
    across = np.where(length > 0.0, axial * strain / np.where(length > 0.0, length, 1.0), 0.0)
    for i in range(count):
        square = across[i] * (np.eye(3) - np.outer(u[i], u[i]))
        tangent[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] += np.block([[square, -square], [-square, square]])
    return np.asarray(tangent)


def _angles(p: Floats, table: Floats, u: Floats) -> Floats:
    """How the logarithm of the factor between a line (n,) and the one before it changes with both ends of all lines
    (n, n, 6): +-mu dphi where the saddle slips, else 0."""
    count, length = len(u), table[:, LENGTH]
    found = np.zeros((count, count, 6))
    for i in range(1, count):
        cosine = float(u[i - 1] @ u[i]) * p[i, WAY]
        sine = float(np.linalg.norm(np.cross(u[i - 1], u[i])))
        if table[i, RUN_WAY] == 0.0 or sine == 0.0 or np.log(table[i, RATIO]) >= STEEPEST:
            continue
        for at, other in ((i - 1, i), (i, i - 1)):
            rate = -(p[i, WAY] * u[other] - cosine * u[at]) / (sine * length[at]) * p[i, FRICTION] * table[i, RUN_WAY]
            found[i, at] = np.concatenate([-rate, rate])
    return found
