"""A hypar and a cone of cloth beside another program, and how fast both tend to their limit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hookean import InputError, Scene, relax

from .membrane_program import Program, cloth, cuts

CLOTH = {"warp_stiffness": 600.0, "weft_stiffness": 450.0, "shear_stiffness": 30.0, "poisson": 0.3}
STIFF = cloth(*CLOTH.values())
Roof = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def hypar(count: int) -> Roof:
    """Points, quads, warp of each, and the held rim: 6 by 6, 2 high at two corners, the warp between these."""
    u, v = (part.ravel() for part in np.meshgrid(*[np.linspace(0, 1, count + 1)] * 2, indexing="ij"))
    number = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    return (
        np.column_stack([6 * u, 6 * v, 2 * (u + v - 2 * u * v)]),
        faces,
        np.tile([1.0, -1.0, 0.0], (len(faces), 1)),
        rim,
    )


def cone(count: int) -> Roof:
    """The same of a cone from a ring of radius 1 at 3 to one of radius 5 at 0, its warp down the slope."""
    around = 4 * count
    t, s = (part.ravel() for part in np.meshgrid(np.arange(around), np.linspace(0, 1, count + 1), indexing="ij"))
    angle, radius = 2 * np.pi * t / around, 1 + 4 * s
    x = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 3 * (1 - s) ** 2])
    number = np.arange(around * (count + 1)).reshape(around, count + 1)
    on = np.roll(number, -1, axis=0)
    faces = np.stack([number[:, :-1], number[:, 1:], on[:, 1:], on[:, :-1]], axis=-1).reshape(-1, 4)
    return x, faces, x[faces].mean(axis=1) * [1, 1, 0] - [0, 0, 1.0], np.concatenate([number[:, 0], number[:, -1]])


ROOFS: dict[str, Any] = {"hypar": hypar, "cone": cone}


def loaded(x: np.ndarray, faces: np.ndarray, by: float) -> np.ndarray:
    """Snow per true area, as forces on the corners of both cuts."""
    triangles, load = cuts(faces)[0], np.zeros_like(x)
    normal = np.cross(*(x[triangles[:, i]] - x[triangles[:, 0]] for i in (1, 2)))
    for corner in triangles.T:
        np.add.at(load[:, 2], corner, -by * np.linalg.norm(normal, axis=1) / 12)
    return load


def solved(roof: Roof, load: np.ndarray) -> Any:
    x, faces, warp, held = roof
    membrane = {"kind": "membrane", "mesh": "roof", **CLOTH, "warp": warp, "prestress": [3, 2, 0]}
    push = {"kind": "unary", "particles": range(len(x)), "vector": load}
    meshes = {"roof": {"vertices": x, "faces": faces}}
    spec = {"units": {"force": "kN"}, "particles": x, "meshes": meshes, "forces": [membrane, push]}
    return relax(Scene.read({**spec, "anchors": [{"particles": held}], "settings": {"tolerance": 1e-11}}))


@pytest.mark.parametrize("name", ROOFS)
def test_a_roof_is_the_same_in_another_program(name: str) -> None:
    """Prestressed as drawn, under snow, both programs on the same triangles: they differ by what their solvers leave,
    1e-11 of the load at each of a hundred particles, against a stiffness of 2 to 600 kN/m: below 1e-8 of what moves."""
    roof = ROOFS[name](8)
    x, faces, warp, held = roof
    triangles, face = cuts(faces)
    load = loaded(x, faces, 0.6)
    moved, stress = Program(x, triangles, warp[face], STIFF, np.array([3.0, 2.0, 0.0]), held, load).solved()
    found = solved(roof, load)
    assert found.converged
    size = np.linalg.norm(moved - x, axis=1).max()
    assert 0.01 < size < 1.0
    np.testing.assert_allclose(found.particles, moved, atol=1e-8 * size)
    own = found.force("membrane")["warp"]
    assert np.sort(own) == pytest.approx(np.sort(stress), rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROOFS)
def test_what_a_roof_deflects_converges_with_the_square_of_the_mesh(name: str) -> None:
    """Halving the mesh divides the change of the deflection half way up by about four, by three at least this coarse,
    so that at 16 quads less than a third of the last change is left: below 1 % of it."""
    deflected = []
    for count in (4, 8, 16):
        x, faces, *_ = roof = ROOFS[name](count)
        at = (count + 1) * (count // 2) + count // 2 if name == "hypar" else count // 2
        deflected.append(float((solved(roof, loaded(x, faces, 0.6)).particles[at] - x[at])[2]))
    one, two = np.diff(deflected)
    assert one / two > 3.0
    assert abs(two) / 3.0 < 0.01 * abs(deflected[-1])


def test_a_box_of_cloth_that_is_alike_in_all_directions_needs_no_warp() -> None:
    """Rows of quads cannot go on round its corners. Such a cloth has the same forces for every warp (rounding of 600
    kN/m: 1e-9 of the largest force); another one is refused with what to do."""
    corners = [[i, j, k] for i in (0.0, 1) for j in (0.0, 1) for k in (0.0, 1)]
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    cloth = {"kind": "membrane", "mesh": "box", "warp_stiffness": 6e5, "prestress": [2e3, 2e3, 0.0]}

    moved = np.array(corners) + np.random.default_rng(4).uniform(-0.1, 0.1, (8, 3))

    def forces(**more: object) -> NDArray[np.float64]:
        meshes = {"box": {"vertices": corners, "faces": sides}}
        held = {"particles": list(range(8)), "targets": moved}
        scene = Scene(particles=corners, meshes=meshes, forces=[{**cloth, **more}], anchors=[held])
        return np.asarray(relax(scene).reactions["force"], np.float64)

    found, along = forces(), forces(warp=[1.0, 0.3, 0.2])
    assert np.abs(found).max() > 1e4
    assert found == pytest.approx(along, abs=1e-9 * np.abs(along).max())
    with pytest.raises(InputError, match="remesh there, or give the membrane a warp"):
        forces(weft_stiffness=5e5)
