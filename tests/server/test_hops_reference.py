"""Recorded requests of Grasshopper's component: answered as ghhops-server answers wherever that one succeeds, and
well where it fails: other paths than {0}, inputs without a value, lines as results, errors that are JSON always."""

from __future__ import annotations

import importlib.metadata
import json
import threading
from collections.abc import Iterator
from http.server import ThreadingHTTPServer
from pathlib import Path
from typing import Any

import httpx
import pytest
import rhino3dm

from serving import HANG

from .hops_canvas import PARAMETERS, Component, Solved, Unusable
from .hops_inside import Service, functions
from .hops_recording import OURS, reference

pytest.importorskip("ghhops_server", reason="ghhops-server is not installed: pip install 'hookean[test]'")

DATA = Path(__file__).parents[3] / "shared" / "data" / "grasshopper"
SUCCEEDS = ("add", "pts", "tree", "mesh", "crv")
FAILS = ("add_missing_optional", "add_empty_optional", "add_path_0_0", "types")


@pytest.fixture(scope="module")
def recorded() -> dict[str, Any]:
    path = DATA / "hops_recorded.json"
    if not path.exists():
        pytest.skip("the recorded traffic is not beside the project")
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


@pytest.fixture(scope="module")
def ours() -> Iterator[Service]:
    with functions(OURS):
        yield Service()


@pytest.fixture(scope="module")
def theirs() -> Iterator[httpx.Client]:
    """ghhops-server's built-in server, on a port of its own."""
    from ghhops_server.middlewares.hopsdefault import _HopsHTTPHandler

    _HopsHTTPHandler.hops = reference()
    server = ThreadingHTTPServer(("127.0.0.1", 0), _HopsHTTPHandler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    with httpx.Client(base_url=f"http://127.0.0.1:{server.server_address[1]}", timeout=HANG) as client:
        yield client
    server.shutdown()
    thread.join()
    server.server_close()


def plain(solved: Solved) -> dict[str, Any]:
    """Values of a solution; geometry as what is encoded of it."""
    shown = {name: {path: [v.Encode()["data"] if hasattr(v, "Encode") else v for v in branch]
                    for path, branch in tree.items()} for name, tree in solved.values.items()}  # fmt: skip
    return {**shown, "errors": solved.errors, "warnings": solved.warnings}


def described(name: str, ours: Service) -> Component:
    if "/" not in name:
        return Component(ours.call, f"/{name}")
    said = json.dumps(OURS[name].described(name)).encode()
    answer = httpx.Response(200, content=said, headers={"content-type": "application/json"})
    component = Component(lambda *a: answer, f"/{name}")
    component.call = ours.call
    return component


def test_the_reference_is_the_recorded_version() -> None:
    assert importlib.metadata.version("ghhops-server") == "1.5.5"


def test_the_reference_answers_as_recorded(theirs: httpx.Client, recorded: dict[str, Any]) -> None:
    """Its components are those of the recording, and they fail where they did."""
    for name, request in recorded["requests"].items():
        status, _, text = recorded["responses"][f"default SOLVE {name}"]
        if status == "EXC":
            with pytest.raises(httpx.RemoteProtocolError):
                theirs.post("/solve", json=request)
            continue
        answer = theirs.post("/solve", json=request)
        assert answer.status_code == status
        assert answer.json()["values"] == json.loads(text)["values"]
    kept = json.loads(recorded["responses"]["default GET /"][2])
    for one, there in zip(kept, theirs.get("/").json(), strict=True):
        assert {k: v for k, v in one.items() if k != "Icon"} == there


@pytest.mark.parametrize("name", SUCCEEDS)
def test_what_the_reference_can_is_answered_the_same(
    name: str, ours: Service, theirs: httpx.Client, recorded: dict[str, Any]
) -> None:
    """The same values on the component, from the same request."""
    request = recorded["requests"][name]
    component = described(request["pointer"], ours)
    answers = ours.call("POST", "/solve", request), theirs.post("/solve", json=request)
    flask = httpx.Response(200, content=recorded["responses"][f"flask SOLVE {name}"][2])  # its other server
    mine, other = (plain(component.read(answer)) for answer in answers)
    assert plain(component.read(flask)) == other
    if name == "mesh":  # ours is a new mesh of the same shape
        mine["M"], other["M"] = (shape(component.read(answer).one("M")) for answer in answers)
    assert mine == other
    assert [answer.status_code for answer in answers] == [200, 200] and not mine["errors"] + mine["warnings"]


def shape(mesh: Any) -> Any:
    return [(p.X, p.Y, p.Z) for p in mesh.Vertices.ToPoint3dArray()], [mesh.Faces[i] for i in range(len(mesh.Faces))]


@pytest.mark.parametrize("name", ["add", "sub/types", "pts", "tree", "mesh", "crv", "boom"])
def test_descriptions_become_the_same_component(name: str, ours: Service, theirs: httpx.Client) -> None:
    """Inputs alike in name, type, access and default; outputs in name and type."""
    mine, other = described(name, ours), Component(lambda method, path: theirs.get(path), f"/{name}")
    assert mine.inputs == other.inputs and mine.title == other.title
    assert [(p.name, p.kind) for p in mine.outputs] == [(p.name, p.kind) for p in other.outputs]
    (listed,) = [one for one in ours.call("GET", "/").json() if one["Uri"] == f"/{name}"]
    (known,) = [one for one in theirs.get("/").json() if one["Uri"] == f"/{name}"]
    assert set(listed) == set(known)


SUMS = {"add_missing_optional": 3.5, "add_empty_optional": 3.5, "add_path_0_0": 3.5}


@pytest.mark.parametrize("name", FAILS)
def test_where_the_reference_fails_ours_is_right(
    name: str, ours: Service, theirs: httpx.Client, recorded: dict[str, Any]
) -> None:
    request = recorded["requests"][name]
    with pytest.raises((httpx.RemoteProtocolError, AssertionError)):
        assert not theirs.post("/solve", json=request).json()["errors"]
    component = described(request["pointer"], ours)
    found = component.post(request)
    assert found.errors == found.warnings == []
    if name in SUMS:
        assert found.one("Sum") == SUMS[name]
        return
    values = {one["ParamName"]: json.loads(one["InnerTree"]["{0}"][0]["data"]) for one in request["values"]}
    assert [found.one(n) for n in ("I", "F", "T")] == [values[n] for n in ("I", "F", "T")] == [4, True, "cable net é"]
    assert found.one("L") == [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]]
    assert found.one("PL") == [[1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    assert found.one("P") == found.one("V") == [1.0, 2.0, 3.0]


def test_errors_are_json_always(ours: Service, recorded: dict[str, Any]) -> None:
    """A function that fails, one that there is not, and addresses and methods that there are not: a sentence on the
    component, where the reference sends pages, nothing or a traceback."""
    boom = described("boom", ours)
    assert boom.post(recorded["requests"]["boom"]).errors == ["/A: no cables"]
    (unknown,) = boom.post(recorded["requests"]["unknown"]).errors
    assert "unknown function; known: /add" in unknown
    nowhere = Component(ours.call, "/nope")
    assert nowhere.errors == ["There is no function with this name; GET / of this server lists all."]
    assert nowhere.inputs == nowhere.outputs == []
    for method, path, status in (("GET", "/nope", 404), ("GET", "/solve", 405), ("PUT", "/solve", 401)):
        answer = ours.call(method, path)
        assert answer.status_code == status and answer.headers["content-type"] == "application/problem+json"
        assert boom.read(answer).errors


def test_the_model_of_the_component_refuses_what_the_component_cannot_use(theirs: httpx.Client, ours: Service) -> None:
    """Pages, nothing at all, other numbers of values, values of other types."""
    page = httpx.Response(200, content=b"<html>", headers={"content-type": "text/html"})
    empty = httpx.Response(404, content=b"", headers={"content-type": "application/json"})
    for answer in (page, empty):
        with pytest.raises(Unusable):
            Component(lambda *a, answer=answer: answer, "/add")
    add = described("add", ours)
    for value in (
        [],
        [{"ParamName": "Sum", "InnerTree": {"0": [{"type": "System.Double", "data": "NaN"}]}}],
        [{"ParamName": "Sum", "InnerTree": {"0": [{"type": "System.String", "data": '"a"'}]}}],
        [{"ParamName": "Sum", "InnerTree": {"x": []}}],
        [{"ParamName": "Sum", "InnerTree": {"0": [{"type": "System.Object", "data": "1"}]}}],
    ):
        with pytest.raises(Unusable):
            add.read(httpx.Response(200, content=json.dumps({"values": value}).encode()))
    with pytest.raises(Unusable):
        add.read(page)


def test_the_sample_definition_fits_descriptions_of_ours() -> None:
    """Hops_Example.gh: its components would keep their parameters if our functions stood behind their addresses."""
    from hookean_canvas import archive
    from hookean_server.hops.model import Function, item

    path = DATA / "Hops_Example.gh"
    if not path.exists():
        pytest.skip("the sample definition is not beside the project")
    kinds = {guid: kind for kind, guid in PARAMETERS.items() if guid}
    found = {}
    for chunk in archive.read(path).walk():
        location = chunk.value("RemoteDefinitionLocation")
        if not location:
            continue
        data = chunk.chunk("ParameterData")
        pointer = location.split("/", 3)[3]
        sides: dict[str, list[tuple[str, str]]] = {}
        for side in ("Input", "Output"):
            guids = [str(data.value(f"{side}Id", i)) for i in range(data.value(f"{side}Count"))]
            names = [data.chunk(f"{side}Param", i).value("Name") for i in range(len(guids))]
            sides[side] = list(zip(names, guids, strict=True))
        inputs, outputs = ([item(n, n, kinds[g], n) for n, g in sides[side]] for side in ("Input", "Output"))
        function = Function(pointer, pointer, "", tuple(inputs), tuple(outputs), lambda *a: {})
        with functions({pointer: function}):
            component = Component(Service().call, f"/{pointer}")
        assert component.request({p.name: PLACES[p.kind] for p in component.inputs})["pointer"] == pointer
        for params, side in ((component.inputs, "Input"), (component.outputs, "Output")):
            assert [(p.name, PARAMETERS[p.kind]) for p in params] == sides[side]
            assert {p.access for p in params} == {"item"}
        found[pointer] = (len(inputs), len(outputs))
    assert found == {"add": (2, 1), "pointat": (2, 1), "srf4pt": (4, 1), "interplength": (3, 1)}


PLACES: dict[str, Any] = {
    "Number": 1.0,
    "Point": (0.0, 0.0, 0.0),
    "Curve": rhino3dm.LineCurve(*[rhino3dm.Point3d(i, 0, 0) for i in (0, 1)]),
}
