"""Natives about the edges and the control points of surfaces, and the pieces of polylines."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import segments
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

PIECES = 32  # flat quads along each edge of a surface between curved edges


@native("0148a65d-6f42-414a-9db7-9a9b2eb78437", "Brep Edges", "Edges",
        "Brep (B): brep", "Naked (En): list; Interior (Ei): list; Non-Manifold (Em): list")  # fmt: skip
def brep_edges(brep: Any) -> tuple[list[Any], list[Any], list[Any]]:
    """The edges of a Brep: those of one face, of two, and of more; the seam of a closed face is of two."""
    whole = brep if isinstance(brep, rhino3dm.Brep) else rhino3dm.Brep.CreateFromSurface(brep)
    if hasattr(brep, "ToBrep"):
        whole = brep.ToBrep(True)
    faces = [whole.Faces[i] for i in range(len(whole.Faces))]
    loops = [face.Loops[i] for face in faces for i in range(len(face.Loops))]
    uses = Counter(loop.Trims[i].EdgeIndex for loop in loops for i in range(loop.TrimCount))
    edges = [(whole.Edges[i].ToNurbsCurve(), uses[i]) for i in range(len(whole.Edges))]
    return (
        [edge for edge, count in edges if count == 1],
        [edge for edge, count in edges if count == 2],
        [edge for edge, count in edges if count > 2],
    )


@native("36132830-e2ef-4476-8ea1-6a43922344f0", "Edge Surface", "EdgeSrf",
        "Curve A (A): curve; Curve B (B): curve; Curve C (C): curve optional; Curve D (D): curve optional",
        "Surface (S)",
        remark=f"Coons' surface, in {PIECES} by {PIECES} quads where an edge is curved")  # fmt: skip
def edge_surface(a: Any, b: Any, c: Any, d: Any) -> Any:
    """The surface between two, three or four edges that meet at their ends, in whatever order and direction."""
    given = [edge for edge in (a, b, c, d) if edge is not None]
    if len(given) == 2:
        found = rhino3dm.NurbsSurface.CreateRuledSurface(given[0], given[1])
        if found is None:
            raise Unfit("no surface can be made between these curves")
        return found
    straight = all(edge.IsLinear() for edge in given)
    steps = 1 if straight else PIECES
    sides = _round([_places(edge, steps) for edge in given])
    if len(sides) == 3:
        sides.append(np.repeat(sides[0][:1], steps + 1, axis=0))
    return _grid(_coons(sides[0], sides[1], sides[2][::-1], sides[3][::-1]))


def _places(edge: Any, steps: int) -> shapes.Array:
    first, last = edge.Domain.T0, edge.Domain.T1
    return shapes.rows(edge.PointAt(t) for t in np.linspace(first, last, steps + 1).tolist())


def _round(edges: list[shapes.Array]) -> list[shapes.Array]:
    """Edges each of which starts where the one before ends; Unfit where they do not meet."""
    size = max(float(np.ptp(np.vstack(edges), axis=0).max()), 1e-12)
    found, left = [edges[0]], edges[1:]
    while left:
        at = found[-1][-1]
        near, number, turned = min(
            (float(np.linalg.norm(edge[-1 if turned else 0] - at)), i, turned)
            for i, edge in enumerate(left)
            for turned in (False, True)
        )
        if near > 1e-3 * size:
            raise Unfit("the edges do not meet at their ends")
        found.append(left[number][::-1] if turned else left[number])
        del left[number]
    if np.linalg.norm(found[-1][-1] - found[0][0]) > 1e-3 * size:
        raise Unfit("the edges do not meet at their ends")
    return found


def _coons(bottom: shapes.Array, right: shapes.Array, top: shapes.Array, left: shapes.Array) -> shapes.Array:
    """Points [i, j] of Coons' surface: u along bottom and top, v along left and right (Coons 1967)."""
    u = np.linspace(0.0, 1.0, len(bottom))[:, None, None]
    v = np.linspace(0.0, 1.0, len(left))[None, :, None]
    ruled = (1 - v) * bottom[:, None] + v * top[:, None] + (1 - u) * left[None] + u * right[None]
    corners = (1 - u) * ((1 - v) * bottom[0] + v * top[0]) + u * ((1 - v) * bottom[-1] + v * top[-1])
    found: shapes.Array = ruled - corners
    return found


def _grid(places: shapes.Array) -> Any:
    """The surface of degree 1 through a grid of points."""
    nu, nv = places.shape[:2]
    found = rhino3dm.NurbsSurface.Create(3, False, 2, 2, nu, nv)
    for knots, count in ((found.KnotsU, nu), (found.KnotsV, nv)):
        for i in range(count):
            knots[i] = i / (count - 1)
    for i in range(nu):
        for j in range(nv):
            found.Points[i, j] = rhino3dm.Point4d(*places[i, j].tolist(), 1.0)
    return found


@native("15128198-399d-4d6c-9586-1f65db3ce7bf", "Surface Points", "SrfPt",
        "Surface (S): surface",
        "Points (P): list; Weights (W): list; Greville (G): list; U Count (U); V Count (V)")  # fmt: skip
def surface_points(surface: Any) -> tuple[list[Any], list[float], list[Any], int, int]:
    """The control points of a surface, a row along v for each u, their weights and Greville parameters."""
    form = surface.ToNurbsSurface()
    nu, nv = form.Points.CountU, form.Points.CountV
    bounded(nu * nv)
    held = [form.Points.GetControlPoint(i, j) for i in range(nu) for j in range(nv)]
    weights = [float(one.W) for one in held]
    at = [_greville(knots, degree, n) for knots, degree, n in (
        (form.KnotsU, form.Degree(0), nu), (form.KnotsV, form.Degree(1), nv)
    )]  # fmt: skip
    points = [rhino3dm.Point3d(one.X / w, one.Y / w, one.Z / w) for one, w in zip(held, weights, strict=True)]
    return points, weights, [rhino3dm.Point3d(u, v, 0.0) for u in at[0] for v in at[1]], nu, nv


def _greville(knots: Any, degree: int, count: int) -> list[float]:
    return [sum(knots[i + k] for k in range(degree)) / degree for i in range(count)]


@native("f88a6cd9-1035-4361-b896-4f2dfe79272d", "Segment Lengths", "LenSeg", "Curve (C): curve",
        "Shortest Length (Sl); Shortest Domain (Sd); Longest Length (Ll); Longest Domain (Ld)",
        remark="domains are those of a parameter that grows by 1 on each segment")  # fmt: skip
def segment_lengths(curve: Any) -> tuple[float, Any, float, Any]:
    """The shortest and the longest piece of a polyline or joined curve: their lengths and domains."""
    lengths = [float(arc_lengths.length(piece)) for piece in segments(curve)]
    short, long = int(np.argmin(lengths)), int(np.argmax(lengths))
    return lengths[short], rhino3dm.Interval(short, short + 1), lengths[long], rhino3dm.Interval(long, long + 1)


@native("04887d01-504c-480e-b2a2-01ea19cc5922", "Text Split", "Split",
        "Text (T): text; Separators (C): text = ','", "Result (R): list")  # fmt: skip
def text_split(text: str, separators: str) -> list[str]:
    """The parts of a text between separators, each of which is one character; without empty ones."""
    for mark in separators[1:]:
        text = text.replace(mark, separators[0])
    return [part for part in (text.split(separators[0]) if separators else [text]) if part]


@native("e521f7c8-92f4-481c-888b-eea109e3d6e9", "Rectangular Array", "ArrRec",
        "Geometry (G): geometry; Cell (C): curve; X Count (X): integer = 3; Y Count (Y): integer = 3",
        "Geometry (G): list; Transform (X): list")  # fmt: skip
def rectangular_array(geometry: Any, cell: Any, nx: int, ny: int) -> tuple[list[Any], list[Any]]:
    """Copies of geometry at steps of the sides of a rectangle, the first one in place; x runs first."""
    if min(nx, ny) < 1:
        raise Unfit("X Count and Y Count must be at least 1")
    bounded(nx * ny)
    found = shapes.rectangle(cell)
    if found is None:
        raise Unfit("Cell is not a rectangle")
    frame, width, height = found
    _, x, y, _ = shapes.axes(frame)
    steps = [i * width * x + j * height * y for j in range(ny) for i in range(nx)]
    changes = [rhino3dm.Transform.Translation(*step.tolist()) for step in steps]
    return [shapes.transformed(geometry, change) for change in changes], changes
