from __future__ import annotations

import math
from typing import Any

import compas.geometry as cg
import numpy as np
import pytest
import rhino3dm as r
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize import edges, mesh_faces, mesh_surface, naked_edges, triangles
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from soak import examples

few = settings(derandomize=True, deadline=None, max_examples=examples(25))
counts = st.integers(3, 12)


def euler(mesh: Mesh) -> int:
    return len(mesh.vertices) - len(edges(mesh)) + len(mesh.faces)


def volume(mesh: Mesh) -> float:
    p = mesh.vertices[triangles(mesh)]
    return float(np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() / 6)


def patch(points: np.ndarray, degree: int = 2) -> Any:
    """A rhino3dm surface of one span from points (p + 1, p + 1, 3)."""
    n = degree + 1
    surface = r.NurbsSurface.Create(3, False, n, n, n, n)
    for knots in (surface.KnotsU, surface.KnotsV):
        for i in range(2 * degree):
            knots[i] = 0.0 if i < degree else 1.0
    for i in range(n):
        for j in range(n):
            surface.Points[(i, j)] = r.Point4d(*points[i, j].tolist(), 1.0)
    return surface


@few
@given(counts, st.integers(2, 12))
def test_sphere_has_two_poles_and_a_seam(u: int, v: int) -> None:
    sphere = r.Sphere(r.Point3d(1, 2, 3), 2.0)
    for surface in (sphere.ToNurbsSurface(), sphere.ToBrep()):
        mesh = mesh_surface(surface, u, v)
        assert len(mesh.vertices) == u * (v - 1) + 2
        assert len(mesh.faces) == u * v
        assert (mesh.faces[:, 2] == mesh.faces[:, 3]).sum() == 2 * u
        assert euler(mesh) == 2 and not len(naked_edges(mesh))
        assert np.abs(np.linalg.norm(mesh.vertices - [1, 2, 3], axis=1) - 2).max() < 1e-14 * 10
        assert 0 < volume(mesh) < 4 / 3 * math.pi * 8


@few
@given(counts, counts)
def test_torus_is_closed_both_ways(u: int, v: int) -> None:
    circle = r.Circle(r.Point3d(3, 0, 0), 1.0)
    circle.Plane = r.Plane(r.Point3d(3, 0, 0), r.Vector3d(0, 1, 0))
    axis = r.Line(r.Point3d(0, 0, 0), r.Point3d(0, 0, 1))
    surface = r.RevSurface.Create(circle.ToNurbsCurve(), axis, 0.0, 2 * math.pi)
    mesh = mesh_surface(surface, u, v)
    assert len(mesh.vertices) == len(mesh.faces) == u * v
    assert euler(mesh) == 0 and not len(naked_edges(mesh))
    x, y, z = mesh.vertices.T
    assert np.abs((np.hypot(x, y) - 3) ** 2 + z**2 - 1).max() < 1e-13
    assert mesh_surface(cg.ToroidalSurface(3.0, 1.0), u, v).vertices.shape == (u * v, 3)


@few
@given(counts, st.integers(1, 8))
def test_cone_has_an_apex(u: int, v: int) -> None:
    line = r.LineCurve(r.Point3d(2, 0, 0), r.Point3d(0, 0, 4))
    surface = r.RevSurface.Create(line, r.Line(r.Point3d(0, 0, 0), r.Point3d(0, 0, 1)), 0.0, 2 * math.pi)
    mesh = mesh_surface(surface, u, v)
    assert len(mesh.vertices) == u * v + 1
    assert euler(mesh) == 1  # a disc
    assert len(naked_edges(mesh)) == u
    tips = mesh.faces[mesh.faces[:, 2] == mesh.faces[:, 3]]
    assert len(tips) == u and np.allclose(mesh.vertices[tips[:, 2]], [0, 0, 4], atol=1e-14)


@few
@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 10**6))
def test_vertices_are_the_surface_at_even_parameters(u: int, v: int, seed: int) -> None:
    p = np.random.default_rng(seed).uniform(-1, 1, (3, 3, 3)) + np.stack(
        [*np.meshgrid([0, 4, 8], [0, 4, 8], indexing="ij"), np.zeros((3, 3))], axis=2
    )
    mesh = mesh_surface(patch(p), u, v)
    # the tensor Bernstein sum, written out
    b = [lambda t: (1 - t) ** 2, lambda t: 2 * t * (1 - t), lambda t: t**2]
    s, t = np.arange(u + 1) / u, np.arange(v + 1) / v
    want = sum(b[i](s)[:, None, None] * b[j](t)[None, :, None] * p[i, j] for i in range(3) for j in range(3))
    assert np.abs(mesh.vertices - want.reshape(-1, 3)).max() < 1e-14 * 20
    assert len(mesh.faces) == u * v
    a, c = mesh.vertices[mesh.faces[:, 2]] - mesh.vertices[mesh.faces[:, 0]], mesh.vertices[mesh.faces[:, 1]]
    normal = np.cross(c - mesh.vertices[mesh.faces[:, 0]], a)
    assert (normal[:, 2] > 0).all()


@pytest.mark.parametrize("side", ["u0", "u1", "v0", "v1"])
def test_each_collapsed_side_becomes_one_vertex(side: str) -> None:
    p = np.stack([*np.meshgrid([0.0, 1, 2], [0.0, 1, 2], indexing="ij"), np.zeros((3, 3))], axis=2)
    row = {"u0": p[0], "u1": p[-1], "v0": p[:, 0], "v1": p[:, -1]}[side]
    row[:] = row[1].copy()
    mesh = mesh_surface(patch(p), 4, 3)
    along = 3 if side[0] == "u" else 4
    assert len(mesh.vertices) == 20 - along
    assert len(mesh.faces) == 12
    tips = mesh.faces[mesh.faces[:, 2] == mesh.faces[:, 3]]
    assert len(tips) == along
    assert np.allclose(mesh.vertices[tips[:, 2]], row[0])
    assert euler(mesh) == 1
    q = mesh.vertices[triangles(mesh)]
    assert (np.cross(q[:, 1] - q[:, 0], q[:, 2] - q[:, 0])[:, 2] > 0).all()


def test_a_surface_that_only_touches_itself_is_not_welded() -> None:
    # both ends of the middle line meet at one point, the sides do not
    p = np.array([[[0, j, 0], [6, j, 4], [0, j, 0.2 * (j - 1) ** 2]] for j in range(3)], dtype=float).swapaxes(0, 1)
    p[2, 1, 2] = -0.2  # so that the middle of the last side falls on the middle of the first
    mesh = mesh_surface(patch(p), 6, 4)
    assert len(mesh.vertices) == 35


def test_cylinder_and_box() -> None:
    cylinder = r.Cylinder(r.Circle(r.Point3d(0, 0, 0), 1), 2).ToBrep(False, False)
    mesh = mesh_faces(cylinder, 8, 5)
    assert (len(mesh.vertices), len(mesh.faces), euler(mesh), len(naked_edges(mesh))) == (48, 40, 0, 16)
    box = r.Brep.CreateFromBoundingBox(r.BoundingBox(r.Point3d(0, 0, 0), r.Point3d(1, 2, 3)))
    for u, v in ((1, 1), (4, 4), (8, 5), (2, 7)):
        mesh = mesh_faces(box, u, v)
        assert euler(mesh) == 2 and not len(naked_edges(mesh))
        assert volume(mesh) == pytest.approx(6, rel=1e-14)
    quad_sphere = mesh_faces(r.Brep.CreateQuadSphere(r.Sphere(r.Point3d(0, 0, 0), 2)), 6, 6)
    assert len(quad_sphere.vertices) == 6 * 36 + 2 and euler(quad_sphere) == 2


def test_capped_cylinder_is_refused_by_its_name() -> None:
    # opennurbs caps with trimmed planes
    capped = r.Cylinder(r.Circle(r.Point3d(0, 0, 0), 1), 2).ToBrep(True, True)
    with pytest.raises(InputError, match=r"^drum: faces \d, \d are trimmed"):
        mesh_faces(capped, 8, 5, name="drum")


@pytest.mark.parametrize(
    ("surface", "u", "v", "says"),
    [
        (r.Sphere(r.Point3d(0, 0, 0), 1).ToNurbsSurface(), 0, 4, "^u: 0 faces"),
        (r.Sphere(r.Point3d(0, 0, 0), 1).ToNurbsSurface(), 4, -1, "^v: -1 faces"),
        (r.Sphere(r.Point3d(0, 0, 0), 1).ToNurbsSurface(), 4, 2.5, "^v: 2.5 faces"),
        (r.Sphere(r.Point3d(0, 0, 0), 1).ToNurbsSurface(), 2, 4, "at least 3"),
        (patch(np.full((3, 3, 3), np.nan)), 2, 2, "not finite"),
        (patch(np.full((3, 3, 3), 5.0)), 2, 2, "no area"),
        ("a surface", 2, 2, "not a surface"),
    ],
)
def test_bad_input_gets_a_sentence(surface: Any, u: Any, v: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        mesh_surface(surface, u, v)


def test_what_has_no_faces_is_refused_by_its_name() -> None:
    with pytest.raises(InputError, match=r"^roof: .*no faces"):
        mesh_faces(r.Circle(r.Point3d(0, 0, 0), 1), 2, 2, name="roof")


def test_too_few_pieces_round_a_sphere_are_refused():
    """One piece round and one up leave two poles and no face between them."""
    sphere = r.Sphere(r.Point3d(0, 0, 0), 1.0).ToNurbsSurface()
    with pytest.raises(InputError, match="at least 3"):
        mesh_surface(sphere, 1, 1)
