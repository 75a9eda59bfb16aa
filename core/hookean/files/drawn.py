"""What is drawn in a file that names no forces: a scene by the convention for .3dm files without such layers.

Lines become springs (1000 N/m, as long as drawn), meshes membranes: springs of rest factor 0 along their edges. Points
are anchors; where there are none, loose ends of lines and naked vertices of meshes are held.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.duplicates import unique_points
from hookean.discretize.meshes import edges, naked_vertices, tidy_faces
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from hookean.values.units import METRES

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_PARTS = 20  # meshes, or bundles of lines, that become forces of their own
WELD = (1e-3, 1e-5)  # what is nearer than this, in m and as part of the size, is one particle


@dataclass
class Drawn:
    """Meshes, lines `(m, 2, 3)` and points `(n, 3)` by the names they had (may be ""), in `unit`, which the file states
    (`stated`) or not; `warnings`: what of the file was not read."""

    meshes: list[tuple[str, Mesh]] = field(default_factory=list)
    lines: list[tuple[str, Floats]] = field(default_factory=list)
    points: list[tuple[str, Floats]] = field(default_factory=list)
    unit: str = "m"
    stated: bool = False
    warnings: list[str] = field(default_factory=list)


def tables_of(drawn: Drawn) -> tuple[dict[str, Any], list[str], str]:
    """The scene in m, N and s as plain values, warnings, and a sentence where nothing at all is held. InputError where
    there is nothing to relax."""
    if not drawn.meshes and not drawn.lines:
        raise InputError("", "has no lines or faces, so it cannot be relaxed")
    warnings = list(drawn.warnings)
    factor = METRES[drawn.unit]
    every = [m.vertices for _, m in drawn.meshes] + [p.reshape(-1, 3) for _, p in (*drawn.lines, *drawn.points)]
    size = float(np.ptp(np.concatenate(every), axis=0).max()) * factor
    weld = float(f"{max(min(WELD[0], WELD[1] * size), 1e-12):.3g}")
    meshes = _apart([(name, Mesh(m.vertices * factor, m.faces)) for name, m in drawn.meshes], weld)
    lines = [(name, ends * factor) for name, ends in _few(drawn.lines)]
    points = [(name, p * factor) for name, p in _few(drawn.points)]
    anchors = [_anchor(name or "points", p, weld) for name, p in points]
    loose: list[str] = []
    if not anchors:
        anchors = _held(meshes, lines, weld, loose)
    tables = _tables(meshes, lines, anchors, weld)
    return (tables, warnings + loose, "") if anchors else (tables, warnings, "; ".join(loose))


def _tables(
    meshes: list[tuple[str, Mesh]], lines: list[tuple[str, Floats]], anchors: list[dict[str, Any]], weld: float
) -> dict[str, Any]:
    """The scene as plain tables; forces have names of their own."""
    # points are anchors by guess, and these files cannot set strict: one that meets no particle is a warning
    scene: dict[str, Any] = {"weld_tolerance": weld, "strict": False, "meshes": {}, "forces": [], "geometry": []}
    scene["anchors"] = anchors
    used: set[str] = set()
    for name, mesh in meshes:
        called = _unused(name or "membrane", used)
        scene["meshes"][called] = {"vertices": mesh.vertices, "faces": mesh.faces}
        scene["forces"].append({"kind": "springs", "name": called, "mesh": called, "rest_factor": 0.0})
        scene["geometry"].append({"kind": "mesh", "name": called, "mesh": called})
    for name, ends in lines:
        scene["forces"].append({"kind": "springs", "name": _unused(name or "springs", used), "lines": ends})
    return scene


def _apart(meshes: list[tuple[str, Mesh]], weld: float) -> list[tuple[str, Mesh]]:
    """Meshes welded, those that share edges as one: a seam is neither an end of them nor twice as stiff."""
    if not meshes:
        return []
    starts = np.cumsum([0, *(len(m.vertices) for _, m in meshes)])
    vertices = np.concatenate([m.vertices for _, m in meshes])
    kept, place = unique_points(vertices, weld)
    vertices = vertices[kept]
    parts = [Mesh(vertices, tidy_faces(place[m.faces + start])) for (_, m), start in zip(meshes, starts, strict=False)]
    whole = _together(parts) if len(parts) <= MOST_PARTS else np.zeros(len(parts), np.int64)
    found = []
    for number in range(int(whole.max()) + 1):
        mine = np.flatnonzero(whole == number)
        faces = np.concatenate([parts[i].faces for i in mine])
        if len(faces):
            used, renumbered = np.unique(faces, return_inverse=True)
            name = next((meshes[i][0] for i in mine if meshes[i][0]), "")
            found.append((name, Mesh(vertices[used], renumbered.reshape(faces.shape))))
    return found


def _together(parts: list[Mesh]) -> Ints:
    """The number of the whole that each part belongs to, by the edges they share."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    sides = [edges(part) for part in parts]
    owner = np.repeat(np.arange(len(parts)), [len(s) for s in sides])
    _, edge = np.unique(np.concatenate(sides), axis=0, return_inverse=True)
    shape = (len(parts), int(edge.max(initial=-1)) + 1)
    meets = coo_array((np.ones(len(owner), np.int64), (owner, edge.ravel())), shape=shape).tocsr()
    _, number = connected_components(meets @ meets.T, directed=False)
    return np.asarray(number, np.int64)


def _held(
    meshes: list[tuple[str, Mesh]], lines: list[tuple[str, Floats]], weld: float, loose: list[str]
) -> list[dict[str, Any]]:
    """Loose ends and naked vertices as anchors; a sentence for what has none goes to `loose`."""
    anchors: list[dict[str, Any]] = []
    if lines:
        ends = np.concatenate([piece for _, piece in lines]).reshape(-1, 3)
        kept, place = unique_points(ends, weld)
        alone = ends[kept][np.bincount(place, minlength=len(kept)) == 1]
        if len(alone):
            anchors.append({"name": "loose ends", "points": alone})
        elif not meshes:
            loose.append("no line has a loose end, so nothing is held: pin something, or it shrinks")
    naked = []
    for name, mesh in meshes:
        rim = naked_vertices(mesh)
        naked.append(mesh.vertices[rim])
        if not len(rim):
            loose.append(f"{name or 'the mesh'} is closed, so nothing of it is held: pin some of it, or it shrinks")
    if sum(map(len, naked)):
        anchors.append(_anchor("naked vertices", np.concatenate(naked), weld))
    return anchors


def _anchor(name: str, points: Floats, weld: float) -> dict[str, Any]:
    return {"name": name, "points": points[unique_points(points, weld)[0]]}


def _few(parts: list[tuple[str, Floats]]) -> list[tuple[str, Floats]]:
    """Parts of one name as one; where there are very many names, all of them."""
    names = dict.fromkeys(name for name, _ in parts)
    if len(names) > MOST_PARTS:
        return [("", np.concatenate([part for _, part in parts]))]
    return [(name, np.concatenate([part for other, part in parts if other == name])) for name in names]


def _unused(name: str, used: set[str]) -> str:
    """A name that no other has: such as `roof`, `roof/2`."""
    called = next(c for c in (name, *(f"{name}/{i}" for i in range(2, len(used) + 3))) if c not in used)
    used.add(called)
    return called
