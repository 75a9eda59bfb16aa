"""A drawing in, the relaxed drawing out: over HTTP as in Python."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import httpx
import pytest
import rhino3dm

from hookean.files.recipe import relax_file
from serving import CABLE

from .conftest import problem

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


@pytest.mark.parametrize("part", [0.2, 0.5, 0.9, 0.99])
def test_damaged_files(client: httpx.Client, drawing: bytes, part: float) -> None:
    found = problem(post(client, drawing[: int(part * len(drawing))]), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/file"


def test_nothing_is_left_behind(client: httpx.Client, drawing: bytes) -> None:
    import tempfile
    import time

    before = set(Path(tempfile.gettempdir()).glob("hookean-*"))
    post(client, drawing)
    post(client, drawing[:1000])
    left = set(Path(tempfile.gettempdir()).glob("hookean-*")) - before
    until = time.monotonic() + 20.0  # tests beside this one have folders of their own, which go, too
    while any(path.exists() for path in left) and time.monotonic() < until:
        time.sleep(0.1)
    assert not [path for path in left if path.exists()]
