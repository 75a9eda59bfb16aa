"""COMPAS structures as parts of a scene and back: the numbers of the engine on the keys a person gave."""

from __future__ import annotations

import json
from typing import Any

import compas as real_compas
import numpy as np
import pytest
from compas.datastructures import Graph, Mesh
from compas.geometry import Line, Point, Pointcloud, Polygon, Polyline, Vector
from hypothesis import given
from hypothesis import strategies as st

from hookean import Scene, relax
from hookean.files import compas_json
from hookean_client import Problem, compas


def solve(structures: list[Any], forces: list[Any], anchors: list[Any], **more: Any) -> dict[str, Any]:
    """The result as it comes over HTTP."""
    scene = Scene.read(json.loads(json.dumps(compas.scene(structures, forces, anchors, **more))))
    return json.loads(json.dumps(relax(scene).to_dict(), default=lambda array: array.tolist()))


def net() -> Mesh:
    """A square of 4 x 4 faces whose keys have gaps, held at its corners."""
    mesh = Mesh.from_meshgrid(4.0, nx=4)
    extra = [mesh.add_vertex(x=9.0) for _ in range(3)]
    for key in extra[:2]:
        mesh.delete_vertex(key)
    mesh.delete_vertex(extra[2])
    mesh.vertices_attribute("is_support", True, keys=list(mesh.vertices_where({"vertex_degree": 2})))
    return mesh


def test_a_mesh_comes_back_relaxed_with_its_forces_and_reactions() -> None:
    mesh = net()
    result = solve(
        [mesh], [compas.springs(mesh, stiffness=10.0, rest_factor=0.5), compas.load(mesh, [0, 0, -1])],
        [compas.anchors(mesh)],
    )  # fmt: skip
    [found] = compas.relaxed([mesh], result)
    assert isinstance(found, Mesh) and found is not mesh
    assert mesh.vertex_coordinates(12) == [2.0, 2.0, 0.0]  # what was given stays
    assert [found.vertex_coordinates(key) for key in found.vertices()] == result["particles"]
    for a, b in found.edges():
        assert found.edge_length((a, b)) == pytest.approx(found.edge_attribute((a, b), "length"), abs=1e-12)
        force = 10.0 * (found.edge_length((a, b)) - 0.5 * mesh.edge_length((a, b)))
        assert found.edge_attribute((a, b), "force") == pytest.approx(force, abs=1e-9)
        strain = found.edge_length((a, b)) / (0.5 * mesh.edge_length((a, b))) - 1
        assert found.edge_attribute((a, b), "strain") == pytest.approx(strain, abs=1e-9)
    reactions = np.array(found.vertices_attribute("reaction"))
    assert np.allclose(reactions.sum(axis=0), [0, 0, 25], atol=1e-3)  # they carry what is laid on
    held = {key for key in found.vertices() if any(found.vertex_attribute(key, "reaction"))}
    assert held == set(mesh.vertices_where(is_support=True)) and len(held) == 4
    assert found.attributes["status"] == "converged" and found.attributes["residual"] <= 1e-6
    assert real_compas.json_loads(real_compas.json_dumps(found)).attributes["status"] == "converged"


def test_a_graph_of_any_keys_hangs_as_the_engine_says() -> None:
    graph = Graph()
    graph.add_node("left", x=0.0, is_anchor=True)
    graph.add_node((1, 2), x=1.0, pz=-3.0)
    graph.add_node(7, x=2.0, is_fixed=True)
    graph.add_edge(7, (1, 2), ea=50.0)
    graph.add_edge("left", (1, 2), ea=100.0)
    result = solve([graph], [compas.springs(graph, stiffness="ea"), compas.load(graph)], [compas.anchors(graph)])
    [found] = compas.relaxed([graph], result)
    assert list(found.nodes()) == ["left", (1, 2), 7] and list(found.edges()) == list(graph.edges())
    x, y, z = found.node_coordinates((1, 2))
    assert z < -0.1 and y == 0.0 and x < 1.0  # the stiffer side gives less
    up = [found.node_attribute(key, "reaction")[2] for key in ("left", 7)]
    assert sum(up) == pytest.approx(3.0, abs=1e-5)
    force = {key: found.edge_attribute((key, (1, 2)), "force") for key in (7,)}[7]
    assert force == pytest.approx(50.0 * (np.hypot(2.0 - x, z) - 1.0), abs=1e-9)


def test_structures_that_touch_are_joined() -> None:
    mesh = net()
    stay = Line([2.0, 2.0, 0.0], [2.0, 2.0 + 2e-4, 3.0])
    tie = Polyline([[2, 2, 3], [3, 3, 5]])
    forces = [compas.springs(s, stiffness=100.0, rest_factor=0.9) for s in (mesh, stay, tie)]
    structures = [mesh, stay, tie]
    result = solve(structures, forces, [compas.anchors(mesh), compas.anchors(tie, at=[1])])
    assert len(result["particles"]) == 25 + 2  # the foot of the stay is a vertex of the mesh, its head one of the tie
    moved, line, polyline = compas.relaxed(structures, result)
    assert isinstance(line, Line) and isinstance(polyline, Polyline)
    assert list(line.start) == moved.vertex_coordinates(12) and list(line.end) == list(polyline.points[0])
    assert line.start.z > 0.1 and list(polyline.points[1]) == [3, 3, 5]


def test_springs_side_by_side_are_added() -> None:
    graph = Graph.from_lines([[[0, 0, 0], [2, 0, 0]]])
    one = compas.springs(graph, stiffness=1.0, rest_length=1.0)
    two = {**one, "stiffness": 3.0, "lines": compas.buffer([[[2, 0, 0], [0, 0, 0]]])}
    [found] = compas.relaxed([graph], solve([graph], [one, two], [compas.anchors(graph, at=["0", 1])]))
    assert found.edge_attribute((0, 1), "force") == pytest.approx(4.0)
    assert found.node_attribute(1, "reaction") == pytest.approx([4.0, 0.0, 0.0])


def test_results_of_buffers_are_the_same() -> None:
    from hookean_server.http import answers

    mesh = net()
    scene = Scene.read(compas.scene([mesh], [compas.springs(mesh, rest_factor=0.0)], [compas.anchors(mesh)]))
    result = relax(scene)
    both = [json.loads(answers.encode(result, scene, arrays, None)) for arrays in ("list", "buffer")]
    assert isinstance(both[1]["particles"], dict)
    plain, packed = [compas.relaxed([mesh], each)[0] for each in both]
    assert plain.vertices_attributes("xyz") == packed.vertices_attributes("xyz")
    assert plain.vertices_attribute("reaction") == packed.vertices_attribute("reaction")
    assert plain.edges_attribute("force") == packed.edges_attribute("force")


def test_targets_and_axes_of_anchors_are_the_engines() -> None:
    graph = Graph.from_lines([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]])
    ends = compas.anchors(graph, at=[0, 2], targets=[[0, 0, 1], [2, 0, 1]], name="ends")
    middle = compas.anchors(graph, at=[1], axes="yz")
    result = solve([graph], [compas.springs(graph, name="cable")], [ends, middle])
    assert result["particles"][0] == [0, 0, 1] and result["reactions"]["names"][0] == "ends"
    assert result["forces"][0]["name"] == "cable" and result["particles"][1] == pytest.approx([1, 0, 0], abs=1e-5)


@pytest.mark.parametrize(
    ("thing", "kind", "count", "edges"),
    [
        (Point(1, 2, 3), "point", 1, []),
        (Vector(1, 2, 3), "point", 1, []),
        (Line([0, 0, 0], [1, 0, 0]), "line", 2, [(0, 1)]),
        (Polyline([[0, 0, 0], [1, 0, 0], [1, 1, 0]]), "polyline", 3, [(0, 1), (1, 2)]),
        (Polygon([[0, 0, 0], [1, 0, 0], [1, 1, 0]]), "polygon", 3, [(0, 1), (1, 2), (2, 0)]),
        (Pointcloud([[0, 0, 0], [1, 0, 0]]), "points", 2, []),
        (Mesh.from_meshgrid(1.0, nx=1), "mesh", 4, None),
        (Graph.from_lines([[[0, 0, 0], [1, 0, 0]]]), "graph", 2, [(0, 1)]),
    ],
)
def test_structures_are_what_their_documents_say(thing: Any, kind: str, count: int, edges: Any) -> None:
    """The converters, which never see JSON, and the reader of documents, which never sees compas, agree."""
    assert compas.kind(thing) == kind and len(compas.keys(thing)) == count
    if edges is not None:
        assert compas.edges(thing) == edges
    document = compas_json.read(compas.document(thing))
    assert document.points.tolist() == compas.points(thing)
    if kind in ("line", "polyline", "polygon", "graph"):
        place = dict(zip(compas.keys(thing), compas.points(thing), strict=True))
        assert document.lines.tolist() == [[place[a], place[b]] for a, b in compas.edges(thing)]
    assert [list(face) for face in document.faces] == compas.faces(thing)


@given(
    st.lists(
        st.tuples(*[st.floats(-1e3, 1e3, allow_subnormal=False)] * 3).map(list), min_size=1, max_size=30
    ),
    st.sampled_from([1e-6, 1e-3, 1.0, 100.0]),
)  # fmt: skip
def test_every_vertex_is_at_the_first_place_near_it(points: list[list[float]], tolerance: float) -> None:
    places, [index] = compas.numbers([Pointcloud(points)], tolerance)
    apart = np.linalg.norm(np.array(places)[:, None] - np.array(places)[None], axis=2)
    assert np.all(apart[~np.eye(len(places), dtype=bool)] > tolerance)
    for i, point in enumerate(points):
        near = np.flatnonzero(np.linalg.norm(np.array(places) - point, axis=1) <= tolerance)
        assert index[i] == near[0]


def test_lines_become_a_graph_and_faces_a_mesh() -> None:
    lines = [[[0, 0, 0], [1, 0, 0]], [[1, 0, 1e-4], [2, 0, 0]], [[2, 0, 0], [1, 0, 0]], [[5, 5, 5], [5, 5, 5]]]
    graph = compas.to_graph(lines, "net")
    assert isinstance(graph, Graph) and graph.name == "net"
    assert list(graph.edges()) == [(0, 1), (1, 2)] and graph.node_coordinates(1) == [1, 0, 0]
    mesh = compas.to_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    assert isinstance(mesh, Mesh) and mesh.number_of_faces() == 1 and mesh.area() == pytest.approx(1.0)


def no_coordinates() -> Mesh:
    mesh = Mesh.from_meshgrid(1.0, nx=1)
    mesh.vertex_attribute(2, "z", float("nan"))
    return mesh


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (lambda: compas.kind(None), "not nothing"),
        (lambda: compas.points({"a": 1}), "not dict"),
        (lambda: compas.points(no_coordinates()), "Vertex 2 of the mesh is not at finite coordinates"),
        (lambda: compas.springs(Point(0, 0, 0)), "has no edges"),
        (lambda: compas.springs(net(), stiffness="ea"), 'no attribute "ea"; set it for all edges, or give a number'),
        (lambda: compas.springs(net(), stiffness=[1.0, 2.0]), "stiffness has 2 values for 40 edges"),
        (lambda: compas.load(net()), "No vertex has a load in px, py, pz"),
        (lambda: compas.load(net(), [[0, 0, 1], [0, 0, 1]]), "2 vectors given for 25 vertices"),
        (lambda: compas.load(net(), [0, 1]), "vectors given"),
        (lambda: compas.load(net(), []), "vectors given"),
        (lambda: compas.load(net(), [0, 0, 1], at=[99]), "99 is not a vertex of the mesh; its 25 keys are 0 to 24"),
        (lambda: compas.anchors(Mesh.from_meshgrid(1.0, nx=1)), "No vertex is held: set is_support"),
        (lambda: compas.anchors(net(), at=[0], targets=[]), "0 targets x, y, z given for 1 anchors"),
    ],
)
def test_what_does_not_fit_is_one_sentence(fault: Any, said: str) -> None:
    with pytest.raises(Problem) as told:
        fault()
    assert said in told.value.detail and told.value.detail.count("\n") == 0 and told.value.slug == "invalid-input"
