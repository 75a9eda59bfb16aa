"""Subdivision of meshes, as components of Weaverbird do it. Source: Catmull and Clark (1978), Loop (1987)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.meshes import combined, edges, in_place, mesh_join, sides
from hookean_canvas.run.natives.shapes import Array, Faces

MOST = 6  # steps, each of which makes four times as many faces
_INPUTS = "Mesh/Polylines (M/P): mesh; Level (L): integer = 1; Smooth Naked Edges (S): integer = 0"
_REMARK = "naked edges: 0 fixed, 1 smooth, 2 smooth with fixed corners"


@native("", "Weaverbird's Catmull-Clark Subdivision", "wbCatmullClark", _INPUTS, "Output Mesh (O)",
        remark=_REMARK, plugin=True)  # fmt: skip
def catmull_clark_mesh(mesh: Any, level: int, naked: int) -> Any:
    """Quads that tend to a smooth surface."""
    return subdivided(mesh, level, naked, catmull_clark)


@native("", "Weaverbird's Loop Subdivision", "wbLoop", _INPUTS, "Output Mesh (O)",
        remark=_REMARK, plugin=True)  # fmt: skip
def loop_mesh(mesh: Any, level: int, naked: int) -> Any:
    """Triangles that tend to a smooth surface."""
    return subdivided(mesh, level, naked, loop)


@native("", "Weaverbird's Join Meshes and Weld", "wbJoin", "Meshes (M+): mesh list; Weld (W): boolean = True",
        "Mesh (M)", plugin=True)  # fmt: skip
def join_meshes(meshes: list[Any], weld: bool) -> Any:
    """Meshes as one, and vertices in one place made one if wanted."""
    return combined(meshes) if weld else mesh_join(meshes)


def subdivided(mesh: Any, level: int, naked: int, rule: Callable[[Array, Faces], tuple[Array, Faces]]) -> Any:
    """A mesh after steps of a rule; `naked`: 0 keeps those on naked edges, 2 those of one face."""
    if not 0 <= level <= MOST:
        raise Unfit(f"Level must be from 0 to {MOST}")
    vertices, faces = welded(mesh)
    for _ in range(level):
        new, made = rule(vertices, faces)
        fixed = {0: lambda pairs, near: True, 2: lambda pairs, near: near == 1}.get(naked)
        if fixed is not None:
            _fix(new, vertices, faces, fixed)
        vertices, faces = new, made
    return shapes.mesh(vertices, faces)


def _fix(new: Array, vertices: Array, faces: Faces, fixed: Callable[[int, int], bool]) -> None:
    """Put vertices on naked edges back: all, or those of one face only."""
    count = [0] * len(vertices)
    for face in faces:
        for i in face:
            count[i] += 1
    for pair, near in edges(vertices, faces).items():
        for i in pair if len(near) == 1 else ():
            if fixed(len(near), count[i]):
                new[i] = vertices[i]


def welded(mesh: Any) -> tuple[Array, Faces]:
    """Vertices and faces, vertices in one place made one."""
    vertices, faces = shapes.mesh_parts(mesh)
    of = in_place(vertices)
    used = sorted({of[i] for face in faces for i in face})
    number = {i: k for k, i in enumerate(used)}
    return vertices[used], [tuple(number[of[i]] for i in face) for face in faces]


def catmull_clark(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """One step of Catmull and Clark (1978); naked edges become cubic B-splines."""
    at = edges(vertices, faces)
    centres = np.array([vertices[list(face)].mean(axis=0) for face in faces])
    number = {pair: len(vertices) + k for k, pair in enumerate(at)}
    middle = {pair: vertices[list(pair)].mean(axis=0) for pair in at}
    made = [0.5 * middle[p] + 0.5 * centres[f].mean(axis=0) if len(f) == 2 else middle[p] for p, f in at.items()]
    moved = _vertices(vertices, faces, at, centres, middle)
    start = len(vertices) + len(at)
    quads: Faces = []
    for k, face in enumerate(faces):
        ring = [number[min(a, b), max(a, b)] for a, b in sides(face)]
        quads += [(face[i], ring[i], start + k, ring[i - 1]) for i in range(len(face))]
    return np.concatenate([moved, np.array(made).reshape(-1, 3), centres]), quads


def _vertices(vertices: Array, faces: Faces, at: Any, centres: Array, middle: Any) -> Array:
    """New places of the vertices: (F + 2 R + (n - 3) P) / n inside, (a + 6 P + b) / 8 on naked edges."""
    of_faces: list[list[int]] = [[] for _ in vertices]
    for k, face in enumerate(faces):
        for i in face:
            of_faces[i].append(k)
    found = vertices.copy()
    naked: list[list[int]] = [[] for _ in vertices]
    rings: list[list[Array]] = [[] for _ in vertices]
    for (a, b), near in at.items():
        for i, j in ((a, b), (b, a)):
            rings[i].append(middle[a, b])
            if len(near) == 1:
                naked[i].append(j)
    for i, place in enumerate(vertices):
        if len(naked[i]) == 2:
            found[i] = (vertices[naked[i]].sum(axis=0) + 6.0 * place) / 8.0
        elif not naked[i] and of_faces[i]:
            n = len(of_faces[i])
            found[i] = (centres[of_faces[i]].mean(axis=0) + 2.0 * np.mean(rings[i], axis=0) + (n - 3) * place) / n
    return found


def loop(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """One step of Loop (1987) on triangles; naked edges become cubic B-splines. Quads are cut first."""
    cut: Faces = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    at = edges(vertices, cut)
    number = {pair: len(vertices) + k for k, pair in enumerate(at)}
    made, naked, near = [], [[] for _ in vertices], [set() for _ in vertices]  # type: ignore[var-annotated]
    for pair, around in at.items():
        a, b = pair
        near[a].add(b)
        near[b].add(a)
        if len(around) == 2:
            far = [next(i for i in cut[f] if i not in pair) for f in around]
            made.append(0.375 * vertices[list(pair)].sum(axis=0) + 0.125 * vertices[far].sum(axis=0))
        else:
            made.append(0.5 * vertices[list(pair)].sum(axis=0))
            naked[a].append(b)
            naked[b].append(a)
    moved = vertices.copy()
    for i, place in enumerate(vertices):
        if len(naked[i]) == 2:
            moved[i] = 0.75 * place + 0.125 * vertices[naked[i]].sum(axis=0)
        elif not naked[i] and near[i]:
            n = len(near[i])
            beta = (0.625 - (0.375 + 0.25 * math.cos(2.0 * math.pi / n)) ** 2) / n
            moved[i] = (1.0 - n * beta) * place + beta * vertices[sorted(near[i])].sum(axis=0)
    found: Faces = []
    for a, b, c in cut:
        ab, bc, ca = (number[min(p, q), max(p, q)] for p, q in ((a, b), (b, c), (c, a)))
        found += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([moved, np.array(made).reshape(-1, 3)]), found
