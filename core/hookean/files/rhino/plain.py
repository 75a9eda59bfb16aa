"""What is drawn in a .3dm file as plain numbers: for programs that have no reader of such files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.breps import is_trimmed, mesh_faces
from hookean.discretize.meshes import as_mesh
from hookean.errors import InputError
from hookean.files.rhino.model import Model, Object, expand, points_in, rhino

Array = NDArray[np.float64]
KINDS = ("point", "points", "line", "polyline", "curve", "surface", "brep", "mesh")
"""Types of objects that are read; others, such as a text or a dimension, are left out with a warning."""


def plain(model: Model, divisions: tuple[int, int] | None = None) -> dict[str, Any]:
    """A model as `{"name", "unit", "metres", "tolerance", "layers", "objects", "warnings"}`, lengths in its unit.

    An object has `id`, `name`, `layer`, `visible` and a `kind`: `point`, `points`, `line` and `polyline` have `points`
    `(n, 3)`; `curve` and `surface` their NURBS form (see `hookean.discretize.nurbs`), knots as Rhino has them, weights
    where any is not 1; `mesh` has `vertices` and `faces`; `brep` has none. With `divisions` (u, v) surfaces and Breps
    also have `mesh`, as `mesh_faces` makes it, or `fault`, a sentence. Blocks are expanded; what hookean added, and
    what lies in layouts, is left out; damaged objects are, too, with a warning for each. Raises InputError where blocks
    cannot be expanded.
    """
    drawn = [item for item in expand(model, model.foreign()) if not item.page]
    damaged: list[str] = []
    warnings = list(model.warnings)
    found = [(item, _whole(item, divisions, damaged)) for item in drawn]
    objects = [
        {"id": str(item.id), "name": item.name, "layer": item.layer, "visible": item.visible, **what}
        for item, what in found
        if what is not None
    ]
    warnings += damaged
    if other := len(drawn) - len(objects) - len(damaged):
        warnings.append(f"{other} objects are not points, curves, surfaces or meshes and are left out.")
    layers = [{"path": layer.path, "visible": layer.visible, "colour": list(layer.colour)} for layer in model.layers]
    about = {"name": model.name, "unit": model.unit, "metres": model.metres, "tolerance": model.tolerance}
    return {**about, "layers": layers, "objects": objects, "warnings": warnings}


def _whole(item: Object, divisions: tuple[int, int] | None, damaged: list[str]) -> dict[str, Any] | None:
    """What `_plain` reads of an object; nothing, and a sentence more in `damaged`, where a mesh of it cannot be read or
    a number is not finite."""
    try:
        with np.errstate(divide="ignore", invalid="ignore"):  # weights of zero are refused below
            found = _plain(item, divisions)
        if not all(np.isfinite(a).all() for a in (found or {}).values() if isinstance(a, np.ndarray)):
            raise InputError("", "a coordinate, weight or knot is not finite; rebuild it in Rhino")
    except InputError as error:
        damaged.append(f"{item.kind} {item.id} on layer {item.layer} is left out: {error.sentence}.")
        return None
    return found


def _plain(item: Object, divisions: tuple[int, int] | None) -> dict[str, Any] | None:
    geometry = item.geometry
    if isinstance(geometry, rhino.Point):
        return {"kind": "point", "points": _rows([geometry.Location])}
    if isinstance(geometry, rhino.PointCloud):
        return {"kind": "points", "points": _rows(points_in(geometry))}
    if isinstance(geometry, rhino.Mesh):
        mesh = as_mesh(geometry)
        return {"kind": "mesh", "vertices": mesh.vertices, "faces": mesh.faces}
    if isinstance(geometry, rhino.Curve):
        return _curve(geometry)
    if isinstance(geometry, rhino.Extrusion | rhino.Brep | rhino.Surface):
        return {**_surface(geometry), **_meshed(geometry, divisions)}
    return None


def _curve(geometry: Any) -> dict[str, Any] | None:
    nurbs = geometry.ToNurbsCurve()
    if nurbs is None:
        return None
    points, weights = _controls(list(nurbs.Points))
    if nurbs.Degree == 1 and (weights == weights[0]).all():
        return {"kind": "line" if len(points) == 2 else "polyline", "points": points}
    knots = np.array(list(nurbs.Knots), dtype=np.float64)
    return {"kind": "curve", "degree": int(nurbs.Degree), "points": points, "knots": knots, **_rational(weights)}


def _surface(geometry: Any) -> dict[str, Any]:
    """The NURBS form of a surface, or of the one untrimmed face of a Brep."""
    if isinstance(geometry, rhino.Extrusion):
        return {"kind": "brep"}
    if isinstance(geometry, rhino.Brep):
        if len(geometry.Faces) != 1 or is_trimmed(geometry.Faces[0]) or geometry.Faces[0].OrientationIsReversed:
            return {"kind": "brep"}
        geometry = geometry.Faces[0].UnderlyingSurface()
    nurbs = geometry.ToNurbsSurface()
    if nurbs is None:
        return {"kind": "brep"}
    count_u, count_v = nurbs.Points.CountU, nurbs.Points.CountV
    points, weights = _controls([nurbs.Points.GetControlPoint(i, j) for i in range(count_u) for j in range(count_v)])
    return {
        "kind": "surface",
        "degree_u": int(nurbs.Degree(0)),
        "degree_v": int(nurbs.Degree(1)),
        "points": points.reshape(count_u, count_v, 3),
        "knots_u": np.array(list(nurbs.KnotsU), dtype=np.float64),
        "knots_v": np.array(list(nurbs.KnotsV), dtype=np.float64),
        **_rational(weights.reshape(count_u, count_v)),
    }


def _meshed(geometry: Any, divisions: tuple[int, int] | None) -> dict[str, Any]:
    if divisions is None:
        return {}
    try:
        mesh = mesh_faces(geometry, *divisions)
    except InputError as error:
        return {"fault": error.sentence}
    return {"mesh": {"vertices": mesh.vertices, "faces": mesh.faces}}


def _controls(points: Sequence[Any]) -> tuple[Array, Array]:
    """Places `(n, 3)` and weights `(n,)` of control points as rhino3dm has them, multiplied by their weight."""
    four = np.array([[p.X, p.Y, p.Z, p.W] for p in points], dtype=np.float64).reshape(-1, 4)
    return four[:, :3] / four[:, 3:], four[:, 3]


def _rational(weights: Array) -> dict[str, Array]:
    return {} if (weights == 1.0).all() else {"weights": weights}


def _rows(points: Sequence[Any]) -> Array:
    return np.array([[p.X, p.Y, p.Z] for p in points], dtype=np.float64).reshape(-1, 3)
