"""Log-ins: a cookie is good for this start of the server, its port and some hours, and is renewed while it is used; a
code is good once; `hookean token --renew` ends all of them, and what they had open."""

from __future__ import annotations

import hashlib
import json
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hookean_server.http import tokens
from hookean_server.http.tokens import CODE_LIFE, CODES, LIFE, LOGINS, RENEWED, Tokens
from serving import CABLE, HANG, Home, wait_for

from .conftest import Served, problem

NAME = "hookean-8765"


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The monotonic clock, to be moved by hand [s]."""
    clock = [1000.0]
    monkeypatch.setattr(tokens.time, "monotonic", lambda: clock[0])
    return clock


def let_in(known: Tokens, *values: str, name: str = NAME) -> list[bool]:
    return [known.logged_in(name, [value])[0] is not None for value in values]


# cookies


def test_a_cookie_is_of_one_start_and_one_port() -> None:
    """Two starts with the same token, as HOOKEAN_TOKEN gives it, and two ports of one start."""
    first, second = Tokens("t" * 20), Tokens("t" * 20)
    value = first.login(NAME)
    assert let_in(first, value) == [True] and let_in(second, value) == [False]
    assert let_in(first, value, name="hookean-8766") == [False]


def test_a_server_that_is_started_again_knows_no_cookie(tmp_path: Path) -> None:
    """Killed and started again with the same sessions, port and token: whoever took the port in between, and was sent
    the cookie by a page that goes on asking, can do nothing with it."""
    home = Home(tmp_path / "state")
    home.environment["HOOKEAN_TOKEN"] = "the-same-token-for-both"
    known = {"authorization": "Bearer the-same-token-for-both"}
    try:
        home.serve()
        url, port = home.told["url"], home.told["port"]
        cookie = httpx.post(f"{url}/v1/login", headers=known, timeout=HANG).headers["set-cookie"].split(";")[0]
        assert httpx.get(f"{url}/v1/sessions", headers={"cookie": cookie}, timeout=HANG).status_code == 200
        home.kill()
        process = home.start("--port", str(port))
        assert process.stdout is not None and url in process.stdout.readline()
        problem(httpx.get(f"{url}/v1/sessions", headers={"cookie": cookie}, timeout=HANG), 401, "unauthorized")
        assert httpx.get(f"{url}/v1/sessions", headers=known, timeout=HANG).status_code == 200
        stored = b"".join(path.read_bytes() for path in home.folder.iterdir() if path.name.startswith("sessions"))
        assert cookie.partition("=")[2].encode() not in stored
    finally:
        home.end()


def test_a_cookie_ends_unless_it_is_used(now: list[float]) -> None:
    known = Tokens("t" * 20)
    value = known.login(NAME)
    now[0] += LIFE - 1.0
    assert let_in(known, value) == [True]
    now[0] += 2.0
    assert let_in(known, value) == [False], "use lengthens no value: there is a new one"


def test_use_renews_a_cookie(now: list[float]) -> None:
    """After ten minutes an answer brings a new value; the old one is good for as long as it was. For days of use."""
    known = Tokens("t" * 20)
    value = first = known.login(NAME)
    now[0] += RENEWED - 1.0
    assert known.logged_in(NAME, [value])[1] == ""
    for _ in range(200):
        now[0] += LIFE / 8
        entry, fresh = known.logged_in(NAME, [value])
        assert entry is not None and fresh not in ("", value)
        value = fresh
    assert let_in(known, first, value) == [False, True]
    known.logout(NAME, [value])
    assert let_in(known, value) == [False]


def test_taking_a_cookie_back_ends_all_it_was_renewed_by(now: list[float]) -> None:
    known = Tokens("t" * 20)
    first, other = known.login(NAME), known.login(NAME)
    now[0] += RENEWED + 1.0
    second = known.logged_in(NAME, [first])[1]
    known.logout(NAME, [first])
    assert let_in(known, first, second, other) == [False, False, True]


@pytest.mark.parametrize(
    "forged", ["", ".", "..", "a.1.b", "{value}x", "x{value}", "{who}.9999999999.{mac}", "{who}.1.é"]
)
def test_what_is_no_cookie(forged: str) -> None:
    known = Tokens("t" * 20)
    value = known.login(NAME)
    who, _, mac = value.split(".")
    assert let_in(known, forged.format(value=value, who=who, mac=mac)) == [False]


def test_the_one_longest_unused_makes_room(now: list[float]) -> None:
    known = Tokens("t" * 20)
    values = []
    for _ in range(LOGINS):
        values.append(known.login(NAME))
        now[0] += 1.0
    assert let_in(known, values[0]) == [True]
    now[0] += 1.0
    known.login(NAME)
    assert let_in(known, *values[:3]) == [True, False, True]


def test_a_page_gets_a_new_cookie_while_it_goes_on() -> None:
    """Over a socket: a server whose cookies are renewed at once sends another one that lets in as well."""
    served = Served(f"from hookean_server.http import tokens; tokens.RENEWED = -1.0; tokens.LIFE = {LIFE};", workers=1)
    try:
        first = served.client.post("/v1/login").headers["set-cookie"]
        assert f"Max-Age={int(LIFE)}" in first and "HttpOnly" in first and "SameSite=Strict" in first
        with httpx.Client(base_url=served.url, timeout=HANG) as page:
            answer = page.get("/v1/sessions", headers={"cookie": first.split(";")[0]})
            fresh = answer.headers["set-cookie"]
            assert fresh.startswith(f"hookean-{served.port}=") and f"Max-Age={int(LIFE)}" in fresh
            page.cookies.clear()
            assert page.get("/v1/sessions", headers={"cookie": fresh.split(";")[0]}).status_code == 200
            page.cookies.clear()
            out = page.delete("/v1/login", headers={"cookie": fresh.split(";")[0]})
            assert len(out.headers.get_list("set-cookie")) == 1 and "Max-Age=0" in out.headers["set-cookie"]
    finally:
        served.end()


def test_a_cookie_makes_no_other_log_in(served: Served) -> None:
    """A stolen cookie gives neither a code, nor another cookie, nor another token: taking it back ends it all."""
    cookie = {"cookie": served.client.post("/v1/login").headers["set-cookie"].split(";")[0]}
    with httpx.Client(base_url=served.url, timeout=HANG) as page:
        assert page.get("/v1/sessions", headers=cookie).status_code == 200
        for path in ("/v1/login", "/v1/login/codes", "/v1/token"):
            problem(page.post(path, headers=cookie), 401, "unauthorized")
        problem(page.get(f"/v1/login/codes/{'0' * 64}", headers=cookie), 401, "unauthorized")


# codes


def test_a_code_is_good_once(served: Served) -> None:
    """Of many that come with it at once one is let in; afterwards nobody, and it opens nothing but the log-in."""
    for _ in range(5):
        code = served.client.post("/v1/login/codes").json()["code"]
        known, path = (
            {"authorization": f"Bearer {code}"},
            f"/v1/login/codes/{hashlib.sha256(code.encode()).hexdigest()}",
        )
        with httpx.Client(base_url=served.url, timeout=HANG) as page:
            for closed in ("/v1/sessions", "/metrics", "/v1/login/codes"):
                problem(page.get(closed, headers=known), 401, "unauthorized")
            assert served.client.get(path).status_code == 204, "what is refused elsewhere does not spend it"
            together = threading.Barrier(8)

            def come(_: int) -> int:
                with httpx.Client(base_url=served.url, timeout=HANG) as other:
                    together.wait(HANG)  # noqa: B023
                    return other.post("/v1/login", headers=known).status_code  # noqa: B023

            with ThreadPoolExecutor(8) as several:
                found = sorted(several.map(come, range(8)))
            assert found == [204] + [401] * 7
            assert served.client.get(path).status_code == 404
            problem(page.post("/v1/login", headers=known), 401, "unauthorized")


def test_a_page_of_elsewhere_spends_no_code(served: Served) -> None:
    code = served.client.post("/v1/login/codes").json()["code"]
    known = {"authorization": f"Bearer {code}"}
    with httpx.Client(base_url=served.url, timeout=HANG) as page:
        foreign = page.post("/v1/login", headers={**known, "origin": "http://evil.example"})
        problem(foreign, 403, "forbidden-origin")
        assert page.post("/v1/login", headers={**known, "origin": served.url}).status_code == 204


def test_a_code_ends_after_a_minute(now: list[float]) -> None:
    known = Tokens("t" * 20)
    code = known.code()
    named = hashlib.sha256(code.encode()).hexdigest()
    now[0] += CODE_LIFE - 1.0
    assert known.waits(named)
    now[0] += 1.0
    assert not known.waits(named) and known.spend(f"Bearer {code}") is None


def test_codes_do_not_pile_up() -> None:
    known = Tokens("t" * 20)
    codes = [known.code() for _ in range(CODES + 1)]
    assert [known.spend(f"Bearer {code}") is not None for code in codes] == [False] + [True] * CODES
    assert known.spend("Bearer ") is known.spend("") is known.spend("Bearer " + "t" * 20) is None


# everybody out


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    found = Home(tmp_path / "state")
    yield found
    found.end()


def test_renewing_the_token_logs_everybody_out(home: Home) -> None:
    """The running server: the old token, cookies and codes are worth nothing, a socket is closed with 4401, a stream of
    events ends; the command prints the new token, which is in the file; sessions are kept."""
    home.environment["HOOKEAN_TOKEN"] = "the-token-as-it-was"
    home.serve()
    url, before = home.told["url"], home.told
    old = {"authorization": f"Bearer {before['token']}"}
    with httpx.Client(base_url=url, timeout=HANG) as asks:
        asks.put("/v1/sessions/a", json=CABLE, headers=old).raise_for_status()
        cookie = {"cookie": asks.post("/v1/login", headers=old).headers["set-cookie"].split(";")[0]}
        code = {"authorization": f"Bearer {asks.post('/v1/login/codes', headers=old).json()['code']}"}
        socket_url = f"{url.replace('http', 'ws')}/v1/sessions/a/frames"
        with connect(socket_url, additional_headers=old) as one, connect(socket_url, additional_headers=cookie) as two:
            for socket in (one, two):
                assert "hello" in str(socket.recv(timeout=HANG))
            done = home.command("token", "--renew")
            for socket in (one, two):
                with pytest.raises(ConnectionClosed) as closed:
                    while True:
                        socket.recv(timeout=HANG)
                assert closed.value.rcvd is not None and closed.value.rcvd.code == 4401
        assert done.returncode == 0 and "logged out" in done.stderr
        token = home.told["token"]
        assert done.stdout.strip() == token != before["token"] and home.told["proof"] != before["proof"]
        assert home.told["pid"] == before["pid"] and (home.folder / "server.json").stat().st_mode & 0o777 == 0o600
        for known in (old, cookie):
            problem(asks.get("/v1/sessions", headers=known), 401, "unauthorized")
        problem(asks.post("/v1/login", headers=code), 401, "unauthorized")
        [session] = asks.get("/v1/sessions", headers={"authorization": f"Bearer {token}"}).json()["sessions"]
        assert session["key"] == "a"
    home.environment.pop("HOOKEAN_TOKEN")
    assert home.command("token").stdout.strip() == token


def test_renewing_ends_a_stream_of_events(home: Home) -> None:
    home.serve()
    old = {"authorization": f"Bearer {home.told['token']}"}
    endless = {**CABLE, "settings": {"solver": "verlet", "drag": 0, "time_step": 0.001, "max_iterations": 10**9}}
    endless["settings"]["tolerance"] = 0
    with httpx.Client(base_url=home.told["url"], timeout=HANG) as asks:
        job = asks.post("/v1/jobs", json={"scene": endless}, headers=old).headers["location"]
        with asks.stream("GET", f"{job}/events", headers=old) as events:
            assert events.status_code == 200
            told = events.iter_bytes()
            next(told)
            assert home.command("token", "--renew").returncode == 0
            with pytest.raises(httpx.RemoteProtocolError):
                for _ in told:
                    pass
        assert asks.delete(job, headers={"authorization": f"Bearer {home.told['token']}"}).status_code == 204


def test_nothing_changes_where_the_new_token_cannot_be_published() -> None:
    """Clients could not find it: the old one stays."""
    known = Tokens("t" * 20)
    value, code = known.login(NAME), known.code()

    def fails(token: str, proof: str) -> None:
        raise OSError(28, "No space left on device")

    known.publish = fails
    with pytest.raises(OSError):
        known.renew()
    assert known.token == "t" * 20 and let_in(known, value) == [True] and known.spend(f"Bearer {code}") is not None


def test_with_no_server_there_is_nothing_to_renew(home: Home) -> None:
    done = home.command("token", "--renew")
    assert done.returncode == 1 and "No hookean server is running" in done.stderr and done.stdout == ""


def test_log_outs_close_sockets(served: Served) -> None:
    """A page that logs out watches no longer; another one does."""
    served.client.put("/v1/sessions/watched", json=CABLE).raise_for_status()
    cookies = [served.client.post("/v1/login").headers["set-cookie"].split(";")[0] for _ in range(2)]
    url = f"ws://127.0.0.1:{served.port}/v1/sessions/watched/frames"
    with (
        connect(url, additional_headers={"cookie": cookies[0]}) as mine,
        connect(url, additional_headers={"cookie": cookies[1]}) as other,
    ):
        for socket in (mine, other):
            assert "hello" in str(socket.recv(timeout=HANG))
        with httpx.Client(base_url=served.url, timeout=HANG) as page:
            assert page.delete("/v1/login", headers={"cookie": cookies[0]}).status_code == 204
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                mine.recv(timeout=HANG)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 4401
        other.send(json.dumps({"id": 7, "do": "pause"}))
        wait_for(lambda: '"id": 7' in str(other.recv(timeout=HANG)))
