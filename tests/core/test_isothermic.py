"""Quads with the same product of opposite sides: cross ratios, nets on spheres, and a discrete minimal surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid
from hookean.system.system import compile


def model(x: np.ndarray, faces: Any, *more: str) -> Scene:
    kinds = ("isothermic", *more)
    settings = {"tolerance": 1e-10, "max_iterations": 50000}
    forces = [{"kind": kind, "mesh": "m"} for kind in kinds]
    return Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings)


def on_sphere(z: np.ndarray) -> np.ndarray:
    """Inverse stereographic projection of complex numbers (n,), a Moebius transformation: cross ratios stay."""
    size = np.abs(z) ** 2
    return np.column_stack([2.0 * z.real, 2.0 * z.imag, size - 1.0]) / (1.0 + size)[:, None]


def squares(count: int, tall: int) -> tuple[np.ndarray, np.ndarray, tuple[int, int]]:
    """A grid of squares in the complex plane as numbers (n,), quads (m, 4) and how many numbers are along each axis."""
    mesh = grid(0.2 * np.arange(count) - 0.45, 0.2 * np.arange(tall) - 0.35)
    x = mesh.vertices
    return x[:, 0] + 1j * x[:, 1], mesh.faces, (count, tall)


def mercator(count: int, tall: int) -> tuple[np.ndarray, np.ndarray]:
    """Part of the sphere by parallels and meridians, between which it is conformal (Lambert 1772, Mercator's spacing).

    In the plane these are concentric circles of radii q^i. A quad of one step a of the turn has the sides 2 r sin(a/2),
    2 q r sin(a/2) and twice (q - 1) r: the products are the same where (q - 1)^2 = 4 q sin^2(a/2).
    """
    a = 0.25
    s = np.sin(a / 2.0)
    q = 1.0 + 2.0 * s * s + 2.0 * s * np.sqrt(1.0 + s * s)
    mesh = grid(np.arange(count, dtype=float), np.arange(tall, dtype=float))
    return on_sphere(0.4 * q ** mesh.vertices[:, 1] * np.exp(1j * a * mesh.vertices[:, 0])), mesh.faces


def enneper() -> tuple[np.ndarray, np.ndarray]:
    """Discrete Enneper surface: its edges are those of a grid of squares on the sphere, each divided by the square of
    its length, with the other sign along the second axis (Bobenko and Pinkall 1996, the dual isothermic surface)."""
    z, faces, _ = squares(5, 5)
    normal = on_sphere(z)
    corner = {(round(5 * c.real + 2.25), round(5 * c.imag + 1.75)): n for n, c in enumerate(z)}
    x = np.zeros_like(normal)
    for (i, j), n in sorted(corner.items()):
        if (i, j) != (0, 0):
            back, sign = (corner[i - 1, j], 1.0) if i else (corner[i, j - 1], -1.0)
            edge = normal[n] - normal[back]
            x[n] = x[back] + sign * edge / (edge @ edge)
    return 0.1 * x, faces


@pytest.mark.parametrize(("a", "b"), [(3.0, 4.0), (2.0, 2.0), (5.0, 0.5)])
def test_a_rectangle_is_off_by_the_difference_of_its_sides(a: float, b: float) -> None:
    """u = 2 (a^2 - b^2) / (2 a + 2 b) = a - b, and E = k u^2 / 2."""
    x = np.array([[0, 0, 0], [a, 0, 0], [a, b, 0], [0, b, 0.0]])
    system = compile(model(x, [[0, 1, 2, 3]]))
    assert system.evaluate(system.start())[2].sum() == pytest.approx(0.5 * (a - b) ** 2, rel=1e-13)
    found = system.scene.forces[0].measure(system.groups[0].block, x, np.zeros((1, 4, 3)))
    assert found["distance"] == pytest.approx([a - b], abs=1e-13)


def test_quads_of_cross_ratio_minus_one_are_at_rest_and_stay_so_by_moebius_transformations() -> None:
    """(a - b)(c - d) / ((b - c)(d - a)) = -1 in the plane, moved to a sphere: no force; and one where it is not."""
    rng = np.random.default_rng(4)
    for wanted in (-1.0, -1.3):
        a, b, c = rng.normal(size=3) + 1j * rng.normal(size=3)
        # solved for d: (a - b)(c - d) = wanted (b - c)(d - a)
        d = ((a - b) * c + wanted * (b - c) * a) / ((a - b) + wanted * (b - c))
        x = on_sphere(np.array([a, b, c, d]))
        force = {"kind": "isothermic", "particles": [[0, 1, 2, 3]], "stiffness": 1.0}
        system = compile(Scene(particles=x, forces=[force]))
        size = np.abs(system.evaluate(system.start())[0]).max()
        assert size <= 1e-13 if wanted == -1.0 else size > 1e-3


@pytest.mark.parametrize("net", ["mercator", "enneper"])
def test_isothermic_nets_stay_and_come_back(net: str) -> None:
    """No force, to rounding; disturbed ones come back to u = 0 with corners on circles, each to 1e-6 of a side."""
    x, faces = mercator(5, 4) if net == "mercator" else enneper()
    for kinds in ((), ("cyclic_quad",)):
        system = compile(model(x, faces, *kinds))
        assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-12
    side = np.linalg.norm(x[faces[:, 1]] - x[faces[:, 0]], axis=1).min()
    moved = x + 0.05 * side * np.random.default_rng(1).normal(size=x.shape)
    found = relax(model(moved, faces, "cyclic_quad"))
    assert found.converged and np.abs(found.particles - x).max() > 1e-3 * side
    assert np.abs(found.forces[0]["distance"]).max() <= 1e-6 * side
    assert np.abs(found.forces[1]["distance"]).max() <= 1e-6 * side


def test_triangles_have_no_force() -> None:
    """Only the quad of a mesh counts."""
    x = np.array([[0, 0, 0], [1, 0, 0.1], [1, 2, 0], [0, 1.2, 0], [2, 0, 0.0]])
    (group,) = compile(model(x, [[0, 1, 2, 3], [1, 4, 2, 2]])).groups
    assert group.block.indices.tolist() == [[0, 1, 2, 3]]
