"""A session exported in a format and opened again, over HTTP: the same model, and its state where the format has it."""

from __future__ import annotations

import json
from typing import Any

import httpx
import numpy as np
import pytest

from soak import sampled

from .test_additions import FILES, edited, opened

ENDINGS = {"scene": "json", "3dm": "3dm", "npz": "npz", "compas": "json"}


def out(client: httpx.Client, address: str, form: str) -> httpx.Response:
    """A session in a format, as the page asks for it."""
    path = f"{address}/scene" if form == "scene" else f"{address}/state"
    answer = client.get(path, params={} if form == "scene" else {"format": form})
    assert answer.status_code == 200, answer.text
    return answer


@pytest.mark.parametrize("what", sampled(["drawing", "9.29-diagonals", "sheet"], 3))
def test_what_was_taken_out_is_the_same_model(client: httpx.Client, what: str) -> None:
    """Edited and moved: each file gives a session with the same scene; .npz with the same shape, speed and time."""
    address, made = opened(client, what), []
    try:
        [anchor] = client.get(f"{address}/anchors").json()["anchors"][:1]
        lifted = [[x, y, z + 0.1] for x, y, z in anchor["targets"]]
        edited(client, address, move=[{"anchor": 0, "targets": lifted}], pin=[{"particles": [7], "name": "hand"}])
        edited(client, address, add=[{"kind": "self_weight", "name": "weight", "total": 5.0}], release=[0])
        client.post(f"{address}/step", params={"frames": 3})
        scene, state = (client.get(f"{address}/{part}").json() for part in ("scene", "state"))
        for form, ending in ENDINGS.items():
            answer = out(client, address, form)
            assert "hookean-warnings" not in answer.headers
            again = client.post("/v1/sessions", files={"file": (f"taken.{ending}", answer.content)})
            assert again.status_code == 201, again.text
            made.append(again.headers["location"])
            assert client.get(f"{made[-1]}/scene").json() == scene, form
            if form == "npz":
                now = client.get(f"{made[-1]}/state").json()
                assert now["particles"] == state["particles"] and now["time"] == state["time"] > 0
                assert again.json()["revision"] == 0
        steps = [client.post(f"{key}/step", params={"frames": 2}).json() for key in (address, made[-2])]
        assert steps[0]["energy"] == steps[1]["energy"]
    finally:
        for one in (address, *made):
            client.delete(one)


def test_a_saved_simulation_takes_the_place_of_a_session(client: httpx.Client) -> None:
    """PUT: as saved, with a revision more; undo has nothing of before."""
    address = opened(client, "scene")
    saved = out(client, address, "npz").content
    edited(client, address, release=[5])
    client.post(f"{address}/step")
    back = client.put(address, files={"file": ("saved.npz", saved)})
    assert back.status_code == 200, back.text
    assert back.json()["revision"] == 2 and back.json()["iteration"] == 0 and back.json()["undo"] == 0
    assert np.array_equal(client.get(f"{address}/anchors").json()["anchors"][0]["particles"], [0, 5])
    client.delete(address)


@pytest.mark.parametrize(("form", "lacks"), [("obj", "not forces, loads"), ("csv", "cannot be opened")])
def test_a_format_that_is_not_the_model_has_a_sentence(client: httpx.Client, form: str, lacks: str) -> None:
    address = opened(client, "sheet")
    answer = out(client, address, form)
    [sentence] = json.loads(answer.headers["hookean-warnings"])
    assert lacks in sentence
    made = client.post("/v1/sessions", files={"file": (f"taken.{form}", answer.content)})
    assert made.status_code == (201 if form == "obj" else 422)
    if form == "obj":
        assert made.json()["particles"] == client.get(address).json()["particles"]
        client.delete(made.headers["location"])
    client.delete(address)


@pytest.mark.parametrize("data", [b"PK\x03\x04", b"PK\x03\x04" + bytes(200), FILES["scene"][1]])
def test_a_file_that_is_no_saved_simulation_is_refused(client: httpx.Client, data: bytes) -> None:
    made = client.post("/v1/sessions", files={"file": ("a.npz", data)})
    found: dict[str, Any] = made.json()
    assert made.status_code == 422 and "Simulation.save" in found["errors"][0]["detail"]
    assert found["errors"][0]["pointer"] == "/file"
