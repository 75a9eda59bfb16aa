"""What a person would connect to the component of a force: the force's own example, as values of Grasshopper."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.forces import KINDS
from hookean.forces.base import PLACES
from hookean.scene.catalogue import catalogue
from hookean_canvas.components import force_bundles

ENTRIES = {entry["kind"]: entry for entry in catalogue()}
GRID = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]
"""Faces of the mesh that examples on 9 particles act on, 3 rows of 3."""


def inputs(kind: str) -> dict[str, list[Any]]:
    """For each input of the component of a force that its example gives, or that must be connected, what flows in."""
    force, x = KINDS[kind].example()
    found: dict[str, list[Any]] = {}
    for entry in force_bundles.entries(ENTRIES[kind]):
        count = sum(variable.startswith(entry.variable.rstrip("123456789")) for variable in found)
        values = _values(force, np.asarray(x), entry.field, count)
        if values and (entry.variable.startswith("_") and not entry.variable.endswith("_") or _given(force, entry)):
            found[entry.variable] = values
    return found


def _given(force: Any, entry: force_bundles.Entry) -> bool:
    return entry.field in force.model_fields_set or entry.field in PLACES


def _values(force: Any, x: Any, field: str, corner: int) -> list[Any]:
    """What flows into the input of a field; `corner` of the particles of each element where there is one for each."""
    rows = x[np.asarray(force.particles)] if getattr(force, "particles", None) is not None else None
    if field == "points" and rows is not None:
        return [{"Point3d": row.tolist()} for row in (rows if rows.ndim == 2 else rows[:, corner])]
    if field == "lines" and rows is not None:
        return [{"Line": row.tolist()} for row in rows] if rows.ndim == 3 else []
    if field == "mesh":
        return [{"Mesh": {"vertices": x.tolist(), "faces": GRID}}]
    if field == "target":
        return [{"Mesh": {"vertices": force.vertices.tolist(), "faces": force.faces.tolist()}}]
    if field == "curve":
        return [{"Polyline": force.curve.tolist()}]
    if field == "control_points":
        four = np.dstack([force.control_points, force.weights]).tolist()
        degrees = {"degree_u": force.degree_u, "degree_v": force.degree_v}
        knots = {"knots_u": force.knots_u[1:-1].tolist(), "knots_v": force.knots_v[1:-1].tolist()}  # as Rhino has them
        return [{"NurbsSurface": {"points": four, **degrees, **knots}}]
    if field in ("image", "path"):
        return [", ".join(map(str, row)) for row in getattr(force, field).tolist()]
    kind = next(f["type"] for f in ENTRIES[force.kind]["fields"] if f["name"] == field)
    value = getattr(force, field)
    if value is None or isinstance(value, str):
        return [value] if value else []
    array = np.asarray(value)
    if "vector" in kind or "point" in kind:
        name = "Vector3d" if "vector" in kind else "Point3d"
        return [{name: row.tolist()} for row in np.atleast_2d(array)]
    return [float(one) if array.dtype.kind == "f" else one.item() for one in array.ravel()]
