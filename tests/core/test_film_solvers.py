"""What counts of the forces on films, and the solvers that go by it: steps across films, in time and of relaxation."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import Simulation, relax
from hookean.errors import InputError
from hookean.films import EDGE, SLIDING, WHOLE, WITHIN
from hookean.solvers import solver
from hookean.stability.equilibrium import Stability
from hookean.system.balance import balance
from hookean.system.system import compile
from soak import examples, sampled

from .film_meshes import area, disc, film, inside, patch, scene, slopes, square, thinnest, triangles, tube
from .test_soapfilm import off_scherk, scherk

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(30), database=None)


def area_gradient(x: np.ndarray, faces: Any) -> np.ndarray:
    """Derivative of the area by the places of vertices, by complex steps: exact to rounding."""
    corners, shares = triangles(faces)
    found = np.zeros_like(x)
    for i in range(3):
        for c in range(3):
            moved = x[corners].astype(complex)
            moved[:, i, c] += 1e-30j
            normal = np.cross(moved[:, 1] - moved[:, 0], moved[:, 2] - moved[:, 0])
            slope = 0.5 * shares * np.sqrt((normal**2).sum(axis=1)).imag / 1e-30
            found[:, c] += np.bincount(corners[:, i], slope, len(x))
    return found


def normals(x: np.ndarray, faces: Any) -> np.ndarray:
    """Unit normals of vertices of a mesh whose faces are oriented alike: the areas around, as vectors."""
    corners, _ = triangles(faces)
    a, b, c = (x[corners[:, i]] for i in range(3))
    vector = np.cross(b - a, c - a)
    found = np.stack([np.bincount(corners.ravel(), np.repeat(vector[:, k], 3), len(x)) for k in range(3)], axis=1)
    return found / np.linalg.norm(found, axis=1)[:, None]


def test_a_film_is_at_rest_where_its_area_does_not_change_across_it() -> None:
    """Of the gradient of the area, by independent code, next to nothing is left across the film at any vertex.

    Along it some is: 1e-3 of the film's tension x a side. That the residual does not count.
    """
    x, faces, rim = square(16, scherk, "quads")
    result = film(x, faces, rim, tolerance=1e-11)
    free = inside(x, rim)
    gradient = area_gradient(result.particles, faces)[free]
    across = (gradient * normals(result.particles, faces)[free]).sum(axis=1)
    assert np.abs(across).max() <= 1e-11 * (2 / 16)
    assert 1e-6 < np.abs(gradient).max() <= 1e-3 * (2 / 16)


@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_which_way_faces_run_does_not_matter(seed: int) -> None:
    """Any faces turned over: what counts is the same, to rounding."""
    rng = np.random.default_rng(seed)
    x, faces, rim = square(5, scherk, "quads" if seed % 2 else "triangles")
    x[inside(x, rim)] += 0.05 * rng.normal(size=(16, 3))
    turned = np.where(rng.random((len(faces), 1)) < 0.5, faces[:, ::-1], faces)
    left = []
    for some in (faces, turned):
        system = compile(scene(x, some, rim))
        left.append(balance(system, system.start()).forces)
    assert np.abs(left[0] - left[1]).max() <= 1e-14 and np.abs(left[0]).max() > 1e-3


def test_what_counts_at_each_particle() -> None:
    """Within a film its normal; at an edge what is across it; at corners, springs and single loads all of it."""
    x, faces, _ = square(6, lambda u, v: 0.2 * u * v, "quads")
    number = np.arange(49).reshape(7, 7)
    more = [
        {"kind": "springs", "particles": [[number[2, 2], number[2, 3]]]},
        {"kind": "unary", "particles": [number[4, 4]], "vector": [0, 0, 1.0]},
        {"kind": "pull_to_curve", "particles": number[0], "curve": x[number[0]], "strength": 1e3},
    ]
    system = compile(scene(x, faces, number[-1], more, [{"particles": number[3, 1:3], "axes": "xy"}]))
    films, state = system.films, system.start()
    assert films is not None
    kind = films.kind.reshape(7, 7)
    assert (kind[1:-1, 1:-1] == WITHIN).sum() == 22 and kind[2, 2] == kind[2, 3] == kind[4, 4] == WHOLE
    assert (kind[0, 1:-1] == SLIDING).all() and (kind[1:-1, 0] == EDGE).all()
    axes, counts = films.frames(state.x, state.free)
    number_of = counts.sum(axis=1).reshape(7, 7)
    assert np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(3), atol=1e-14)
    assert (number_of[1, 1:-1] == 1).all() and number_of[2, 2] == 3 and (number_of[-1] == 0).all()
    assert (number_of[0, 1:-1] == 2).all() and (number_of[1:-1, 0] == 2).all() and number_of[0, 0] == 3
    # held on x and y: z is what is left, and moves the film
    assert (number_of[3, 1:3] == 1).all() and np.abs(axes[number[3, 1], 0]).tolist() == [0, 0, 1]
    right = normals(x, faces)
    assert np.abs(np.abs((axes[number[1, 1], 0] * right[number[1, 1]]).sum()) - 1) <= 1e-14


def test_a_moebius_strip_has_normals() -> None:
    """No side is the outer one of a one-sided film; each vertex has a normal all the same, and the film is found."""
    n, m = 40, 6
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, np.linspace(-0.4, 0.4, m + 1), indexing="ij")
    r = 1 + v * np.cos(u / 2)
    x = np.stack([r * np.cos(u), r * np.sin(u), v * np.sin(u / 2)], axis=-1).reshape(-1, 3)
    number = np.arange(len(x)).reshape(n, m + 1)
    faces = patch(np.concatenate([number, number[:1, ::-1]]))
    result = film(x, faces, np.concatenate([number[:, 0], number[:, -1]]))
    assert area(result.particles, faces) < area(x, faces) and thinnest(result.particles, faces) > 0.1


def test_a_film_folded_over_itself_is_not_at_rest() -> None:
    """A vertex of a flat disc moved beyond its neighbours: flat, but not the least area. It is unfolded again."""
    x, faces, rim = disc(12, 4)
    x[15] += 0.5 * (x[0] - x[15]) * 2.2
    system = compile(scene(x, faces, rim))
    assert balance(system, system.start()).residual > 0.01
    assert area(film(x, faces, rim).particles, faces) == pytest.approx(6 * np.sin(np.pi / 6), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(["relaxation", "momentum", "verlet", "yoshida"], 2))
def test_all_solvers_find_scherks_surface(name: str) -> None:
    """From a flat start, by relaxation, by Kangaroo's steps and in time: the same film, with order 2 (+- 0.4).

    Vertices do not lie where `auto` has them, so errors differ, by less than half; nor where more evenness has them.
    """
    errors = []
    settings: dict[str, Any] = {"solver": name, "max_iterations": 30_000}
    for n in (8, 16):
        x, faces, rim = square(n, scherk, "triangles")
        x[inside(x, rim), 2] = 0.0
        given = settings | ({"time_step": 0.1, "drag": 0.4 * np.sqrt(8 / n)} if name in ("verlet", "yoshida") else {})
        more = {"tolerance": 1e-8, "settings": given}
        errors.append(off_scherk(film(x, faces, rim, **more).particles))
        assert errors[-1] <= 1.5 * off_scherk(film(x, faces, rim).particles)
    assert slopes(errors) == pytest.approx([2], abs=0.4)
    assert off_scherk(film(x, faces, rim, evenness=0.2, **more).particles) <= 2.0 * errors[-1]


@pytest.mark.soak
@pytest.mark.parametrize("name", ["auto", pytest.param("relaxation", marks=pytest.mark.soak), "newton"])
def test_bubbles_on_a_disc_are_caps_of_spheres(name: str) -> None:
    """Sphere p = 2 T / R over a rim of radius 1: height R - sqrt(R^2 - 1), up to nearly half a sphere, order 2.

    Relaxation overshoots, and Newton steps alone do not spread vertices: on finer meshes both collapse.
    """
    for radius in (3.0, 1.5, 1.1, *([1.02] if name == "auto" else [])):
        errors = []
        for n in (16, 32, 64) if name == "auto" else (8, 16, 32):
            x, faces, rim = disc(n, n // 2)
            pressure = {"kind": "pressure", "mesh": "skin", "pressure": 2.0 / radius}
            result = film(x, faces, rim, [pressure], tolerance=1e-8, settings={"solver": name})
            errors.append(result.particles[0, 2] - radius + np.sqrt(radius**2 - 1.0))
        assert slopes(errors) == pytest.approx([2, 2], abs=0.25)


@pytest.mark.soak
@pytest.mark.parametrize("name", ["auto", "relaxation"])
def test_a_bubble_that_bursts_is_reported(name: str) -> None:
    """Beyond p = 2 T / a no cap over a rim of radius a bears the pressure; what is returned is no larger than a few."""
    x, faces, rim = disc(32, 16)
    pressure = {"kind": "pressure", "mesh": "skin", "pressure": 2.0 / 0.9}
    result = relax(scene(x, faces, rim, [pressure], settings={"solver": name}))
    assert str(result.status) == "diverged" and area(result.particles, faces) <= 10 * np.pi
    if name == "auto":
        assert "burst" in result.message and area(result.particles, faces) <= 3 * np.pi


def test_newton_ends_quickly() -> None:
    """From a shape near the film each Newton step leaves at most 100 times the square of the last imbalance, or 0.01.

    That of the gradient along the film, 1e-3 of T h for sides h of a quarter: the axes of a step stand still.
    """
    x, faces, rim = square(8, lambda u, v: u * v, "quads")
    near = film(x, faces, rim, tolerance=1e-3).particles
    near[inside(x, rim)] += 0.005 * np.random.default_rng(2).normal(size=(49, 3))
    system = compile(scene(x, faces, rim, settings={"solver": "newton"}))
    state = system.start()
    state.x = near
    method = solver("newton")
    method.start(system, state)
    state.scratch["shift"][0] = 0.0
    left = [balance(system, state).out_of_balance]
    while left[-1] > 1e-14 and len(left) < 8:
        method.advance(system, state, 1, 0.0)
        left.append(balance(system, state).out_of_balance)
    assert left[0] > 1e-4 and left[-1] <= 1e-14
    assert all(b <= max(100.0 * a * a, 0.01 * a) + 1e-14 for a, b in pairwise(left))


def test_a_run_in_pieces_is_a_run() -> None:
    """Steps taken one by one by solvers made anew, from a state alone, end at the same bits."""
    x, faces, rim = tube(16, 8, 0.5, "quads")
    for name, count in (("relaxation", 40), ("verlet", 40), ("newton", 3)):
        ends = []
        for pieces in (1, count):
            system = compile(scene(x, faces, rim, settings={"solver": name, "time_step": 0.01}))
            state, method = system.start(), solver(name)
            method.start(system, state)
            for _ in range(pieces):
                if name == "relaxation":
                    method = solver(name)
                method.advance(system, state, count // pieces, 0.0)
            ends.append(state.x.copy())
        assert np.array_equal(*ends) and not np.array_equal(ends[0], x)


def test_a_vertex_that_is_released_joins_its_film() -> None:
    """Held at a height over a flat film and released, in time: all is flat again, to a thousandth of that height."""
    x, faces, rim = square(6, lambda u, v: 0.0 * u, "quads")
    settings = {"solver": "verlet", "time_step": 0.05, "drag": 0.5}
    system = compile(scene(x, faces, rim, settings=settings))
    state, method, middle = system.start(), solver("verlet"), len(x) // 2
    state.x[middle, 2], state.free[middle, 2] = 0.5, 0.0
    method.start(system, state)
    method.advance(system, state, 500, 0.0)
    assert state.x[middle, 2] == 0.5 and (state.x[inside(x, rim), 2] > 0.01).all()
    state.free[middle] = 1.0
    method.advance(system, state, 1000, 0.0)
    assert np.abs(state.x[:, 2]).max() <= 5e-4


def test_forces_added_to_a_running_film_count() -> None:
    """Where a spring is added all of the force counts at its particle, until it is removed; a film added counts."""
    x, faces, rim = square(4, lambda u, v: 0.0 * u, "quads")
    running = Simulation(scene(x, faces, rim))
    middle = len(x) // 2
    assert running.system.films is not None and running.system.films.kind[middle] == WITHIN
    spring = {"kind": "anchor_spring", "particles": [middle], "targets": [[0.0, 0.0, 1.0]]}
    running.patch({"add": [spring]})
    assert running.system.films.kind[middle] == WHOLE
    running.patch({"remove": [1]})
    assert running.system.films.kind[middle] == WITHIN
    running.patch({"add": [spring], "remove": [0]})
    assert running.system.films is None
    running.undo()
    assert running.system.films is not None and running.system.films.kind[middle] == WITHIN


@pytest.mark.soak
def test_a_film_in_a_net_is_stiff_as_a_whole() -> None:
    """Where springs hold every vertex nothing is left out, and a film adds its tension to theirs: one shape for all."""
    x, faces, rim = square(8, lambda u, v: 0.3 * u * v, "quads")
    net = {"kind": "springs", "mesh": "skin", "stiffness": 5.0, "rest_factor": 0.8}
    found = [
        film(x, faces, rim, [net], tolerance=1e-9, settings={"solver": name}).particles
        for name in ("auto", "relaxation", "newton")
    ]
    assert np.abs(found[0] - found[1]).max() <= 1e-7 and np.abs(found[0] - found[2]).max() <= 1e-7


@pytest.mark.parametrize("sections", ["tied", "free"])
def test_a_film_in_a_frame_that_bends(sections: str) -> None:
    """Sides of springs that resist bending, held at their ends: one stable shape by all solvers.

    Where in the film vertices lie differs, and so does its error: by less than 1e-3 of how far the sides move.
    """
    n = 6
    x, faces, rim = square(n, lambda u, v: 0.3 * u * v + 0.2 * (1.0 - u**2), "quads")
    number = np.arange(len(x)).reshape(n + 1, n + 1)
    sides = [number[0], number[-1], number[:, 0], number[:, -1]]
    pairs = np.concatenate([np.column_stack([side[:-1], side[1:]]) for side in sides])
    corners = np.concatenate([np.column_stack([side[:-2], side[1:-1], side[2:]]) for side in sides])
    frame = [
        {"kind": "springs", "particles": pairs, "stiffness": 200.0},
        {"kind": "bend", "particles": corners, "stiffness": 5.0, "sections": sections},
    ]
    held = number[[0, 0, -1, -1], [0, -1, 0, -1]]
    found = [
        film(x, faces, held, frame, tolerance=1e-9, settings={"solver": name})
        for name in ("auto", "relaxation", "newton")
    ]
    assert found[0].solver == "auto: film" and found[0].stability is Stability.STABLE
    moved = np.abs(found[0].particles[rim] - x[rim]).max()
    for other in found[1:]:
        assert moved > 0.02 and np.abs(found[0].particles[rim] - other.particles[rim]).max() <= 1e-3 * moved


def test_multilevel_refuses_films() -> None:
    """Its steps know no films: a sentence says what does."""
    x, faces, rim = square(4, scherk, "quads")
    with pytest.raises(InputError, match="use auto"):
        relax(scene(x, faces, rim, settings={"solver": "multilevel"}))
