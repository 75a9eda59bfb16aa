"""Volumes: the pressure in meshes that something tightens, by virtual work; which meshes are closed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial import ConvexHull

from hookean import InputError, Scene, relax
from hookean.forces import enclosed
from hookean.system.system import compile

TENSION = 4.0
GOLDEN = 0.5 * (1.0 + np.sqrt(5.0))
SOLID = 5.0 * (3.0 + np.sqrt(5.0)) / 12.0  # volume of an icosahedron by the cube of its edge


def icosahedron() -> tuple[np.ndarray, np.ndarray]:
    """Vertices with edges of length 2 and faces that are oriented outwards."""
    signs = np.array([[s, GOLDEN * t] for s in (-1, 1) for t in (-1, 1)])
    x = np.concatenate([np.roll(np.column_stack([np.zeros(4), signs]), axis, axis=1) for axis in range(3)])
    return x, outwards(x)


def outwards(x: np.ndarray) -> np.ndarray:
    """Faces of the convex hull, counter-clockwise from outside."""
    faces = ConvexHull(x).simplices
    a, b, c = x[faces].transpose(1, 0, 2)
    inwards = (np.cross(b - a, c - a) * (a - x.mean(axis=0))).sum(axis=1) < 0
    return np.where(inwards[:, None], faces[:, ::-1], faces)


def tightened(**force: Any) -> Any:
    """An icosahedron of springs of rest length 0, so that each pulls with TENSION x its length, at rest."""
    x, faces = icosahedron()
    forces = [{"mesh": "skin", **force}]
    forces.append({"kind": "springs", "mesh": "skin", "stiffness": TENSION, "rest_length": 0.0})
    meshes = {"skin": {"vertices": x, "faces": faces}}
    return relax(Scene(particles=x, meshes=meshes, forces=forces, settings={"tolerance": 1e-12}))


def test_an_icosahedron_shrinks_until_its_pressure_holds() -> None:
    """Virtual work of scaling: 30 k l^2 = 3 p V, with V = 5 (3 + sqrt 5) l^3 / 12 and p = K (V0 - V) / V0."""
    stiffness, start = 60.0, SOLID * 8.0
    found = tightened(kind="volume", stiffness=stiffness)

    def excess(edge: float) -> float:
        volume = SOLID * edge**3
        return 30.0 * TENSION * edge**2 - 3.0 * stiffness * (start - volume) / start * volume

    edge = brentq(excess, 1.0, 2.0, xtol=1e-14)
    assert found.converged and found.stability == "mechanism" and found.soft_modes == 6
    assert found.forces[1]["length"] == pytest.approx(np.full(30, edge), abs=1e-9)
    assert found.forces[0]["volume"] == pytest.approx(np.full(20, SOLID * edge**3), rel=1e-9)
    assert found.forces[0]["pressure"] == pytest.approx(np.full(20, 10.0 * TENSION / (SOLID * edge)), rel=1e-8)


@pytest.mark.parametrize("factor", [0.1, 1.0, 3.0])
def test_alone_it_has_its_volume(factor: float) -> None:
    """Nothing else acts: V = V0, a factor of the start, exactly up to the residual."""
    x, faces = icosahedron()
    force = {"kind": "volume", "mesh": "skin", "volume_factor": factor}
    scene = {"particles": x, "meshes": {"skin": {"vertices": x, "faces": faces}}, "forces": [force]}
    found = relax(Scene(**scene, settings={"tolerance": 1e-10}))
    assert found.converged
    assert found.forces[0]["volume"] == pytest.approx(np.full(20, factor * SOLID * 8.0), rel=1e-9)


def test_a_cube_of_quads_has_its_volume() -> None:
    """Quads are the mean of their cuts: energy K (V - V0)^2 / (2 V0) with V = 6 and V0 = 6 x 0.5."""
    x = np.array([[i, j, k] for i in (0, 1.0) for j in (0, 2.0) for k in (0, 3.0)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    force = {"kind": "volume", "mesh": "box", "stiffness": 7.0, "volume_factor": 0.5}
    system = compile(Scene(particles=x, meshes={"box": {"vertices": x, "faces": faces}}, forces=[force]))
    assert system.evaluate(system.start())[2].sum() == pytest.approx(7.0 * 9.0 / 6.0, rel=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda faces: faces[1:], "the mesh is not closed at the edge of particles"),
        (
            lambda faces: faces[:, ::-1],
            r"a volume of -17.4536 m\^3 is enclosed; more than 0 is needed: turn its faces outwards",
        ),
        (lambda faces: np.concatenate([faces, faces]), "the mesh is not closed at the edge of particles"),
        (lambda faces: faces[:0], "the mesh has no faces; give a closed mesh"),
        (
            lambda faces: np.concatenate([faces[:1], faces[:1, ::-1]]),
            r"a volume of \S+ m\^3 is enclosed; more than 0 is needed: give a mesh that is not flat",
        ),
    ],
)
@pytest.mark.parametrize("kind", ["volume", "gas"])
def test_meshes_that_enclose_nothing_are_refused(kind: str, change: Any, message: str) -> None:
    """Open, inside out, with faces twice, without faces, flat."""
    x, faces = icosahedron()
    meshes = {"skin": {"vertices": x, "faces": change(faces)}}
    with pytest.raises(InputError, match=f"/meshes/skin/faces: {message}"):
        compile(Scene(particles=x, meshes=meshes, forces=[{"kind": kind, "mesh": "skin"}]))


@pytest.mark.parametrize("kind", ["volume", "gas"])
def test_a_large_mesh_has_a_bound_for_steps_and_no_tangent(kind: str) -> None:
    """Beyond 300 particles: the reason is reported, and time steps come from what particles feel at most."""
    x = np.random.default_rng(1).normal(size=(enclosed.LARGEST + 1, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    meshes = {"ball": {"vertices": x, "faces": outwards(x)}}
    system = compile(Scene(particles=x, meshes=meshes, forces=[{"kind": kind, "mesh": "ball"}]))
    assert system.no_tangent() == "a closed mesh of 301 particles under pressure is too large for a tangent"
    state = system.start()
    ((group, own),) = system.elements(state.x, state.memory)
    w = system.evaluate(state)[1]
    assert np.array_equal(system.stiffness_blocks(group, state, own), w[:, None, None] * np.eye(3))
