"""Every analysis over HTTP gives what its function gives."""

from __future__ import annotations

import copy
import io
import json
from pathlib import Path

import ezdxf
import httpx
import numpy as np
import pytest

import hookean
from hookean.files.exchange.write import exchange
from hookean.files.report import report
from hookean_server.http.analysis_schemas import ANALYSIS_EXAMPLES, CASES_EXAMPLE, EXPORT_EXAMPLE, REPORT_EXAMPLE
from hookean_server.workers.analysis_task import ANALYSES

from .conftest import problem


@pytest.mark.thinned
@pytest.mark.parametrize("name", ANALYSES)
def test_an_analysis_is_its_function(client: httpx.Client, name: str) -> None:
    body = ANALYSIS_EXAMPLES[name]
    answer = client.post(f"/v1/analysis/{name}", json=body)
    assert answer.status_code == 200, answer.text
    given = {key: value for key, value in body.items() if key != "scene"}
    wanted = ANALYSES[name].function(hookean.Scene.read(body["scene"]), **given).to_dict()
    assert answer.json() == json.loads(json.dumps(wanted))


@pytest.mark.parametrize(
    ("change", "pointer", "said", "slug"),
    [
        ({"scene": None}, "/scene", "an object", "invalid-scene"),
        ({"count": 0}, "/count", "at least 1", "invalid-input"),
        ({"cuont": 3}, "/cuont", "no field", "invalid-input"),
        ({"loads": ["snow"]}, "/loads/0", "no load is called 'snow'", "invalid-input"),
        (
            {"count": 200, "scene": {"particles": [[0, 0, float(i)] for i in range(9000)]}},
            "/",
            "fewer modes",
            "invalid-input",
        ),
    ],
)
def test_bad_requests_get_one_sentence(client: httpx.Client, change: dict, pointer: str, said: str, slug: str) -> None:
    body = {**copy.deepcopy(ANALYSIS_EXAMPLES["buckling"]), **change}
    answer = client.post("/v1/analysis/buckling", json=body)
    found = problem(answer, 422, slug)
    assert found["errors"][0]["pointer"] == pointer and said in found["errors"][0]["detail"]


def test_a_scene_without_equilibrium_is_a_problem(client: httpx.Client) -> None:
    scene = {"particles": [[0, 0, 0]], "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -1]}]}
    answer = client.post("/v1/analysis/frequencies", json={"scene": scene})
    assert "not in equilibrium" in answer.json()["detail"]
    assert client.post("/v1/analysis/frequencies", json=[]).status_code == 422
    assert client.post("/v1/analysis/frequencies", json={}).status_code == 422


def test_masses_of_a_request_are_those_of_the_function(client: httpx.Client) -> None:
    """The net of the example has no weight: numbers are taken, and a word needs a self_weight; without, a note."""
    body = ANALYSIS_EXAMPLES["frequencies"]
    one, four = (client.post("/v1/analysis/frequencies", json={**body, "masses": m}).json() for m in (None, 4.0))
    assert four["frequencies"] == pytest.approx([0.5 * f for f in one["frequencies"]], rel=1e-9)
    assert len(one["notes"]) == 1 and four["notes"] == []
    answer = client.post("/v1/analysis/frequencies", json={**body, "masses": "self_weight"})
    assert problem(answer, 422, "invalid-input")["errors"][0]["pointer"] == "/masses"


def test_a_case_of_a_request_is_that_of_the_function(client: httpx.Client) -> None:
    """Analyses of a combination, of a column whose loads are in cases; its name has a place in the request."""
    column = {
        "particles": [[0, 0, 0], [0, 0, 1], [0, 0, 2]],
        "forces": [
            {"kind": "beam", "particles": [[0, 1], [1, 2]], "E": 1e6, "G": 4e5, "A": 1, "Iy": 0.01, "Iz": 0.01}
            | {"J": 0.02},
            {"kind": "unary", "name": "P", "particles": [2], "vector": [0, 0, -10]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "load_cases": {"P": {"forces": ["P"]}},
        "combinations": {"ULS": {"P": 1.5}},
    }
    one = client.post("/v1/analysis/buckling", json={"scene": column, "count": 1, "case": "ULS"}).json()
    wanted = hookean.buckling(hookean.Scene.read(column), 1, case="ULS")
    assert one["factors"] == pytest.approx(wanted.factors.tolist(), rel=1e-12) and one["loads"] == ["P"]
    for change, pointer in (({"case": "snow"}, "/case"), ({}, "/loads")):
        answer = client.post("/v1/analysis/buckling", json={"scene": column, **change})
        assert problem(answer, 422, "invalid-input")["errors"][0]["pointer"] == pointer
    for name in ("frequencies", "mechanisms"):
        one = client.post(f"/v1/analysis/{name}", json={"scene": column, "case": "ULS"}).json()
        wanted = ANALYSES[name].function(hookean.Scene.read(column), case="ULS").to_dict()
        assert one == json.loads(json.dumps(wanted))
        answer = client.post(f"/v1/analysis/{name}", json={"scene": column, "case": "snow"})
        assert problem(answer, 422, "invalid-input")["errors"][0]["pointer"] == "/case"


def test_load_cases_are_those_of_the_function(client: httpx.Client) -> None:
    """Each on a worker of its own, with the bits of one after another."""
    answer = client.post("/v1/analysis/load-cases", json=CASES_EXAMPLE)
    assert answer.status_code == 200, answer.text
    wanted = hookean.load_cases(hookean.Scene.read(CASES_EXAMPLE["scene"])).to_dict()
    assert answer.json() == json.loads(json.dumps(wanted))
    one = client.post("/v1/analysis/load-cases", json={**CASES_EXAMPLE, "cases": ["ULS 1"]}).json()
    assert [case["name"] for case in one["cases"]] == ["ULS 1"]
    assert one["cases"][0] == answer.json()["cases"][1]


def test_bad_cases_get_one_sentence(client: httpx.Client) -> None:
    answer = client.post("/v1/analysis/load-cases", json={**CASES_EXAMPLE, "cases": ["rain"]})
    found = problem(answer, 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/cases" and "'rain' is not a load case" in found["detail"]
    scene = {**CASES_EXAMPLE["scene"], "load_cases": {}, "combinations": {}}
    found = problem(client.post("/v1/analysis/load-cases", json={"scene": scene}), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/scene/load_cases"


def test_load_cases_of_a_bent_beam_start_from_its_rotations(client: httpx.Client) -> None:
    """A cantilever that is bent in its form is, over HTTP, the one of the function: its ends are turned there too."""
    beam = {"kind": "beam", "particles": [[0, 1], [1, 2]], "E": 1e4, "G": 5e3, "A": 1.0, "Iy": 0.01, "Iz": 0.01}
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [
            {**beam, "J": 0.02, "normal": [0, 1, 0]},
            {"kind": "unary", "name": "dead", "particles": [2], "vector": [0, 0, -20]},
            {"kind": "unary", "name": "snow", "particles": [2], "vector": [0, 0, -5]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "load_cases": {"snow": {"forces": ["snow"]}},
        "combinations": {"ULS": {"snow": 1.5}},
    }
    answer = client.post("/v1/analysis/load-cases", json={"scene": scene})
    assert answer.status_code == 200, answer.text
    wanted = hookean.load_cases(hookean.Scene.read(scene)).to_dict()
    assert abs(wanted["form"]["particles"][2][2]) > 0.3
    assert answer.json() == json.loads(json.dumps(wanted))


def test_prestress_of_cloth_that_was_a_film_is_multiplied(client: httpx.Client) -> None:
    """A flat film of tension 2 between held edges: 1.5 times that, over HTTP as by the function."""
    x = [[i, j, 0.0] for i in range(3) for j in range(3)]
    scene = {
        "particles": x,
        "meshes": {"skin": {"vertices": x, "faces": [[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]]}},
        "forces": [{"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": 2.0}],
        "anchors": [{"particles": [0, 1, 2, 3, 5, 6, 7, 8]}],
        "combinations": {"jacked": {"prestress": 1.5}},
        "stages": {"films": {"film": {"warp_stiffness": 100.0}}},
    }
    answer = client.post("/v1/analysis/load-cases", json={"scene": scene})
    assert answer.status_code == 200, answer.text
    assert answer.json()["cases"][0]["result"]["forces"][0]["warp"] == pytest.approx([3.0] * 16, rel=1e-12)


def test_a_report_is_that_of_the_function(client: httpx.Client) -> None:
    answer = client.post("/v1/analysis/report", json=REPORT_EXAMPLE)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    wanted = report(hookean.Scene.read(REPORT_EXAMPLE["scene"]), title="Truss", pictures=False)
    assert answer.text == wanted


def test_an_export_is_read_back_with_the_shape_of_its_case(client: httpx.Client) -> None:
    """Lines of the DXF file, by ezdxf, to the last digit but one of float32 coordinates at most."""
    answer = client.post("/v1/analysis/export", json=EXPORT_EXAMPLE)
    assert answer.status_code == 200, answer.text
    assert 'filename="result.dxf"' in answer.headers["content-disposition"]
    lines = ezdxf.read(io.StringIO(answer.text)).modelspace().query('LINE[layer != "LOADS"]')
    found = sorted([*map(tuple, (line.dxf.start, line.dxf.end))] for line in lines)
    case = hookean.load_cases(hookean.Scene.read(EXPORT_EXAMPLE["scene"]), ["ULS 1"]).cases["ULS 1"].result
    wanted = sorted([tuple(case.particles[i]) for i in pair] for pair in ([0, 1], [1, 2]))
    np.testing.assert_allclose(found, wanted, atol=1e-6)


@pytest.mark.parametrize("ending", ["vtu", "inp", "ifc", "compas.json"])
def test_an_export_is_the_file_that_python_writes(client: httpx.Client, ending: str, tmp_path: Path) -> None:
    """To the byte; tests/files reads these back by meshio, ifcopenshell and compas."""
    answer = client.post("/v1/analysis/export", json={"scene": EXPORT_EXAMPLE["scene"], "format": ending})
    exchange(hookean.relax(hookean.Scene.read(EXPORT_EXAMPLE["scene"])), tmp_path / f"result.{ending}")
    assert answer.status_code == 200 and answer.content == (tmp_path / f"result.{ending}").read_bytes()


@pytest.mark.parametrize(
    ("change", "pointer", "said"),
    [
        ({"format": "stl"}, "/format", '"stl" given; allowed: dxf, vtu, inp, ifc, compas.json'),
        ({"case": "rain"}, "/cases", "'rain' is not a load case or combination"),
        ({"scene": {"particles": [[0, 0, 0]], "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -1]}]},
          "case": None},
         "/scene", "is not in equilibrium"),
    ],
)  # fmt: skip
def test_bad_exports_get_one_sentence(client: httpx.Client, change: dict, pointer: str, said: str) -> None:
    answer = client.post("/v1/analysis/export", json={**EXPORT_EXAMPLE, **change})
    found = problem(answer, 422, "invalid-input")
    assert found["errors"][0]["pointer"] == pointer and said in found["detail"]
