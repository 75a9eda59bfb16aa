"""Whatever has faces to one mesh."""

from __future__ import annotations

from typing import Any

from hookean.discretize.breps import mesh_faces
from hookean.discretize.surfaces import mesh_grid
from hookean.values.mesh import Mesh


def mesh_surface(surface: Any, u: int, v: int) -> Mesh:
    """A surface as a mesh of u by v quads, at even steps over its two parameter domains.

    Vertex (i, j) is S(u0 + i (u1 - u0) / u, v0 + j (v1 - v0) / v), numbered with j fastest; face (i, j)
    runs i j, i+1 j, i+1 j+1, i j+1, so that its normal is S_u x S_v and its first side runs along u.
    A side collapsed to a point (the pole of a sphere) becomes one vertex and its quads triangles
    `(a, b, c, c)` with c the pole; a closed surface is welded along its seam.

    Takes a rhino3dm or COMPAS surface or a `NurbsSurface`; a Brep, BrepFace or Extrusion goes to `mesh_faces`. Raises
    InputError where a count is not a whole number >= 1 (>= 3 round a closed direction), a point is not
    finite or the surface has no size.
    """
    if any(hasattr(surface, part) for part in ("Faces", "OuterLoop", "ProfileCount")):
        return mesh_faces(surface, u, v)
    return mesh_grid(surface, u, v)
