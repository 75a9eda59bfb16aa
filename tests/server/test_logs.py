"""Logs tell what happened and nothing that is private: no token, no address as sent, no coordinate, no key."""

from __future__ import annotations

import json
import logging
import re
import sys
from typing import Any

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from hookean_server.http.logs import JsonLines, short_hash
from serving import CABLE, HANG, wait_for

from .conftest import PATIENT, Served

MARK = 91827.36451827  # a coordinate that is found again wherever it is written
MARKED: dict[str, Any] = {**CABLE, "particles": [*CABLE["particles"][:-1], [10.0, MARK, -MARK]]}
FIELDS = {"time", "level", "logger", "event", "id", "method", "route", "status", "ms"}


def busy_run(served: Served) -> str:
    """A bit of everything, good and bad; the value of a cookie that was given."""
    client = served.client
    client.post("/v1/relax", json=MARKED)
    client.post("/v1/relax", json={**MARKED, "forces": [{"kind": f"secret{MARK}"}]})
    client.post("/v1/relax", content=f"[{MARK}", headers={"content-type": "application/json"})
    client.post("/v1/relax/3dm", files={"file": f"{MARK}".encode()})
    client.post("/v1/discretize/divide", json={"curve": [[0, 0, 0], [MARK, 0, 0]], "count": 2})
    client.post("/solve", json={"pointer": f"secret{MARK}", "values": []})
    cookie = str(client.post("/v1/login").headers["set-cookie"]).split(";")[0].split("=")[1]
    client.get("/v1/sessions", headers={"cookie": f"hookean-{served.port}={cookie}", "authorization": ""})
    with httpx.Client(base_url=served.url, timeout=HANG) as nobody:
        nobody.get("/v1/sessions", headers={"authorization": f"Bearer {served.token}x"})
        nobody.get(f"/v1/sessions?token={served.token}&at={MARK}")
        nobody.get("/v1/health", headers={"host": f"secret{MARK}"})
    client.put("/v1/sessions/secret-key", json=MARKED)
    client.patch("/v1/sessions/secret-key", json={"move": [{"particles": [0], "targets": [[0, 0, MARK]]}]})
    client.patch("/v1/sessions/secret-key", json={"pin": [{"particles": [1], "targets": [[MARK, 0, 0]]}]})
    client.get("/v1/sessions/secret-key/state")
    client.get("/v1/sessions/secret-other")
    url = f"{served.url.replace('http', 'ws')}/v1/sessions/secret-key/frames"
    with connect(url, additional_headers=served.known) as socket:
        socket.send(json.dumps({"id": 1, "do": "step"}))
        socket.send(json.dumps({"id": 2, "edit": {"secret": MARK}}))
        wait_for(lambda: '"id": 2' in str(socket.recv(timeout=HANG)))
    with pytest.raises(InvalidStatus):
        connect(url, additional_headers={"authorization": f"Bearer {served.token}x"}).close()
    client.get(f"/secret{MARK}")
    return cookie


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_busy_run_in_json() -> None:
    served = Served(PATIENT, workers=1, log="json").ready()
    ids = {served.client.get("/v1/health").headers["x-request-id"] for _ in range(5)}
    cookie = busy_run(served)
    code, said = served.end()
    assert code == 0
    lines = [json.loads(line) for line in said.splitlines()]
    for private in (served.token, cookie, f"{MARK}", "36451827", "secret", "token="):
        assert private not in said, [line for line in said.splitlines() if private in line]
    assert {"started", "worker replaced", "stopping"} <= {line["event"] for line in lines}
    requests = [line for line in lines if line["event"] == "request"]
    assert len(requests) > 20 and all(set(line) >= FIELDS for line in requests)
    assert ids <= {line["id"] for line in requests} and len({line["id"] for line in requests}) == len(requests)
    assert all(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", line["time"]) for line in lines)
    session = {line["session"] for line in requests if line["route"] == "/v1/sessions/{key}" and line["status"] < 300}
    assert session == {short_hash("secret-key")}
    sockets = {(line["status"], line.get("problem")) for line in lines if line["event"] == "socket"}
    assert sockets == {(101, None), (401, "unauthorized")}
    assert {line["level"] for line in lines} == {"info"}
    told = {line.get("problem") for line in requests}
    assert {"unauthorized", "forbidden-host", "invalid-scene", "invalid-input", "not-found", None} <= told


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_busy_run_is_quiet_by_default() -> None:
    served = Served(PATIENT, workers=1).ready()
    busy_run(served)
    code, said = served.end()
    assert (code, said) == (0, "")


@pytest.mark.soak
def test_a_log_that_nobody_reads_holds_nothing_up() -> None:
    """Several times what a pipe holds: every request is answered, and what was waiting is written at the end."""
    served = Served(PATIENT, workers=1, log="json").ready()
    for _ in range(1500):
        assert served.client.get("/v1/health").status_code == 200
    code, said = served.end()
    assert code == 0 and len(said) > 200_000
    assert all(json.loads(line) for line in said.splitlines())


def test_an_exception_is_told_by_its_type_and_places() -> None:
    """Not by its words, which may quote the input, nor by paths of the machine."""
    try:
        raise ValueError(f"secret {MARK}")
    except ValueError:
        record = logging.LogRecord("hookean", logging.ERROR, __file__, 1, "%s failed", ("it",), sys.exc_info())
    line = JsonLines().format(record)
    found = json.loads(line)
    assert found["event"] == "it failed" and found["error"] == "ValueError" and found["level"] == "error"
    assert found["at"][-1].startswith("test_logs.py:") and "secret" not in line and "/" not in "".join(found["at"])
