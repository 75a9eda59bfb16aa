"""Whole shells, a membrane and a shell on one mesh: two of the obstacle course of Belytschko and others, "Stress
projection for membrane and shear locking in shell finite elements", 1985. The loads are so small that the shells stay
linear: they move by less than a fiftieth of their thickness."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import quads


def settled(
    x: np.ndarray, faces: Any, material: dict[str, float], thickness: float, load: dict[str, Any], held: Any
) -> np.ndarray:
    """Displacements (n, 3) of a shell of one material."""
    both = [{"kind": kind, "mesh": "m", "material": "it", "thickness": thickness} for kind in ("membrane", "shell")]
    scene = Scene(
        particles=x,
        meshes={"m": {"vertices": x, "faces": faces}},
        materials={"it": material},
        forces=[*both, load],
        anchors=held,
        settings={"solver": "newton", "tolerance": 1e-10, "position_tolerance": None},
    )
    found = relax(scene)
    assert found.converged, found.message
    return np.asarray(found.particles - x)


def scordelis_lo(count: int) -> float:
    """Sag of the middle of the free edge, as a part of 0.3024: R = 25, length 50, 40 degrees to either side, t = 0.25,
    E = 4.32e8, nu = 0, between diaphragms, under 90 per area; the whole roof."""
    turn, y = np.radians(np.linspace(-40, 40, count + 1)), np.linspace(0, 50.0, count + 1)
    around, along = np.meshgrid(turn, y, indexing="ij")
    mesh = quads(np.stack([25 * np.sin(around), along, 25 * np.cos(around)], axis=-1))
    x, small = np.array(mesh.vertices), 1e-2
    ends = np.flatnonzero(np.isin(x[:, 1], [0.0, 50.0]))
    middle = (count // 2) * (count + 1) + count // 2
    held = [{"particles": ends, "axes": "xz"}, {"particles": [middle], "axes": "y"}]
    load = {"kind": "area_weight", "mesh": "m", "weight": 90 * small, "per": "start"}
    moved = settled(x, mesh.faces, {"E": 4.32e8, "poisson": 0.0}, 0.25, load, held)
    return float(-moved[count // 2, 2] / small / 0.3024)


def pinched_cylinder(around: int, along: int) -> float:
    """Displacement under a load of two that pinch a cylinder between diaphragms, as a part of 1.8248e-5: R = 300,
    length 600, t = 3, E = 3e6, nu = 0.3, P = 1; the whole cylinder."""
    turn, y = np.arange(around) * 2 * np.pi / around, np.linspace(0, 600.0, along + 1)
    t, level = np.meshgrid(turn, y, indexing="ij")
    x = np.stack([300 * np.cos(t), level, 300 * np.sin(t)], axis=-1).reshape(-1, 3)
    number = np.arange(around * (along + 1)).reshape(around, along + 1)
    onward = np.roll(number, -1, axis=0)
    faces = np.stack([number[:, :-1], onward[:, :-1], onward[:, 1:], number[:, 1:]], axis=-1).reshape(-1, 4)
    top, bottom, side = (int(number[at, along // 2]) for at in (around // 4, 3 * around // 4, 0))
    ends = np.concatenate([number[:, 0], number[:, -1]])
    held = [{"particles": ends, "axes": "xz"}, {"particles": [side], "axes": "y"}]
    load = {"kind": "unary", "particles": [top, bottom], "vector": [[0, 0, -100.0], [0, 0, 100.0]]}
    moved = settled(x, faces, {"E": 3e6, "poisson": 0.3}, 3.0, load, held)
    return float(-moved[top, 2] / 100.0 / 1.8248e-5)


@pytest.mark.slow
def test_the_scordelis_lo_roof_converges() -> None:
    """Within 5 % with 32 x 32 faces on the whole roof, and a third of the error with half of the mesh width."""
    coarse, fine = (abs(scordelis_lo(count) - 1.0) for count in (16, 32))
    assert fine < 0.05 and fine < 0.4 * coarse


@pytest.mark.soak
def test_the_scordelis_lo_roof_with_64_by_64_faces() -> None:
    """Within 2 % of 0.3024."""
    assert scordelis_lo(64) == pytest.approx(1.0, abs=0.02)


@pytest.mark.soak
def test_the_pinched_cylinder_with_16_by_16_faces_on_an_eighth() -> None:
    """Within 15 % of 1.8248e-5; finer meshes are left to `make soak`."""
    assert pinched_cylinder(64, 32) == pytest.approx(1.0, abs=0.15)


@pytest.mark.soak
def test_the_pinched_cylinder_converges() -> None:
    """From above: 6 % with 32 x 32 faces on an eighth of it, less than half of the error of 16 x 16."""
    coarse, fine = (abs(pinched_cylinder(around, around // 2) - 1.0) for around in (64, 128))
    assert fine < 0.06 and fine < 0.5 * coarse


@pytest.mark.soak
def test_the_pinched_cylinder_with_64_by_64_faces_on_an_eighth() -> None:
    """Within 5 % of 1.8248e-5."""
    assert pinched_cylinder(256, 128) == pytest.approx(1.0, abs=0.05)
