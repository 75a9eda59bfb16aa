"""Relaxing over HTTP is relaxing in Python, in every form the answer can have."""

from __future__ import annotations

import base64
import copy
import json
from typing import Any

import compas
import httpx
import numpy as np
import pytest
from compas.datastructures import Graph, Mesh
from compas.geometry import Pointcloud

from hookean import Scene, relax
from hookean_server.http.schemas import EXAMPLES
from serving import CABLE

from .conftest import problem

SCENES = {"chapter": CABLE, **EXAMPLES["relax"]}
NET = EXAMPLES["relax"]["pulled net"]


def arrays(value: Any) -> Any:
    """A JSON answer with every buffer as an array."""
    if isinstance(value, dict):
        if set(value) == {"dtype", "shape", "base64"}:
            return np.frombuffer(base64.b64decode(value["base64"]), value["dtype"]).reshape(value["shape"])
        return {k: arrays(v) for k, v in value.items()}
    return [arrays(v) for v in value] if isinstance(value, list) else value


def lists(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {k: lists(v) for k, v in value.items()}
    return [lists(v) for v in value] if isinstance(value, list) else value


@pytest.mark.thinned
@pytest.mark.parametrize("name", SCENES)
def test_lists_are_the_same_to_the_bit(client: httpx.Client, name: str) -> None:
    answer = client.post("/v1/relax", json=SCENES[name])
    wanted = json.loads(json.dumps(relax(Scene.read(SCENES[name])).to_dict()))
    assert answer.status_code == 200
    assert answer.json() == wanted


@pytest.mark.parametrize("name", SCENES)
def test_buffers_are_the_same_to_the_bit(client: httpx.Client, name: str) -> None:
    answer = client.post("/v1/relax?arrays=buffer", json=SCENES[name]).json()
    result = relax(Scene.read(SCENES[name]))
    assert arrays(answer["particles"]).tobytes() == result.particles.tobytes()
    assert answer["particles"]["dtype"] == "<f8"
    assert arrays(answer["forces"][0]["particles"]).tobytes() == result.forces[0]["particles"].tobytes()
    assert lists(arrays(answer)) == json.loads(json.dumps(result.to_dict()))


def test_a_large_net_is_the_same_to_the_bit(client: httpx.Client) -> None:
    mesh = Mesh.from_meshgrid(10.0, nx=30)
    vertices, faces = mesh.to_vertices_and_faces()
    scene = {
        "meshes": {"net": {"vertices": vertices, "faces": faces}},
        "forces": [
            {"kind": "springs", "mesh": "net", "stiffness": 10, "rest_factor": 0.7},
            {"kind": "unary", "points": vertices, "vector": [0, 0, 0.01]},
        ],
        "anchors": [{"points": [[0, 0, 0], [10, 0, 0], [0, 10, 0], [10, 10, 3]], "targets": None}],
        "strict": False,
    }
    answer = client.post("/v1/relax", json=scene).json()
    assert answer == json.loads(json.dumps(relax(Scene.read(scene)).to_dict()))


def test_the_cable_of_the_chapter(client: httpx.Client) -> None:
    answer = client.post("/v1/relax", json=CABLE).json()
    points = np.array(answer["particles"])
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert answer["status"] == "converged"
    assert lengths.sum() == pytest.approx(10.4679154891668, abs=1e-6)
    assert answer["forces"][0]["length"] == pytest.approx(lengths.tolist(), abs=1e-12)
    assert points[[0, 5]].tolist() == [[0, 0, 0], [10, 0, 0]]
    assert points[2, 2] == pytest.approx(points[3, 2], abs=1e-6)
    lift = np.array(answer["reactions"]["force"])
    assert lift.sum(axis=0) == pytest.approx([0, 0, 120], abs=1e-3)


def test_the_cable_to_full_accuracy(client: httpx.Client) -> None:
    answer = client.post("/v1/relax", json={**CABLE, "settings": {"tolerance": 1e-12}}).json()
    assert sum(answer["forces"][0]["length"]) == pytest.approx(10.4679154891668, abs=1e-11)


@pytest.mark.parametrize(
    ("settings", "status"),
    [
        ({"max_iterations": 1}, "max_iterations"),
        ({"time_limit": 0, "solver": "relaxation"}, "time_limit"),
        ({"solver": "verlet", "time_step": 1e3}, "diverged"),
    ],
)
def test_every_finished_run_is_an_answer(client: httpx.Client, settings: dict[str, Any], status: str) -> None:
    answer = client.post("/v1/relax", json={**CABLE, "settings": settings})
    assert answer.status_code == 200
    assert answer.json()["status"] == status and answer.json()["message"]
    assert "NaN" not in answer.text and "Infinity" not in answer.text


def test_scenes_without_forces_are_scenes(client: httpx.Client) -> None:
    for scene in ({"particles": [[0, 0, 0]]}, {**CABLE, "forces": []}):
        answer = client.post("/v1/relax", json=scene)
        assert answer.status_code == 200
        assert answer.json() == json.loads(json.dumps(relax(Scene.read(scene)).to_dict()))


def test_loads_that_meet_no_particle_are_a_problem_or_in_the_report(client: httpx.Client) -> None:
    """422 with each force by its pointer; with strict false the answer has their points, and a sentence for each."""
    gusts = [
        {"kind": "unary", "name": name, "points": [[0, 0, 0], [9, 9, 9]], "vector": [0, 0, 1]} for name in ("a", "b")
    ]
    scene = {**CABLE, "forces": [*CABLE["forces"], *gusts]}
    errors = problem(client.post("/v1/relax", json=scene), 422, "invalid-scene")["errors"]
    assert [error["pointer"] for error in errors] == ["/forces/2/points", "/forces/3/points"]
    assert errors[1]["detail"].startswith("b: 1 of 2 points met no particle; the nearest is 12.7671 m away from (9, 9")
    report = client.post("/v1/relax", json={**scene, "strict": False}).json()["report"]
    assert report["unmatched"][0]["pointer"] == "/forces/2/points/1"
    assert [(one["name"], one["count"], one["total"]) for one in report["missed"]] == [("a", 1, 2), ("b", 1, 2)]


def test_answers_take_the_form_of_the_request(client: httpx.Client) -> None:
    points = np.array(CABLE["particles"], dtype="<f8")
    text = base64.b64encode(points.tobytes()).decode()
    scene = {**CABLE, "particles": {"dtype": "<f8", "shape": [6, 3], "base64": text}}
    as_given = client.post("/v1/relax", json=scene).json()
    assert as_given["particles"]["shape"] == [6, 3]
    assert client.post("/v1/relax?arrays=list", json=scene).json() == client.post("/v1/relax", json=CABLE).json()
    # buffers that went out can come back in
    again = {**scene, "particles": as_given["particles"]}
    assert client.post("/v1/relax", json=again).status_code == 200


def test_compas_documents_in_and_out(client: httpx.Client) -> None:
    mesh = Mesh.from_vertices_and_faces(NET["meshes"]["net"]["vertices"], NET["meshes"]["net"]["faces"])
    mesh.name = "sail"
    scene = {**NET, "meshes": {"net": json.loads(compas.json_dumps(mesh))}}
    plain = client.post("/v1/relax", json=NET).json()
    found = client.post("/v1/relax", json=scene).json()
    entry = found["geometry"][0]
    back = compas.json_loads(json.dumps(entry.pop("mesh")))
    assert isinstance(back, Mesh) and back.name == "sail"
    vertices, faces = back.to_vertices_and_faces()
    assert vertices == plain["geometry"][0].pop("vertices")
    assert [[*f, f[-1]][:4] for f in faces] == plain["geometry"][0].pop("faces")
    assert found == plain
    asked = client.post("/v1/relax?meshes=compas", json=NET).json()
    assert compas.json_loads(json.dumps(asked["geometry"][0]["mesh"])).to_vertices_and_faces() == (vertices, faces)
    refused = client.post("/v1/relax?meshes=plain", json=scene).json()
    assert refused["geometry"][0]["vertices"] == vertices


def test_keys_and_many_sided_faces_come_back(client: httpx.Client) -> None:
    mesh = Mesh.from_meshgrid(2.0, nx=2)
    mesh.delete_face(0)
    mesh.remove_unused_vertices()
    faces = {f: mesh.face_vertices(f) for f in mesh.faces()}
    document = json.loads(compas.json_dumps(mesh))
    scene = {
        "meshes": {"a": document},
        "forces": [{"kind": "springs", "mesh": "a", "rest_factor": 0.5}],
        "anchors": [{"points": [[2, 0, 0], [0, 2, 0]]}],
        "geometry": [{"kind": "mesh", "mesh": "a"}],
    }
    answer = client.post("/v1/relax", json=scene).json()
    back = compas.json_loads(json.dumps(answer["geometry"][0]["mesh"]))
    assert list(back.vertices()) == list(mesh.vertices())
    assert [back.face_vertices(f) for f in back.faces()] == list(faces.values())


def test_a_compas_graph_is_springs(client: httpx.Client) -> None:
    lines = [[CABLE["particles"][i], CABLE["particles"][i + 1]] for i in range(5)]
    scene = {
        "forces": [
            {"kind": "springs", "lines": json.loads(compas.json_dumps(Graph.from_lines(lines)))},
            {
                "kind": "unary",
                "points": json.loads(compas.json_dumps(Pointcloud(CABLE["particles"]))),
                "vector": [0, 0, -20],
            },
        ],
        "anchors": [{"points": [[0, 0, 0], [10, 0, 0]]}],
    }
    answer = client.post("/v1/relax", json=scene).json()
    assert sum(answer["forces"][0]["length"]) == pytest.approx(10.4679154891668, abs=1e-6)


def test_carried_documents_come_back_as_documents(client: httpx.Client) -> None:
    graph = Graph.from_lines([[CABLE["particles"][i], CABLE["particles"][i + 1]] for i in range(5)])
    scene = {**CABLE, "geometry": [json.loads(compas.json_dumps(graph)), {"kind": "points", "particles": [0]}]}
    answer = client.post("/v1/relax", json=scene).json()
    back = compas.json_loads(json.dumps(answer["geometry"][0]["document"]))
    assert isinstance(back, Graph) and list(back.edges()) == list(graph.edges())
    assert [back.node_coordinates(node) for node in back.nodes()] == answer["particles"]
    assert answer["geometry"][1]["points"] == [[0, 0, 0]]
    plain = client.post("/v1/relax?meshes=plain", json=scene).json()
    assert plain["geometry"][0]["lines"][0] == [answer["particles"][0], answer["particles"][1]]


def test_a_document_alone_is_relaxed_with_its_boundary_held(client: httpx.Client) -> None:
    mesh = Mesh.from_meshgrid(4.0, nx=4)
    mesh.vertex_attribute(1, "z", 1.0)
    answer = client.post("/v1/relax", json=json.loads(compas.json_dumps(mesh))).json()
    assert answer["status"] == "converged" and set(answer["reactions"]["names"]) == {"held"}
    back = compas.json_loads(json.dumps(answer["geometry"][0]["mesh"]))
    assert list(back.faces()) == list(mesh.faces()) and 0.0 < back.vertex_attribute(6, "z") < 1.0
    graph = Graph.from_lines([[[0, 0, 0], [1, 0, 3]], [[1, 0, 3], [2, 0, 0]]])
    answer = client.post("/v1/relax", json=json.loads(compas.json_dumps(graph))).json()
    assert answer["particles"][1] == pytest.approx([1, 0, 0], abs=1e-5)
    refused = client.post("/v1/relax", json=json.loads(compas.json_dumps(Pointcloud([[0, 0, 0]]))))
    assert refused.status_code == 422 and "cannot be relaxed" in refused.text


def test_requests_do_not_disturb_each_other(client: httpx.Client) -> None:
    from concurrent.futures import ThreadPoolExecutor

    def one(load: int) -> bool:
        scene = copy.deepcopy(CABLE)
        scene["forces"][1]["vector"] = [0, 0, -load]
        return bool(
            client.post("/v1/relax", json=scene).json() == json.loads(json.dumps(relax(Scene.read(scene)).to_dict()))
        )

    with ThreadPoolExecutor(6) as threads:
        assert all(threads.map(one, range(1, 25)))


def test_times_are_told(client: httpx.Client) -> None:
    said = client.post("/v1/relax", json=CABLE).headers["server-timing"]
    assert [part.split(";")[0] for part in said.split(", ")] == ["decode", "solve", "encode"]


def test_a_faulty_parameter(client: httpx.Client) -> None:
    found = problem(client.post("/v1/relax?arrays=secret", json=CABLE), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/query/arrays" and "secret" not in json.dumps(found)


def test_all_faults_are_listed(client: httpx.Client) -> None:
    scene = {**CABLE, "weld_tolerance": -1, "settings": {"drag": -1}, "forces": [{"kind": "springs"}] * 30}
    found = problem(client.post("/v1/relax", json=scene), 422, "invalid-scene")
    assert len(found["errors"]) == 20
    pointers = [e["pointer"] for e in found["errors"]]
    assert "/weld_tolerance" in pointers and "/forces/0" in pointers
