"""Hops' own calls, as Grasshopper's component makes them: described, solved, and refused in words it can show."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hookean import Scene, relax
from hookean_server.hops.functions import FUNCTIONS
from serving import CABLE, HANG
from soak import examples

from .conftest import Served

RECORDED = Path(__file__).parents[3] / "shared" / "data" / "grasshopper" / "hops_recorded.json"
GOO = {"System.Boolean", "System.Double", "System.String", "System.Int32", "Rhino.Geometry.Line",
       "Rhino.Geometry.Point3d", "Rhino.Geometry.Vector3d", "Rhino.Geometry.Mesh"}  # fmt: skip


@pytest.fixture(scope="module")
def hops(served: Served) -> Iterator[httpx.Client]:
    """Hops sends no token and no Accept."""
    with httpx.Client(base_url=served.url, timeout=HANG) as client:
        del client.headers["accept"]
        yield client


@pytest.fixture(scope="module")
def recorded() -> dict[str, Any]:
    if not RECORDED.exists():
        pytest.skip("the recorded traffic is not beside the project")
    found: dict[str, Any] = json.loads(RECORDED.read_text(encoding="utf-8"))
    return found


def branch(kind: str, *values: Any, path: str = "{0}") -> dict[str, Any]:
    return {path: [{"type": kind, "data": json.dumps(v)} for v in values]}


def point(row: Any) -> dict[str, float]:
    return dict(zip("XYZ", map(float, row), strict=True))


def cable(**more: Any) -> dict[str, Any]:
    """The cable of five springs as Hops sends it; Line has members that are not needed, as in .NET."""
    x = CABLE["particles"]
    lines = [{"From": point(a), "To": point(b), "Length": 2.0, "IsValid": True}
             for a, b in pairwise(x)]  # fmt: skip
    given = {
        "Lines": branch("Rhino.Geometry.Line", *lines),
        "Anchors": branch("Rhino.Geometry.Point3d", point(x[0]), point(x[-1])),
        "Load": branch("Rhino.Geometry.Vector3d", {"X": 0.0, "Y": 0.0, "Z": -20.0}),
        "Stiffness": branch("System.Double", 1000.0),
        **more,
    }
    return asked("relax", given)


def asked(pointer: str, given: dict[str, Any]) -> dict[str, Any]:
    return {"absolutetolerance": 0.001, "angletolerance": 1.0, "modelunits": "Meters", "dataversion": 7, "algo": None,
            "pointer": pointer, "cachesolve": False, "warnings": [], "errors": [],
            "values": [{"ParamName": name, "InnerTree": tree} for name, tree in given.items()]}  # fmt: skip


def read(answer: httpx.Response) -> dict[str, list[Any]]:
    """What Hops makes of an answer; it would fail on anything that is not checked here."""
    schema = answer.json()
    assert all(isinstance(said, str) for said in schema["errors"] + schema["warnings"])
    found = {}
    for tree in schema["values"]:
        values = []
        for path, items in tree["InnerTree"].items():
            assert all(part.isdigit() for part in path.strip("{}").split(";"))
            for item in items:
                assert item["type"] in GOO and isinstance(item["data"], str)
                values.append(json.loads(item["data"]))
        found[tree["ParamName"]] = values
    return found


def test_the_list_and_each_description_are_as_hops_reads_them(hops: httpx.Client, recorded: dict[str, Any]) -> None:
    """The same members as in recorded descriptions, no others but Default; a media type with json in it."""
    _, media, text = recorded["responses"]["flask GET /"]
    known = json.loads(text)
    listed = hops.get("/")
    assert media in listed.headers["content-type"] and listed.status_code == 200
    members = set.intersection(*(set(one) for one in known))
    parameter = {key for one in known for p in one["Inputs"] + one["Outputs"] for key in p}
    types = {(p["ParamType"], p["ResultType"]) for one in known for p in one["Inputs"] + one["Outputs"]}
    types |= {("Curve", "Rhino.Geometry.Curve"), ("Surface", "Rhino.Geometry.Brep")}  # as ghhops-server has them
    for one in listed.json():
        assert members == set(one)
        assert hops.get(one["Uri"]).json() == one
        for p in one["Inputs"] + one["Outputs"]:
            assert parameter - {"Default"} <= set(p) <= parameter | {"Minimum", "Maximum"}
            assert (p["ParamType"], p["ResultType"]) in types
            assert -1 <= p["AtLeast"] <= p["AtMost"]
        assert len({p["Name"] for p in one["Inputs"]}) == len(one["Inputs"])
    assert {one["Uri"].strip("/") for one in listed.json()} == set(FUNCTIONS)


def test_a_cable_as_the_component_sends_it(hops: httpx.Client) -> None:
    """The same numbers as the scene gives, to the bit."""
    answer = hops.post("/solve", json=cable())
    assert answer.status_code == 200 and "solve;dur=" in answer.headers["server-timing"]
    found = read(answer)
    assert list(found) == [p.name for p in FUNCTIONS["relax"].outputs]
    truth = relax(Scene.model_validate(CABLE))
    assert found["Forces"] == truth.force("springs")["force"].tolist() and found["Status"] == ["converged"]
    assert [[p[a] for a in "XYZ"] for p in found["Particles"]] == truth.particles.tolist()
    assert [[p[a] for a in "XYZ"] for p in found["Reactions"]] == truth.reactions["force"].tolist()
    assert found["Springs"][1]["From"] == found["Springs"][0]["To"] == found["Particles"][1]


def test_an_input_of_another_version_is_told(hops: httpx.Client) -> None:
    """A value that is not used would be missed; an input without values has none to miss."""
    found = {}
    for number, tree in enumerate((branch("System.Double", 2.0), {"{0}": []}, {})):
        found[number] = hops.post("/solve", json=cable(Stifness=tree)).json()
    assert [len(one["warnings"]) for one in found.values()] == [1, 0, 0]
    assert found[0]["warnings"][0].startswith("Stifness is no input") and "Stiffness" in found[0]["warnings"][0]
    assert found[0]["values"] == found[1]["values"] == found[2]["values"]


def test_the_same_inputs_give_the_same_bytes(hops: httpx.Client) -> None:
    """Hops keeps answers for ever."""
    assert hops.post("/solve", json=cable()).content == hops.post("/solve", json=cable()).content


def test_a_recorded_mesh(hops: httpx.Client, recorded: dict[str, Any]) -> None:
    """The mesh of the recording relaxes with its own boundary held, and comes back as a mesh rhino3dm reads."""
    import rhino3dm

    request = recorded["requests"]["mesh"]
    tree = request["values"][0]["InnerTree"]
    load = branch("Rhino.Geometry.Vector3d", {"X": 0.0, "Y": 0.0, "Z": -1.0})
    values = [{"ParamName": "Mesh", "InnerTree": tree}, {"ParamName": "Load", "InnerTree": load}]
    answer = hops.post("/solve", json={**request, "pointer": "relax_mesh", "values": values})
    found = read(answer)
    assert answer.status_code == 200, answer.text
    mesh = rhino3dm.CommonObject.Decode(found["Mesh"][0])
    given = rhino3dm.CommonObject.Decode(json.loads(next(iter(tree.values()))[0]["data"]))
    assert (len(mesh.Vertices), len(mesh.Faces)) == (len(given.Vertices), len(given.Faces))
    assert len(found["Edges"]) == len(found["Forces"]) == 4


def test_a_mesh_with_a_loose_middle_sags(hops: httpx.Client) -> None:
    import rhino3dm

    mesh: Any = rhino3dm.Mesh()
    for i, j in np.ndindex(3, 3):
        mesh.Vertices.Add(float(i), float(j), 0.0)
    for i, j in np.ndindex(2, 2):
        mesh.Faces.AddFace(3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1)
    given = {
        "Mesh": branch("Rhino.Geometry.Mesh", mesh.Encode()),
        "Load": branch("Rhino.Geometry.Vector3d", point((0, 0, -10))),
        "Rest factor": branch("System.Double", 0.8),
    }
    answer = hops.post("/solve", json=asked("relax_mesh", given))
    back = rhino3dm.CommonObject.Decode(read(answer)["Mesh"][0])
    heights = [back.Vertices[i].Z for i in range(9)]
    assert heights[4] < -0.005 and heights[:4] + heights[5:] == [0.0] * 8


def test_polylines_are_their_pieces(hops: httpx.Client) -> None:
    """A curve made of straight pieces, as rhino3dm encodes it, gives what its lines give."""
    import rhino3dm

    curve = rhino3dm.PolylineCurve([rhino3dm.Point3d(*p) for p in CABLE["particles"]])
    encoded = branch("Rhino.Geometry.PolylineCurve", curve.Encode())
    as_curve, as_lines = hops.post("/solve", json=cable(Lines=encoded)), hops.post("/solve", json=cable())
    assert as_curve.json() == as_lines.json()


def test_a_figure_and_an_operation_in_a_worker(hops: httpx.Client) -> None:
    """As on the canvas: a cable with its own values, then its particles as a curve cut into pieces."""
    import rhino3dm

    figure = read(hops.post("/solve", json=asked("cable", {})))
    assert figure["Length"] == pytest.approx([10.753329301669], abs=1e-9) and figure["Status"] == ["converged"]
    curve = rhino3dm.PolylineCurve([rhino3dm.Point3d(*(p[a] for a in "XYZ")) for p in figure["Particles"]])
    given = {"Curve": branch("Rhino.Geometry.PolylineCurve", curve.Encode(), path="{4;2}")}
    found = read(hops.post("/solve", json=asked("divide", given)))["Points"]
    assert len(found) == 11 and found[0] == figure["Particles"][0] and found[-1] == figure["Particles"][-1]


@pytest.mark.parametrize("unit", ["Millimeters", "Feet", "Meters"])
def test_numbers_are_in_the_units_of_the_model(hops: httpx.Client, unit: str) -> None:
    """Lengths and stiffness in model units, forces in N: only the numbers count."""
    assert hops.post("/solve", json={**cable(), "modelunits": unit}).json() == hops.post("/solve", json=cable()).json()


def test_an_unknown_unit_is_told(hops: httpx.Client) -> None:
    said = hops.post("/solve", json={**cable(), "modelunits": "Parsecs"}).json()["warnings"]
    assert said == ["The unit of this model is unknown; its lengths are read as metres."]


@settings(max_examples=examples(25), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_tree_of_the_same_values_gives_the_same(hops: httpx.Client, data: st.DataObject) -> None:
    """Grafted, nested, cut into branches: the values count, not their paths (the reference server fails on {0;0})."""
    request = cable()
    for value in request["values"]:
        items = [item for items in value["InnerTree"].values() for item in items]
        cuts = data.draw(st.sets(st.integers(0, len(items)), max_size=3))
        ends = [0, *sorted(cuts), len(items)]
        paths = data.draw(st.lists(st.lists(st.integers(0, 9), min_size=1, max_size=3), min_size=len(ends) - 1,
                                   max_size=len(ends) - 1, unique_by=tuple))  # fmt: skip
        value["InnerTree"] = {"{" + ";".join(map(str, p)) + "}": items[a:b]
                              for p, (a, b) in zip(paths, pairwise(ends), strict=True)}  # fmt: skip
    assert hops.post("/solve", json=request).json() == hops.post("/solve", json=cable()).json()


def without(name: str) -> dict[str, Any]:
    request = cable()
    return {**request, "values": [v for v in request["values"] if v["ParamName"] != name]}


def test_defaults_stand_in(hops: httpx.Client) -> None:
    """Absent or empty: the same as the default, where the reference server fails."""
    truth = hops.post("/solve", json=cable()).json()
    assert hops.post("/solve", json=without("Stiffness")).json() == truth
    assert hops.post("/solve", json=cable(Stiffness={})).json() == truth
    other = hops.post("/solve", json=cable(Other=branch("System.Double", 1.0))).json()
    assert len(other["warnings"]) == 1 and {**other, "warnings": []} == truth


FAULTY: dict[str, tuple[Any, str]] = {
    "no lines": (without("Lines"), "Lines is missing; connect at least one line"),
    "no load": (without("Load"), "Load is missing; connect one vector"),
    "two stiffnesses": (cable(Stiffness=branch("System.Double", 1.0, 2.0)), "Stiffness accepts one number; 2 given"),
    "text": (cable(Stiffness=branch("System.String", "soft")), "/Stiffness: a finite number is expected"),
    "a negative factor": (
        cable(**{"Rest factor": branch("System.Double", -1.0)}),
        "Rest factor: -1 given; 0 and more allowed",
    ),
    "a point as line": (cable(Lines=branch("Rhino.Geometry.Point3d", point((0, 0, 0)))), "/Lines: geometry as Hops"),
    "damaged geometry": (
        cable(Lines=branch("x", {"version": 10000, "archive3dm": 70, "opennurbs": 1, "data": "AAAA"})),
        "/Lines: rhino3dm cannot decode this",
    ),
    "no JSON inside": (cable(Stiffness={"{0}": [{"type": "System.Double", "data": "NaN"}]}), "is not a number"),
    "no function": (asked("nope", {}), "unknown function; known: /relax, /relax_mesh"),
    "no tree": ({**cable(), "values": [{"ParamName": "Lines", "InnerTree": 1}]}, "branches are lists"),
    "no values": ({"pointer": "relax"}, "a list of values"),
    "a list": ([], "a list of values"),
}


@pytest.mark.parametrize("name", FAULTY)
def test_faults_are_sentences_on_the_component(hops: httpx.Client, name: str) -> None:
    """A problem document whose errors are what Hops shows; no values, so that nothing is taken for a result."""
    request, sentence = FAULTY[name]
    answer = hops.post("/solve", json=request)
    found = answer.json()
    assert answer.status_code == 422 and answer.headers["content-type"] == "application/problem+json"
    assert found["values"] == [] and found["warnings"] == [] and found["errors"] == [found["detail"]]
    assert sentence in found["detail"] and found["status"] == 422


def test_every_recorded_request_is_answered_in_json(hops: httpx.Client, recorded: dict[str, Any]) -> None:
    """Functions we do not have: their requests are read, and refused in words Hops can show, never by a page."""
    for request in recorded["requests"].values():
        answer = hops.post("/solve", json=request, headers={"content-type": "application/json; charset=utf-8"})
        assert answer.status_code == 422
        assert read(answer) == {} and answer.json()["errors"][0].startswith("/pointer: unknown function")


def test_what_is_not_reached_is_a_warning(hops: httpx.Client) -> None:
    """An anchor that meets no line."""
    stray = cable(Anchors=branch("Rhino.Geometry.Point3d", point((0, 0, 0)), point((10, 0, 0)), point((5, 5, 5))))
    answer = hops.post("/solve", json=stray)
    assert answer.status_code == 200 and "1 of 3 points met no particle" in answer.json()["warnings"][0]
    lost = hops.post("/solve", json=cable(Anchors=branch("Rhino.Geometry.Point3d", point((5, 5, 5)))))
    assert lost.status_code == 422 and "No anchor holds a particle" in lost.json()["errors"][0]


def test_no_page_may_call(served: Served, hops: httpx.Client) -> None:
    """Any Origin is refused, our own too, with the token too; and nothing but JSON is read."""
    for origin in (served.url, "http://evil.example", "null"):
        for extra in ({}, served.known):
            headers = {"origin": origin, **extra}
            assert hops.post("/solve", json=cable(), headers=headers).status_code == 403
            assert hops.get("/", headers=headers).status_code == 403
            assert hops.get("/relax", headers=headers).status_code == 403
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", ""):
        refused = hops.post("/solve", content=json.dumps(cable()), headers={"content-type": kind})
        assert refused.status_code == 415 and refused.json()["errors"]
    assert hops.post("/solve", json=cable(), headers={"host": f"evil.example:{served.port}"}).status_code == 403
    assert hops.post("/solve", json=cable(), headers={"sec-fetch-site": "cross-site"}).status_code == 403
