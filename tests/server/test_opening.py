"""A session from a file that is dropped on the page: .3dm, OBJ, COMPAS JSON, scene; damaged ones are problems of it."""

from __future__ import annotations

import json
import random
import tomllib
from pathlib import Path
from typing import Any

import httpx
import pytest

from hookean.commands.examples import find
from serving import CABLE

from .conftest import Served, problem

SHEET = "".join(f"v {i} {j} 0\n" for i in range(4) for j in range(4)) + "".join(
    f"f {4 * i + j + 1} {4 * i + j + 5} {4 * i + j + 6} {4 * i + j + 2}\n" for i in range(3) for j in range(3)
)
LINE = {"dtype": "compas.geometry/Line", "data": {"start": [0, 0, 0], "end": [1, 0, 0]}}
POLYLINE = {"dtype": "compas.geometry/Polyline", "data": {"points": [[1, 0, 0], [2, 0, 0], [2, 1, 0]]}}


def opened(client: httpx.Client, name: str, data: str | bytes, **more: Any) -> httpx.Response:
    """What POST /v1/sessions answers to a file of a name."""
    return client.post("/v1/sessions", files={"file": (name, data), **more})


@pytest.mark.thinned
@pytest.mark.parametrize(
    ("name", "data", "particles", "held"),
    [
        ("sheet.obj", SHEET, 16, 12),
        ("SHEET.OBJ", SHEET, 16, 12),
        ("sheet", SHEET, 16, 12),
        ("lines.json", json.dumps([LINE, POLYLINE]), 4, 2),
        ("scene.json", json.dumps(CABLE), 6, 2),
        ("no ending", json.dumps(CABLE), 6, 2),
    ],
)
def test_a_dropped_file_is_a_session(client: httpx.Client, name: str, data: str, particles: int, held: int) -> None:
    made = opened(client, name, data)
    assert made.status_code == 201, made.text
    address = made.headers["location"]
    assert made.json()["particles"] == particles
    found = client.get(f"{address}/anchors").json()["anchors"]
    assert sum(len(anchor["particles"]) for anchor in found) == held
    assert client.post(f"{address}/step", params={"frames": 10}).json()["status"] in ("running", "converged")
    assert client.delete(address).status_code == 204


def test_a_drawing_of_rhino_is_taken_as_before(client: httpx.Client) -> None:
    """With its recipe; one that does not fit another file is refused where it does not."""
    folder = find("9.24").folder
    model, recipe = (folder / "model.3dm").read_bytes(), (folder / "recipe.toml").read_text()
    recipe_json = json.dumps(tomllib.loads(recipe))
    made = opened(client, "model.3dm", model, recipe=(None, recipe_json))
    assert made.status_code == 201 and made.json()["particles"] == 441, made.text
    client.delete(made.headers["location"])
    found = problem(opened(client, "sheet.obj", SHEET, recipe=(None, recipe_json)), 422, "invalid-input")
    assert found["errors"][0]["pointer"].startswith("/recipe/forces/0/")


def test_put_gives_a_session_a_file(client: httpx.Client) -> None:
    """The same file again changes nothing, another one raises the revision."""
    address = "/v1/sessions/opened-by-put"
    first = client.put(address, files={"file": ("a.obj", SHEET)})
    assert first.status_code == 201
    same = client.put(address, files={"file": ("a.obj", SHEET)})
    assert same.status_code == 200 and same.headers["etag"] == first.headers["etag"]
    other = client.put(address, files={"file": ("a.json", json.dumps([LINE]))})
    assert other.status_code == 200 and other.json()["particles"] == 2
    assert other.json()["revision"] > first.json()["revision"]
    client.delete(address)


def test_what_is_not_taken_and_what_was_changed_is_told(client: httpx.Client) -> None:
    """A stiff star of lines explodes with the usual step of time: it gets one that holds, and that is said."""
    star = "v 0 0 0\n" + "".join(f"v {i + 1} {i % 7} {i % 5}\n" for i in range(200))
    star += "vn 0 0 1\n" + "".join(f"l 1 {i + 2}\n" for i in range(200))
    made = opened(client, "star.obj", star).json()
    assert any("normals" in said for said in made["warnings"])
    assert any("steps of" in said for said in made["warnings"])
    address = f"/v1/sessions/{made['key']}"
    assert client.get(address).json()["warnings"] == made["warnings"]
    scene = client.get(f"{address}/scene").json()
    again = client.put(address, json={**scene, "settings": {**scene["settings"], "drag": 2.0}}).json()
    assert again["revision"] == 1 and again["warnings"] == made["warnings"], "they are of the file, not of one scene"
    assert client.patch(address, json={"pin": [{"particles": [0], "targets": [[0, 0, 1]]}]}).status_code == 200
    assert client.post(f"{address}/step", params={"frames": 20}).json()["status"] != "diverged"
    client.delete(address)


def test_what_was_told_of_a_file_and_a_new_name_outlive_the_server(tmp_path: Path) -> None:
    """A page that is loaded again after a restart shows it too; a branch has it, another file's session has not."""
    state = str(tmp_path / "sessions.db")
    first = Served(state=state, workers=1)
    try:
        for key, more in (("a", "vn 0 0 1\nusemtl red\n"), ("b", "")):
            made = first.client.put(f"/v1/sessions/{key}", files={"file": ("a.obj", SHEET + more)})
            assert made.status_code == 201, made.text
        first.client.post("/v1/sessions/a/branches", params={"to": "c"})
        renamed = first.client.put("/v1/sessions/a/label", params={"label": "Sheet"}).json()
        assert (renamed["label"], renamed["revision"]) == ("Sheet", 0)
    finally:
        first.end()
    second = Served(state=state, workers=1)
    try:
        listed = second.client.get("/v1/sessions").json()["sessions"]
        told = ["not read from the file: normals, materials"]
        assert {one["key"]: one["label"] for one in listed} == {"a": "Sheet", "b": "", "c": ""}
        assert {one["key"]: one["warnings"] for one in listed} == {"a": told, "b": [], "c": told}
        second.client.post("/v1/sessions/a/step")
        assert second.client.get("/v1/sessions/a").json()["warnings"] == told
    finally:
        second.end()


@pytest.mark.thinned
@pytest.mark.parametrize(
    ("name", "data", "pointer", "said"),
    [
        ("a.obj", SHEET + "f 1 2 99\n", "/file", "line 26: vertex 99 does not exist"),
        ("a.obj", "", "/file", "the file is empty"),
        ("a.json", '{"forces": [{"kind": "springs", "lines": 7}]}', "/file/forces/0/lines", ""),
        ("a.json", "{", "/file", "not valid JSON"),
        ("a.json", "[" * 5000, "/", ""),
        ("a.json", '[{"dtype": "builtins/eval", "data": "1"}]', "/file", "no lines or faces"),
        ("a.stl", "solid", "/file", "give a .3dm, .obj, .json, .npz or .hookean file"),
        ("a.3dm", SHEET, "/file", ""),
        ("../../etc/passwd", "root:x:0:0", "/file", "give a .3dm, .obj, .json, .npz or .hookean file"),
    ],
)
def test_a_fault_is_one_of_the_file(client: httpx.Client, name: str, data: str, pointer: str, said: str) -> None:
    found = problem(opened(client, name, data), 422, "invalid-input")
    assert found["errors"][0]["pointer"].startswith(pointer) and said in found["errors"][0]["detail"], found
    assert "/tmp" not in json.dumps(found)


def test_the_limit_of_files_is_that_of_all(client: httpx.Client) -> None:
    problem(opened(client, "a.obj", b"#" * 65 * 2**20), 413, "too-large")


@pytest.mark.soak
def test_damaged_files_are_problems_of_the_file(client: httpx.Client, tmp_path: Path) -> None:
    """Cuts and mutations of good files: a session, or 422 with a sentence, never the server's failure."""
    chance = random.Random(7)
    good = {"a.obj": SHEET.encode(), "a.json": json.dumps([LINE, POLYLINE]).encode(),
            "b.json": json.dumps(CABLE).encode()}  # fmt: skip
    refused = 0
    for number in range(12):
        name, data = list(good.items())[number % len(good)]
        changed = bytearray(data[: chance.randrange(len(data) // 2, len(data))] if chance.random() < 0.5 else data)
        for _ in range(chance.randrange(4)):
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        answer = opened(client, name, bytes(changed))
        if answer.status_code == 201:
            client.delete(answer.headers["location"])
        else:
            refused += 1
            assert answer.status_code == 422, answer.text
            assert problem(answer, 422, answer.json()["type"].rpartition("/")[2])["errors"]
    assert refused > 2
