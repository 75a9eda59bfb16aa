"""A drawing in, the relaxed drawing out: over HTTP as in Python."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import httpx
import pytest
import rhino3dm

from hookean.files.relax_file import relax_file
from hookean_server.http.claimed import NAMES, warned
from serving import CABLE, wait_for
from soak import sampled

from .conftest import Served, problem

RECIPE = {
    "units": {"length": "m", "force": "N"},
    "forces": [
        {"kind": "springs", "lines": "layer:cables", "stiffness": 1000},
        {"kind": "unary", "points": "vertices:layer:cables", "vector": [0, 0, -20]},
    ],
    "anchors": [{"points": [[0, 0, 0], [10, 0, 0]]}],
}


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    layer = rhino3dm.Layer()
    layer.Name = "cables"
    attributes = rhino3dm.ObjectAttributes()
    attributes.LayerIndex = file.Layers.Add(layer)
    points = CABLE["particles"]
    for a, b in itertools.pairwise(points):
        file.Objects.AddLine(rhino3dm.Point3d(*a), rhino3dm.Point3d(*b), attributes)
    path = tmp_path_factory.mktemp("drawing") / "cable.3dm"
    assert file.Write(str(path), 7)
    return path.read_bytes()


def post(client: httpx.Client, drawing: bytes, **more: Any) -> httpx.Response:
    form = {"file": ("../../a name.3dm", drawing)}
    return client.post("/v1/relax/3dm", files=form, data={"recipe": json.dumps(RECIPE)}, **more)


def test_the_relaxed_file(client: httpx.Client, drawing: bytes, tmp_path: Path) -> None:
    before = client.get("/v1/health").json()["workers"]["restarts"]
    answer = post(client, drawing)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "model/vnd.3dm"
    assert "relaxed.3dm" in answer.headers["content-disposition"]
    source, target = tmp_path / "upload.3dm", tmp_path / "relaxed.3dm"
    source.write_bytes(drawing)
    relax_file(source, target, json.dumps(RECIPE))
    wanted, found = rhino3dm.File3dm.Read(str(target)), rhino3dm.File3dm.FromByteArray(answer.content)
    assert len(found.Objects) == len(wanted.Objects) > 5
    for i in range(len(wanted.Objects)):
        one, other = wanted.Objects[i], found.Objects[i]
        assert one.Geometry.Encode() == other.Geometry.Encode()
        assert one.Attributes.Id == other.Attributes.Id
    # the worker that read a foreign file is not used again
    assert client.post("/v1/relax", json=CABLE).status_code == 200
    assert client.get("/v1/health").json()["workers"]["restarts"] > before


@pytest.mark.parametrize("how", [{"params": {"answer": "report"}}, {"headers": {"accept": "application/json"}}])
def test_the_report(client: httpx.Client, drawing: bytes, how: dict[str, Any]) -> None:
    answer = post(client, drawing, **how)
    assert answer.headers["content-type"] == "application/json", answer.text
    found = answer.json()
    assert found["result"]["status"] == "converged"
    assert sum(found["result"]["forces"][0]["length"]) == pytest.approx(10.4679154891668, abs=1e-6)
    assert "/tmp" not in answer.text


def test_faulty_recipes(client: httpx.Client, drawing: bytes) -> None:
    faulty = [
        ("{", "/recipe"),
        ("forces = 5 =", "/recipe"),
        (json.dumps({**RECIPE, "forces": [{"kind": "springs", "lines": "layer:none"}]}), "/recipe/forces/0"),
        (json.dumps({**RECIPE, "forces": [{"kind": "spring"}]}), "/recipe/forces/0"),
        (json.dumps({**RECIPE, "extra": 1}), "/recipe"),
        (b"\xff", "/recipe"),
    ]
    for recipe, pointer in faulty:
        answer = client.post("/v1/relax/3dm", files={"file": ("a.3dm", drawing)}, data={"recipe": recipe})
        found = problem(answer, 422, "invalid-input")
        assert found["errors"][0]["pointer"].startswith(pointer), (recipe, found)
        assert "/tmp" not in answer.text


def test_what_meets_no_particle_is_a_problem_unless_the_recipe_goes_on(client: httpx.Client, drawing: bytes) -> None:
    """A load beside the cable: its pointer leads into the recipe, and it is a warning with strict false."""
    astray = {"kind": "unary", "name": "gust", "points": [[0, 0, 0], [0, 0, 9]], "vector": [0, 0, 1]}
    recipe = {**RECIPE, "forces": [*RECIPE["forces"], astray]}
    said = "gust: 1 of 2 points met no particle; the nearest is 9 m away from (0, 0, 9)"
    found = problem(_with(client, drawing, recipe), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == f"/recipe/forces/{len(RECIPE['forces'])}/points"
    assert found["errors"][0]["detail"].startswith(said)
    answer = _with(client, drawing, {**recipe, "strict": False}, params={"answer": "report"})
    assert any(said in warning for warning in answer.json()["warnings"]), answer.text


def _with(client: httpx.Client, drawing: bytes, recipe: dict[str, Any], **more: Any) -> httpx.Response:
    data = {"recipe": json.dumps(recipe)}
    return client.post("/v1/relax/3dm", files={"file": ("a.3dm", drawing)}, data=data, **more)


@pytest.mark.thinned
@pytest.mark.parametrize("part", [0.2, 0.5, 0.9, 0.99])
def test_damaged_files(client: httpx.Client, drawing: bytes, part: float) -> None:
    found = problem(post(client, drawing[: int(part * len(drawing))]), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/file"


def test_nothing_is_left_behind(drawing: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a server that has a folder for temporary files to itself."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    served = Served(workers=1)
    try:
        served.ready()
        own = set(tmp_path.glob("hookean-*"))  # of the server's sockets, where the folder's path is short enough
        assert post(served.client, drawing).status_code == 200
        assert post(served.client, drawing[:1000]).status_code == 422
        wait_for(lambda: set(tmp_path.glob("hookean-*")) <= own)
    finally:
        served.end()
    assert not list(tmp_path.glob("hookean-*"))


ENDS: dict[str, dict[str, Any]] = {
    "converged": {},
    "max_iterations": {"settings": {"max_iterations": 1}},
    "time_limit": {"settings": {"time_limit": 0, "solver": "relaxation"}},
    "diverged": {"settings": {"solver": "verlet", "time_step": 1e3}},
    "stalled": {
        "forces": [{**RECIPE["forces"][0], "rest_factor": 0}, RECIPE["forces"][1]],
        "anchors": [],
        "settings": {"solver": "force_density"},
    },
}


@pytest.mark.thinned
@pytest.mark.parametrize("status", sampled(ENDS, 2))
def test_a_file_says_how_its_run_ended(client: httpx.Client, drawing: bytes, tmp_path: Path, status: str) -> None:
    """Headers, document text, report and `/v1/relax` of the same scene say the same, with the same status code; the
    body is the file with its last good shape. The text is what the command writes, too."""
    recipe = {**RECIPE, **ENDS[status]}
    form: dict[str, Any] = {"files": {"file": ("a.3dm", drawing)}, "data": {"recipe": json.dumps(recipe)}}
    answer = client.post("/v1/relax/3dm", **form)
    report = client.post("/v1/relax/3dm", params={"answer": "report"}, **form)
    source, target = tmp_path / "upload.3dm", tmp_path / "relaxed.3dm"
    source.write_bytes(drawing)
    found = relax_file(source, target, json.dumps(recipe), recipe_name="recipe")
    scene = client.post("/v1/relax", json=json.loads(found.scene.canonical))
    assert answer.status_code == report.status_code == scene.status_code == 200, answer.text
    said = {name: text for name, text in answer.headers.items() if name in NAMES}
    assert said["hookean-status"] == status == scene.json()["status"] == report.json()["result"]["status"]
    assert said["hookean-message"] == report.json()["result"]["message"]
    assert float(said["hookean-residual"]) == pytest.approx(report.json()["result"]["residual"], rel=1e-8)
    assert said["hookean-out-of-balance"].endswith(" N")
    warnings = json.loads(said.pop("hookean-warnings", "[]"))
    told = json.loads(scene.headers.get("hookean-warnings", "[]"))
    assert set(told) <= set(warnings) and warnings == report.json()["warnings"]
    file = rhino3dm.File3dm.FromByteArray(answer.content)
    text = dict(file.Strings)
    assert text.pop("hookean:warnings", "") == "\n".join(warnings)
    assert {f"hookean-{k.removeprefix('hookean:').replace('_', '-')}": v for k, v in text.items()} == said
    written = dict(rhino3dm.File3dm.Read(str(target)).Strings)
    assert written.pop("hookean:warnings", "") == "\n".join(warnings) and written == text
    others = {name: value for name, value in said.items() if name != "hookean-message"}
    assert {k: v for k, v in scene.headers.items() if k in others} == others
    assert len(file.Objects) > 5


def test_a_solve_that_takes_too_long_ends_with_what_it_has(drawing: bytes) -> None:
    """The file with the last good shape, and the status `time_limit`, as `/v1/relax` answers; not a problem."""
    served = Served(file_seconds=0.5, workers=1)
    try:
        served.ready()
        endless = {**RECIPE, "settings": {"solver": "verlet", "drag": 0, "tolerance": 0, "max_iterations": 10**9}}
        endless["forces"] = [{**RECIPE["forces"][0], "damping": 0}, RECIPE["forces"][1]]
        form = {"file": ("a.3dm", drawing)}
        answer = served.client.post("/v1/relax/3dm", files=form, data={"recipe": json.dumps(endless)})
        assert answer.status_code == 200, answer.text
        assert answer.headers["hookean-status"] == "time_limit" and "0.5 s" in answer.headers["hookean-message"]
        assert dict(rhino3dm.File3dm.FromByteArray(answer.content).Strings)["hookean:status"] == "time_limit"
    finally:
        served.end()


def test_the_headers_are_described(client: httpx.Client) -> None:
    document = client.get("/v1/openapi.json").json()
    for path in ("/v1/relax", "/v1/relax/3dm"):
        headers = document["paths"][path]["post"]["responses"]["200"]["headers"]
        assert tuple(headers) == NAMES and all(entry["description"] for entry in headers.values())


def test_names_in_a_file_cannot_write_headers(client: httpx.Client, tmp_path: Path) -> None:
    """Names with ends of lines and letters of all alphabets, and so many that their notes would fill the head."""
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    for i in range(400):
        layer = rhino3dm.Layer()
        layer.Name = f"cabels {i}\r\nSet-Cookie: a=b\N{GREEK SMALL LETTER ALPHA}\N{CROSS MARK}{'long ' * 30}"
        attributes = rhino3dm.ObjectAttributes()
        attributes.LayerIndex = file.Layers.Add(layer)
        attributes.SetUserString(f"stifness{i}\r\nX-Evil: 1\u2028", "7")
        file.Objects.AddLine(rhino3dm.Point3d(i, 0, 0), rhino3dm.Point3d(i + 1, 0, 0), attributes)
    path = tmp_path / "odd.3dm"
    assert file.Write(str(path), 7)
    answer = client.post("/v1/relax/3dm", files={"file": ("a.3dm", path.read_bytes())})
    assert answer.status_code == 200, answer.text
    assert "set-cookie" not in answer.headers and "x-evil" not in answer.headers
    own = {name: value for name, value in answer.headers.items() if name.startswith("hookean-")}
    assert set(own) <= set(NAMES) and all(value.isascii() and value.isprintable() for value in own.values())
    assert len(own["hookean-warnings"]) <= 4096 and json.loads(own["hookean-warnings"])


@pytest.mark.parametrize(
    ("warnings", "last"),
    [
        (["plain"], "plain"),
        (["\N{CROSS MARK}" * 400] * 3, "..."),
        ([f"{i} \N{CROSS MARK}" * 40 for i in range(500)], "more"),
        (["a\r\nSet-Cookie: b=c\0\x7f\u2028"], "\u2028"),
    ],
)
def test_warnings_fit_into_a_header(warnings: list[str], last: str) -> None:
    """At most 4096 printable ASCII characters, however many and whatever they are; those left out are counted."""
    header = warned(warnings)["hookean-warnings"]
    found = json.loads(header)
    assert len(header) <= 4096 and header.isascii() and header.isprintable()
    assert found[-1].endswith(last) and len(found[0]) <= 300
    if last == "more":
        assert found[-1] == f"and {500 - len(found) + 1} more"
    assert warned([]) == {}
