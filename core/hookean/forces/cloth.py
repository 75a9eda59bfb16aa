"""What a membrane is made of, and which way its warp runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import Floats, Ints, Places, units
from hookean.values.columns import fault

if TYPE_CHECKING:
    from hookean.forces.membrane import Membrane
    from hookean.scene.load_cases import ElasticCloth

STIFFNESSES = ("warp_stiffness", "weft_stiffness", "shear_stiffness", "poisson")
ALIKE = 1e-9  # part by which an isotropic cloth may differ with direction


def one_way(force: Membrane | ElasticCloth) -> None:
    """A fault unless the stiffness and the warp are each given in one way."""
    own = [name for name in STIFFNESSES if getattr(force, name) is not None]
    if force.material is not None and own:
        raise fault(f"material and {own[0]} given; give either a material, or warp_stiffness with what belongs to it")
    if force.material is None and force.warp_stiffness is None:
        raise fault("its stiffness is missing; give either material or warp_stiffness")
    if force.material is None and force.thickness is not None:
        raise fault("thickness given without a material; warp_stiffness is per width already", "/thickness")
    if force.warp is not None and force.warp_lines is not None:
        raise fault("warp and warp_lines given; give at most one of them")
    if force.warp_lines is not None and not len(force.warp_lines):
        raise fault("no line given; give at least one", "/warp_lines")
    if force.material is None:
        _possible(filled(*(getattr(force, name) for name in STIFFNESSES)))


def filled(warp: Any, weft: Any, shear: Any, poisson: Any) -> tuple[float, float, float, float]:
    """Ew, Ef, G and nu, with their defaults where they are None."""
    weft, poisson = warp if weft is None else weft, 0.0 if poisson is None else poisson
    if shear is None:
        mean = np.sqrt(warp * weft)
        shear = mean / (2.0 * (1.0 + poisson * mean / warp))
    return float(warp), float(weft), float(shear), float(poisson)


def _possible(cloth: tuple[float, float, float, float]) -> None:
    warp, weft, _, poisson = cloth
    if not poisson**2 * weft < warp or cloth[2] <= 0.0:
        most = np.sqrt(warp / weft)
        raise fault(f"{poisson:g} given; between -{most:.4g} and {most:.4g} allowed with these stiffnesses", "/poisson")


def numbers(force: Membrane, places: Places) -> tuple[float, float, float, float]:
    """Ew, Ef, G [force/length] and nu [-] of a membrane; InputError where its material does not have them."""
    if force.material is None:
        return filled(*(getattr(force, name) for name in STIFFNESSES))
    material = places.material(force.material)
    if material.warp_stiffness is not None:
        if force.thickness is not None:
            raise InputError("", f"{force.material} is a cloth, whose stiffness is per width; remove thickness")
        return filled(*(getattr(material, name) for name in STIFFNESSES))
    if force.thickness is None:
        raise InputError("", f"{force.material} is a solid; give the thickness of the membrane")
    stiff = material.modulus(force.material) * force.thickness
    return filled(stiff, None, None, material.contraction(force.material))


def made(force: Membrane, places: Places) -> tuple[Floats, Ints]:
    """Points (n, 3) [length] and faces (m, 4) of the shape that has the prestress: the start, or `shape`."""
    faces = places.faces(force.mesh)
    if force.shape is None:
        return places.x, faces
    vertices, own = places.geometry(force.mesh)
    if len(force.shape) != len(vertices):
        said = f"{len(force.shape)} points of shape for a mesh of {len(vertices)} vertices; give one for each vertex"
        raise InputError("", said)
    triangles = faces[:, 2] == faces[:, 3]
    return force.shape, np.column_stack([own[:, :3], np.where(triangles, own[:, 2], own[:, 3])])


def stresses(force: Membrane, face: Ints, faces: int) -> Floats:
    """Stress (m, 3) [force/length] at the start of the triangles of these faces (m,)."""
    rows = np.atleast_2d(force.prestress)
    if len(rows) == 1:
        return np.broadcast_to(rows, (len(face), 3))
    if len(rows) == len(face):
        return rows
    if len(rows) == faces:
        return rows[face]
    said = f"{len(rows)} stresses for {faces} faces of {len(face)} triangles; give one, or one for each"
    raise InputError("", said)


def grain(force: Membrane, x: Floats, faces: Ints, cloth: tuple[float, float, float, float], places: Places) -> Floats:
    """Direction of the warp (m, 3) in every face of a shape with points (n, 3); InputError where it has none."""
    corners = x[faces]
    if force.warp is not None:
        given = np.atleast_2d(force.warp)
        if len(given) not in (1, len(faces)):
            raise InputError("", f"{len(given)} directions of warp for {len(faces)} faces; give one, or one for each")
        return _along(units(np.broadcast_to(given, (len(faces), 3))), corners)
    if force.warp_lines is not None:
        return _along(_nearest(np.asarray(force.warp_lines), corners.mean(axis=1)), corners)
    first, last = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 3]
    triangles = faces[:, 2] == faces[:, 3]
    isotropic = _isotropic(cloth, np.asarray(force.prestress))
    try:
        warp = None if triangles.any() else places.warp(faces)
    except InputError:
        if not isotropic:
            raise
        return first + last  # as round a corner of a box: no row goes on there, and no direction differs
    if warp is not None:
        size = len(x)
        known = np.unique(np.sort(warp, axis=1) @ [size, 1])
        side = np.isin(np.sort(faces[:, :2], axis=1) @ [size, 1], known)
        other = corners[:, 2] - corners[:, 1] + corners[:, 3] - corners[:, 0]
        return np.where(side[:, None], first + last, other)
    if not isotropic:
        raise InputError("", "a mesh with triangles has no rows for the warp to follow; give warp or warp_lines")
    return first


def _isotropic(cloth: tuple[float, float, float, float], prestress: Floats) -> bool:
    warp, weft, shear, poisson = cloth
    rows = np.atleast_2d(prestress)
    size = np.abs(rows).max(initial=0.0)
    uneven = np.abs(np.column_stack([rows[:, 0] - rows[:, 1], rows[:, 2]])).max(initial=0.0)
    even = uneven <= ALIKE * size
    alike = abs(warp - weft) <= ALIKE * warp and abs(shear * 2.0 * (1.0 + poisson) - warp) <= ALIKE * warp
    return bool(even and alike)


def _along(direction: Floats, corners: Floats) -> Floats:
    """The directions, each with a part along its face; of a quad, along both of its cuts."""
    for cut in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3)):
        a, b, c = (corners[:, i] for i in cut)
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal, axis=1)
        normal /= np.where(size > 0.0, size, 1.0)[:, None]
        across = np.flatnonzero((size > 0.0) & (np.abs((direction * normal).sum(axis=1)) > 1.0 - 1e-6))
        if len(across):
            raise InputError("", f"the warp runs square to face {across[0]}; give a direction that lies along it")
    return direction


def _nearest(lines: Floats, points: Floats) -> Floats:
    """The unit direction (m, 3) of the line nearest to each point."""
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    long = np.linalg.norm(along, axis=1)
    if not (long > 0.0).all():
        raise InputError("", f"line {int(np.argmin(long))} of warp_lines has no length; remove it")
    found = np.empty((len(points), 3))
    for i, point in enumerate(points):
        part = np.clip(((point - start) * along).sum(axis=1) / long**2, 0.0, 1.0)
        apart = np.linalg.norm(start + part[:, None] * along - point, axis=1)
        nearest = int(np.argmin(apart))
        found[i] = along[nearest] / long[nearest]
    return found
