"""Conditional requests (RFC 9110, section 13) on every route of a session, and what its ETags stand for."""

from __future__ import annotations

import signal
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from serving import CABLE, wait_for

from .conftest import Served, problem
from .test_races import at_once

A = "/v1/sessions/a"
OTHER = '"0123456789abcdef-0-01234567"'  # an ETag that no session has
CHANGES: dict[str, Callable[[httpx.Client, dict[str, str]], httpx.Response]] = {
    "PUT": lambda client, when: client.put(A, json=changed(-1), headers=when),
    "PATCH": lambda client, when: client.patch(A, json={"release": [0]}, headers=when),
    "rename": lambda client, when: client.put(f"{A}/label", params={"label": "b"}, headers=when),
    "branch": lambda client, when: client.post(f"{A}/branches", params={"to": "b"}, headers=when),
    **{
        name: lambda client, when, name=name: client.post(f"{A}/{name}", headers=when)
        for name in ("play", "relax", "pause", "step", "reset", "undo")
    },
    "DELETE": lambda client, when: client.delete(A, headers=when),
}
READS = ("", "/state", "/state?format=csv", "/scene", "/anchors", "/topology")


def changed(load: float) -> dict[str, Any]:
    return {**CABLE, "forces": [CABLE["forces"][0], {**CABLE["forces"][1], "vector": [0, 0, load]}]}


@pytest.fixture
def client(served: Served) -> Iterator[httpx.Client]:
    """A session `a` at revision 1."""
    served.client.put(A, json=CABLE)
    served.client.patch(A, json={"pin": [{"particles": [2]}]})
    yield served.client
    for session in served.client.get("/v1/sessions").json()["sessions"]:
        served.client.delete(f"/v1/sessions/{session['key']}")


MET = [
    ("if-match", "{now}"),
    ("if-match", f"{OTHER}, {{now}}"),
    ("if-match", f',{OTHER} ,\t{{now}}, W/"x,y"'),
    ("if-match", "*"),
    ("if-none-match", f"{OTHER}, W/{{before}}"),
]
UNMET = [
    *[("if-match", given) for given in (OTHER, "{before}", "W/{now}", f"W/{{now}}, {OTHER}", "{bare}", "1", "")],
    *[("if-none-match", given) for given in ("{now}", f"{OTHER}, W/{{now}}", "*", "{bare}")],
]
"""Conditions, where `now` is the ETag of the session, `before` that of its last revision, `bare` the first unquoted."""


def headers(client: httpx.Client, name: str, given: str) -> dict[str, str]:
    now = client.get(A).headers["etag"]
    before = now.replace("-1-", "-0-")
    assert before != now
    return {name: given.format(now=now, before=before, bare=now.strip('"'))}


@pytest.mark.thinned
@pytest.mark.parametrize("change", CHANGES)
def test_a_change_is_refused_where_its_condition_is_not_met(client: httpx.Client, change: str) -> None:
    """Section 13.1.1: If-Match compares strongly; 13.1.2: If-None-Match weakly. The refusal has the ETag that is, and
    nothing has changed."""
    now = client.get(A).headers["etag"]
    for name, given in UNMET:
        answer = CHANGES[change](client, headers(client, name, given))
        problem(answer, 412, "stale-revision")
        assert answer.headers["etag"] == client.get(A).headers["etag"] == now
    assert "b" not in [session["key"] for session in client.get("/v1/sessions").json()["sessions"]]


@pytest.mark.thinned
@pytest.mark.parametrize(("change", "met"), [*[(change, MET[0]) for change in CHANGES], *[("PATCH", m) for m in MET]])
def test_a_change_is_made_where_its_condition_is_met(client: httpx.Client, change: str, met: tuple[str, str]) -> None:
    assert CHANGES[change](client, headers(client, *met)).status_code in (200, 201, 204)


@pytest.mark.thinned
@pytest.mark.parametrize("change", CHANGES)
def test_an_etag_of_a_deleted_session_matches_none_made_again(client: httpx.Client, change: str) -> None:
    """Under the same key, of the same scene, at the same revision."""
    old = client.get(A).headers["etag"]
    client.delete(A)
    client.put(A, json=CABLE)
    client.patch(A, json={"pin": [{"particles": [2]}]})
    new = client.get(A)
    assert new.json()["revision"] == 1 and new.headers["etag"] != old
    problem(CHANGES[change](client, {"if-match": old}), 412, "stale-revision")
    assert CHANGES[change](client, {"if-none-match": old}).status_code in (200, 201, 204)


@pytest.mark.parametrize("read", READS)
def test_who_has_it_already_is_answered_304(client: httpx.Client, read: str) -> None:
    first = client.get(A + read)
    now = first.headers["etag"]
    for given in (now, f"W/{now}", f"{OTHER}, {now}", "*"):
        again = client.get(A + read, headers={"if-none-match": given})
        assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", now), given
    for given in (OTHER, now.strip('"'), ""):
        assert client.get(A + read, headers={"if-none-match": given}).content == first.content
    assert client.get(A + read, headers={"if-match": f"{OTHER}, {now}"}).status_code == 200
    for given in (OTHER, f"W/{now}"):
        refused = client.get(A + read, headers={"if-match": given})
        problem(refused, 412, "stale-revision")
        assert refused.headers["etag"] == now
    client.put(A, json={**changed(-3), "particles": [*CABLE["particles"], [12, 0, 0]]})
    assert client.get(A + read, headers={"if-none-match": now}).status_code == 200


def test_news_that_are_no_edit_are_read(client: httpx.Client) -> None:
    """A step, and the name for people, change what is read but not the revision: 200, and an edit still lands."""
    seen = client.get(A).headers["etag"]
    client.post(f"{A}/step")
    stepped = client.get(A, headers={"if-none-match": seen})
    assert stepped.status_code == 200 and stepped.json()["revision"] == 1
    client.put(A, json=CABLE, params={"label": "roof"})
    assert client.get(A, headers={"if-none-match": stepped.headers["etag"]}).json()["label"] == "roof"
    assert client.patch(A, json={"release": [2]}, headers={"if-match": seen}).status_code == 200


def test_only_the_first_of_many_makes_a_session(client: httpx.Client) -> None:
    """`If-None-Match: *` makes, `If-Match: *` replaces; without a session the refusal has no ETag."""
    made = [lambda: client.put("/v1/sessions/b", json=CABLE, headers={"if-none-match": "*"})] * 6
    assert sorted(answer.status_code for answer in at_once(*made)) == [201] + 5 * [412]
    for given in ("*", OTHER, "nothing"):
        refused = client.put("/v1/sessions/c", json=CABLE, headers={"if-match": given})
        problem(refused, 412, "stale-revision")
        assert "etag" not in refused.headers
    assert client.put("/v1/sessions/b", json=changed(-2), headers={"if-match": "*"}).status_code == 200


def test_of_edits_for_one_revision_one_lands(client: httpx.Client) -> None:
    now = client.get(A).headers["etag"]
    edits = [
        lambda load=load: client.patch(A, json={"forces": {"1": {"vector": [0, 0, load]}}}, headers={"if-match": now})
        for load in range(-9, -1)
    ]
    found = at_once(*edits)
    assert sorted(answer.status_code for answer in found) == [200] + 7 * [412]
    [load] = [number - 9 for number, answer in enumerate(found) if answer.status_code == 200]
    assert client.get(f"{A}/scene").json()["forces"][1]["vector"] == [0, 0, load]
    assert client.get(A).json()["revision"] == 2


def test_answers_of_edits_at_once_are_each_of_their_own(client: httpx.Client) -> None:
    """Each answer has the revision that its edit made, not a later one."""
    made = [lambda: client.patch(A, json={"pin": [{"particles": [3]}]})] * 12
    found = at_once(*made)
    assert sorted(answer.json()["revision"] for answer in found) == list(range(2, 14))
    assert all(answer.json()["etag"] == answer.headers["etag"] for answer in found)


def test_etags_are_the_same_after_a_start() -> None:
    """Also after the service was killed: what was acknowledged under an ETag is there under it."""
    with tempfile.TemporaryDirectory() as folder:
        state = str(Path(folder) / "sessions.db")
        tags = []
        for how in (signal.SIGTERM, signal.SIGKILL, signal.SIGTERM):
            served = Served(state=state, workers=1)
            if not tags:
                served.client.put(A, json=CABLE)
                served.client.patch(A, json={"release": [5]})
            tags.append(served.client.get(A).headers["etag"])
            served.end(how)
        served = Served(state=state, workers=1)
        wait_for(lambda: served.health())
        edited = served.client.patch(A, json={"release": [0]}, headers={"if-match": tags[0]})
        served.end()
    assert tags == tags[:1] * 3 and edited.status_code == 200
