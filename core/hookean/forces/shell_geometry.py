"""The start mesh of a shell: its triangles with their neighbours, and curvature by fold angles (see `shell`)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces.base import Floats, Ints
from hookean.forces.dihedral import SLIVER

Complex = NDArray[np.complex128]

# Each edge with the other edges of its two triangles, as the triangle sees them: what a part of its fold comes from.
FIVE = np.array([[i, (i + 1) % 3, (i + 2) % 3, 3 + 2 * i, 4 + 2 * i] for i in range(3)])


def triangles(x: Floats, faces: Ints) -> Ints:
    """Triangles (m, 3) of faces (k, 4): quads cut along the shorter diagonal; those without area left out.

    A quad whose shorter diagonal lies outside it is cut along the other one.
    """
    a, b, c, d = (x[faces[:, i]] for i in range(4))
    first, second = np.linalg.norm(c - a, axis=1), np.linalg.norm(d - b, axis=1)

    def inside(p: Floats, q: Floats, r: Floats, s: Floats) -> NDArray[np.bool_]:
        one, other = np.cross(q - p, r - p), np.cross(r - p, s - p)
        return np.asarray((one * other).sum(axis=1) > 0)

    fits, other_fits = inside(a, b, c, d), inside(b, c, d, a)
    # equal but for rounding is a draw, so that a regular grid is cut in a regular way; Rhino's meshes have single
    # precision, 6e-8 of coordinates that may be a hundred times the diagonals
    along_first = np.where(fits == other_fits, first <= second * (1.0 + 1e-5), fits)
    quad = faces[:, 2] != faces[:, 3]
    one = np.where((along_first | ~quad)[:, None], faces[:, [0, 1, 2]], faces[:, [0, 1, 3]])
    two = np.where(along_first[:, None], faces[:, [0, 2, 3]], faces[:, [1, 2, 3]])
    both = np.stack([one, two], axis=1).reshape(-1, 3)[np.stack([np.ones_like(quad), quad], axis=1).ravel()]
    p, q, r = (x[both[:, i]] for i in range(3))
    height = np.linalg.norm(np.cross(q - p, r - p), axis=1)
    size = ((q - p) ** 2).sum(axis=1) + ((r - p) ** 2).sum(axis=1)
    return np.ascontiguousarray(both[height > 10.0 * SLIVER * size])


def neighbours(corners: Ints, pointer: str) -> Ints:
    """For each edge (i, i + 1) of each triangle the same edge of its neighbour, as 3 t + i; -1 at naked edges."""
    pairs = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    same = (pairs[order[1:]] == pairs[order[:-1]]).all(axis=1)
    crowded = np.flatnonzero(same[1:] & same[:-1])
    if len(crowded):
        a, b = pairs[order[crowded[0]]]
        raise InputError(
            pointer,
            f"three faces meet at the edge from particle {a} to {b}; a shell bends across edges of one or two faces. "
            "Split the mesh there, or remove doubled faces",
        )
    across = np.full(len(pairs), -1)
    first, second = order[:-1][same], order[1:][same]
    across[first], across[second] = second, first
    return across.reshape(-1, 3)


def renumbered(across: Ints, kept: NDArray[np.bool_]) -> Ints:
    """Places across edges when only some triangles are kept."""
    number = np.cumsum(kept) - 1
    across = across[kept]
    return np.where(across >= 0, 3 * number[across // 3] + across % 3, -1)


def elements(corners: Ints, across: Ints) -> tuple[Ints, NDArray[np.bool_]]:
    """Particles (m, 12) of each triangle's element, and which are there; the others repeat the first corner."""
    index = np.repeat(corners[:, :1], 12, axis=1)
    there = np.zeros(index.shape, dtype=bool)
    index[:, :3], there[:, :3] = corners, True
    tips = np.roll(corners, -2, axis=1).ravel()
    for i in range(3):
        met = across[:, i] >= 0
        other, edge = across[met, i] // 3, across[met, i] % 3
        index[met, 3 + i], there[met, 3 + i] = tips[across[met, i]], True
        # the neighbour runs along the common edge the other way, unless its orientation is opposite
        turned = corners[other, edge] == corners[met, i]
        for j in range(2):
            beyond = across[other, (edge + 1 + np.where(turned, 1 - j, j)) % 3]
            index[met, 6 + 2 * i + j] = np.where(beyond >= 0, tips[beyond], index[met, 0])
            there[met, 6 + 2 * i + j] = beyond >= 0
    return index, there


def _place(x: Floats, corners: Sequence[Ints] | Ints, za: Complex, zb: Complex, side: float) -> Complex:
    """Where corner c comes to lie when triangle a b c is laid into the plane with a at za and b at zb."""
    a, b, c = (x[corner] for corner in corners)
    e, p = b - a, c - a
    ee = (e * e).sum(axis=1)
    safe = np.where(ee > 0, ee, 1.0)
    foot, height = (p * e).sum(axis=1) / safe, np.linalg.norm(np.cross(e, p), axis=1) / safe
    return np.asarray(za + (zb - za) * (foot + side * 1j * height))


def _tensor(z: Complex) -> Floats:
    """z z^T / 2 as (xx, yy, sqrt 2 xy): the height at z of a sheet, for each of three unit curvatures."""
    return 0.5 * np.stack([z.real**2, z.imag**2, np.sqrt(2.0) * z.real * z.imag], axis=-1)


def _fold_ofcurvature(a: Complex, b: Complex, c: Complex, d: Complex, there: NDArray[np.bool_]) -> Floats:
    """Fold angle of edge a-b with tips c, d in a sheet of constant curvature, by curvature (m, 3); 0 if not there."""
    total = np.zeros((len(a), 3))
    for tip in (c, d):
        local = np.where(there, (tip - a) / np.where(there, b - a, 1.0), 1j)
        foot, height = local.real, np.abs(local.imag * (b - a))
        rise = _tensor(tip - a) - foot[:, None] * _tensor(b - a)
        total += rise / np.where(there, height, 1.0)[:, None]
    return np.where(there[:, None], total, 0.0)


def _own_part(a: Complex, b: Complex, c: Complex) -> Floats:
    """The part of that fold on the side of c: slope across the middle of the edge over the slope of the triangle."""
    e, middle = b - a, 0.5 * (b - a)
    outward = -1j * e / np.abs(e)
    local = (c - a) / e
    rise = _tensor(c - a) - local.real[:, None] * _tensor(e)
    mixed = np.sqrt(0.5) * (middle.real * outward.imag + middle.imag * outward.real)
    slope = np.stack([middle.real * outward.real, middle.imag * outward.imag, mixed], axis=-1)
    return slope + rise / (local.imag * np.abs(e))[:, None]


def _split(x: Floats, index: Ints, there: NDArray[np.bool_], i: int) -> Floats:
    """The angle at edge i on the side of the triangle, by the five fold angles (m, 5) of `FIVE`."""
    j, k = (i + 1) % 3, (i + 2) % 3
    node = [index[:, n] for n in (i, j, k, 3 + i, 3 + j, 3 + k, 6 + 2 * i, 7 + 2 * i)]
    has = [there[:, n] for n in (3 + i, 3 + j, 3 + k, 6 + 2 * i, 7 + 2 * i)]
    za = np.zeros(len(index), complex)
    zb = za + np.linalg.norm(x[node[1]] - x[node[0]], axis=1)
    zc, zd = _place(x, node[:3], za, zb, 1.0), _place(x, (node[0], node[1], node[3]), za, zb, -1.0)
    folds = np.stack(
        [
            _fold_ofcurvature(za, zb, zc, zd, has[0]),
            _fold_ofcurvature(zb, zc, za, _place(x, (node[1], node[2], node[4]), zb, zc, -1.0), has[1]),
            _fold_ofcurvature(zc, za, zb, _place(x, (node[2], node[0], node[5]), zc, za, -1.0), has[2]),
            _fold_ofcurvature(za, zd, zb, _place(x, (node[0], node[3], node[6]), za, zd, -1.0), has[3]),
            _fold_ofcurvature(zd, zb, za, _place(x, (node[3], node[1], node[7]), zd, zb, -1.0), has[4]),
        ],
        axis=1,
    )
    share = zc.imag / (zc.imag - zd.imag)
    missing = np.where(has[0][:, None], _own_part(za, zb, zc) - share[:, None] * folds[:, 0], 0.0)
    part = _least(folds, missing)
    part[:, 0] += np.where(has[0], share, 0.0)
    return part


def _least(folds: Floats, wanted: Floats) -> Floats:
    """The smallest r (m, 5) with folds^T r = wanted; directions that the folds hardly tell apart are left out."""
    found = np.zeros(folds.shape[:2])
    todo = np.abs(wanted).max(axis=1, initial=0.0) > 1e-9 * np.abs(folds[:, 0]).max(axis=1, initial=0.0)
    folds, wanted = folds[todo], wanted[todo]
    size, axes = np.linalg.eigh(np.einsum("mhk,mhl->mkl", folds, folds))
    keep = size > 0.01 * size[:, -1:]
    inverse = np.where(keep, 1.0 / np.where(keep, size, 1.0), 0.0)
    found[todo] = np.einsum("mhk,mkl,ml,mnl,mn->mh", folds, axes, inverse, axes, wanted, optimize=True)
    return found


def curvature(
    x: Floats, index: Ints, there: NDArray[np.bool_], across: Ints, poisson: float
) -> tuple[Floats, Floats, Floats]:
    """sqrt(A) K as (xx, yy, sqrt 2 xy) in the triangle's plane, times the root of the stiffness, by the parts of folds
    (m, 3, 3), these parts by five folds each (m, 3, 5), and the areas (m,)."""
    za = np.zeros(len(index), complex)
    zb = za + np.linalg.norm(x[index[:, 1]] - x[index[:, 0]], axis=1)
    z = np.stack([za, zb, _place(x, index.T[:3], za, zb, 1.0)], axis=1)
    edges = np.roll(z, -1, axis=1) - z
    area = 0.5 * zb.real * z[:, 2].imag
    outward = -1j * edges / np.abs(edges)
    # (2 / h) n n^T = l / A n n^T for each edge
    axes = 2.0 * _tensor(outward) * (np.abs(edges) / area[:, None])[:, :, None] @ root_of_stiffness(poisson)
    parts = np.stack([_split(x, index, there, i) for i in range(3)], axis=1)
    _balance(parts, index[:, :3].ravel(), across.ravel())
    naked = np.where(there[:, 3:6, None], 0.0, axes)
    some = ~there[:, 3:6].all(axis=1)
    # the curvature that turning naked edges cannot take away
    left = np.eye(3) - np.linalg.pinv(naked[some], rcond=1e-6) @ naked[some]
    axes = axes.transpose(0, 2, 1)
    axes[some] = left @ axes[some]
    axes = np.where(there[:, None, 3:6], axes, 0.0)
    return np.sqrt(area)[:, None, None] * axes, parts, area


def _balance(parts: Floats, start: Ints, across: Ints) -> None:
    """Give the second triangle of every edge what the first leaves of the fold: exactly, not but for rounding."""
    first = np.flatnonzero(across > np.arange(len(across)))
    second = across[first]
    turned = start[first] == start[second]  # see `_elements`
    seen = np.where(turned[:, None], [0, 4, 3, 2, 1], [0, 3, 4, 1, 2])
    flat = parts.reshape(-1, 5)
    flat[second] = -np.take_along_axis(flat[first], seen, axis=1)
    flat[second, 0] += 1.0


def rows(axes: Floats, parts: Floats) -> Floats:
    """sqrt(A) K (m, 3, 9) by the nine fold angles."""
    rows = np.zeros((len(axes), 3, 9))
    for i in range(3):
        for j in range(5):
            rows[:, :, FIVE[i, j]] += axes[:, :, i] * parts[:, i, j, None]
    return rows


def root_of_stiffness(poisson: float) -> Floats:
    """The symmetric root R (3, 3) of (1 - nu) 1 + nu m m^T, m = (1, 1, 0), by which K has the energy of a plate:
    |R K|^2 = (1 - nu) |K|^2 + nu (tr K)^2."""
    less, more = np.sqrt(1.0 - poisson), np.sqrt(1.0 + poisson)
    trace = np.array([1.0, 1.0, 0.0])
    return np.asarray(less * np.eye(3) + 0.5 * (more - less) * np.outer(trace, trace))
