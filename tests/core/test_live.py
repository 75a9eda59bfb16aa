"""Films that are remeshed while they relax: catenoids from coarse cylinders, bubbles, drops on a plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, relax_live
from hookean.discretize import as_mesh, naked_edges, refine, volume
from hookean.forces.soapfilm import shapes
from hookean.running.live import live_film
from hookean.values.mesh import Mesh

CUBE = Mesh(
    np.array([[x, y, z] for z in (0.0, 1.0) for y in (-0.7, 0.7) for x in (-0.7, 0.7)]),
    np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]),
)


def cylinder(count: int, half: float, rows: int) -> tuple[Mesh, np.ndarray]:
    """A cylinder of radius 1 of few quads, and the vertices of its rims."""
    turn = np.arange(count) * 2.0 * np.pi / count
    x = np.array([[np.cos(a), np.sin(a), z] for z in np.linspace(-half, half, rows + 1) for a in turn])
    i, j = np.arange(count), np.arange(rows)[:, None]
    a, b = j * count + i, j * count + (i + 1) % count
    faces = np.stack([a, b, b + count, a + count], axis=2).reshape(-1, 4)
    return Mesh(x, faces), np.r_[:count, len(x) - count : len(x)]


def catenoid(half: float, length: float) -> Any:
    """Between two rings of radius 1, from an octagonal cylinder of 16 quads."""
    mesh, rim = cylinder(8, half, 2)
    turn = np.linspace(0.0, 2.0 * np.pi, 721)
    rings = [np.column_stack([np.cos(turn), np.sin(turn), np.full(721, z)]) for z in (-half, half)]
    scene = Scene(
        particles=mesh.vertices, meshes={"film": {"vertices": mesh.vertices, "faces": mesh.faces}},
        forces=[{"kind": "soapfilm", "mesh": "film"}], anchors=[{"particles": rim}], settings={"max_iterations": 3000},
    )  # fmt: skip
    return relax_live(scene, length, curves=rings)


@pytest.mark.parametrize("length", [0.4, 0.2])
def test_a_catenoid_from_a_coarse_cylinder(length: float) -> None:
    """r = a cosh(z / a), a cosh(h / a) = 1 (Euler 1744), to the order of the mesh: a flat triangle of sides l is up to
    l^2 / 6 times a curvature of 1 / a = 1.2 away. Its edges are as long as asked for, its rims on the rings."""
    half = 0.5
    found = catenoid(half, length)
    a = brentq(lambda a: a * np.cosh(half / a) - 1.0, 0.6, 0.999)
    x = found.particles
    radius = np.hypot(x[:, 0], x[:, 1])
    assert found.converged
    assert np.abs(radius - a * np.cosh(x[:, 2] / a)).max() <= 1.2 * length**2 / 6.0
    t = np.asarray(found.scene.meshes["film"].faces)[:, :3]
    sides = np.linalg.norm(x[t] - x[np.roll(t, 1, axis=1)], axis=2)
    assert 0.4 * length <= sides.min() and sides.max() <= 1.6 * length
    rim = np.unique(naked_edges(Mesh(x, t[:, [0, 1, 2, 2]])))
    assert len(rim) > 2 * 8 if length < 0.4 else len(rim) >= 2 * 8
    assert np.abs(radius[rim] - 1.0).max() < 1e-5  # the sagitta of a chord of a 720-gon
    assert shapes(x, np.ascontiguousarray(t))[1].min() > 0.2


def drop(degrees: float, length: float) -> tuple[Any, float]:
    """A drop on the plane z = 0 from a block: its surface has a tension of 1, its base, which stays in the plane and
    slides there, -cos(theta), as Young's law has it. What is found, and the volume."""
    block = refine(CUBE, 2)
    x, on = block.vertices, (block.vertices[block.faces, 2] == 0.0).all(axis=1)
    parts = {"cap": block.faces[~on], "base": block.faces[on], "drop": block.faces}
    scene = Scene(
        particles=x, meshes={name: {"vertices": x, "faces": faces} for name, faces in parts.items()},
        forces=[
            {"kind": "soapfilm", "mesh": "cap"},
            {"kind": "soapfilm", "mesh": "base", "tension": -np.cos(np.radians(degrees))},
            {"kind": "volume", "mesh": "drop", "stiffness": 1e4},
        ],
        anchors=[{"particles": np.flatnonzero(x[:, 2] == 0.0), "axes": "z"}],
        settings={"max_iterations": 4000, "tolerance": 2e-3},
    )  # fmt: skip
    return relax_live(scene, length, rounds=12), volume(block)


@pytest.mark.parametrize(("degrees", "length"), [(120.0, 0.35), pytest.param(100.0, 0.2, marks=pytest.mark.soak)])
def test_a_drop_on_a_plane_is_a_cap_with_its_contact_angle(degrees: float, length: float) -> None:
    """A spherical cap of angle theta: V = pi R^3 (2 - 3 cos + cos^3) / 3, h = R (1 - cos), base R sin. Of triangles of
    sides l the radius is off by l^2 / 6R. The volume is kept but for p / K = 2 / (R K) of it."""
    found, size = drop(degrees, length)
    assert found.converged, found.message
    x, c = found.particles, np.cos(np.radians(degrees))
    kept = volume(Mesh(x, np.asarray(found.scene.meshes["drop"].faces)))
    assert kept == pytest.approx(size, rel=3e-4)
    radius = (3.0 * kept / (np.pi * (2.0 - 3.0 * c + c**3))) ** (1.0 / 3.0)
    off = 1.5 * length**2 / (6.0 * radius)
    assert x[:, 2].max() == pytest.approx(radius * (1.0 - c), abs=off)
    base = np.unique(np.asarray(found.scene.meshes["base"].faces))
    assert (x[base, 2] == 0.0).all()
    cap = np.setdiff1d(np.arange(len(x)), base)
    centre = np.array([*x[cap, :2].mean(axis=0), -radius * c])
    assert np.abs(np.linalg.norm(x[cap] - centre, axis=1) - radius).max() <= 2.0 * off
    wide = np.linalg.norm(x[base, :2] - centre[:2], axis=1).max()
    assert wide == pytest.approx(radius * np.sin(np.radians(degrees)), abs=2.0 * off)


def test_a_bubble_from_a_cube_is_a_sphere() -> None:
    """Of its volume, twice that of the cube: 4 pi R^3 / 3, to l^2 / 6R; the volume is kept but for p / K,
    p = 2 / R and K = 1e4 / 1.4."""
    found = live_film(CUBE, 0.35, volume_factor=2.0)
    radius = (3.0 * 2.0 * volume(CUBE) / (4.0 * np.pi)) ** (1.0 / 3.0)
    away = np.linalg.norm(found.vertices - found.vertices.mean(axis=0), axis=1)
    assert len(naked_edges(found)) == 0
    assert volume(found) == pytest.approx(2.0 * volume(CUBE), rel=1.1 * 2.0 / radius / (1e4 / 1.4))
    assert np.abs(away - radius).max() <= 2.0 * 0.35**2 / (6.0 * radius)


def test_a_film_in_a_square_rim_stays_on_it() -> None:
    """A bent square's rim is kept exactly: its corners stay, new vertices lie on its sides; twice the same bits."""
    x = np.array([[0, 0, 0], [1, 0, 0.4], [1, 1, 0], [0, 1, 0.4]], float)
    one, two = (live_film(as_mesh((x, [[0, 1, 2, 3]])), 0.25) for _ in range(2))
    assert one.vertices.tobytes() == two.vertices.tobytes() and one.faces.tobytes() == two.faces.tobytes()
    rim = one.vertices[np.unique(naked_edges(one))]
    for corner in x:
        assert (rim == corner).all(axis=1).any()
    ends = np.stack([x, np.roll(x, -1, axis=0)], axis=1)
    along = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
    off = np.linalg.norm(np.cross(rim[:, None] - ends[:, 0], along), axis=2).min(axis=1)
    assert off.max() < 1e-14 * 10
    assert len(rim) >= 4 * 4


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, 1]}]}, "/forces: there is no soapfilm"),
        ({"more": {"kind": "unary", "particles": [0], "vector": [0, 0, 1]}}, "/forces/1: unary given"),
        ({"warp": 2.0}, "/forces/0/warp: yarns run with the material"),
        ({"masses": [1.0] * 8}, "/masses: masses and velocities by particle"),
        ({"length": 0.0}, "length: it is 0.0"),
    ],
)
def test_scenes_that_cannot_live_are_refused(change: dict[str, Any], message: str) -> None:
    given = {"kind": "soapfilm", "mesh": "film", "warp": change.get("warp", 0.0)}
    forces = change.get("forces", [given, *([change["more"]] if "more" in change else [])])
    scene = Scene(
        particles=CUBE.vertices, meshes={"film": {"vertices": CUBE.vertices, "faces": CUBE.faces}}, forces=forces,
        masses=change.get("masses", 1.0),
    )  # fmt: skip
    with pytest.raises(InputError, match=message):
        relax_live(scene, change.get("length", 0.3))


def test_films_that_cannot_be_are_refused() -> None:
    """A closed one without a volume, an open one with one."""
    with pytest.raises(InputError, match="a closed film without a volume shrinks"):
        live_film(CUBE, 0.3)
    with pytest.raises(InputError, match="an open mesh encloses no volume"):
        live_film(Mesh(CUBE.vertices, CUBE.faces[1:]), 0.3, volume_factor=1.0)
