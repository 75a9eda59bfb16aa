"""The surface of a shape: of a soap film in equilibrium, of a net and its start, and of what is no shape."""

from __future__ import annotations

import numpy as np
import pytest

import hookean
from hookean import InputError
from hookean.discretize import clothed_vertices, grid, naked_vertices, triangles


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


def test_cloth_shows_its_stress_state_and_utilisation_at_particles() -> None:
    """A flat sheet of prestress s1, s2 between held edges has these stresses everywhere, and no shear: the largest is
    s1, and it uses max(s1 / 60, s2 / 40) of its strength. A particle without cloth has none."""
    mesh = grid(np.arange(5.0), np.arange(5.0))
    scene = {
        "particles": [*mesh.vertices.tolist(), [9.0, 0.0, 0.0]],
        "meshes": {"sheet": {"vertices": mesh.vertices, "faces": mesh.faces}},
        "materials": {"cloth": {"warp_stiffness": 800.0, "weft_stiffness": 600.0, "shear_stiffness": 20.0,
                                "warp_strength": 60.0, "weft_strength": 40.0}},
        "forces": [{"kind": "membrane", "mesh": "sheet", "material": "cloth", "warp": [1, 0, 0],
                    "prestress": [3.0, 2.5, 0.0], "wrinkling": True},
                   {"kind": "springs", "particles": [[0, 25]], "stiffness": 1.0}],
        "anchors": [{"particles": [*naked_vertices(mesh), 25]}],
    }  # fmt: skip
    found = hookean.surface(hookean.relax(hookean.Scene.read(scene)), drops=0)
    assert found.cloth.stress[:25] == pytest.approx(3.0, rel=1e-9)
    assert (found.cloth.state[:25] == 2.0).all()
    assert found.cloth.utilisation[:25] == pytest.approx(2.5 / 40.0, rel=1e-9)
    assert np.isnan([found.cloth.stress[25], found.cloth.state[25], found.cloth.utilisation[25]]).all()
    assert found.to_dict()["utilisation"][25] is None
    assert any("cloth stressed by up to 3 N/m" in line for line in found.summary())
