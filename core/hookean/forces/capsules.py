"""Contacts of two capsules of `collide_lines`, which share the loops of spheres."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.cells import PARALLEL, nearest
from hookean.forces.crowd_rows import NEAREST
from hookean.forces.neighbours import HERE

TINY = 1e-280  # square of a length: what is smaller is a point


@device
def gap(here: Any, i: Any, j: Any) -> Any:
    """Squared distance of the axes of two elements, and where on the axes they are nearest."""
    s, t, square = 0.0, 0.0, 0.0
    if here.shape[1] == HERE:
        for c in range(3):
            square += (here[j, c] - here[i, c]) ** 2
        return square, s, t
    s, t = nearest(here, i, j, 4)
    for c in range(3):
        square += (here[j, c] + t * here[j, 4 + c] - here[i, c] - s * here[i, 4 + c]) ** 2
    return square, s, t


@device
def stiffer(here: Any, i: Any, j: Any, s: Any, t: Any, length: Any, overlap: Any) -> Any:
    """How much more than 2 a contact of capsules counts for the stiffness, as its point slides along them.

    With U the half axes along which it slides and q^2 = 1 / the least eigenvalue of U'U, its tangent is at most
    k n n' + k overlap q (2 + length q / 2), n the gradient of the distance; the rest of it is negative.
    """
    uu, vv, turn = 0.0, 0.0, 0.0
    for c in range(3):
        d, k = (c + 1) % 3, (c + 2) % 3
        uu += here[i, 4 + c] * here[i, 4 + c]
        vv += here[j, 4 + c] * here[j, 4 + c]
        cross = here[i, 4 + d] * here[j, 4 + k] - here[i, 4 + k] * here[j, 4 + d]
        turn += cross * cross
    uu, vv = uu if abs(s) < 1.0 else 0.0, vv if abs(t) < 1.0 else 0.0
    least = max(turn, PARALLEL * uu * vv) / (uu + vv) if uu > TINY and vv > TINY else uu + vv
    q = 1.0 / np.sqrt(least) if least > TINY else 0.0
    return overlap * q * (2.0 + 0.5 * length * q)


@device
def push_capsules(here: Any, i: Any, j: Any, skin: Any, stiffness: Any) -> Any:
    """Add the forces of two capsules on both ends of each, by where on the axis they act, and how often they count for
    the stiffness; returns their energy."""
    apart = 0.0
    for c in range(3):
        apart += (here[j, c] - here[i, c]) ** 2
    reach = here[i, 3] + here[j, 3] + skin
    if apart >= reach * reach:
        return 0.0
    square, s, t = gap(here, i, j)
    reach = here[i, 7] + here[j, 7]
    if square >= (reach + skin) * (reach + skin):
        return 0.0
    here[i, 15] += 1.0
    here[j, 15] += 1.0
    if square >= reach * reach:
        return 0.0
    length = np.sqrt(square)
    overlap = reach - length
    more = 0.5 * stiffer(here, i, j, s, t, length, overlap)
    here[i, 15] += more
    here[j, 15] += more
    for c in range(3):
        push = here[j, c] + t * here[j, 4 + c] - here[i, c] - s * here[i, 4 + c]
        push *= stiffness * overlap / length if length > NEAREST else 0.0
        here[i, 8 + c] -= 0.5 * (1.0 - s) * push
        here[i, 11 + c] -= 0.5 * (1.0 + s) * push
        here[j, 8 + c] += 0.5 * (1.0 - t) * push
        here[j, 11 + c] += 0.5 * (1.0 + t) * push
    return 0.5 * stiffness * overlap * overlap
