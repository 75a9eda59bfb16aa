"""Loads and self weight added to sessions of every figure and of files of every kind; removed, undone, kept, exported.

Oracle: sums of loads by hand, and a session of the scene that was exported.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from hookean.commands.examples import examples, find
from serving import CABLE

from .conftest import Served, problem
from .test_opening import LINE, POLYLINE, SHEET

NAMES = [example.name for example in examples()]
SOME = NAMES[1::9]
OTHERS = [name for name in NAMES if name not in SOME]
FILES: dict[str, tuple[str, bytes]] = {
    "sheet": ("sheet.obj", SHEET.encode()),
    "lines": ("lines.json", json.dumps([LINE, POLYLINE]).encode()),
    "scene": ("scene.json", json.dumps(CABLE).encode()),
    "drawing": ("model.3dm", (find("9.26").folder / "model.3dm").read_bytes()),
}


def opened(client: httpx.Client, what: str) -> str:
    """The address of a new session of a figure or a file."""
    if what in FILES:
        made = client.post("/v1/sessions", files={"file": FILES[what]})
    else:
        made = client.post("/v1/sessions", content=client.get(f"/v1/examples/{what}/scene").content, headers=JSON)
    assert made.status_code == 201, made.text
    return str(made.headers["location"])


JSON = {"content-type": "application/json"}


def loads(client: httpx.Client, address: str) -> np.ndarray:
    """The sum of all loads on each particle (n, 3) [force], as the result lists them."""
    found = client.get(f"{address}/state").json()
    total = np.zeros((len(found["particles"]), 3))
    for force in found["forces"]:
        if force["kind"] in ("unary", "self_weight"):
            for row, vector in zip(force["particles"], force["force"], strict=True):
                total[row[0]] += vector
    return total


def edited(client: httpx.Client, address: str, **edit: Any) -> dict[str, Any]:
    answer = client.patch(address, json=edit)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


@pytest.mark.thinned
@pytest.mark.parametrize("what", [*SOME, *(pytest.param(name, marks=pytest.mark.soak) for name in OTHERS), *FILES])
def test_a_load_and_self_weight_are_added_to_any_scene(client: httpx.Client, what: str) -> None:
    address = opened(client, what)
    try:
        first, before = client.get(f"{address}/scene").content, loads(client, address)
        topology = client.get(f"{address}/topology")
        held = {p for anchor in client.get(f"{address}/anchors").json()["anchors"] for p in anchor["particles"]}
        count = len(before)
        free = [particle for particle in range(count) if particle not in held]
        load = {"kind": "unary", "name": "a load", "particles": free, "vector": [0, 0, -0.01]}
        assert edited(client, address, add=[load])["undo"] == 1
        weight = {"kind": "self_weight", "name": "a weight", "total": 0.02 * count}
        assert edited(client, address, add=[weight])["undo"] == 2

        wanted = before.copy()
        wanted[free, 2] -= 0.01
        wanted[:, 2] -= 0.02
        assert loads(client, address) == pytest.approx(wanted, abs=1e-12)
        changed = client.get(f"{address}/topology")
        assert changed.headers["etag"] != topology.headers["etag"]
        assert [force["name"] for force in changed.json()["forces"]][-2:] == ["a load", "a weight"]
        stepped = client.post(f"{address}/step", params={"frames": 3}).json()
        # these loads may be more than a light film can carry
        collapsed = "the film has collapsed" in stepped["message"]
        assert stepped["status"] in ("running", "converged") or collapsed, stepped["message"]

        scene = client.get(f"{address}/scene").content
        again = client.post("/v1/sessions", content=scene, headers=JSON)
        assert again.status_code == 201, again.text
        assert loads(client, again.headers["location"]) == pytest.approx(wanted, abs=1e-12)
        client.delete(again.headers["location"])

        for action, left in (("undo", 1), ("undo", 0), ("redo", 1), ("redo", 2)):
            assert client.post(f"{address}/{action}").json()["undo"] == left
        assert client.get(f"{address}/scene").content == scene
        edited(client, address, remove=["a weight", "a load"])
        assert client.get(f"{address}/scene").content == first
        assert client.get(f"{address}/topology").headers["etag"] == topology.headers["etag"]
        assert loads(client, address) == pytest.approx(before)
    finally:
        client.delete(address)


def test_additions_outlive_the_server(tmp_path: Path) -> None:
    """Added, one removed, one undone; the server ends and starts: the same scene, and the state goes on in it."""
    state = str(tmp_path / "sessions.db")
    first = Served(state=state, workers=1)
    try:
        assert first.client.put("/v1/sessions/a", files={"file": FILES["sheet"]}).status_code == 201
        address = "/v1/sessions/a"
        edited(first.client, address, add=[{"kind": "unary", "name": "one", "particles": [5], "vector": [0, 0, 2]}])
        edited(
            first.client, address, add=[{"kind": "self_weight", "name": "two", "total": 4}], pin=[{"particles": [6]}]
        )
        edited(first.client, address, remove=["one"])
        edited(first.client, address, add=[{"kind": "unary", "name": "three", "particles": [9], "vector": [1, 0, 0]}])
        first.client.post(f"{address}/undo")
        first.client.post(f"{address}/step", params={"frames": 2})
        kept = [first.client.get(f"{address}/{what}").json() for what in ("scene", "anchors", "topology")]
        particles = first.client.get(f"{address}/state").json()["particles"]
    finally:
        first.end()
    second = Served(state=state, workers=1)
    try:
        assert [second.client.get(f"{address}/{what}").json() for what in ("scene", "anchors", "topology")] == kept
        assert second.client.get(f"{address}/state").json()["particles"] == particles
        assert second.client.post(f"{address}/redo").json()["redo"] == 0
        names = [force["name"] for force in second.client.get(f"{address}/scene").json()["forces"]]
        assert names == [kept[0]["forces"][0]["name"], "two", "three"]
        for _ in range(4):
            second.client.post(f"{address}/undo")
        assert len(second.client.get(f"{address}/scene").json()["forces"]) == 1
    finally:
        second.end()


def test_a_fault_of_an_added_force_has_its_place(client: httpx.Client) -> None:
    address = opened(client, "sheet")
    for edit, pointer in (
        ({"add": [{"kind": "unary", "particles": [99], "vector": [0, 0, 1]}]}, "/add/0/particles"),
        ({"add": [{"kind": "unary", "particles": [1], "vector": [0, 0, 1], "nme": "a"}]}, "/add/0/nme"),
        ({"add": {"kind": "unary"}}, "/add"),
        ({"remove": ["none"]}, "/remove/0"),
    ):
        found = problem(client.patch(address, json=edit), 422, "invalid-input")
        assert found["errors"][0]["pointer"] == pointer
    assert client.get(address).json()["revision"] == 0
    client.delete(address)
