"""Gas: Boyle's law in a mesh that springs tighten."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from core.test_volume import SOLID, TENSION, icosahedron, outwards, tightened
from hookean import Scene, relax
from hookean.forces import enclosed
from hookean.system.system import compile


@pytest.mark.parametrize(("pressure", "outside"), [(20.0, 0.0), (90.0, 80.0), (30.0, 40.0)])
def test_boyles_law_holds_an_icosahedron_open(pressure: float, outside: float) -> None:
    """Virtual work of scaling: 30 k l^2 = 3 (p0 V0 / V - p_out) V with V = 5 (3 + sqrt 5) l^3 / 12; the left side and
    p_out V grow with l, so that one edge length solves it."""
    start = SOLID * 8.0
    found = tightened(kind="gas", pressure=pressure, outside=outside)

    def excess(edge: float) -> float:
        return 10.0 * TENSION * edge**2 - pressure * start + outside * SOLID * edge**3

    edge = brentq(excess, 0.1, 20.0, xtol=1e-14)
    assert found.converged
    assert found.forces[1]["length"] == pytest.approx(np.full(30, edge), rel=1e-8)
    expected = pressure * start / (SOLID * edge**3) - outside
    assert found.forces[0]["pressure"] == pytest.approx(np.full(20, expected), rel=1e-6)


def bubble(level: int, **content: Any) -> tuple[float, float]:
    """Mean radius and pressure of a film of tension 0.8 on an icosahedron cut `level` times."""
    x, faces = icosahedron()
    for _ in range(level):
        x = np.concatenate([x, np.unique((x[faces] + x[np.roll(faces, 1, axis=1)]).reshape(-1, 3) / 2.0, axis=0)])
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        faces = outwards(x)
    forces = [{"kind": "soapfilm", "mesh": "skin", "tension": 0.8}, {"mesh": "skin", **content}]
    mesh = {"skin": {"vertices": x, "faces": faces}}
    found = relax(Scene(particles=x, meshes=mesh, forces=forces, settings={"tolerance": 1e-9}))
    assert found.converged, found.message
    radius = np.linalg.norm(found.particles - found.particles.mean(axis=0), axis=1).mean()
    return radius, found.forces[1]["pressure"][0]


@pytest.mark.parametrize("kind", ["gas", "volume"])
def test_a_bubble_has_the_pressure_of_laplace(kind: str) -> None:
    """p = 2 T / R, with p = p0 V0 / V - p_out in a gas and p = K (V0 - V) / V0 of a volume (Laplace, 1806). Chords of
    a sphere miss it by the square of their length: with each edge halved by about 4 times less."""
    content = {"gas": {"pressure": 2.0, "outside": 0.3}, "volume": {"stiffness": 9.0}}[kind]
    missed = []
    for level in (1, 2):
        radius, pressure = bubble(level, kind=kind, **content)
        missed.append(abs(pressure * radius / 1.6 - 1.0))
    assert missed[0] < 0.15
    assert missed[1] < missed[0] / 3.0


@pytest.mark.parametrize("volume", [1e-2, 1.0001e-3, 0.9999e-3, 1e-4, 0.0, -0.5])
def test_a_crushed_gas_has_a_finite_pressure(volume: float) -> None:
    """Above a thousandth of V0 Boyle's law; below, energy and pressure continue it with the slope there: to second
    order, so that 1e-7 beside the limit they differ by 1e-13 of it."""
    row = np.array([[0.0, 0.0, 1.0, 5.0, 1.0, 2.0, enclosed.GAS]])
    energy, pressure, fall = enclosed.respond(row, 0, volume)
    if volume >= 1e-3:
        assert (energy, pressure, fall) == pytest.approx(
            (-5.0 * np.log(volume) + 2.0 * volume, 5.0 / volume - 2.0, 5.0 / volume**2)
        )
    else:
        below = volume - 1e-3
        assert pressure == pytest.approx(5e3 - 5e6 * below - 2.0)
        assert energy == pytest.approx(-5.0 * np.log(1e-3) - 5e3 * below + 2.5e6 * below**2 + 2.0 * volume)
        assert fall == pytest.approx(5e6)


def test_energy_is_counted_from_the_start() -> None:
    """-p0 V0 ln(V / V0) + p_out V is p_out V0 there."""
    x, faces = icosahedron()
    force = {"kind": "gas", "mesh": "skin", "pressure": 3.0, "outside": 2.0}
    system = compile(Scene(particles=x, meshes={"skin": {"vertices": x, "faces": faces}}, forces=[force]))
    assert system.evaluate(system.start())[2].sum() == pytest.approx(2.0 * SOLID * 8.0, rel=1e-14)
