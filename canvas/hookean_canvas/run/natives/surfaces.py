"""Natives of the tab Surface that need no more than points of surfaces, parts of Breps, and straight lines."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

AROUND, ALONG = 12, 50  # sides of a pipe, and pieces of a curve
SHARPEST = 1e-3  # of 2: below it a polyline turns back


@native("5106bafc-d5d4-4983-83e7-7be3ed07f502", "Divide Surface", "SDivide",
        "Surface (S): surface; U Count (U): integer = 10; V Count (V): integer = 10",
        "Points (P): branches; Normals (N): branches; Parameters (uv): branches")  # fmt: skip
def divide_surface(surface: Any, nu: int, nv: int) -> tuple[list[list[Any]], ...]:
    """Points at even steps of the parameters of a surface, normals and parameters, a branch for each step of u."""
    if min(nu, nv) < 1:
        raise Unfit("U Count and V Count must be at least 1")
    bounded(nu * nv)
    (u0, u1), (v0, v1) = ((domain.T0, domain.T1) for domain in (surface.Domain(0), surface.Domain(1)))
    at = [[(u, v) for v in np.linspace(v0, v1, nv + 1).tolist()] for u in np.linspace(u0, u1, nu + 1).tolist()]
    return (
        [[surface.PointAt(u, v) for u, v in row] for row in at],
        [[surface.NormalAt(u, v) for u, v in row] for row in at],
        [[rhino3dm.Point3d(u, v, 0.0) for u, v in row] for row in at],
    )


@native("8d372bdc-9800-45e9-8a26-6e33c5253e21", "Deconstruct Brep", "DeBrep",
        "Brep (B): brep", "Faces (F): list; Edges (E): list; Vertices (V): list")  # fmt: skip
def deconstruct_brep(brep: Any) -> tuple[list[Any], list[Any], list[Any]]:
    """The faces, the edges and the vertices of a Brep."""
    whole = brep if isinstance(brep, rhino3dm.Brep) else rhino3dm.Brep.CreateFromSurface(brep)
    if hasattr(brep, "ProfileCount"):
        whole = brep.ToBrep(True)
    faces = [whole.Faces[i].DuplicateFace(False) for i in range(len(whole.Faces))]
    edges = [whole.Edges[i].ToNurbsCurve() for i in range(len(whole.Edges))]
    return faces, edges, [whole.Vertices[i].Location for i in range(len(whole.Vertices))]


@native("6e5de495-ba76-42d0-9985-a5c265e9aeca", "Ruled Surface", "RuleSrf",
        "Curve A (A): curve; Curve B (B): curve", "Surface (S)")  # fmt: skip
def ruled_surface(a: Any, b: Any) -> Any:
    """The surface of straight lines between two curves."""
    found = rhino3dm.NurbsSurface.CreateRuledSurface(a, b)
    if found is None:
        raise Unfit("no surface can be made between these curves")
    return found


@native("d51e9b65-aa4e-4fd6-976c-cef35d421d05", "Boundary Surfaces", "Boundary",
        "Edges (E): curve list", "Surfaces (S): list",
        remark="one surface for each closed curve: curves within others cut no holes, and are not joined")  # fmt: skip
def boundary_surfaces(edges: list[Any]) -> list[Any]:
    """The plane within each closed planar curve; four straight sides are those of a surface."""
    return [_within(edge) for edge in edges if edge is not None]


def _within(edge: Any) -> Any:
    if not edge.IsClosed or not edge.IsPlanar():
        raise Unfit("an edge is not closed or not planar")
    at = shapes.corners(edge)
    if at is not None and len(at) == 5 and _convex(at[:4]):
        a, b, c, d = shapes.points(at[:4])
        return ruled_surface(rhino3dm.LineCurve(a, b), rhino3dm.LineCurve(d, c))
    places = at if at is not None else np.array(arc_lengths.divide(edge, ALONG))
    found = rhino3dm.Brep.CreateTrimmedPlane(shapes.fitted_plane(places), edge)
    if found is None:
        raise Unfit("no surface can be made within this curve")
    return found


def _convex(at: shapes.Array) -> bool:
    sides = np.roll(at, -1, axis=0) - at
    turns = np.cross(sides, np.roll(sides, -1, axis=0))
    return bool((turns @ turns.sum(axis=0) > 0.0).all())


@native("a7a41d0a-2188-4f7a-82cc-1a2c4e4ec850", "Loft", "Loft",
        "Curves (C): curve list; Options (O): any optional", "Loft (L): list",
        remark="straight between one curve and the next, whatever the options")  # fmt: skip
def loft(curves: list[Any], options: Any) -> list[Any]:
    """A surface between each curve and the next one."""
    given = [curve for curve in curves if curve is not None]
    if len(given) < 2:
        raise Unfit("two curves or more are needed")
    return [ruled_surface(a, b) for a, b in pairwise(given)]


@native("c277f778-6fdf-4890-8f78-347efb23c406", "Pipe", "Pipe",
        "Curve (C): curve; Radius (R): number = 1.0; Caps (E): integer = 0", "Pipe (P)",
        remark=f"a mesh of {AROUND} sides; curves are cut into {ALONG} pieces; caps are flat")  # fmt: skip
def pipe(curve: Any, radius: float, caps: int) -> Any:
    """A pipe of a radius round a curve: each piece is a prism, and two meet in the plane that halves their angle."""
    if not radius > 0.0:
        raise Unfit("the radius must be positive")
    at = shapes.corners(curve)
    if at is None:
        at = np.array(arc_lengths.divide(curve, ALONG))
    at = at[np.append(True, np.linalg.norm(np.diff(at, axis=0), axis=1) > 0.0)]
    if len(at) < 2:
        raise Unfit("the curve has no length")
    rings = _rings(at, radius)
    sides = [(i, (i + 1) % AROUND) for i in range(AROUND)]
    starts = range(0, AROUND * (len(at) - 1), AROUND)
    faces: shapes.Faces = [(k + i, k + j, k + AROUND + j, k + AROUND + i) for k in starts for i, j in sides]
    places, end = rings.reshape(-1, 3), AROUND * (len(at) - 1)
    if caps and (at[0] - at[-1]).any():
        faces += [(j, i, len(places)) for i, j in sides]
        faces += [(end + i, end + j, len(places) + 1) for i, j in sides]
        places = np.concatenate([places, at[:1], at[-1:]])
    return shapes.mesh(places, faces)


def _rings(at: shapes.Array, radius: float) -> shapes.Array:
    """Corners (n, AROUND, 3) of the prisms round a polyline (n, 3), ring by ring along its pieces."""
    ways = np.array([shapes.unit(step) for step in np.diff(at, axis=0)])
    closed = not (at[0] - at[-1]).any()
    before = np.concatenate([ways[-1:] if closed else ways[:1], ways])
    after = np.concatenate([ways, ways[:1] if closed else ways[-1:]])
    across = np.eye(3)[np.abs(ways[0]).argmin()]
    x = shapes.unit(np.cross(ways[0], across))
    turn = 2.0 * np.pi * np.arange(AROUND)[:, None] / AROUND
    ring = at[0] + radius * (np.cos(turn) * x + np.sin(turn) * np.cross(ways[0], x))
    found = []
    for place, way, one, other in zip(at, [ways[0], *ways], before, after, strict=True):
        normal = one + other
        if float(normal @ way) < SHARPEST:
            raise Unfit("the curve turns back on itself")
        ring = ring + ((place - ring) @ normal / (way @ normal))[:, None] * way
        found.append(ring)
    return np.array(found)
