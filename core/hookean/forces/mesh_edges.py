"""Parts of a mesh that are elements of forces: its quads, and the edges between two of its triangles."""

from __future__ import annotations

import numpy as np

from hookean.forces.base import Ints, complete


def folds(faces: Ints) -> Ints:
    """Start, end, tip of one triangle and tip of the other (k, 4) of every edge that two triangles share.

    `faces` (m, 4), of which quads are left out; the edge runs as in the first triangle.
    """
    corners = faces[faces[:, 2] == faces[:, 3], :3]
    start, end, tip = (np.roll(corners, -i, axis=1).ravel() for i in range(3))
    pairs = np.sort(np.column_stack([start, end]), axis=1)
    order = np.lexsort(pairs.T)
    _, first, count = np.unique(pairs[order], axis=0, return_index=True, return_counts=True)
    one, other = order[first[count == 2]], order[first[count == 2] + 1]
    return np.column_stack([start[one], end[one], tip[one], tip[other]])


def quads(faces: Ints) -> Ints:
    """The faces (m, 4) with four corners that all met particles."""
    return complete(faces[faces[:, 2] != faces[:, 3]])
