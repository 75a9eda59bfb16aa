"""Films at their edges: cables, curves they slide along, planes of symmetry, other films; and films under loads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import relax
from hookean.forces import Springs
from hookean.running.result import Status
from soak import sampled

from .film_meshes import area, disc, film, inside, patch, scene, slopes, square, triangles, tube


def edge_springs(number: np.ndarray, stiffness: float, length: float) -> dict[str, Any]:
    """Springs along the four sides of a grid, one for each edge, of a stiffness EA and a rest length per side."""
    sides = (number[0], number[-1], number[:, 0], number[:, -1])
    pairs = np.concatenate([np.column_stack([side[:-1], side[1:]]) for side in sides])
    n = len(number) - 1
    return {"kind": "springs", "particles": pairs, "stiffness": stiffness * n / length, "rest_length": length / n}


@pytest.mark.parametrize("kind", sampled(["triangles", "quads"], 2))
def test_edge_cables_of_a_plane_film_are_arcs(kind: str) -> None:
    """Tension S of a cable about a plane film T: an arc of radius S / T, S = EA (l - l0) / l0 the same all along.

    Of n straight pieces, phi apart: 2 S sin(phi / 2) = T L cos(phi / 2), so a circle of radius R with S = T R
    cos(phi / 2), to 1e-9; R itself, from l = 2 R asin(c / 2 R) of the smooth arc, with order 2 (+- 0.1).
    """
    tension, stiffness, length, errors = 2.0, 40.0, 1.94, []
    smooth = brentq(lambda r: stiffness * (2 * r * np.arcsin(1 / r) / length - 1) - tension * r, 1.0001, 50.0)
    for n in (4, 8, 16, 32):
        x, faces, _ = square(n, lambda u, v: 0.0 * u, kind)
        number = np.arange(len(x)).reshape(n + 1, n + 1)
        held = [{"particles": number[[0, 0, -1, -1], [0, -1, 0, -1]]}]
        result = film(x, faces, [], [edge_springs(number, stiffness, length)], held, tension=tension)
        side = result.particles[number[0], :2]
        sag = side[n // 2, 0] - side[0, 0]
        radius = (1.0 + sag**2) / (2.0 * sag)  # of the circle through both ends and the middle
        centre = [side[n // 2, 0] - radius, 0.0]
        assert np.linalg.norm(side - centre, axis=1) == pytest.approx(np.full(n + 1, radius), rel=1e-9)
        turn = 2.0 * np.arcsin(1.0 / radius) / n
        assert result.force("springs")["force"] == pytest.approx(
            np.full(4 * n, tension * radius * np.cos(turn / 2)), rel=1e-9
        )
        assert np.abs(result.particles[:, 2]).max() <= 1e-12
        errors.append(radius - smooth)
    assert slopes(errors) == pytest.approx([2, 2, 2], abs=0.1)


@pytest.mark.soak
def test_a_hoop_that_a_film_draws_open() -> None:
    """Film T from a ring of radius 1 to a hoop at a height, held there alone: a catenoid r = a cosh((z - b) / a).

    The hoop bears T dr/ds = S / r with S = EA (2 pi r / l0 - 1) and dr/ds = sqrt(1 - (a / r)^2). Order 2 (+- 0.2).
    """
    tension, height, stiffness, length = 1.0, 0.5, 2.0, 2.0

    def neck(radius: float) -> float:
        return float(brentq(lambda a: a * (np.arccosh(1 / a) - np.arccosh(radius / a)) - height, 1e-6, radius))

    def left(radius: float) -> float:
        pull = stiffness * (2 * np.pi * radius / length - 1) / radius
        return tension * np.sqrt(1 - (neck(radius) / radius) ** 2) - pull

    right = brentq(left, 0.325, 0.40)
    errors = []
    for n in (32, 64, 128):
        m = n // 4
        u, v = np.meshgrid(np.linspace(0, 1, m + 1), 2 * np.pi * np.arange(n) / n, indexing="ij")
        r = 1 - 0.65 * u
        x = np.stack([r * np.cos(v), r * np.sin(v), 0 * u], axis=-1).reshape(-1, 3)
        number = np.arange(len(x)).reshape(m + 1, n)
        faces = patch(np.column_stack([number, number[:, 0]]))
        pairs = np.column_stack([number[-1], np.roll(number[-1], -1)])
        hoop = Springs(particles=pairs, stiffness=stiffness * n / length, rest_length=length / n)
        raised = {"particles": number[-1], "axes": "z", "targets": x[number[-1]] + [0, 0, height]}
        result = film(x, faces, number[0], [hoop], [raised], tension=tension)
        radii = np.linalg.norm(result.particles[number[-1], :2], axis=1)
        assert np.ptp(radii) <= 1e-9
        errors.append(radii.mean() - right)
    assert slopes(errors) == pytest.approx([2, 2], abs=0.2) and abs(errors[-1]) <= 1e-3


def test_films_that_meet_at_120_degrees() -> None:
    """Two rings and a disc of film between them: catenoids that meet the disc at 120 degrees. Plateau 1873; order 2.

    r = a cosh(z / a + c) with dr/dz = sinh(c) = tan 30 degrees at the disc, and r = 1 at the rings.
    """
    half, c, errors = 0.3, np.arcsinh(np.tan(np.pi / 6)), []
    a = brentq(lambda a: a * np.cosh(half / a + c) - 1, 0.4, 0.9)
    for n in (16, 32, 64):
        m = 2 * (n // 8)
        x, faces, rings = tube(n, m, half, "quads")
        y, more, edge = disc(n, n // 4)
        own = inside(y, edge)
        number = np.empty(len(y), int)
        number[edge], number[own] = n * (m // 2) + np.arange(n), len(x) + np.arange(len(own))
        result = film(np.concatenate([x, y[own]]), np.concatenate([faces, number[more]]), rings)
        errors.append(np.linalg.norm(result.particles[number[edge], :2], axis=1).mean() - a * np.cosh(c))
    assert slopes(errors) == pytest.approx([2, 2], abs=0.3) and abs(errors[-1]) <= 1e-3


def test_a_plane_of_symmetry_and_a_rail_are_met_at_right_angles() -> None:
    """Half a catenoid whose edge is held in a plane alone is half of the whole one: the same neck to 1e-9."""
    n, m, half = 32, 12, 0.6
    x, faces, rim = tube(n, m, half, "quads")
    whole = film(x, faces, rim).particles.reshape(m + 1, n, 3)
    lower = np.arange(n * (m // 2 + 1))
    kept = faces[(faces < len(lower)).all(axis=1)]
    plane = [{"particles": lower[-n:], "axes": "z"}]
    part = film(x[lower], kept, lower[:n], anchors=plane).particles.reshape(-1, n, 3)
    necks = [np.linalg.norm(ring[:, :2], axis=1).mean() for ring in (whole[m // 2], part[-1])]
    assert necks[1] == pytest.approx(necks[0], abs=1e-3)
    radii = np.linalg.norm(part[-1, :, :2], axis=1)
    assert np.ptp(radii) <= 1e-9 and not np.ptp(part[-1, :, 2])


def test_a_rim_slides_along_curves() -> None:
    """A rim drawn off its curves and pulled to them: the film that it spans where it is held on them, a flat disc.

    Pulled with strength S, particles rest T h / S off their curve, h the length of rim at each.
    """
    n, strength, tension = 24, 1e4, 3.0
    x, faces, rim = disc(n, 8)
    turn = 2 * np.pi * np.arange(4000) / 4000
    curve = np.column_stack([np.cos(turn), np.sin(turn), 0.2 * np.cos(2 * turn)])
    rng = np.random.default_rng(1)
    x[rim] *= rng.uniform(0.9, 1.1, (n, 1))
    pull = {"kind": "pull_to_curve", "particles": rim, "curve": curve, "closed": True, "strength": strength}
    result = film(x, faces, [], [pull], tension=tension, tolerance=1e-8)
    y = result.particles
    held = film(y, faces, rim, tension=tension).particles
    assert np.abs(held[:, 2] - y[:, 2]).max() <= 1e-3
    across = result.force("pull_to_curve")["distance"] * strength
    assert across.sum() == pytest.approx(tension * np.linalg.norm(np.diff(curve, axis=0), axis=1).sum(), rel=0.02)
    # spread as drawn: about as far apart from each other, 2 pi / n
    angle = np.unwrap(np.arctan2(y[rim, 1], y[rim, 0]))
    assert np.abs(np.diff(angle) - 2 * np.pi / n).max() <= 0.3 * 2 * np.pi / n


def test_an_edge_that_nothing_holds_is_reported() -> None:
    """A film on four points, and one with three free sides: a film draws a free edge back whatever its shape."""
    x, faces, _ = square(6, lambda u, v: 0.3 * u * v, "quads")
    number = np.arange(len(x)).reshape(7, 7)
    for held in (number[[0, 0, -1, -1], [0, -1, 0, -1]], number[0]):
        result = relax(scene(x, faces, held))
        assert result.status is Status.DIVERGED
        assert "/forces/0: the film's edge at particle" in result.message
        assert "Anchor the edge, or put springs along it" in result.message
        assert np.array_equal(result.particles, x)


def test_a_load_on_a_single_vertex_is_borne_in_full() -> None:
    """F up on the middle of a hexagon of radius 1: E = 3 T sqrt(3/4 + h^2) - F h, so h^2 = 3/4 F^2 / (9 T^2 - F^2)."""
    tension, load = 2.0, 3.0
    turn = np.pi / 3 * np.arange(6)
    x = np.concatenate([[[0.3, -0.2, 0.4]], np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])])
    faces = [[0, 1 + i, 1 + (i + 1) % 6] for i in range(6)]
    up = {"kind": "unary", "particles": [0], "vector": [0.0, 0.0, load]}
    result = film(x, faces, np.arange(1, 7), [up], tension=tension)
    height = load * np.sqrt(0.75) / np.sqrt(9 * tension**2 - load**2)
    assert result.particles[0] == pytest.approx([0, 0, height], abs=1e-9)


def test_a_load_on_all_vertices_bends_a_film_as_pressure_does() -> None:
    """w per area on a disc under T: z = w (1 - r^2) / 4 T while slopes s are small, to s^2 and with order 2."""
    tension, w, errors = 4.0, 0.01, []
    for n in (16, 32, 64):
        x, faces, rim = disc(n, n // 2)
        corners, shares = triangles(faces)
        a, b, c = (x[corners[:, i]] for i in range(3))
        share = 0.5 * shares * np.linalg.norm(np.cross(b - a, c - a), axis=1) / 3.0
        vector = np.zeros_like(x)
        vector[:, 2] = w * np.bincount(corners.ravel(), np.repeat(share, 3), len(x))
        load = {"kind": "unary", "particles": np.arange(len(x)), "vector": vector}
        result = film(x, faces, rim, [load], tension=tension, tolerance=1e-9)
        errors.append(result.particles[0, 2] / (w / (4 * tension)) - 1.0)
    # the slope at the rim is w / 2 T = 1e-3
    assert slopes(np.array(errors)) == pytest.approx([2, 2], abs=0.3) and abs(errors[-1]) <= 2e-3


def test_a_load_that_no_film_bears_is_reported() -> None:
    """A film pulled at a vertex by more than its triangles bear gets a spike without end: F = 2 pi a T of a catenoid.

    Its neck a would be a fifth of a face; what is returned is finite and little larger than what was drawn.
    """
    x, faces, rim = square(32, lambda u, v: 0.0 * u, "triangles")
    up = {"kind": "unary", "particles": [len(x) // 2], "vector": [0.0, 0.0, 0.5]}
    result = relax(scene(x, faces, rim, [up]))
    assert result.status is Status.DIVERGED and "Collapsed after" in result.message
    assert area(result.particles, faces) <= 1.5 * area(x, faces)
