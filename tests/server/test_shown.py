"""What a program and the page share beside the model: what is picked, colours, the edits; and the page in a frame."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

import hookean
from serving import CABLE, HANG

from .conftest import Served, problem

KEY = "/v1/sessions/shown"


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    found = Served(workers=1)
    yield found
    found.end()


@pytest.fixture
def session(served: Served) -> httpx.Client:
    """A client whose session is new."""
    served.client.delete(KEY)
    assert served.client.put(KEY, json=CABLE).status_code == 201
    return served.client


def test_what_is_picked_and_colours_are_kept_apart_and_change_no_model(session: httpx.Client) -> None:
    """A PATCH changes what it names alone (RFC 7396, section 1); null takes it back; the ETag stays."""
    tag = session.get(KEY).headers["etag"]
    assert session.get(f"{KEY}/view").json() == {"picked": None, "colours": None}
    picked = {"kind": "particle", "index": 3}
    colours = {"title": "Used", "unit": "%", "of": "springs", "values": [1.0, 2.0, 3.0, 4.0, 5.0]}
    assert session.patch(f"{KEY}/view", json={"picked": picked}).json() == {"picked": picked, "colours": None}
    assert session.patch(f"{KEY}/view", json={"colours": colours}).json() == {"picked": picked, "colours": colours}
    assert session.patch(f"{KEY}/view", json={"picked": None}).json() == {"picked": None, "colours": colours}
    assert session.get(KEY).headers["etag"] == tag


@pytest.mark.parametrize(
    ("given", "pointer"),
    [
        ({"picked": {"kind": "face", "index": 1}}, "/picked/kind"),
        ({"picked": {"kind": "spring", "index": -1}}, "/picked/index"),
        ({"colours": {"title": "Used", "of": "springs", "values": []}}, "/colours/values"),
        ({"colour": None}, "/colour"),
    ],
)
def test_an_invalid_view_is_refused_with_its_place(session: httpx.Client, given: dict[str, object], pointer: str):
    answer = session.patch(f"{KEY}/view", json=given)
    assert problem(answer, 422, "invalid-input")["errors"][0]["pointer"] == pointer


def test_the_surface_is_that_of_the_core(session: httpx.Client) -> None:
    """Of a session that was not run yet: slope and height lines of its mesh, and no drops but those asked for."""
    scene = hookean.family("saddle", rise=2.0, across=6, along=6)
    assert session.put(KEY, content=scene.canonical, headers={"content-type": "application/json"}).status_code == 200
    truth = hookean.surface(hookean.Simulation(scene), 0.25, 7)
    assert session.get(f"{KEY}/surface", params={"step": 0.25, "drops": 7}).json() == truth.to_dict()
    answer = session.get(f"{KEY}/surface")
    assert answer.json()["water"]["lines"] == []
    tag = {"if-none-match": answer.headers["etag"]}
    assert session.get(f"{KEY}/surface", headers=tag).status_code == 304
    found = problem(session.get(f"{KEY}/surface", params={"step": 1e-9}), 422, "invalid-input")
    assert "at most 1000 levels" in found["detail"]


def test_edits_are_listed_with_the_revisions_they_led_to(session: httpx.Client) -> None:
    patches = [{"forces": {"1": {"vector": [0, 0, -30.0]}}}, {"pin": [{"particles": [2], "targets": [[4, 0, 1]]}]}]
    made = [session.patch(KEY, json=patch).json()["revision"] for patch in patches]
    assert session.post(f"{KEY}/undo").status_code == 200
    found = session.get(f"{KEY}/edits").json()["edits"]
    assert [edit["revision"] for edit in found[:2]] == made
    assert [edit["edit"] for edit in found] == [*patches, {"undo": True}]
    assert session.get(f"{KEY}/edits", params={"after": made[0]}).json()["edits"] == found[1:]


def test_the_page_may_be_framed_where_a_client_with_the_token_asked_for_it(served: Served) -> None:
    """CSP 3, section 6.4.2: `frame-ancestors`. Others learn nothing that opens this, and frames of no other machine."""
    html = {"accept": "text/html"}
    with httpx.Client(base_url=served.url, timeout=HANG) as anybody:
        assert anybody.post("/v1/login/codes").status_code == 401
        frame = served.client.post("/v1/login/codes").json()["frame"]
        policies = [
            anybody.get("/", params=query, headers=html).headers["content-security-policy"]
            for query in ({"frame": frame}, {"frame": frame[:-1]}, {"frame": ""}, {})
        ]
    local = "frame-ancestors http://127.0.0.1:* http://localhost:*;"
    assert [local in policy for policy in policies] == [True, False, False, False]
    assert ["frame-ancestors 'none';" in policy for policy in policies] == [False, True, True, True]
