"""Natives of the tab Surface that need no more than points of surfaces and the parts of Breps."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm


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
    if hasattr(brep, "ToBrep"):
        whole = brep.ToBrep(True)
    faces = [whole.Faces[i].DuplicateFace(False) for i in range(len(whole.Faces))]
    edges = [whole.Edges[i].ToNurbsCurve() for i in range(len(whole.Edges))]
    return faces, edges, [whole.Vertices[i].Location for i in range(len(whole.Vertices))]
