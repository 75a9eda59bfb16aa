"""Every Brep and extrusion of the real files: what is meshed, what is refused, and that seams are shared."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import rhino3dm as r
from scipy.spatial import cKDTree

from hookean.discretize import as_mesh, edges, is_trimmed, mesh_faces, mesh_surface, naked_edges, triangles
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from soak import sampled

FILES = [
    "v3_Terrain.3dm",
    "v3_UntrimmedSurfaces.3dm",
    "v5_extrusions.3dm",
    "v7_my_brep.3dm",
    "v7_my_trimmed_surface.3dm",
    "v7_rhino_logo_nurbs.3dm",
]
# object number and its trimmed faces: the ones without a cached mesh
REFUSED = {
    "v3_Terrain.3dm": {0: [0]},
    "v3_UntrimmedSurfaces.3dm": {32: [0], 34: [0, 1], 45: [0, 1, 2, 3, 4]},
    "v7_my_trimmed_surface.3dm": {0: [0]},
}


def breps(objects: list[tuple[Any, str]]) -> list[tuple[int, Any]]:
    return [(i, g) for i, (g, _) in enumerate(objects) if isinstance(g, r.Brep)]


def faces_of(brep: Any) -> list[Any]:
    return [brep.Faces[i] for i in range(len(brep.Faces))]


def euler(mesh: Mesh) -> int:
    return len(mesh.vertices) - len(edges(mesh)) + len(mesh.faces)


def volume(mesh: Mesh) -> float:
    p = mesh.vertices[triangles(mesh)]
    return float(np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() / 6)


def check_seams(mesh: Mesh) -> None:
    """No two vertices in one place; every inner edge run once each way (one side is outside)."""
    size = float(np.ptp(mesh.vertices, axis=0).max())
    assert not cKDTree(mesh.vertices).query_pairs(1e-6 * size)
    assert np.array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))
    sides = np.stack([mesh.faces, np.roll(mesh.faces, -1, 1)], 2).reshape(-1, 2)
    sides = sides[sides[:, 0] != sides[:, 1]]
    assert len(np.unique(sides, axis=0)) == len(sides)


def grid(face: Any, u: int, v: int) -> np.ndarray:
    (a, b), (c, d) = ((face.Domain(k).T0, face.Domain(k).T1) for k in (0, 1))
    at = [face.PointAt(a + (b - a) * i / u, c + (d - c) * j / v) for i in range(u + 1) for j in range(v + 1)]
    return np.array([[p.X, p.Y, p.Z] for p in at])


def on_faces(mesh_points: np.ndarray, faces: list[Any], u: int, v: int) -> None:
    """Each vertex is a surface point of some face, evaluated here once more."""
    sizes = {(u, v), (v, u), (u, u), (v, v)}
    marks = np.concatenate([grid(f, *s) for f in faces for s in sizes])
    assert cKDTree(marks).query(mesh_points)[0].max() <= 1e-12 * np.abs(marks).max()


@pytest.mark.soak
@pytest.mark.parametrize("counts", sampled([(5, 3), (4, 4)], 2))
def test_all_133_untrimmed_faces(counts: tuple[int, int], rhino_objects: Any) -> None:
    u, v = counts
    faces_seen = 0
    for _, brep in breps(rhino_objects("v3_UntrimmedSurfaces.3dm")):
        faces = faces_of(brep)
        if any(is_trimmed(f) for f in faces):
            # the untrimmed neighbours of trimmed faces are meshed one by one
            singles = [f for f in faces if not is_trimmed(f)]
            for f in singles:
                assert len(mesh_surface(f, u, v).faces) == u * v
            continue
        mesh = mesh_faces(brep, u, v)
        faces_seen += len(faces)
        check_seams(mesh)
        on_faces(mesh.vertices, faces, u, v)
        if u == v:
            assert len(mesh.faces) == len(faces) * u * v
    trimmed = [brep for _, brep in breps(rhino_objects("v3_UntrimmedSurfaces.3dm")) if is_trimmed(brep.Faces[0])]
    faces_seen += sum(not is_trimmed(f) for brep in trimmed for f in faces_of(brep))
    assert faces_seen == 133


def test_seams_of_the_untrimmed_breps(rhino_objects: Any) -> None:
    every = [b for _, b in breps(rhino_objects("v3_UntrimmedSurfaces.3dm"))]
    by_count = {len(b.Faces): b for b in every if not is_trimmed(b.Faces[0])}
    for u, v in ((4, 4), (5, 3)):
        # two caps of revolution: closed, two poles
        closed = mesh_faces(by_count[2], u, v)
        assert euler(closed) == 2 and not len(naked_edges(closed)) and volume(closed) > 0
        # a ring of eight faces: open above and below
        ring = mesh_faces(by_count[8], u, v)
        assert euler(ring) == 0
        assert len(naked_edges(ring)) in (8 * 2 * u, 8 * 2 * v)


def test_the_six_faces_of_the_twisted_box(rhino_objects: Any) -> None:
    brep = rhino_objects("v7_my_brep.3dm")[0][0]
    for u, v in ((1, 1), (4, 4), (5, 3)):
        mesh = mesh_faces(brep, u, v)
        check_seams(mesh)
        on_faces(mesh.vertices, faces_of(brep), u, v)
        assert euler(mesh) == 2 and not len(naked_edges(mesh))
    assert len(mesh_faces(brep, 4, 4).faces) == 96


@pytest.mark.soak
def test_the_22_cached_meshes_of_the_logo(rhino_objects: Any) -> None:
    seen = 0
    for (_, brep), chi in zip(breps(rhino_objects("v7_rhino_logo_nurbs.3dm")), (0, 2, 2, 0, 0, 2), strict=True):
        mesh = mesh_faces(brep, 4, 4)
        cached = [as_mesh(f.GetMesh(r.MeshType.Any)) for f in faces_of(brep)]
        seen += len(cached)
        assert len(mesh.faces) == sum(len(c.faces) for c in cached)
        every = np.concatenate([c.vertices for c in cached])
        assert cKDTree(mesh.vertices).query(every)[0].max() <= 1e-6 * np.ptp(every, axis=0).max()
        assert euler(mesh) == chi and not len(naked_edges(mesh)) and volume(mesh) > 0
        check_seams(mesh)
    assert seen == 22


@pytest.mark.slow
@pytest.mark.parametrize(("u", "v"), [(4, 4), (5, 3), (16, 2)])
def test_the_seven_extrusions(u: int, v: int, rhino_objects: Any) -> None:
    extrusions = [g for g, _ in rhino_objects("v5_extrusions.3dm") if isinstance(g, r.Extrusion)]
    assert len(extrusions) == 7
    for extrusion in extrusions:
        brep = extrusion.ToBrep(True)
        mesh = mesh_faces(extrusion, u, v)
        check_seams(mesh)
        on_faces(mesh.vertices, [f for f in faces_of(brep) if not is_trimmed(f)], u, v)
        closed = extrusion.CapCount == 2
        holes = extrusion.ProfileCount - 1
        assert (len(naked_edges(mesh)) == 0) == closed
        if closed:
            assert euler(mesh) == 2 - 2 * holes
            assert volume(mesh) == pytest.approx(_prism(mesh, extrusion), rel=1e-9)


def _prism(mesh: Mesh, extrusion: Any) -> float:
    """Volume between the two end planes (mitred or not): cross section x height over its centroid.

    Area and centroid come from the walls' own base sides, so they owe nothing to the caps.
    """
    along = extrusion.PathTangent
    axis = np.array([along.X, along.Y, along.Z])
    x = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    frame = np.stack([x / np.linalg.norm(x), np.cross(axis, x / np.linalg.norm(x)), axis])
    p = mesh.vertices @ frame.T
    quads = mesh.faces[mesh.faces[:, 2] != mesh.faces[:, 3]]
    walls = quads[np.ptp(p[quads, 2], axis=1) > 1e-9 * np.ptp(p[:, 2])]
    sides = np.stack([walls, np.roll(walls, -1, 1)], 2).reshape(-1, 2)
    sides = sides[(np.abs(p[:, 2] - p[:, 2].min()) < 1e-9 * np.ptp(p[:, 2]))[sides].all(axis=1)]
    a, b = p[sides[:, 0], :2], p[sides[:, 1], :2]
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2
    centre = ((a + b) * cross[:, None]).sum(axis=0) / (6 * area)
    above = np.zeros(len(p), bool)
    inner = np.unique(sides)
    for q in inner:  # the highest vertex over each base vertex lies in the other end plane
        over = np.flatnonzero(np.abs(p[:, :2] - p[q, :2]).max(axis=1) < 1e-9 * np.ptp(p))
        above[over[p[over, 2].argmax()]] = True
    plane = np.linalg.lstsq(np.c_[p[above][:, :2], np.ones(above.sum())], p[above][:, 2], rcond=None)[0]
    return float(abs(area) * (centre @ plane[:2] + plane[2] - p[:, 2].min()))


@pytest.mark.slow
@pytest.mark.parametrize("file", FILES)
def test_exactly_the_trimmed_faces_without_a_mesh_are_refused(file: str, rhino_objects: Any) -> None:
    refused = {}
    for i, brep in breps(rhino_objects(file)):
        try:
            mesh_faces(brep, 3, 3, name=f"object {i}")
        except InputError as error:
            assert error.pointer == f"object {i}"
            faces = error.sentence.split(" trimmed")[0].removeprefix("faces ").removeprefix("face ")
            refused[i] = [int(w) for w in faces.replace("are", "").replace("is", "").split(",")]
    assert refused == REFUSED.get(file, {})


@pytest.mark.slow
@pytest.mark.parametrize("file", sampled(FILES, 3))
def test_trimmed_as_the_edges_say(file: str, rhino_objects: Any) -> None:
    """Another way to tell: one loop, its edges on the sides of the domain and as long as those."""
    trimmed = untrimmed = 0
    for geometry, _ in rhino_objects(file):
        if not isinstance(geometry, (r.Brep, r.Extrusion)):
            continue
        brep = geometry if isinstance(geometry, r.Brep) else geometry.ToBrep(True)
        for face in faces_of(brep):
            assert is_trimmed(face) == (not _covers_its_sides(face, brep))
            trimmed += is_trimmed(face)
            untrimmed += not is_trimmed(face)
    assert (trimmed, untrimmed) == {
        "v3_Terrain.3dm": (1, 0),
        "v3_UntrimmedSurfaces.3dm": (8, 133),
        "v5_extrusions.3dm": (8, 40),
        "v7_my_brep.3dm": (0, 6),
        "v7_my_trimmed_surface.3dm": (1, 0),
        "v7_rhino_logo_nurbs.3dm": (13, 9),
    }[file]


def _covers_its_sides(face: Any, brep: Any) -> bool:
    if len(face.Loops) != 1:
        return False
    loop = face.Loops[0]
    trims = [loop.Trims[i].EdgeIndex for i in range(loop.TrimCount)]
    walked = np.concatenate([_dense(brep.Edges[e]) for e in trims if e >= 0])
    sides = [_dense(face.IsoCurve(d, at)) for d in (0, 1) for at in (face.Domain(1 - d).T0, face.Domain(1 - d).T1)]

    def run(chains: list[np.ndarray]) -> float:
        return sum(float(np.linalg.norm(np.diff(c, axis=0), axis=1).sum()) for c in chains)

    around = run(sides)
    off = cKDTree(np.concatenate(sides)).query(walked)[0].max()
    return off < 2e-3 * around and abs(run([_dense(brep.Edges[e]) for e in trims if e >= 0]) - around) < 1e-3 * around


def _dense(curve: Any) -> np.ndarray:
    at = np.linspace(curve.Domain.T0, curve.Domain.T1, 301)
    return np.array([[p.X, p.Y, p.Z] for p in (curve.PointAt(t) for t in at.tolist())])
