"""Several meshes as one clean mesh."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from hookean.discretize.meshes import join
from hookean.errors import InputError
from hookean.values.mesh import Mesh


def clean(meshes: Iterable[Any], tolerance: float = 0.01) -> Mesh:
    """Several meshes as one, welded, without unused vertices and without faces that are there twice.

    Vertices nearer than `tolerance` (length units) become one, the first of them; faces that lose a
    side become triangles, and those without three different corners go. Of faces with the same
    corners, in any order, the first stays. Vertices keep their order. Slender faces stay: removing
    them would open the mesh. Raises InputError where no mesh is given, or `tolerance` is negative.
    """
    parts = list(meshes)
    if not parts:
        raise InputError("meshes", "there are none; give at least one mesh")
    whole = join(parts, tolerance)
    # (a, b, c, c) and (b, c, a, a) are one triangle: compare sets, not multisets
    triangle = whole.faces[:, 2] == whole.faces[:, 3]
    key = np.sort(np.where(triangle[:, None], np.c_[whole.faces[:, :3], np.full(len(triangle), -1)], whole.faces))
    _, first = np.unique(key, axis=0, return_index=True)
    faces = whole.faces[np.sort(first)]
    used, place = np.unique(faces, return_inverse=True)
    return Mesh(whole.vertices[used], place.reshape(-1, 4).astype(np.int64))
