"""Every operation over HTTP gives what its function gives."""

from __future__ import annotations

import json
from typing import Any

import compas
import httpx
import numpy as np
import pytest
import rhino3dm
from compas.datastructures import Mesh
from compas.geometry import Line, Polygon, Polyline

from hookean.discretize import curves, meshing
from hookean.discretize.catenary import catenary
from hookean_server.http.schemas import EXAMPLES
from hookean_server.workers.discretize_task import OPERATIONS

from .conftest import problem

SMALL = EXAMPLES["discretize"]


def sphere() -> Any:
    return rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0).ToBrep().Surfaces[0]


def document(thing: Any) -> Any:
    return json.loads(compas.json_dumps(thing))


def test_the_table_is_listed(client: httpx.Client) -> None:
    listed = client.get("/v1/discretize").json()["operations"]
    assert [o["operation"] for o in listed] == list(OPERATIONS)
    assert all(o["summary"].endswith((".", ":", ",")) or o["summary"] for o in listed)


@pytest.mark.parametrize("name", SMALL)
def test_an_operation_is_its_function(client: httpx.Client, name: str) -> None:
    operation = OPERATIONS[name]
    answer = client.post(f"/v1/discretize/{name}", json=SMALL[name])
    assert answer.status_code == 200, answer.text
    given = {key: read(value) for key, value in SMALL[name].items()}
    wanted = operation.function(given.pop(operation.takes), **given)
    found = answer.json()
    several = wanted if len(operation.gives) > 1 else (wanted,)
    for key, value in zip(operation.gives, several, strict=True):
        if key == "mesh":
            assert found[key] == {"vertices": value.vertices.tolist(), "faces": value.faces.tolist()}
        elif key == "neighbours":
            assert found[key] == [ring.tolist() for ring in value]
        else:
            assert found[key] == np.asarray(value).tolist()


def read(value: Any) -> Any:
    """An input of the body as functions accept it."""
    if isinstance(value, dict):
        return value["vertices"], value["faces"]
    if isinstance(value, list):
        return [read(one) for one in value] if isinstance(value[0], dict) else np.array(value)
    return value


def test_curves_as_compas_and_rhino(client: httpx.Client) -> None:
    points = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]]

    def divided(curve: Any) -> Any:
        answer = client.post("/v1/discretize/divide", json={"curve": curve, "count": 7})
        assert answer.status_code == 200, answer.text
        return answer.json()["points"]

    wanted = curves.divide(np.array(points), 7).tolist()
    assert divided(points) == divided(document(Polyline(points))) == wanted
    assert divided(document(Line(points[0], points[1]))) == curves.divide(np.array(points[:2]), 7).tolist()
    assert divided(document(Polygon(points)))[0] == divided(document(Polygon(points)))[-1]
    arc = rhino3dm.Arc(rhino3dm.Point3d(0, 0, 0), 2.0, 1.5).ToNurbsCurve()
    assert divided(arc.Encode()) == curves.divide(arc, 7).tolist()


def test_a_worker_that_decoded_rhino_geometry_is_replaced(client: httpx.Client) -> None:
    before = client.get("/v1/health").json()["workers"]["restarts"]
    answer = client.post("/v1/discretize/mesh_surface", json={"surface": sphere().Encode(), "u": 6, "v": 5})
    wanted = meshing.mesh_surface(sphere(), 6, 5)
    assert answer.json()["mesh"]["faces"] == wanted.faces.tolist()
    assert np.allclose(answer.json()["mesh"]["vertices"], wanted.vertices, atol=1e-12)
    assert client.post("/v1/discretize/length", json={"curve": [[0, 0, 0], [1, 0, 0]]}).json() == {"length": 1.0}
    assert client.get("/v1/health").json()["workers"]["restarts"] > before


def test_meshes_as_compas(client: httpx.Client) -> None:
    mesh = Mesh.from_meshgrid(2.0, nx=2)
    plain = dict(zip(("vertices", "faces"), mesh.to_vertices_and_faces(), strict=True))
    one = client.post("/v1/discretize/warp_weft", json={"mesh": document(mesh)}).json()
    assert one == client.post("/v1/discretize/warp_weft", json={"mesh": plain}).json()
    welded = client.post("/v1/discretize/weld", json={"mesh": document(mesh)}).json()["mesh"]
    assert compas.json_loads(json.dumps(welded)).to_vertices_and_faces() == mesh.to_vertices_and_faces()


def test_nurbs_forms_are_the_geometry_itself(client: httpx.Client) -> None:
    """A curve and a surface as numbers give what rhino3dm's own give; knots as Rhino has them, or all of them."""
    arc = rhino3dm.Arc(rhino3dm.Point3d(0, 0, 0), 2.0, 1.5).ToNurbsCurve()
    four = np.array([[p.X, p.Y, p.Z, p.W] for p in arc.Points])
    form = {"degree": 2, "points": (four[:, :3] / four[:, 3:]).tolist(), "weights": four[:, 3].tolist()}
    short = list(arc.Knots)
    for knots in (short, [short[0], *short, short[-1]]):
        answer = client.post("/v1/discretize/divide", json={"curve": {**form, "knots": knots}, "count": 7})
        assert np.allclose(answer.json()["points"], curves.divide(arc, 7), atol=1e-14)
    ball = sphere().ToNurbsSurface()
    rows = range(ball.Points.CountU), range(ball.Points.CountV)
    four = np.array([[[(p := ball.Points.GetControlPoint(i, j)).X, p.Y, p.Z, p.W] for j in rows[1]] for i in rows[0]])
    surface = {
        "degree_u": 2,
        "degree_v": 2,
        "points": (four[..., :3] / four[..., 3:]).tolist(),
        "weights": four[..., 3].tolist(),
        "knots_u": list(ball.KnotsU),
        "knots_v": list(ball.KnotsV),
    }
    found = client.post("/v1/discretize/mesh_surface", json={"surface": surface, "u": 6, "v": 5}).json()["mesh"]
    wanted = meshing.mesh_surface(ball, 6, 5)
    assert found["faces"] == wanted.faces.tolist() and np.allclose(found["vertices"], wanted.vertices, atol=1e-13)


def test_places_are_told_beside_numbers_of_vertices(client: httpx.Client) -> None:
    vertices = np.array(GRID["vertices"])
    found = client.post("/v1/discretize/boundary", json=SMALL["boundary"]).json()
    assert found["clothed"] == [4] and found["naked"] == [0, 1, 2, 3, 5, 6, 7, 8]
    assert found["naked_points"] == vertices[found["naked"]].tolist()
    found = client.post("/v1/discretize/threads", json=SMALL["threads"]).json()
    assert found["warp_lines"] == vertices[found["warp"]].tolist()
    inner = [not naked for naked in found["warp_naked"]]
    assert sum(inner) == 2 and all(4 in pair for pair, is_inner in zip(found["warp"], inner, strict=True) if is_inner)


def test_many_catenaries_in_one_request(client: httpx.Client) -> None:
    lines = [[[0, 0, 0], [4, 0, 1]], [[0, 1, 0], [3, 3, 0]]]
    body = {"lines": lines, "length": [6.0, 5.0], "count": 8, "gravity": [[0, 0, -1], [0, 1, 0]]}
    found = client.post("/v1/discretize/catenary", json=body).json()["polylines"]
    for number, (line, length, gravity) in enumerate(zip(lines, body["length"], body["gravity"], strict=True)):
        assert found[number] == catenary(*line, length, count=8, gravity=gravity).tolist()
    short = problem(client.post("/v1/discretize/catenary", json={**body, "length": [6.0, 1.0]}), 422, "invalid-input")
    assert short["errors"][0]["pointer"] == "/length/1"


def test_arrays_as_buffers(client: httpx.Client) -> None:
    answer = client.post("/v1/discretize/edges?arrays=buffer", json=SMALL["edges"]).json()
    assert answer["edges"]["dtype"] == "<i8" and answer["lines"]["dtype"] == "<f8"


GRID = SMALL["edges"]["mesh"]


@pytest.mark.thinned
@pytest.mark.parametrize(
    ("name", "body", "pointer"),
    [
        ("divide", {}, "/count"),
        ("divide", [], "/"),
        ("divide", {"count": 3}, "/curve"),
        ("divide", {"curve": SMALL["divide"]["curve"], "count": 0}, "/count"),
        ("divide", {"curve": SMALL["divide"]["curve"], "count": 10**9}, "/count"),
        ("divide", {"curve": SMALL["divide"]["curve"], "count": True}, "/count"),
        ("divide", {"curve": SMALL["divide"]["curve"], "count": 3, "u": 1}, "/u"),
        ("divide", {"curve": [[0, 0, 0], [0, 0, 0]], "count": 3}, "/curve"),
        ("divide", {"curve": [[0, 0, 0], [0, 0, "x"]], "count": 3}, "/curve/1/2"),
        ("divide", {"curve": {"dtype": "compas.geometry/Sphere", "data": {}}, "count": 3}, "/curve/dtype"),
        ("divide", {"curve": document(Mesh.from_meshgrid(1.0, nx=1)), "count": 3}, "/curve/dtype"),
        ("divide", {"curve": {"version": 1, "archive3dm": 60, "opennurbs": 1, "data": "AAAA"}, "count": 3}, "/curve"),
        ("divide", {"curve": {"version": "1", "archive3dm": 60, "opennurbs": 1, "data": ""}, "count": 3}, "/curve"),
        ("divide", {"curve": {"degree": 3, "points": GRID["vertices"], "knots": [0, 1]}, "count": 3}, "/curve/knots"),
        ("divide", {"curve": {"points": GRID["vertices"], "knots": [0, 1]}, "count": 3}, "/curve"),
        ("divide", {"curve": {"degree": 9, "points": GRID["vertices"], "knots": [0]}, "count": 3}, "/curve/points"),
        ("arc", {"points": GRID["vertices"], "count": 3}, "/points"),
        ("interpolate", {"points": GRID["vertices"], "count": 9, "degree": 12}, "/degree"),
        ("interpolate", {"points": GRID["vertices"], "count": 9, "degree": 0}, "/degree"),
        ("catenary", {"lines": SMALL["catenary"]["lines"], "length": [1, 2, 3]}, "/length"),
        ("catenary", {"lines": SMALL["catenary"]["lines"], "length": 2, "gravity": [0, 0]}, "/gravity"),
        ("catenary", {"lines": SMALL["catenary"]["lines"], "length": 2, "count": 600_000}, "/count"),
        ("mesh_surface", {"surface": [[0, 0, 0]], "u": 1, "v": 1}, "/surface"),
        ("mesh_surface", {"surface": sphere().Encode(), "u": 2000, "v": 2000}, "/v"),
        ("mesh_surface", {"surface": sphere().Encode(), "u": 2, "v": 2}, "/"),
        ("edges", {"mesh": {"vertices": GRID["vertices"], "faces": [[0, 1, 99]]}}, "/mesh/faces/0/2"),
        ("edges", {"mesh": {"vertices": [[0, 0]], "faces": []}}, "/mesh/vertices"),
        ("edges", {"mesh": 5}, "/mesh"),
        ("corners", {"mesh": GRID, "angle": -1}, "/angle"),
        ("corners", {"mesh": GRID, "angle": "1"}, "/angle"),
        ("diagonals", {"mesh": GRID, "pattern": "all"}, "/pattern"),
        ("warp_weft", {"mesh": GRID, "strict": 1}, "/strict"),
        ("weld", {"mesh": GRID, "tolerance": -1}, "/tolerance"),
        ("refine", {"mesh": GRID, "level": -1}, "/level"),
        ("refine", {"mesh": GRID, "level": 20}, "/level"),
        ("refine", {"mesh": GRID, "level": 9}, "/level"),
        ("refine_strips", {"mesh": GRID, "direction": "up"}, "/direction"),
        ("remesh", {"mesh": GRID}, "/length"),
        ("remesh", {"mesh": GRID, "length": 0}, "/length"),
        ("remesh", {"mesh": GRID, "length": 1e-4}, "/length"),
        ("remesh", {"mesh": GRID, "length": 1, "feature_angle": 0}, "/feature_angle"),
        ("clean", {"meshes": GRID}, "/meshes"),
        ("clean", {"meshes": []}, "/meshes"),
        ("clean", {"meshes": [GRID, {"vertices": GRID["vertices"], "faces": [[0, 1, 99]]}]}, "/meshes/1/faces/0/2"),
        ("vertex_neighbours", {"mesh": GRID, "vertices": [9]}, "/vertices/0"),
        ("vertex_neighbours", {"mesh": GRID, "vertices": [0.5]}, "/vertices/0"),
        ("fold_angle", {**SMALL["fold_angle"], "end": [[0, 0]]}, "/end"),
        ("fold_angle", {**SMALL["fold_angle"], "tip_1": SMALL["fold_angle"]["end"]}, "/tip_1/0"),
        ("mesh_map", {"points": GRID["vertices"], "source": GRID}, "/target"),
        ("mesh_map", {**SMALL["mesh_map"], "target": {**GRID, "faces": [[0, 1, 3]]}}, "/target"),
        ("split_at_corners", {"curve": SMALL["divide"]["curve"], "turning_angle": 4}, "/turning_angle"),
        ("remove_duplicate_lines", {"lines": [[[0, 0, 0]]]}, "/lines"),
        ("remove_duplicate_points", {"points": [[0, 0, 0], [1, 2]]}, "/points"),
    ],
)
def test_faulty_input(client: httpx.Client, name: str, body: Any, pointer: str) -> None:
    found = problem(client.post(f"/v1/discretize/{name}", json=body), 422, "invalid-input")
    assert found["errors"][0]["pointer"].startswith(pointer)


def test_an_unknown_operation_names_those_there_are(client: httpx.Client) -> None:
    found = problem(client.post("/v1/discretize/slice", json={}), 404, "not-found")
    assert "divide" in found["detail"]
