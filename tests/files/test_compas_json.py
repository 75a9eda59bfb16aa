"""COMPAS documents: what real compas writes is read, what is written real compas reads, nothing is imported."""

from __future__ import annotations

import json
import sys
from typing import Any

import compas
import numpy as np
import pytest
from compas.datastructures import Graph, Mesh
from compas.geometry import Line, Point, Pointcloud, Polygon, Polyline, Vector

from hookean.errors import InputError
from hookean.files import compas_json
from hookean.files.documents import plain
from hookean.scene.scene import Scene

MESH = "compas.datastructures/Mesh"


def document(thing: Any) -> Any:
    return json.loads(compas.json_dumps(thing))


def test_mesh_round_trip_through_compas() -> None:
    mesh = Mesh.from_meshgrid(10.0, nx=3)
    mesh.name = "roof"
    found = compas_json.read(document(mesh))
    vertices, faces = mesh.to_vertices_and_faces()
    assert found.points.tolist() == vertices
    assert [list(f) for f in found.faces] == faces
    assert found.name == "roof"
    assert len(found.lines) == mesh.number_of_edges()
    drawn = {frozenset(map(tuple, mesh.edge_coordinates(edge))) for edge in mesh.edges()}
    assert {frozenset(map(tuple, line)) for line in found.lines.tolist()} == drawn
    back = compas.json_loads(json.dumps(compas_json.mesh(found.points, found.faces, found.keys, found.name)))
    assert isinstance(back, Mesh)
    assert back.to_vertices_and_faces() == (vertices, faces)
    assert list(back.vertices()) == list(mesh.vertices())
    assert back.name == "roof"
    assert back.is_manifold()
    back.add_vertex(x=1.0)  # max_vertex is right: no key is overwritten
    assert back.number_of_vertices() == len(vertices) + 1


def test_vertices_and_faces_removed_leave_gaps_in_the_keys() -> None:
    mesh = Mesh.from_meshgrid(10.0, nx=3)
    mesh.delete_face(next(iter(mesh.faces())))
    mesh.remove_unused_vertices()
    assert mesh.number_of_vertices() != max(mesh.vertices()) + 1
    found = compas_json.read(document(mesh))
    assert found.points.tolist() == mesh.to_vertices_and_faces()[0]
    back = compas.json_loads(json.dumps(compas_json.mesh(found.points, found.faces, found.keys)))
    assert list(back.vertices()) == list(mesh.vertices())
    assert [back.face_vertices(f) for f in back.faces()] == [mesh.face_vertices(f) for f in mesh.faces()]


def test_triangles_with_a_repeated_corner_are_written_as_triangles() -> None:
    written = compas_json.mesh(np.eye(3), [[0, 1, 2, 2]])
    assert compas.json_loads(json.dumps(written)).face_vertices(0) == [0, 1, 2]


def test_faces_of_five_sides_are_cut_for_the_scene_only() -> None:
    angle = np.linspace(0, 2 * np.pi, 6)[:-1]
    corners = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1).tolist()
    mesh = Mesh.from_vertices_and_faces(corners, [[0, 1, 2, 3, 4]])
    found, plain = compas_json.plain_mesh(document(mesh))
    assert found.faces == ((0, 1, 2, 3, 4),)
    assert len(plain["faces"]) == 3


def test_graph_round_trip_through_compas() -> None:
    graph = Graph.from_lines([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 5]]])
    found = compas_json.read(document(graph))
    assert found.lines.tolist() == [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 5]]]
    back = compas.json_loads(json.dumps(compas_json.graph(found.points, found.edges, "net")))
    assert isinstance(back, Graph)
    assert sorted(back.edges()) == [(0, 1), (1, 2)]
    assert back.node_coordinates(2) == [2, 0, 5]
    assert back.name == "net"


def test_graph_nodes_of_any_key_and_defaults() -> None:
    graph = Graph()
    graph.add_node("a", x=1, y=2, z=3)
    graph.add_node((1, 2))
    graph.add_edge("a", (1, 2))
    found = compas_json.read(document(graph))
    assert found.points.tolist() == [[1, 2, 3], [0, 0, 0]]
    assert found.edges.tolist() == [[0, 1]]


@pytest.mark.parametrize(
    ("thing", "points", "lines"),
    [
        (Point(1, 2, 3), [[1, 2, 3]], 0),
        (Vector(1, 2, 3), [[1, 2, 3]], 0),
        (Line([0, 0, 0], [1, 0, 0]), [[0, 0, 0], [1, 0, 0]], 1),
        (Polyline([[0, 0, 0], [1, 0, 0], [1, 1, 0]]), [[0, 0, 0], [1, 0, 0], [1, 1, 0]], 2),
        (Polygon([[0, 0, 0], [1, 0, 0], [1, 1, 0]]), [[0, 0, 0], [1, 0, 0], [1, 1, 0]], 3),
        (Pointcloud([[0, 0, 0], [1, 0, 0]]), [[0, 0, 0], [1, 0, 0]], 0),
    ],
)
def test_geometry(thing: Any, points: list[list[float]], lines: int) -> None:
    found = compas_json.read(document(thing))
    assert found.points.tolist() == points
    assert len(found.lines) == lines


def test_a_class_derived_from_mesh_is_read_as_mesh() -> None:
    value = document(Mesh.from_meshgrid(1.0, nx=1))
    value["dtype"], value["inheritance"] = "my_package/Roof", ["compas.datastructures/Mesh"]
    assert compas_json.read(value).kind == "mesh"


def test_nothing_a_document_names_is_imported(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "trap.py").write_text("raise SystemExit('imported')\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(InputError) as error:
        compas_json.read({"dtype": "trap/Mesh", "data": {}, "inheritance": ["trap/Other"]}, "/meshes/a")
    assert "trap" not in sys.modules
    assert error.value.pointer == "/meshes/a/dtype"
    assert "trap/Mesh" in error.value.sentence
    assert all(name in error.value.sentence for name in compas_json.ACCEPTED)


@pytest.mark.parametrize(
    ("value", "pointer"),
    [
        (None, "/"),
        ({"dtype": "compas.geometry/Point"}, "/"),
        ({"dtype": 5, "data": []}, "/dtype"),
        ({"dtype": "compas.geometry/Point", "data": [0, 0]}, "/data"),
        ({"dtype": "compas.geometry/Point", "data": [0, 0, True]}, "/data"),
        ({"dtype": "compas.geometry/Point", "data": [0, 0, float("nan")]}, "/data"),
        ({"dtype": "compas.geometry/Point", "data": [0, 0, 10**400]}, "/data"),
        ({"dtype": "compas.geometry/Line", "data": []}, "/data/start"),
        ({"dtype": "compas.geometry/Polyline", "data": {"points": [[0, 0, 0], ["1", 0, 0]]}}, "/data/points/1"),
        ({"dtype": "compas.datastructures/Mesh", "data": []}, "/data/vertex"),
        ({"dtype": "compas.datastructures/Mesh", "data": {"vertex": {"0": None}, "face": {}}}, "/data/vertex/0"),
        ({"dtype": "compas.datastructures/Mesh", "data": {"vertex": {}, "face": {"0": [0, 1, 2]}}}, "/data/face/0"),
        ({"dtype": MESH, "data": {"vertex": {"0": {}}, "face": {"a/b": [0]}}}, "/data/face/a~1b"),
        ({"dtype": "compas.datastructures/Graph", "data": {"node": {}, "edge": {"0": {"1": {}}}}}, "/data/edge/0"),
        ({"dtype": "compas.datastructures/Graph", "data": {"node": {"0": {}}, "edge": {"0": []}}}, "/data/edge/0"),
    ],
)
def test_a_damaged_document_is_told_with_its_place(value: Any, pointer: str) -> None:
    with pytest.raises(InputError) as error:
        compas_json.read(value)
    assert error.value.pointer == pointer


def test_a_scene_of_documents_is_the_plain_scene() -> None:
    mesh = Mesh.from_meshgrid(4.0, nx=2)
    graph = Graph.from_lines([[[0, 0, 0], [4, 0, 0]]])
    value = {
        "meshes": {"net": document(mesh)},
        "forces": [
            {"kind": "springs", "mesh": "net"},
            {"kind": "springs", "lines": document(graph)},
            {"kind": "springs", "lines": [document(Line([0, 0, 0], [4, 4, 0])), document(Line([4, 0, 0], [0, 4, 0]))]},
            {"kind": "unary", "points": document(Pointcloud([[2, 2, 0]])), "vector": document(Vector(0, 0, -1))},
        ],
        "anchors": [{"points": [document(Point(0, 0, 0)), document(Point(4, 4, 0))]}],
        "geometry": [{"kind": "polyline", "points": document(Polyline([[0, 0, 0], [4, 0, 0]]))}],
    }
    plain, meshes, seen = compas_json.plain_scene(value)
    assert seen and list(meshes) == ["net"]
    vertices, faces = mesh.to_vertices_and_faces()
    wanted = {
        "meshes": {"net": {"vertices": vertices, "faces": faces}},
        "forces": [
            {"kind": "springs", "mesh": "net"},
            {"kind": "springs", "lines": [[[0, 0, 0], [4, 0, 0]]]},
            {"kind": "springs", "lines": [[[0, 0, 0], [4, 4, 0]], [[4, 0, 0], [0, 4, 0]]]},
            {"kind": "unary", "points": [[2, 2, 0]], "vector": [0, 0, -1]},
        ],
        "anchors": [{"points": [[0, 0, 0], [4, 4, 0]]}],
        "geometry": [{"kind": "polyline", "points": [[0, 0, 0], [4, 0, 0]]}],
    }
    assert Scene.read(plain).digest == Scene.read(wanted).digest
    assert value["meshes"]["net"]["dtype"] == "compas.datastructures/Mesh"  # the input stays as it was


def test_plain_scenes_pass_through() -> None:
    value = {"particles": [[0, 0, 0]], "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, 1]}]}
    assert compas_json.plain_scene(value) == (value, {}, False)
    assert compas_json.plain_scene([1]) == ([1], {}, False)


def test_a_point_where_a_mesh_is_expected() -> None:
    with pytest.raises(InputError, match="/meshes/a/dtype"):
        compas_json.plain_scene({"meshes": {"a": document(Point(0, 0, 0))}})


def test_the_same_mesh_is_written_the_same() -> None:
    assert compas_json.mesh(np.eye(3), [[0, 1, 2]]) == compas_json.mesh(np.eye(3), [[0, 1, 2]])


@pytest.mark.parametrize(
    "thing",
    [
        Point(1, 2, 3),
        Vector(1, 2, 3),
        Line([0, 0, 0], [1, 0, 0]),
        Polyline([[0, 0, 0], [1, 0, 0], [1, 1, 0]]),
        Polygon([[0, 0, 0], [1, 0, 0], [1, 1, 0]]),
        Pointcloud([[0, 0, 0], [1, 0, 0]]),
        Graph.from_lines([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 5]]]),
        Mesh.from_meshgrid(1.0, nx=2),
    ],
)
def test_a_carried_document_comes_back_as_what_it_was(thing: Any) -> None:
    """In place where nothing moves, each of its points elsewhere where all is shifted."""
    from hookean.running.result import carried
    from hookean.system.system import compile

    plain, documents, seen = compas_json.plain_scene({"geometry": [document(thing)], "forces": []})
    assert seen and list(documents) == [0]
    system = compile(Scene.read({**plain, "particles": documents[0].points}))
    state = system.start()
    state.x += 1.0
    back = compas.json_loads(json.dumps(compas_json.moved(documents[0], carried(system, state)[0])))
    assert type(back) is type(thing)
    found = compas_json.read(document(back))
    assert found.points.tolist() == (documents[0].points + 1.0).tolist()
    assert found.edges.tolist() == documents[0].edges.tolist()
    assert found.faces == documents[0].faces and found.keys == documents[0].keys


def test_keys_of_a_graph_come_back() -> None:
    graph = Graph()
    for key in ("a", (1, 2), 7):
        graph.add_node(key, x=1, y=2, z=3)
    graph.add_edge((1, 2), "a")
    found = compas_json.read(document(graph))
    back = compas.json_loads(json.dumps(compas_json.graph(found.points, found.edges, "", found.keys)))
    assert list(back.nodes()) == ["a", (1, 2), 7] and list(back.edges()) == [((1, 2), "a")]
    back.add_node()
    assert back.number_of_nodes() == 4  # max_node is right: no key is overwritten


def test_a_document_alone_is_a_scene_with_its_boundary_held() -> None:
    mesh = Mesh.from_meshgrid(4.0, nx=4)
    mesh.vertex_attribute(12, "z", 1.0)
    found = plain(document(mesh))
    scene = Scene.read(found.scene)
    assert len(scene.anchors[0].particles) == 16 and list(found.documents) == [0] and not found.unheld
    with pytest.raises(InputError, match="cannot be relaxed"):
        plain(document(Pointcloud([[0, 0, 0]])))
    closed = plain(document(Mesh.from_polyhedron(6)))
    assert "a closed mesh has no naked vertices" in closed.unheld and not Scene.read(closed.scene).anchors


def test_a_mesh_of_the_name_of_a_document_is_told() -> None:
    value = {"meshes": {"geometry 0": {}}, "geometry": [document(Mesh.from_meshgrid(1.0, nx=1))], "forces": []}
    with pytest.raises(InputError, match="is in use; rename that mesh"):
        compas_json.plain_scene(value)
