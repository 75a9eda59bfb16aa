"""Freezing films: cloth that is made in the shape of the film, with the film's stress in each triangle.

The part of a film's force that lies along it does not count in the form (see `hookean.films`), but elastic cloth has
stiffness along itself and would move by it. So the stress of each triangle differs from the film's by the least
changes ds, min sum A (ds11^2 + ds22^2 + 2 ds12^2), that balance every free particle: with B ds = -left and the weights
W = A (1, 1, 2), ds = W^-1 B^T y with (B W^-1 B^T) y = -left. They are as small as the error of flat triangles, of order
h^2. Where the cloth can bend without stretching, such as beside a cable, no stress balances what is left of this order;
there the form moves by it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.matrices import factor
from hookean.errors import InputError
from hookean.forces import Force
from hookean.forces.base import lengths
from hookean.forces.cloth import grain, numbers
from hookean.forces.membrane import AREA, SLOPES, Membrane
from hookean.forces.soapfilm import SoapFilm, halves, shapes, yarns
from hookean.scene.load_cases import ElasticCloth, Stages, named
from hookean.scene.scene import Scene
from hookean.system.group import Part
from hookean.system.state import State
from hookean.system.system import System, compile

Floats = NDArray[np.float64]

FAINT = 1e-6  # of the mean stiffness, added where flat cloth has none across itself
LAPS = 6  # in which that is made up for
SHOWN = 1e-9  # part of the stress from which on its change is noted


def frozen_film(system: System, stages: Stages, part: Part, x: Floats, element_forces: Floats) -> Force:
    """A film as cloth: its shape is that of the film, its stress that of each of the film's triangles."""
    film, pointer = part.force, f"/forces/{part.number}"
    assert isinstance(film, SoapFilm)
    wanted = _wanted(system, stages, part.number, film)
    places = system.places
    faces = places.faces(film.mesh)
    if len(halves(faces)[0]) != len(element_forces):
        raise InputError(pointer, "the mesh has faces without area, which cannot be cloth; remove them")
    given = {name: getattr(wanted, name) for name in type(wanted).model_fields}
    cloth = Membrane(name=film.name, mesh=film.mesh, shape=x[places.vertices(film.mesh)], **given)
    try:
        if cloth.warp is None and cloth.warp_lines is None:
            threads = film.warp > 0.0 or film.weft > 0.0
            own = x[faces[:, 1]] - x[faces[:, 0]] if threads else grain(cloth, x, faces, numbers(cloth, places), places)
            cloth = cloth.replaced(warp=own)
        along = grain(cloth, x, faces, numbers(cloth, places), places)
    except InputError as error:
        raise InputError(pointer, error.sentence) from None
    corners, share, face = halves(faces)
    return cloth.replaced(prestress=_stress(x, corners, along[face], share, element_forces))


def _wanted(system: System, stages: Stages, number: int, film: SoapFilm) -> ElasticCloth:
    for name, given in stages.films.items():
        if number in named(system.scene, name):
            return given
    name = film.name or film.kind_name
    example = f'"stages": {{"films": {{"{name}": {{"warp_stiffness": 500}}}}}}'
    said = f"{name} keeps its stress at any strain; give the cloth that it becomes, as in {example}"
    raise InputError(f"/forces/{number}", said)


def _stress(x: Floats, corners: NDArray[np.int64], along: Floats, share: Floats, forces: Floats) -> Floats:
    """Stress (m, 3) along a direction, across it and in shear whose forces triangles (m, 3, 3) have:
    A s = -sum of x f."""
    area = shapes(x, corners)[0]
    slopes = yarns(x, corners, along).reshape(-1, 2, 3)
    frame = np.einsum("mki,mic->mkc", slopes, x[corners]) / np.where(area > 0.0, area, 1.0)[:, None, None]
    place = np.einsum("mic,mkc->mik", x[corners] - x[corners].mean(axis=1, keepdims=True), frame)
    pull = np.einsum("mic,mkc->mik", forces, frame)
    stress = -np.einsum("mik,mil->mkl", place, pull) / np.where(area > 0.0, area * share, 1.0)[:, None, None]
    return np.column_stack([stress[:, 0, 0], stress[:, 1, 1], 0.5 * (stress[:, 0, 1] + stress[:, 1, 0])])


def balanced(scene: Scene, numbers_of_films: Iterable[int], state: State) -> tuple[Scene, list[str]]:
    """A scene whose films are cloth, with the stress that is in equilibrium in a state; and a note on each of them."""
    system = compile(scene)
    here = system.start()
    here.x, here.free = state.x, state.free
    forces, notes = list(scene.forces), list[str]()
    for number, change in _changes(system, here, set(numbers_of_films)).items():
        cloth = forces[number]
        assert isinstance(cloth, Membrane)
        stress = cloth.prestress + change
        size, most = np.abs(cloth.prestress).max(initial=0.0), np.abs(change).max(initial=0.0)
        if cloth.wrinkling and _pressed(stress).any():
            said = f"triangle {int(np.argmax(_pressed(stress)))} would wrinkle in the form; give a mesh of even faces"
            raise InputError(f"/forces/{number}", said)
        name = cloth.name or "soapfilm"
        if most > SHOWN * size:
            notes.append(
                f"/forces/{number}: {name} is cloth, whose stress differs by up to {100.0 * most / size:.2g} % from "
                "the film's, which is balanced across itself only"
            )
        forces[number] = cloth.replaced(prestress=stress)
    return scene.replaced(forces=tuple(forces)), notes


def _pressed(stress: Floats) -> NDArray[np.bool_]:
    """Where cloth with these stresses (m, 3) is not in tension in all directions."""
    s = stress.T
    return np.asarray((s[0] < 0.0) | (s[1] < 0.0) | (s[0] * s[1] < s[2] * s[2]))


def _changes(system: System, state: State, chosen: set[int]) -> dict[int, Floats]:
    """The least changes of stress (m, 3) that balance the forces on free particles, by the numbers of the films."""
    import scipy.sparse as sparse

    group = next(g for g in system.groups if g.cls is Membrane)
    parts = [part for part in group.parts if part.number in chosen]
    rows = np.concatenate([np.arange(part.rows.start, part.rows.stop) for part in parts])
    matrix = _forces_of(group.block.indices[rows], group.block.parameters[rows], state)
    area = group.block.parameters[rows, AREA]
    weight = np.column_stack([area, area, 2.0 * area]).ravel()
    free = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), 0.0)
    square = (matrix @ sparse.diags_array(free) @ matrix.T).tocsc()
    faint = FAINT * square.diagonal().mean()
    found = factor(square + faint * sparse.eye_array(square.shape[0], format="csc"))
    forces = (system.evaluate(state)[0] * state.free).ravel()
    left, stress, size = forces, np.zeros(len(weight)), _largest(system, state)
    for _ in range(LAPS):
        if found is None or not np.abs(left).max(initial=0.0) > 1e-16 * size:
            break
        better = stress - free * (matrix.T @ found.solve(left))
        after = forces + matrix @ better
        if not np.abs(after).max() < np.abs(left).max():
            break
        left, stress = after, better
    start = np.concatenate([[0], np.cumsum([part.rows.stop - part.rows.start for part in parts])])
    whole = stress.reshape(-1, 3)
    return {part.number: whole[a:b] for part, a, b in zip(parts, start[:-1], start[1:], strict=True)}


def _forces_of(corners: NDArray[np.int64], parameters: Floats, state: State):  # type: ignore[no-untyped-def]
    """The forces on free axes (3 n,) by the stresses (3 m,) of triangles in the shape in which these are made."""
    import scipy.sparse as sparse

    p, q = parameters[:, SLOPES : SLOPES + 3], parameters[:, SLOPES + 3 : SLOPES + 6]
    u, v = (np.einsum("mi,mic->mc", slope, state.x[corners]) for slope in (p, q))
    area, zero = parameters[:, AREA], np.zeros_like
    parts = [p[:, :, None] * u[:, None], q[:, :, None] * v[:, None]]
    parts.append(p[:, :, None] * v[:, None] + q[:, :, None] * u[:, None])
    values = -area[:, None, None, None] * np.stack(parts, axis=-1) * state.free[corners][..., None]
    at = 3 * corners[:, :, None, None] + np.arange(3)[None, None, :, None] + zero(np.arange(3))
    by = 3 * np.arange(len(corners))[:, None, None, None] + np.arange(3)[None, None, None, :]
    rows, columns = np.broadcast_arrays(at, by)
    shape = (state.x.size, 3 * len(corners))
    return sparse.coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def _largest(system: System, state: State) -> float:
    """The largest force of a triangle or other internal element on a particle."""
    size = 0.0
    for group, memory in zip(system.groups, state.memory, strict=True):
        if len(group.block.indices) and group.cls.role != "load":
            size = max(size, float(lengths(system.element_forces(group, state, memory).reshape(-1, 3)).max()))
    return size
