"""Springs and faces divided into smaller ones, and edges extruded to faces.

Pieces of a spring in a row behave as it did: k and c times the number of pieces, lengths by it (`Force.pieces`). A
quad becomes four and a triangle four; a neighbour that is not divided gets triangles, so that no edge is left open.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import Force, lengths
from hookean.running.drawing.adding import put_faces
from hookean.running.drawing.edits import Divide, Extrude
from hookean.running.drawing.sheet import Cloth, Floats, Ints, Sheet, by_face, columns, remade
from hookean.system.two_ended import spring_ends

Edge = tuple[int, int]


def divide(sheet: Sheet, edit: Divide) -> None:
    """Divide springs, and faces with the springs along their edges. InputError for what cannot be divided."""
    chains: dict[Edge, list[int]] = {}
    pairs, _ = spring_ends(sheet.system)
    for number in sheet.springs(np.asarray(edit.springs), "/divide/springs"):
        force = sheet.scene.forces[number]
        if force.pieces is None:
            raise InputError("/divide/springs", f"{force.called} cannot be divided; divide springs")
    for a, b in pairs[edit.springs].tolist():
        _chain(sheet, chains, a, b, edit.pieces)
    for name, numbers in edit.faces.items():
        _refine(sheet, name, np.asarray(numbers), chains)
    for i, force in enumerate(sheet.scene.forces):
        on_mesh = getattr(force, "mesh", None)
        if force.pieces is None or force.element_arity != 2 or on_mesh in edit.faces:
            continue
        rows = sheet.rows(i)
        inner = [chains.get(_key(a, b), []) for a, b in rows.tolist()]
        if any(inner):
            sheet.forces[i] = _divided(force, rows, inner, f"/forces/{i}")


def extrude(sheet: Sheet, edit: Extrude) -> None:
    """Move edges, and join what is moved to where it was by faces and by springs like those of the edges."""
    edges = np.asarray(edit.edges)
    if edges.ndim != 2 or edges.shape[1] != 2:
        raise InputError("/extrude/edges", f"shape {list(edges.shape)} given; give pairs of particles")
    sheet.exist(edges, "/extrude/edges")
    by = np.asarray(edit.by)
    if not by.any():
        raise InputError("/extrude/by", "has zero length; give the vector by which the edges are moved")
    ends, corner = np.unique(edges, return_inverse=True)
    moved = sheet.new(sheet.start[ends] + by, sheet.now[ends] + by)
    far = moved[corner.reshape(edges.shape)]
    if edit.mesh:
        put_faces(sheet, edit.mesh, np.hstack([edges, far[:, ::-1]]), "/extrude/mesh")
    wanted = {_key(a, b): pair for (a, b), pair in zip(edges.tolist(), far.tolist(), strict=True)}
    rungs = dict(zip(ends.tolist(), moved.tolist(), strict=True))
    for i, force in enumerate(sheet.scene.forces):
        if force.pieces is None or force.role != "internal" or force.element_arity != 2:
            continue
        rows = sheet.rows(i)
        own = [n for n, (a, b) in enumerate(rows.tolist()) if _key(a, b) in wanted]
        if own:
            sheet.forces[i] = _extruded(sheet, force, rows, own, wanted, rungs, f"/forces/{i}")


def _extruded(
    sheet: Sheet, force: Force, rows: Ints, own: list[int], wanted: dict[Edge, Any], rungs: dict[int, int], pointer: str
) -> Force:
    """A force with the lines of moved edges, and with those between their ends; these have the values of a line there.

    A rest length that is given for each line is the start length of new ones times what it is of theirs."""
    source, added = list(own), [wanted[_key(*rows[n].tolist())] for n in own]
    for n in own:
        for end in rows[n].tolist():
            if end in rungs:
                source.append(n)
                added.append([end, rungs.pop(end)])
    fresh = np.array(added)
    values: dict[str, Any] = {n: np.concatenate([v, v[source]]) for n, v in columns(force, len(rows)).items()}
    if "rest_length" in values:
        factor = _lengths(sheet, fresh) / np.maximum(_lengths(sheet, rows[source]), 1e-300)
        values["rest_length"][len(rows) :] *= factor
    return remade(force, pointer, ("edges",), particles=np.concatenate([rows, fresh]), **values)


def _lengths(sheet: Sheet, pairs: Ints) -> Floats:
    return lengths(sheet.start[pairs[:, 1]] - sheet.start[pairs[:, 0]])


def _key(a: int, b: int) -> Edge:
    return (a, b) if a < b else (b, a)


def _chain(sheet: Sheet, chains: dict[Edge, list[int]], a: int, b: int, pieces: int) -> list[int]:
    """The particles that divide a line, from its lower number to the other, made once."""
    key = _key(a, b)
    if key not in chains:
        part = np.arange(1, pieces)[:, None] / pieces
        ends = [(1 - part) * rows[key[0]] + part * rows[key[1]] for rows in (sheet.start, sheet.now)]
        chains[key] = sheet.new(*ends).tolist()
    return chains[key]


def _divided(force: Force, rows: Ints, inner: list[list[int]], pointer: str) -> Force:
    """A force along lines with some of them divided, each in its place."""
    pairs: list[list[int]] = []
    for (a, b), between in zip(rows.tolist(), inner, strict=True):
        through = [a, *(between if a < b else between[::-1]), b]
        pairs += [list(pair) for pair in pairwise(through)]
    pieces = np.array([len(between) + 1 for between in inner])
    source = np.repeat(np.arange(len(rows)), pieces)
    values: dict[str, Any] = {name: column[source] for name, column in columns(force, len(rows)).items()}
    for name, power in (force.pieces or {}).items():
        value = values.get(name, getattr(force, name))
        if value is not None and np.any(value):
            factor = pieces[source].astype(float) ** power
            values[name] = (
                value * factor if len(set(pieces)) > 1 or isinstance(value, np.ndarray) else value * factor[0]
            )
    lines = {"lines", "points"} & set(type(force).model_fields)
    return remade(force, pointer, ("edges", *lines), particles=np.array(pairs), **values)


def _refine(sheet: Sheet, name: str, numbers: Ints, chains: dict[Edge, list[int]]) -> None:
    """Divide faces of a mesh, and its neighbours where they share an edge that is divided."""
    mesh = sheet.mesh(name, f"/divide/faces/{name}")
    if len(numbers) and int(numbers.max()) >= len(mesh.faces):
        said = f"face {int(numbers.max())} does not exist; the mesh has {len(mesh.faces)}, counted from 0"
        raise InputError(f"/divide/faces/{name}", said)
    chosen, corners = set(numbers.tolist()), [_corners(face) for face in mesh.particles[mesh.faces].tolist()]
    halves: dict[Edge, int] = {}
    for number in chosen:
        for a, b in _around(corners[number]):
            chain = _chain(sheet, chains, a, b, 2)
            halves[_key(a, b)] = chain[len(chain) // 2]
    faces: list[list[int]] = []
    parents: list[int] = []
    for number, face in enumerate(corners):
        found = _quartered(sheet, face, halves) if number in chosen else _closed(face, halves)
        faces += [[*part, part[-1]] if len(part) == 3 else part for part in found]
        parents += [number] * len(found)
    for i, force in enumerate(sheet.scene.forces):
        if getattr(force, "mesh", None) == name:
            sheet.forces[i] = _followed(force, mesh, parents, f"/forces/{i}")
    mesh.faces = np.zeros((0, 4), np.int64)
    put_faces(sheet, name, np.array(faces), f"/divide/faces/{name}")


def _followed(force: Force, mesh: Cloth, parents: list[int], pointer: str) -> Force:
    """A force on a mesh whose faces are divided: each part has the values of its face."""
    count = len(mesh.faces)
    each = columns(force, len(mesh.particles) if force.element_arity == 1 else count)
    if force.element_arity <= 2 and each or getattr(force, "shape", None) is not None:
        raise InputError(pointer, "it has a value for each vertex or edge of the mesh; give one value for all first")
    values: dict[str, Any] = {name: column[parents] for name, column in {**each, **by_face(force, count)}.items()}
    return remade(force, pointer, mesh=force.mesh, **values) if values else force  # type: ignore[attr-defined]


def _corners(face: list[int]) -> list[int]:
    """The corners of a face, each once."""
    return list(dict.fromkeys(face))


def _around(face: list[int]) -> Iterable[Edge]:
    return zip(face, [*face[1:], face[0]], strict=True)


def _quartered(sheet: Sheet, face: list[int], halves: dict[Edge, int]) -> list[list[int]]:
    """Four quads about the middle of a quad; of a triangle those at its corners, and the one between."""
    middle = [halves[_key(a, b)] for a, b in _around(face)]
    if len(face) == 3:
        corners = [[face[i], middle[i], middle[i - 1]] for i in range(3)]
        return [*corners, middle]
    centre = int(sheet.new(*(rows[face].mean(axis=0)[None] for rows in (sheet.start, sheet.now)))[0])
    return [[face[i], middle[i], centre, middle[i - 1]] for i in range(4)]


def _closed(face: list[int], halves: dict[Edge, int]) -> list[list[int]]:
    """A face whose neighbours are divided: triangles about the middle of its first divided edge, without any its own
    self."""
    outline: list[int] = []
    for a, b in _around(face):
        outline += [a, *([halves[_key(a, b)]] if _key(a, b) in halves else [])]
    if len(outline) == len(face):
        return [face]
    first = next(i for i, corner in enumerate(outline) if corner not in face)
    turned = outline[first:] + outline[:first]
    return [[turned[0], turned[i], turned[i + 1]] for i in range(1, len(turned) - 1)]
