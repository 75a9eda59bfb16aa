"""Families over HTTP: listed with their parameters, made, rebuilt, undone, and the same in a file of a session."""

from __future__ import annotations

from typing import Any

import httpx
import numpy as np
import pytest

from hookean import family
from hookean.scene.families import families

from .conftest import problem


def test_families_are_listed_and_made_as_the_core_does(client: httpx.Client) -> None:
    assert client.get("/v1/families").json() == {"families": families()}
    body = {"units": {"length": "mm"}, "parameters": {"rise": 2, "across": 3}}
    made = client.post("/v1/families/saddle", json=body)
    assert made.text == family("saddle", {"length": "mm"}, rise=2, across=3).canonical


@pytest.mark.parametrize(
    ("name", "body", "status", "said"),
    [
        ("tent", {}, 404, "GET /v1/families"),
        ("saddle", {"rise": 3}, 422, "units and parameters"),
        ("saddle", {"parameters": [3]}, 422, "object of parameters"),
        ("saddle", {"parameters": {"across": 0}}, 422, "at least 1"),
        ("catenoid", {"parameters": {"height": 9}}, 422, "collapses"),
    ],
)
def test_bad_bodies_are_refused(client: httpx.Client, name: str, body: dict[str, Any], status: int, said: str) -> None:
    answer = client.post(f"/v1/families/{name}", json=body)
    assert answer.status_code == status and said in answer.json()["detail"]


def test_parameters_of_a_session_are_edits_that_its_file_keeps(client: httpx.Client) -> None:
    """Undo and redo lead to the scenes of the parameters, a .hookean file goes on being editable, and a pin that a
    rebuilding could not keep forbids it."""
    address = client.post("/v1/sessions", json=family("cable", parts=4).model_dump(mode="json")).headers["location"]
    scene = f"{address}/scene"
    for parts in (5, 6):
        made = client.patch(address, json={"rebuild": {"parts": parts}, "gesture": "slide"})
        assert made.json()["particles"] == parts + 1
    assert client.get(scene).text == family("cable", parts=6).canonical
    assert len(client.get(f"{address}/topology").json()["springs"]) == 6
    client.post(f"{address}/undo")
    assert client.get(scene).text == family("cable", parts=4).canonical
    client.post(f"{address}/redo")
    file = client.get(f"{address}/state", params={"format": "hookean"}).content
    again = client.post("/v1/sessions", files={"file": ("cable.hookean", file)}).headers["location"]
    assert client.patch(again, json={"rebuild": {"span": 4}}).json()["particles"] == 7
    assert np.ptp(client.get(f"{again}/scene").json()["particles"], axis=0)[0] == 4
    client.patch(again, json={"pin": [{"particles": [2]}]})
    refused = client.patch(again, json={"rebuild": {"span": 5}})
    assert "undo these edits" in problem(refused, 422, "invalid-input")["detail"]
    refused = client.patch(again, json={"rebuild": {"span": 5}, "pin": []})
    assert "only key" in problem(refused, 422, "invalid-input")["detail"]


def test_units_of_a_session_are_an_edit(client: httpx.Client) -> None:
    """The numbers stay, in mm now; undo goes back to m. What is no unit is refused."""
    address = client.post("/v1/sessions", json=family("cable", parts=2).model_dump(mode="json")).headers["location"]
    before = client.get(f"{address}/scene").json()
    assert client.patch(address, json={"units": {"length": "mm"}}).json()["units"]["length"] == "mm"
    after = client.get(f"{address}/scene").json()
    assert after == {**before, "units": {**before["units"], "length": "mm"}}
    client.post(f"{address}/undo")
    assert client.get(f"{address}/scene").json() == before
    refused = client.patch(address, json={"units": {"length": "miles"}})
    assert problem(refused, 422, "invalid-input")["errors"][0]["pointer"] == "/units/length"
