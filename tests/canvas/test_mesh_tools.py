"""Components of tools for meshes and polylines: the numbers of the core, trees, and one sentence for what does not
fit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import rhino3dm

import hookean.discretize as hd
from canvas.canvasing import let_go, point
from canvas.test_tools import QUADS, SQUARE, as_mesh, branches, places, run, said
from hookean.values.mesh import Mesh
from hookean_canvas.run import stand_in
from hookean_client import canvas_geometry
from serving import Home


@pytest.fixture(scope="module", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A server that the components find."""
    patch = pytest.MonkeyPatch()
    found = Home(tmp_path_factory.mktemp("state"))
    found.serve()
    patch.setenv("HOOKEAN_STATE", str(found.folder))
    yield found
    let_go()
    patch.undo()
    found.end()


@pytest.fixture(params=["stand-ins", "rhino3dm"], autouse=True)
def rhino(request: pytest.FixtureRequest) -> Iterator[Any]:
    """Rhino.Geometry: of the stand-ins, and rhino3dm's."""
    made = stand_in.Canvas(rhino3dm if request.param == "rhino3dm" else None).install()
    yield made.modules["Rhino.Geometry"]
    made.remove()


def plain(mesh: Any) -> Any:
    found = canvas_geometry.mesh(mesh)
    return np.array(found["vertices"]), np.array(found["faces"])


def same(found: Any, wanted: Mesh) -> bool:
    vertices, faces = plain(found)
    return bool((vertices == wanted.vertices).all() and (faces == wanted.faces).all())


def test_meshes_are_those_of_the_core() -> None:
    mesh = as_mesh(QUADS)
    [found] = run("Refine", _mesh=[mesh])["mesh"]
    assert same(found, hd.refine(QUADS))
    [found] = run("Refine", _mesh=[mesh], _level_=["2"], _smooth_=[True])["mesh"]
    assert same(found, hd.refine(QUADS, 2, smooth=True))
    for given, direction in (([], "along"), ([1], "warp"), (["Weft"], "weft")):
        [found] = run("RefineStrips", _mesh=[mesh], _direction_=given)["mesh"]
        assert same(found, hd.refine_strips(QUADS, 1, direction))
    [found] = run("Remesh", _mesh=[mesh], _length=[0.4], _angle_=[0.2], _iterations_=[3])["mesh"]
    assert same(found, hd.remesh(QUADS, 0.4, 0.2, 3))
    [found] = run("Diagonalize", _mesh=[mesh])["mesh"]
    assert same(found, hd.diagonalize(QUADS))
    assert [len(plain(one)[1]) for one in run("Refine", _mesh=[mesh] * 3, _level_=[0, 1, 2])["mesh"]] == [6, 24, 96]


def test_meshes_of_a_branch_become_one() -> None:
    """Two squares beside each other, 0.005 apart: 6 vertices; 8 within a smaller distance."""
    beside = Mesh(SQUARE.vertices + [1.005, 0, 0], SQUARE.faces)
    given = [as_mesh(SQUARE), as_mesh(beside), as_mesh(SQUARE)]
    for tolerance, count in (([], 6), ([0.001], 8)):
        vertices, faces = plain(run("CombineClean", _meshes=given, _tolerance_=tolerance)["mesh"])
        assert len(vertices) == count and len(faces) == 2


def test_points_without_duplicates() -> None:
    given = [point(0, 0, 0), point(0, 0, 0.005), point(1, 0, 0), point(0, 0, 0)]
    assert places(run("RemoveDuplicatePoints", _points=given)["points"]).tolist() == [[0, 0, 0], [1, 0, 0]]
    assert len(run("RemoveDuplicatePoints", _points=given, _tolerance_=[0.001])["points"]) == 3


def test_a_checkerboard_and_its_faces() -> None:
    found = run("Checkerboard", _mesh=[as_mesh(QUADS)])
    second, first, other = hd.checkerboard(QUADS)
    assert found["pattern"] == second.tolist() and found["pattern"][1] is True
    assert found["first"] == first.tolist() and found["second"] == other.tolist()


def test_hinges_and_their_angles() -> None:
    found = run("HingePoints", _mesh=[as_mesh(QUADS)])
    corners = [QUADS.vertices[index] for index in hd.hinge_points(QUADS)]
    names = ("start", "end", "tip_1", "tip_2")
    assert all((places(found[name]) == rows).all() for name, rows in zip(names, corners, strict=True))
    angles = run("FoldAngle", **{f"_{name}": found[name] for name in names})["angle"]
    assert angles == hd.fold_angle(*corners).tolist()
    one = run("FoldAngle", _start=[point(0, 0, 0)], _end=[point(1, 0, 0)], _tip_1=[point(0, 1, k) for k in (0, 1)],
              _tip_2=[point(0, -1, 0)])  # fmt: skip
    assert one["angle"] == pytest.approx([0.0, np.pi / 4])


def test_neighbours_have_a_branch_for_each_vertex() -> None:
    mesh = as_mesh(QUADS)
    rings, normals = hd.vertex_neighbours(QUADS)
    found = run("VertexNeighbours", _mesh=[mesh])
    assert (places(found["points"]) == QUADS.vertices).all() and (places(found["normals"]) == normals).all()
    assert branches(found["indices"]) == {f"{{0;{i}}}": ring.tolist() for i, ring in enumerate(rings)}
    near = branches(found["neighbours"])["{0;4}"]
    assert (places(near) == QUADS.vertices[rings[4]]).all()
    two = run("VertexNeighbours", _mesh=[mesh, mesh], vertices_=[7])
    assert branches(two["indices"]) == {"{0;0;0}": rings[7].tolist(), "{0;1;0}": rings[7].tolist()}


def test_points_go_with_their_mesh() -> None:
    moved = Mesh(QUADS.vertices[:, [1, 2, 0]] + 3.0, QUADS.faces)
    given = {"_source": [as_mesh(QUADS)], "_target": [as_mesh(moved)]}
    rows = np.array([[0.5, 0.5, 1.0], [2.5, 1.0, -2.0]])
    for distance, factor in (([], 1.0), ([0.25], 0.25)):
        found = run("MeshMap", _point=[point(*row) for row in rows], _distance_=distance, **given)["points"]
        assert places(found) == pytest.approx(hd.mesh_map(rows, QUADS, moved, factor), abs=1e-14)


def test_polylines_come_apart(rhino: Any) -> None:
    bent = rhino.PolylineCurve([point(*row) for row in ((0, 0, 0), (1, 0, 0), (2, 0.1, 0), (2, 1, 0))])
    found = run("SplitAtCorners", _polyline=[bent])
    assert places(found["corners"]).tolist() == [[2, 0.1, 0]]
    assert [len(canvas_geometry.polyline(part)) for part in found["parts"]] == [3, 2]
    assert len(run("SplitAtCorners", _polyline=[bent], _angle_=[0.05])["corners"]) == 2


@pytest.mark.parametrize(
    ("name", "inputs", "sentence"),
    [
        ("Refine", {}, "Mesh is missing; connect it."),
        ("Refine", {"_mesh": 1, "_level_": [-1]}, "Level: -1 given; a whole number from 0 on is expected."),
        ("RefineStrips", {"_mesh": 1, "_direction_": ["up"]},
         'Direction: the text "up" is unknown; give one of 0 along, 1 warp, 2 weft.'),
        ("Remesh", {"_mesh": 1}, "Length is missing; connect it."),
        ("CombineClean", {}, "Meshes is missing; connect it."),
        ("CombineClean", {"_meshes": ["x"]}, 'The text "x" is not a mesh; connect a mesh.'),
        ("FoldAngle", {"_start": ["0,0,0"], "_end": ["1,0,0"], "_tip_1": ["0,1,0"]},
         "Tip_2 is missing; connect points."),
        ("MeshMap", {"_point": ["0,0,0"]}, "Source is missing; connect a mesh."),
        ("SplitAtCorners", {}, "Curve is missing; connect one."),
        ("VertexNeighbours", {"_mesh": 1, "vertices_": [12]},
         "Vertices 0: vertex 12 does not exist; the mesh has 12, counted from 0."),
    ],
)  # fmt: skip
def test_one_sentence_says_what_does_not_fit(name: str, inputs: dict[str, Any], sentence: str) -> None:
    given = {key: [as_mesh(QUADS)] if value == 1 else value for key, value in inputs.items()}
    assert said(name, **given) == sentence
