"""A draft of a recipe over HTTP: that of the core, accepted by the routes that read recipes; faults are problems."""

from __future__ import annotations

import json
from typing import Any

import httpx
import numpy as np
import pytest

from fuzz import damage
from hookean.commands.examples import find
from hookean.files.recipe.draft import draft, model_in
from hookean.files.relax_file import relax_file
from hookean.files.rhino import threedm

from .conftest import problem

PATH = find("9.27").folder / "model.3dm"
NET = {"layer": "membrane", "family": "surfaces", "role": "net", "values": {"divide_u": 4, "divide_v": 4, "load": -5}}


def asked(client: httpx.Client, choices: Any = None, data: bytes | None = None, name: str = "model.3dm") -> Any:
    form = {} if choices is None else {"choices": (None, json.dumps(choices))}
    return client.post("/v1/recipes/3dm", files={"file": (name, data or PATH.read_bytes()), **form})


def test_it_is_the_draft_of_the_core(client: httpx.Client) -> None:
    for choices in (None, {"rows": [NET], "units": {"length": "cm"}}):
        found = asked(client, choices).json()
        wanted = json.loads(json.dumps(draft(threedm.read(PATH), choices).to_dict()))
        assert found == wanted and found["name"] == "model.3dm"


def test_a_session_has_the_roles_of_its_recipe(client: httpx.Client) -> None:
    """What comes to rest is what the Python API makes of the same file and recipe, by the same solver."""
    found = asked(client, {"rows": [NET]}).json()
    recipe = json.dumps(found["recipe"])
    made = client.post("/v1/sessions", files={"file": ("model.3dm", PATH.read_bytes()), "recipe": (None, recipe)})
    assert made.status_code == 201 and made.json()["particles"] == found["particles"]
    address = made.headers["location"]
    scene = client.get(f"{address}/scene").json()
    assert [force["kind"] for force in scene["forces"]] == ["springs", "unary"]
    held = client.get(f"{address}/anchors").json()["anchors"]
    assert len({p for anchor in held for p in anchor["particles"]}) == found["held"]
    form = {"files": {"file": ("model.3dm", PATH.read_bytes())}, "data": {"recipe": recipe}}
    report = client.post("/v1/relax/3dm", params={"answer": "report"}, **form).json()
    truth = relax_file(PATH, recipe_text=recipe).result
    assert np.array_equal(report["result"]["particles"], truth.particles)
    client.delete(address)


def test_other_files_have_rows_by_their_names_and_whole_models_none(client: httpx.Client) -> None:
    """The draft of an OBJ file is that of the core; a scene opens as it is, and a fault names the line."""
    told = b"o roof\nv 0 0 0\nv 2 0 0\nv 2 2 0\nf 1 2 3\n"

    def found(name: str, data: bytes) -> httpx.Response:
        return client.post("/v1/recipes", files={"file": (name, data)})

    rows = found("roof.obj", told).json()
    model = model_in(told, "roof.obj")
    assert model is not None and rows == json.loads(json.dumps(draft(model).to_dict()))
    assert [row["layer"] for row in rows["rows"]] == ["roof"]
    assert found("scene.json", b'{"particles": [[0, 0, 0]]}').json()["rows"] == []
    said = problem(found("a.obj", b"v 1\n"), 422, "invalid-input")
    assert "line 1: a vertex needs three coordinates" in str(said)


def test_faulty_requests(client: httpx.Client) -> None:
    refused = {
        "/choices/rows/0/role": ({"rows": [{**NET, "role": "cables"}]}, "surfaces may be net, membrane"),
        "/choices/rows/0/values/load": ({"rows": [{**NET, "values": {"load": "x"}}]}, "number"),
        "/choices/row": ({"row": []}, "rows"),
        "/choices": ("[", "object"),
    }
    for pointer, (choices, said) in refused.items():
        found = problem(asked(client, choices), 422, "invalid-input")
        assert found["errors"][0]["pointer"] == pointer and said in found["detail"]
    assert problem(asked(client, data=b"3D Geometry"), 422, "invalid-input")["errors"][0]["pointer"] == "/file"
    form = {"files": {"file": ("a.3dm", PATH.read_bytes())}, "data": {"choices": "{"}}
    found = problem(client.post("/v1/recipes/3dm", **form), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/choices" and "JSON" in found["detail"]
    form["data"] = {"recipe": "{}"}
    found = problem(client.post("/v1/recipes/3dm", **form), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/recipe" and "file and choices" in found["detail"]


@pytest.mark.soak
def test_damaged_files_are_the_files_fault(client: httpx.Client) -> None:
    files = damage.seeds()
    for number in range(0, 2000, 500):
        _, _, data = damage.mutant(files, number)
        answer = asked(client, data=data)
        assert answer.status_code in (200, 422), (number, answer.text[:300])
        if answer.status_code == 422:
            assert answer.json()["errors"][0]["pointer"] == "/file"
