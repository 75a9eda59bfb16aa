"""What a mesh measures: its area, and the volume that it encloses."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize.meshes import as_mesh


def area(mesh: Any) -> float:
    """Area of a mesh [length^2]; a quad is the mean of its two cuts into triangles."""
    return 0.25 * sum(float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) for a, b, c in _cuts(mesh))


def volume(mesh: Any) -> float:
    """Volume [length^3] that a closed mesh encloses, by the divergence theorem: a sixth of the sum of a . (b x c) over
    its triangles; a quad is the mean of its two cuts. Below 0 where the normals point inwards."""
    return float(sum((a * np.cross(b, c)).sum() for a, b, c in _cuts(mesh))) / 12.0


def _cuts(mesh: Any) -> Any:
    """Corners of the triangles of both cuts of all faces; of a triangle `(a, b, c, c)` twice itself."""
    read = as_mesh(mesh)
    a, b, c, d = read.vertices[read.faces].transpose(1, 0, 2)
    return (a, b, c), (a, c, d), (a, b, d), (b, c, d)
