"""The gallery: every figure listed has its picture, and its scene makes a session that moves and does not explode."""

from __future__ import annotations

import httpx
import pytest

from hookean import Scene
from hookean.commands.examples import examples
from soak import sampled

from .conftest import problem

NAMES = [example.name for example in examples()]


def test_all_figures_are_listed_in_the_order_of_the_chapter(client: httpx.Client) -> None:
    """All of them have scenes: the graphs of closed forms stand beside chains that hang on them."""
    listed = client.get("/v1/examples").json()["examples"]
    assert [entry["id"] for entry in listed] == NAMES and len(NAMES) >= 25
    assert listed[0]["figure"] == "Figure 9.1" and listed[1]["figure"] == "Figures 9.4 and 9.5"
    for entry in listed:
        assert entry["title"] and entry["sentence"].endswith(".") and len(entry["sentence"]) <= 110
        assert entry["sentence"].rstrip(".") != entry["title"]


@pytest.mark.parametrize("name", sampled(NAMES, 8))
def test_a_figure_is_a_session_that_moves(client: httpx.Client, name: str) -> None:
    """Ten frames from its start, and it has not diverged; nothing is said of a time step too large."""
    read = client.get(f"/v1/examples/{name}/scene")
    assert read.status_code == 200 and read.headers["content-type"] == "application/json"
    Scene.read(read.text)
    key = f"gallery-{name}"
    made = client.put(f"/v1/sessions/{key}", content=read.content, headers={"content-type": "application/json"})
    assert made.status_code == 201, made.text
    try:
        stepped = client.post(f"/v1/sessions/{key}/step", params={"frames": 10}).json()
        assert stepped["status"] in ("running", "converged") and stepped["iteration"] >= 10, stepped
        assert not client.get(f"/v1/sessions/{key}/state").json()["report"]["warnings"]
    finally:
        assert client.delete(f"/v1/sessions/{key}").status_code == 204


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_has_its_picture(client: httpx.Client, name: str) -> None:
    picture = client.get(f"/v1/examples/{name}/picture")
    assert picture.headers["content-type"] == "image/png" and picture.content.startswith(b"\x89PNG\r\n\x1a\n")
    again = client.get(f"/v1/examples/{name}/picture", headers={"if-none-match": picture.headers["etag"]})
    assert again.status_code == 304 and not again.content


@pytest.mark.parametrize("name", ["9.99-none", "..", "9.4-cable%2f..", "README.md", "9.4", ""])
def test_nothing_else_is_read(client: httpx.Client, name: str) -> None:
    for what in ("scene", "picture"):
        problem(client.get(f"/v1/examples/{name}/{what}"), 404, "not-found")
