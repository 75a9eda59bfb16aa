"""The figures for Prometheus are those of what happened, in its own text format."""

from __future__ import annotations

import json
from collections.abc import Iterator

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families
from websockets.sync.client import connect

from hookean_server.problems import CATALOGUE
from serving import CABLE, HANG, wait_for

from .conftest import Served


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    found = Served(workers=1)
    yield found.ready()
    found.end()


def figures(served: Served) -> dict[tuple[str, frozenset[tuple[str, str]]], float]:
    """Every sample by name and labels, read by Prometheus' own parser."""
    answer = served.client.get("/metrics")
    assert answer.status_code == 200 and answer.headers["content-type"].startswith("text/plain; version=")
    return {
        (sample.name, frozenset(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


def one(served: Served, name: str, **labels: str) -> float:
    return figures(served).get((name, frozenset(labels.items())), 0.0)


def test_the_token_is_needed(served: Served) -> None:
    assert httpx.get(f"{served.url}/metrics", timeout=HANG).status_code == 401


def test_requests_are_counted_by_template(served: Served) -> None:
    """Three requests, one of them refused: counted once each, under the route and not under what was sent."""
    labels = {"method": "POST", "route": "/v1/relax", "status": "200"}
    refused = {**labels, "status": "422"}
    before, refusals = (one(served, "http_request_duration_seconds_count", **each) for each in (labels, refused))
    served.client.post("/v1/relax", json=CABLE)
    served.client.post("/v1/relax", json=CABLE)
    served.client.post("/v1/relax", json=[])
    found = figures(served)
    assert one(served, "http_request_duration_seconds_count", **labels) == before + 2
    assert one(served, "http_request_duration_seconds_count", **refused) == refusals + 1
    assert one(served, "http_request_duration_seconds_bucket", **labels, le="+Inf") == before + 2
    assert 0 < one(served, "http_request_duration_seconds_sum", **labels) < 120
    assert "http_request_duration_seconds_created" not in {name for name, _ in found}


def test_clients_make_no_labels(served: Served) -> None:
    """Whatever addresses and methods are tried, the number of samples stays."""
    for method in ("GET", "BREW"):
        served.client.request(method, "/v1/secret-0")
    served.client.get("/v1/sessions/none-0")
    before = set(figures(served))
    for i in range(30):
        for method in ("GET", f"BREW{i}"):
            served.client.request(method, f"/v1/secret-{i}")
        served.client.get(f"/v1/sessions/none-{i}")
    found = set(figures(served))
    assert len(found - before) <= 40  # the buckets of a route that was first seen now
    assert "secret" not in str(found) and "none-" not in str(found) and "BREW" not in str(found)


def test_refusals_are_counted_by_problem(served: Served) -> None:
    before = figures(served)
    with httpx.Client(base_url=served.url, timeout=HANG) as nobody:
        nobody.get("/v1/sessions")
        nobody.get("/v1/health", headers={"host": "evil.example"})
    served.client.post("/v1/relax", content=b"x", headers={"content-type": "text/plain"})
    served.client.post("/v1/relax", json=[])
    found = figures(served)
    for slug in ("unauthorized", "forbidden-host", "unsupported-media", "invalid-scene"):
        key = ("rejected_total", frozenset({("problem", slug)}))
        assert found[key] == before.get(key, 0.0) + 1, slug
    told = {dict(labels)["problem"] for name, labels in found if name == "rejected_total"}
    assert told <= set(CATALOGUE)


def test_sessions_workers_frames_and_the_store(served: Served) -> None:
    """A session that is watched while it runs, and another that rests."""
    served.client.put("/v1/sessions/a", json=CABLE)
    served.client.put("/v1/sessions/b", json=CABLE)
    assert one(served, "workers", state="session") == 2
    assert sum(v for (n, _), v in figures(served).items() if n == "workers") == 3  # and the one that solves
    assert sum(v for (n, _), v in figures(served).items() if n == "sessions") == 2
    before = one(served, "frames_sent_total")
    url = f"{served.url.replace('http', 'ws')}/v1/sessions/a/frames"
    with connect(url, additional_headers=served.known) as socket:
        socket.send(json.dumps({"id": 1, "do": "step", "frames": 3}))
        while not isinstance(socket.recv(timeout=HANG), bytes):
            pass
        wait_for(lambda: one(served, "frames_sent_total") > before)
    found = figures(served)
    names = {name for name, _ in found}
    assert sum(v for (n, _), v in found.items() if n == "jobs") == 0
    assert {"jobs", "frames_skipped_total", "queue_depth", "checkpoint_seconds", "worker_restarts_total"} <= names
    assert one(served, "queue_depth") == 0 and one(served, "store_failing") == 0
    assert 0 < one(served, "checkpoint_seconds") < 60
    for key in ("a", "b"):
        served.client.delete(f"/v1/sessions/{key}")
    assert sum(v for (n, _), v in figures(served).items() if n == "sessions") == 0


def test_a_worker_that_ends_is_counted(served: Served) -> None:
    """Whether it dies idle or at work."""
    served.ready()
    before = one(served, "worker_restarts_total")
    for worker in served.workers():
        worker.kill()
    served.client.post("/v1/relax", json=CABLE)
    wait_for(lambda: one(served, "worker_restarts_total") > before)
