"""Nets against closed forms: force-density nets, and the linear membrane."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import area, edges, grid, naked_vertices, quads


def net(count: int, side: float, height, *, loads=None, stiffness: float = 1.0, solver: str = "auto") -> Scene:
    """A square net of `count` x `count` cells of rest length 0, rim held at z = height(x, y)."""
    line = np.linspace(-side / 2, side / 2, count + 1)
    mesh = grid(line, line)
    points, rim = mesh.vertices, naked_vertices(mesh)
    points[rim, 2] = height(points[rim, 0], points[rim, 1])
    forces = [{"kind": "springs", "particles": edges(mesh), "stiffness": stiffness, "rest_length": 0}]
    if loads is not None:
        forces.append({"kind": "unary", "particles": np.arange(len(points)), "vector": loads})
    settings = {"tolerance": 1e-12, "solver": solver}
    return Scene(particles=points, forces=forces, anchors=[{"particles": rim}], settings=settings)


def surface_area(points: np.ndarray, count: int, refine: int = 1) -> float:
    """Area of the net's surface."""
    return area(quads(points.reshape(count + 1, count + 1, 3)))


@pytest.mark.parametrize("solver", ["auto", "relaxation"])
def test_force_density_net_on_a_hypar_frame_is_the_hypar(solver: str):
    """Equal q, rim z = x y on 2 x 2: x y is discretely harmonic, so z = x y to round-off; its area is 5.1232,
    0.12 % above the minimal surface's 5.117046."""
    result = relax(net(16, 2.0, lambda x, y: x * y, solver=solver))
    x, y, z = result.particles.T
    assert result.converged
    assert z == pytest.approx(x * y, abs=1e-10)
    coarse, fine = (surface_area(relax(net(n, 2.0, lambda x, y: x * y)).particles, n) for n in (32, 64))
    assert fine + (fine - coarse) / 3.0 == pytest.approx(5.1232, abs=5e-5)
    assert fine > 5.117046


def test_force_density_net_on_scherks_frame_differs_from_the_film():
    """Rim z = ln(cos y / cos x) on [-1, 1]^2: z(.5, 0) tends to 0.1560, not to the film's 0.1306."""
    heights = []
    for count in (16, 32, 64):
        points = relax(net(count, 2.0, lambda x, y: np.log(np.cos(y) / np.cos(x)))).particles
        heights.append(points.reshape(count + 1, count + 1, 3)[3 * count // 4, count // 2, 2])
    limit = heights[2] + (heights[2] - heights[1]) / 3.0
    assert limit == pytest.approx(0.1560, abs=5e-5)


@pytest.mark.parametrize(("count", "coefficient"), [(4, 0.0703125), (16, 0.07344577)])
def test_tensioned_net_under_uniform_pressure(count: int, coefficient: float):
    """w = c p a^2 / T in the middle; n 4: c = 0.0703125 exactly, n 16: 0.07344577, continuum 0.07367135."""
    side, pressure, tension = 3.0, 2.0, 50.0
    load = [0.0, 0.0, pressure * (side / count) ** 2]
    result = relax(net(count, side, lambda x, y: 0 * x, loads=load, stiffness=tension))
    middle = result.particles[((count + 1) ** 2) // 2, 2]
    assert middle == pytest.approx(coefficient * pressure * side**2 / tension, rel=1e-7)


def test_pressed_net_approaches_the_continuum_with_order_two():
    """c tends to 0.07367135 with slope 2."""
    errors = []
    for count in (8, 16, 32, 64):
        result = relax(net(count, 1.0, lambda x, y: 0 * x, loads=[0, 0, 1.0 / count**2]))
        errors.append(abs(result.particles[((count + 1) ** 2) // 2, 2] - 0.07367135))
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert slopes == pytest.approx(np.full(3, 2.0), abs=0.15)


def test_diagonals_come_both_or_one_to_a_face():
    """Figure 9.31: on a quad a-b-c-d the diagonals are a-c ("one") and b-d ("other"), or both."""
    mesh = {"quad": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]}}
    found = {}
    for kind in ("diagonals", "diagonals_one", "diagonals_other"):
        scene = Scene.read({"meshes": mesh, "forces": [{"kind": "springs", "mesh": "quad", "edges": kind}]})
        found[kind] = relax(scene).force("springs")["particles"].tolist()
    assert found == {"diagonals": [[0, 2], [1, 3]], "diagonals_one": [[0, 2]], "diagonals_other": [[1, 3]]}
