"""A read-only link reads one session and nothing else: not another session, no other route, no message that changes."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from hookean_server.http import access
from hookean_server.http.guests import Guests
from hookean_server.http.tokens import Tokens
from serving import CABLE, HANG, app

from .conftest import Served, problem

SESSION = "/v1/sessions/shared"
READS = {
    "/v1/forces",  # the catalogue, the same for all
    "/v1/sessions/{key}",
    "/v1/sessions/{key}/anchors",
    "/v1/sessions/{key}/scene",
    "/v1/sessions/{key}/state",
    "/v1/sessions/{key}/surface",
    "/v1/sessions/{key}/topology",
    "/v1/sessions/{key}/view",
}
ORDERS: list[dict[str, Any]] = [
    {"edit": {"pin": [{"particles": [2]}]}},
    *({"do": do} for do in ("play", "relax", "pause", "step", "reset", "undo", "redo", "nonsense")),
]


@pytest.fixture
def token(served: Served) -> Iterator[str]:
    """A read-only link to a session."""
    assert served.client.put(SESSION, json=CABLE).is_success
    assert served.client.put("/v1/sessions/other", json=CABLE).is_success
    yield served.client.put(f"{SESSION}/guest").json()["token"]
    served.client.delete(SESSION)


@pytest.fixture
def guest(served: Served, token: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=served.url, timeout=HANG, headers={"authorization": f"Bearer {token}"}) as found:
        yield found


def watching(served: Served, token: str, key: str = "shared", **headers: str) -> ClientConnection:
    """A socket as the page of a link opens it."""
    address = f"ws://127.0.0.1:{served.port}/v1/sessions/{key}/frames"
    return connect(address, subprotocols=["hookean", f"bearer.{token}"], additional_headers=headers, open_timeout=HANG)  # type: ignore[list-item]


def test_a_link_reads_its_session_and_nothing_else(served: Served, guest: httpx.Client) -> None:
    """Walks the description of the service: each operation answers as it answers its owner if it is one of those that
    read, and `read-only` otherwise; of another session nothing answers. The session stays as it was."""
    before = served.client.get(SESSION).json()
    sessions = served.client.get("/v1/sessions").json()["sessions"]
    reads = set()
    for path, item in app().openapi()["paths"].items():
        for method in item:
            if access.Access.TOKEN is not app().state.table.declared(method.upper(), path):
                continue
            for key in ("shared", "other"):
                told = path.replace("{key}", key).replace("{action}", "play")
                told = re.sub(r"\{.*?\}", "a", told)
                answer = guest.request(method.upper(), told, content=b"{}")
                if path in READS and method == "get" and ("{key}" not in path or key == "shared"):
                    owners = served.client.request(method.upper(), told)
                    assert answer.status_code == owners.status_code == 200, told
                    reads.add(path)
                else:
                    assert "only reads its session" in problem(answer, 403, "read-only")["detail"]
    assert reads == READS
    assert guest.head(SESSION).status_code == 200
    assert guest.get(f"{SESSION}/state?format=csv").text == served.client.get(f"{SESSION}/state?format=csv").text
    for aliased in (f"{SESSION}/../other", "/v1/sessions/shared%2F..%2Fother", "/v1/nothing", "/V1/sessions"):
        assert guest.get(aliased).status_code in (403, 404), aliased
    problem(guest.post("/v1/sessions/shared/play"), 403, "read-only")
    assert served.client.get(SESSION).json() == before
    kept = [one["key"] for one in served.client.get("/v1/sessions").json()["sessions"]]
    assert kept == [one["key"] for one in sessions]


def test_a_link_is_no_token(served: Served, guest: httpx.Client, token: str) -> None:
    """It is not exchanged for a cookie or a code, and operations for programs do not accept it."""
    for method, path in (
        ("POST", "/v1/login"),
        ("POST", "/v1/login/codes"),
        ("POST", "/v1/token"),
        ("POST", "/v1/shutdown"),
    ):
        assert guest.request(method, path).status_code in (401, 403), path
    assert "repairs" not in guest.get("/v1/health").json()["store"]
    with pytest.raises(InvalidStatus) as refused, watching(served, served.token):
        pass
    assert refused.value.response.status_code == 401, "the token of the service is no link"
    with pytest.raises(InvalidStatus) as refused, watching(served, token, "other"):
        pass
    assert refused.value.response.status_code == 403


def test_a_link_watches_and_no_message_of_it_changes_anything(served: Served, token: str) -> None:
    """Frames come as the session goes on; each order is answered with the problem, also where the browser of the page
    has the cookie of its owner, and the session stays at its revision, paused."""
    cookie = served.client.post("/v1/login").headers["set-cookie"].split(";")[0]
    with watching(served, token, Cookie=cookie) as socket:
        assert socket.subprotocol == "hookean"
        hello = json.loads(socket.recv(HANG))
        assert hello["session"]["key"] == "shared"
        for number, order in enumerate(ORDERS):
            socket.send(json.dumps({"id": number, **order}))
        answers: list[dict[str, Any]] = []
        frames = 0
        while len(answers) < len(ORDERS) or not frames:
            told = socket.recv(HANG)
            if isinstance(told, bytes):
                frames += 1
                socket.send(json.dumps({"ack": int.from_bytes(told[12:16], "little")}))
            elif "id" in (message := json.loads(told)):
                answers.append(message)
        assert [answer["id"] for answer in answers] == list(range(len(ORDERS)))
        assert {answer["problem"]["type"] for answer in answers} == {"/problems/read-only"}
        now = served.client.get(SESSION).json()
        assert (now["revision"], now["playing"]) == (hello["session"]["revision"], False)
        served.client.patch(SESSION, json={"pin": [{"particles": [2]}]})  # its owner may
        while (
            not isinstance(told := socket.recv(HANG), bytes) or int.from_bytes(told[16:24], "little") <= now["revision"]
        ):
            pass


def test_a_link_ends_when_it_is_revoked(served: Served, guest: httpx.Client, token: str) -> None:
    """Its requests are refused, its sockets closed; the owner's go on; the next link has another token."""
    assert served.client.get(f"{SESSION}/guest").json() == {"token": token}
    assert served.client.put(f"{SESSION}/guest").json() == {"token": token}, "one link at a time"
    with watching(served, token) as socket:
        socket.recv(HANG)
        assert served.client.delete(f"{SESSION}/guest").status_code == 204
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                socket.recv(HANG)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 4401
    problem(guest.get(SESSION), 401, "unauthorized")
    assert served.client.get(f"{SESSION}/guest").json() == {"token": None}
    assert served.client.put(f"{SESSION}/guest").json()["token"] != token
    problem(guest.get(SESSION), 401, "unauthorized")


def test_a_link_ends_with_its_session(served: Served, guest: httpx.Client) -> None:
    """Another session under the same key is not the one that was shared."""
    assert guest.get(SESSION).status_code == 200
    assert served.client.delete(SESSION).status_code == 204
    assert served.client.put(SESSION, json=CABLE).status_code == 201
    problem(guest.get(SESSION), 401, "unauthorized")
    assert served.client.get(f"{SESSION}/guest").json() == {"token": None}


def test_links_end_with_the_token_of_the_service() -> None:
    tokens = Tokens("t" * 20)
    session = SimpleNamespace(key="shared", gone=False)
    token = tokens.guests.link(session)
    client = tokens.guests.named(token)
    assert client is not None and tokens.named(f"Bearer {token}") is None
    tokens.renew()
    assert client.ended.is_set() and tokens.guests.named(token) is None


def test_a_link_that_is_not_asked_for_is_forgotten_with_its_session() -> None:
    """What the server keeps does not grow with sessions that come and go."""
    guests = Guests()
    for number in range(50):
        session = SimpleNamespace(key=str(number), gone=False)
        guests.link(session)
        session.gone = True
    last = guests.link(SimpleNamespace(key="last", gone=False))
    assert len(guests._guests) == 1 and guests.named(last) is not None
