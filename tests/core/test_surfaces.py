"""The surface of a shape: of a soap film in equilibrium, of a net and its start, and of what is no shape."""

from __future__ import annotations

import numpy as np
import pytest

import hookean
from hookean import InputError
from hookean.discretize import clothed_vertices, triangles


def test_a_soap_film_has_no_mean_curvature() -> None:
    """The gradient of the area of triangles is the sum of cotangents that H is found by (Pinkall and Polthier 1993).
    A film is at rest where its part along the normal vanishes: |H| = |f| / (2 gamma A), here with |f| below 1e-9 of
    the forces of single triangles."""
    scene = hookean.family("catenoid", rays=12, rings=4)
    [(name, drawn)] = scene.meshes.items()
    cut = triangles((drawn.vertices, drawn.faces))  # a film of quads counts one of their cuts, curvature the mean
    meshes = {name: drawn.replaced(faces=cut[:, [0, 1, 2, 2]])}
    film = hookean.relax(scene.replaced(meshes=meshes, settings=scene.settings.replaced(tolerance=1e-9)))
    assert film.converged
    found = hookean.surface(film)
    inner = clothed_vertices(found.mesh)
    assert len(inner) and np.isfinite(found.mean_curvature).sum() == len(inner)
    assert np.abs(found.mean_curvature[inner]).max() < 1e-6  # of radii of metres
    assert found.gaussian_curvature[inner].max() < 0.0  # a saddle everywhere


def test_displacement_is_from_the_start_and_lines_are_of_the_present_shape() -> None:
    saddle = hookean.family("saddle", rise=2.5, across=8, along=8)
    simulation = hookean.Simulation(saddle)
    before = hookean.surface(simulation, drops=0)
    assert before.displacement.max() == 0.0 and not before.water.lines
    result = simulation.relax()
    for model in (simulation, result, saddle):
        found = hookean.surface(model, 0.5, 20)
        start = np.asarray(hookean.Simulation(saddle).system.points)
        assert found.displacement == pytest.approx(np.linalg.norm(result.particles - start, axis=1), abs=1e-9)
        assert len(found.water.lines) == 20
        assert set(found.heights.heights.round(9) % 0.5) == {0.0}
    told = found.to_dict()
    assert told["gaussian_curvature"][0] is None  # a corner
    assert told["slope"] == pytest.approx(found.slope.tolist())
    assert "height lines, 0.5 m apart" in repr(found)


def test_a_net_without_faces_has_a_displacement_alone() -> None:
    found = hookean.surface(hookean.relax(hookean.family("cable")))
    assert found.displacement.max() > 0.0 and np.isnan(found.slope).all()
    assert not len(found.heights.pieces) and not found.water.lines


def test_faults_are_named() -> None:
    cable = hookean.Simulation(hookean.family("cable"))
    with pytest.raises(InputError, match="from 0 to 10000"):
        hookean.surface(cable, drops=-1)
    with pytest.raises(InputError, match="give one of these"):
        hookean.surface("roof")  # type: ignore[arg-type]
