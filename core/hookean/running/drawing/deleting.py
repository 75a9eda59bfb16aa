"""What is deleted: particles with all elements on them, springs, faces. Numbers of what stays close up."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces.base import PLACES, Force
from hookean.running.drawing.edits import Delete
from hookean.running.drawing.sheet import Cloth, Ints, Sheet, by_face, columns, remade
from hookean.scene.scene import Anchor, Geometry

Mask = NDArray[np.bool_]


def delete(sheet: Sheet, edit: Delete) -> None:
    """Take it out of the model. InputError for what does not exist or cannot be deleted alone."""
    sheet.exist(edit.particles, "/delete/particles")
    gone = np.zeros(sheet.count, bool)
    gone[edit.particles] = True
    springs = sheet.springs(np.asarray(edit.springs), "/delete/springs")
    meshes = _meshes(sheet, gone, {name: np.asarray(faces) for name, faces in edit.faces.items()})
    number = np.cumsum(~gone) - 1
    for i, force in enumerate(sheet.scene.forces):
        mesh = getattr(force, "mesh", None)
        lines = mesh is not None and force.element_arity == 2
        if mesh is not None and not (lines and (i in springs or columns(force, len(sheet.rows(i))))):
            sheet.forces[i] = _on_mesh(force, mesh, meshes.get(mesh), f"/forces/{i}")
        elif any(getattr(force, place, None) is not None for place in PLACES):
            sheet.forces[i] = _thinned(force, sheet.rows(i), gone, springs.get(i), number, f"/forces/{i}")
    sheet.anchors = [_held(sheet, anchor, gone, number) for anchor in sheet.scene.anchors]
    sheet.geometry = [_carried(item, gone, number, sheet) for item in sheet.scene.geometry]
    sheet.start, sheet.now, sheet.same = sheet.start[~gone], sheet.now[~gone], sheet.same[~gone]
    for mesh in sheet.meshes.values():
        mesh.particles = number[mesh.particles]


def _meshes(sheet: Sheet, gone: Mask, given: Mapping[str, Ints]) -> dict[str, tuple[Mask, Mask]]:
    """Thin the meshes; for each that changes, which vertices and faces of it stay."""
    found: dict[str, tuple[Mask, Mask]] = {}
    for name in given:
        sheet.mesh(name, f"/delete/faces/{name}")
    for name in sheet.scene.meshes:
        particles = sheet.system.places.vertices(name)
        touched = (particles >= 0) & gone[particles]
        if name not in given and not touched.any():
            continue
        mesh: Cloth = sheet.mesh(name, f"/meshes/{name}")
        numbers = np.asarray(given.get(name, np.zeros(0, np.int64)))
        if len(numbers) and int(numbers.max()) >= len(mesh.faces):
            said = f"face {int(numbers.max())} does not exist; the mesh has {len(mesh.faces)}, counted from 0"
            raise InputError(f"/delete/faces/{name}", said)
        stays: Mask = np.logical_not(touched[mesh.faces].any(axis=1))
        stays[numbers] = False
        used, faces = np.zeros(len(particles), bool), mesh.faces[stays]
        used[faces] = True
        was = np.zeros(len(particles), bool)
        was[mesh.faces] = True
        used |= ~was & ~touched  # a vertex that was in no face stays
        mesh.faces = (np.cumsum(used) - 1)[faces]
        mesh.particles, mesh.vertices = mesh.particles[used], mesh.vertices[used]
        found[name] = used, stays
    return found


def _on_mesh(force: Force, mesh: str, kept: tuple[Mask, Mask] | None, pointer: str) -> Force | None:
    """A force on a mesh, with the values of the vertices or faces that stay."""
    if kept is None:
        return force
    vertices, faces = kept
    if not faces.any():
        return None
    stays = vertices if force.element_arity == 1 else faces
    values: dict[str, Any] = {name: column[stays] for name, column in columns(force, len(stays)).items()}
    values |= {name: rows[faces] for name, rows in by_face(force, len(faces)).items()}
    shape = getattr(force, "shape", None)  # in which a membrane is made, by vertices
    if isinstance(shape, np.ndarray):
        values["shape"] = shape[vertices]
    return remade(force, pointer, mesh=mesh, **values) if values else force


def _thinned(force: Force, rows: Ints, gone: Mask, springs: Ints | None, number: Ints, pointer: str) -> Force | None:
    """A force by numbers, without its elements on particles that are gone and without some rows."""
    stays: Mask = np.logical_not((gone[rows] & (rows >= 0)).any(axis=1))
    if springs is not None:
        stays[springs] = False
    if not stays.any() and len(rows):
        return None
    place = next(name for name in PLACES if getattr(force, name, None) is not None)
    if stays.all() and place != "particles":
        return force
    values: dict[str, Any] = {name: column[stays] for name, column in columns(force, len(rows)).items()}
    if place in ("points", "lines"):
        return remade(force, pointer, **{place: getattr(force, place)[stays]}, **values)
    left = number[rows[stays]]
    flat = place == "particles" and force.particles.ndim == 1  # type: ignore[attr-defined]
    return remade(force, pointer, ("edges",), particles=left.ravel() if flat else left, **values)


def _held(sheet: Sheet, anchor: Anchor, gone: Mask, number: Ints) -> Anchor | None:
    """An anchor without the particles that are gone."""
    given = anchor.particles
    particles = sheet.system.places.meet(np.asarray(anchor.points)) if given is None else np.asarray(given)
    stays = ~(gone[particles] & (particles >= 0))
    if not stays.any():
        return None
    values: dict[str, Any] = {} if anchor.targets is None else {"targets": np.asarray(anchor.targets)[stays]}
    if given is None:
        return anchor.replaced(points=np.asarray(anchor.points)[stays], **values)
    return anchor.replaced(particles=number[particles[stays]], **values)


def _carried(item: Geometry, gone: Mask, number: Ints, sheet: Sheet) -> Geometry | None:
    """Carried geometry, or None where a particle that it goes through is gone."""
    if item.mesh is not None and item.mesh in sheet.meshes and not len(sheet.meshes[item.mesh].faces):
        return None
    if item.particles is None:
        return item
    particles = np.asarray(item.particles)
    if not gone[particles].any():
        return item.replaced(particles=number[particles])
    if item.kind == "lines":
        pairs = particles.reshape(-1, 2)
        left = pairs[~gone[pairs].any(axis=1)].ravel()
    else:
        left = particles[~gone[particles]] if item.kind == "points" else np.zeros(0, np.int64)
    return item.replaced(particles=number[left]) if len(left) else None
