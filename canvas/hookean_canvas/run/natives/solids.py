"""Natives that make solids of curves and surfaces: as closed meshes, where they are more than walls."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize.triangulate import triangulate
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import native
from hookean_canvas.run.natives.kinds import as_kind
from hookean_canvas.run.natives.meshes import combined
from hookean_canvas.run.natives.meshes_made import mesh_brep
from hookean_canvas.run.natives.surfaces import ruled_surface
from hookean_canvas.run.rhino import rhino3dm


@native("962034e9-cc27-4394-afc4-5c16e3447cf9", "Extrude", "Extr",
        "Base (B): any; Direction (D): vector", "Extrusion (E)",
        remark="surfaces and Breps become closed meshes")  # fmt: skip
def extrude(base: Any, direction: Any) -> Any:
    """The surface that a curve leaves on its way along a vector; of a surface the solid."""
    if not isinstance(base, (rhino3dm.Brep, rhino3dm.Surface, rhino3dm.Mesh)):
        moved = as_kind("curve", base).ToNurbsCurve()
        moved.Translate(direction)
        return ruled_surface(as_kind("curve", base), moved)
    vertices, faces = shapes.mesh_parts(mesh_brep(base, None))
    count = len(vertices)
    sides = Counter(side for face in faces for side in pairwise([*face, face[0]]))
    walls = [(i, j, j + count, i + count) for i, j in sides if (j, i) not in sides]
    rows = np.concatenate([vertices, vertices + shapes.xyz(direction)])
    made = [tuple(reversed(face)) for face in faces] + [tuple(k + count for k in face) for face in faces]
    return shapes.mesh(rows, [*made, *walls])


@native("b648d933-ddea-4e75-834c-8f6f3793e311", "Cap Holes", "Cap", "Brep (B): faces", "Brep (B)",
        remark="a mesh, where there is a hole")  # fmt: skip
def cap_holes(brep: Any) -> Any:
    """The flat holes of a Brep filled; one without holes as it is."""
    if isinstance(brep, rhino3dm.Brep) and brep.IsSolid:
        return brep
    vertices, faces = shapes.mesh_parts(combined([mesh_brep(brep, None)]))
    sides = {side for face in faces for side in pairwise([*face, face[0]])}
    onward = {j: i for i, j in sides if (j, i) not in sides}
    caps: list[tuple[int, ...]] = []
    while onward:
        ring = [next(iter(onward))]
        while ring[-1] in onward:
            ring.append(onward.pop(ring[-1]))
        rows = vertices[ring[:-1]]
        frame = shapes.fitted_plane(rows)
        flat = shapes.coordinates(frame, rows)
        if ring[0] != ring[-1] or np.abs(flat[:, 2]).max() > 1e-3 * float(np.ptp(rows, axis=0).max()):
            continue
        area = float((flat[:, 0] * np.roll(flat[:, 1], -1) - flat[:, 1] * np.roll(flat[:, 0], -1)).sum())
        cut = triangulate(flat[:, :2], [np.arange(len(rows))])
        caps += [tuple(ring[k] for k in (row if area > 0.0 else row[::-1])) for row in cut.tolist()]
    return shapes.mesh(vertices, [*faces, *caps])
