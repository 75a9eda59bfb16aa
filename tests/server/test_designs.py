"""Design problems as jobs: the answer of `hookean.design`, progress, cancelling, going on from the best values."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest

import hookean
from hookean_server.http.design_schemas import PROBLEM, SLOPES
from hookean_server.jobs import designs
from serving import wait_for

from .conftest import Served, problem
from .jobbing import end_all, ended, events, job_workers, post, table


@pytest.fixture(scope="module")
def runner() -> Iterator[Served]:
    found = Served()
    yield found.ready()
    assert found.end()[0] == 0


@pytest.fixture
def jobs(runner: Served) -> Iterator[httpx.Client]:
    yield runner.client
    end_all(runner.client)


def endless() -> dict[str, Any]:
    """A search that goes on: lengths of a heavy net's links against a goal that none of them meet, each to its own."""
    count = 1500
    links = [[i, i + 1] for i in range(count - 1)]
    scene = {
        "particles": [[0.01 * i, 0.0, -0.004 * min(i, count - 1 - i)] for i in range(count)],
        "forces": [
            {"kind": "springs", "name": "chain", "particles": links, "stiffness": 1e4, "rest_length": 0.012},
            {"kind": "unary", "particles": list(range(1, count - 1)), "vector": [0, 0, -1e-3]},
        ],
        "anchors": [{"particles": [0, count - 1]}],
    }
    return {
        "scene": scene,
        "variables": [{"force": "chain", "field": "rest_length", "lower": 0.0101, "upper": 0.05}],
        "goals": [{"kind": "load_path", "force": "chain"}],
        "settings": {"tolerance": 1e-30, "max_iterations": 10**6},
    }


def test_the_answer_is_that_of_the_core(jobs: httpx.Client) -> None:
    found = jobs.post("/v1/design", json=PROBLEM)
    assert found.status_code == 202, found.text
    address = found.headers["location"]
    job = ended(jobs, address)
    assert (job["kind"], job["status"], job["total"], job["done"]) == ("design", "done", 1, 1)
    here = json.loads(json.dumps(hookean.design(PROBLEM).to_dict()))
    assert jobs.get(f"{address}/results/0").json() == here
    (row,) = table(jobs, address)
    assert row["objective"] == here["objective"] and row["message"] == job["message"]
    assert row["parameters"] == {"string.rest_length": here["variables"][0]["value"]}
    assert "string.rest_length" in jobs.get(f"{address}/results?format=csv").text
    assert [told for _, name, told in events(jobs, address) if name != "progress"] == [row, job]
    scene, rest = PROBLEM["scene"], {name: part for name, part in PROBLEM.items() if name != "scene"}
    again = post(jobs, {"scene": scene, "design": rest})
    assert ended(jobs, again)["status"] == "done"
    assert jobs.get(f"{again}/results/0").json() == here


def test_beams_are_designed(jobs: httpx.Client) -> None:
    """Their rows of rotations are not among the particles of the answer."""
    beam = {"kind": "beam", "name": "b", "particles": [[0, 1]], "E": 1e6, "G": 4e5, "A": 0.01, "Iy": 1e-5, "Iz": 1e-5}
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [{**beam, "J": 1e-5}, {"kind": "unary", "particles": [1], "vector": [0, 0, -0.1]}],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
    }
    variables = [{"force": "b", "field": "Iy", "tie": "all", "lower": 1e-7, "upper": 1e-3}]
    goals = [{"kind": "position", "particles": [1], "axes": "z", "target": -0.01}]
    address = jobs.post("/v1/design", json={"scene": scene, "variables": variables, "goals": goals}).headers["location"]
    assert ended(jobs, address)["status"] == "done"
    found = jobs.get(f"{address}/results/0").json()
    assert np.shape(found["result"]["particles"]) == (2, 3) and found["status"] == "converged"


def test_one_key_is_one_job(jobs: httpx.Client) -> None:
    first, second = (jobs.post("/v1/design", json=PROBLEM, headers={"idempotency-key": "k"}) for _ in range(2))
    assert first.headers["location"] == second.headers["location"]
    assert second.headers["idempotency-replayed"] == "true"


@pytest.mark.soak
def test_progress_streams_and_cancelling_keeps_the_best(runner: Served, jobs: httpx.Client) -> None:
    """What a checkpoint has is never lost, not even with the worker; a search goes on from the last one."""
    address = jobs.post("/v1/design", json=endless()).headers["location"]
    wait_for(lambda: jobs.get(f"{address}/results/0").status_code == 200)
    part = jobs.get(f"{address}/results/0").json()
    assert part["status"] == "running" and part["iterations"] > 0 and len(part["result"]["particles"]) == 1500
    before = jobs.get(address).json()["progress"]
    for worker in job_workers(runner):
        worker.kill()
    wait_for(lambda: jobs.get(address).json()["progress"]["iteration"] > before["iteration"] + 3)
    jobs.delete(address)
    job = ended(jobs, address)
    assert job["status"] == "cancelled"
    last = jobs.get(f"{address}/results/0").json()
    assert last["status"] == "cancelled" and last["objective"] <= part["objective"]
    told = [said["objective"] for _, name, said in events(jobs, address) if name == "progress"]
    assert len(told) > 2 and min(told) <= part["objective"]


def test_a_checkpoint_goes_on_from_its_values() -> None:
    """A search that starts from the best values needs no more than their own equilibrium to be as good."""
    kept: list[np.ndarray] = []
    here = hookean.design(PROBLEM, keep=kept.append)
    state = designs._packed(7, kept[-1])
    request = json.dumps(designs.split(copy.deepcopy(PROBLEM))).encode()
    options = {"size": len(request), "seconds": 60.0, "longest": 60.0, "status": "running", "message": "On the way."}
    shown = json.loads(designs.shape(options, request + state, lambda: False).body)
    assert (shown["iterations"], shown["message"], shown["status"]) == (7, "On the way.", "running")
    assert shown["objective"] == pytest.approx(0.0, abs=1e-15)
    row, _, answer = designs.search(options, request + state, lambda: False).body.partition(b"\n")
    assert json.loads(row)["iterations"] <= 3 < here.iterations
    assert json.loads(answer)["variables"][0]["value"] == pytest.approx(kept[-1][0], rel=1e-9)


def test_sensitivity_is_that_of_the_core(client: httpx.Client) -> None:
    found = client.post("/v1/sensitivity", json=SLOPES)
    assert found.status_code == 200, found.text
    here = hookean.sensitivity(SLOPES)
    assert found.json()["value"] == here.value and found.json()["gradient"] == [g.tolist() for g in here.gradient]
    packed = client.post("/v1/sensitivity?arrays=buffer", json=SLOPES).json()["gradient"][0]
    assert packed["shape"] == [2]


def changed(path: str, value: Any) -> Any:
    """The good problem with another value at a pointer; `...` takes it out."""
    body = copy.deepcopy(PROBLEM)
    *steps, last = [int(s) if s.isdigit() else s for s in path.strip("/").split("/")]
    place: Any = body
    for step in steps:
        place = place[step]
    if value is ...:
        del place[last]
    else:
        place[last] = value
    return body


WRONG: list[tuple[Any, str]] = [
    ([], "/"), (5, "/"), (None, "/"), (changed("/variables/0/tie", []), "/variables"), ("text", "/"), ({}, "/scene"),
    *((changed("/scene", v), "/scene") for v in ([], None, 3, {}, {"particles": [[0, 0]]}, {"springs": []})),
    *((changed("/variables", v), "/variables") for v in ([], {}, None, [[]], [5], ["string.rest_length"])),
    *((changed("/variables/0/force", v), "/variables/0") for v in ("rope", 9, -1, None, [], {}, 1.5, True)),
    *((changed("/variables/0/field", v), "/variables/0") for v in ("rest", "", "kind", "particles", None, 4, "name")),
    *((changed("/variables/0/tie", v), "/variables/0") for v in ("some", [[0, 7]], [[0], [0]], [[-1]], 3, [["x"]])),
    *((changed("/variables/0/lower", v), "/variables/0") for v in (3.0, "low", [], 1e999)),
    *((changed("/variables/0/axes", v), "/variables/0") for v in ("w", "zz", 1)),
    (changed("/variables/0", {"anchor": "no", "axes": "x"}), "/variables/0"),
    (changed("/variables/0", {"anchor": "ends", "field": "x"}), "/variables/0"),
    (changed("/variables/0/force", ...), "/variables/0"), (changed("/variables/0/extra", 1), "/variables/0"),
    *((changed("/goals", v), "/goals") for v in ([], None, {}, [3], [{}], [{"kind": "beauty"}], [{"kind": None}])),
    *((changed("/goals/0/particles", v), "/goals/0") for v in ([9], [-1], ["a"], None, [1.5], [[1]], {})),
    *((changed("/goals/0/target", v), "/goals/0") for v in ([1, 2], "low", {}, [[0, 0]], 1e999, [])),
    *((changed("/goals/0/weight", v), "/goals/0") for v in (0, -1, "much", None, [])),
    (changed("/goals/0", {"kind": "force", "force": "load", "target": 1}), "/goals/0"),
    (changed("/goals/0", {"kind": "length", "force": "string", "elements": [5]}), "/goals/0"),
    (changed("/goals/0", {"kind": "volume", "mesh": "none"}), "/goals/0"),
    (changed("/goals/0", {"kind": "output", "force": "string", "column": "colour"}), "/goals/0"),
    (changed("/goals/0", {"kind": "reaction", "anchor": "none"}), "/goals/0"),
    *((changed("/constraints", v), "/constraints") for v in (
        {}, None, 4, [{}], [{"kind": "length", "force": "string"}], [{"kind": "length", "force": "x", "upper": 1}],
        [{"kind": "length", "force": "string", "lower": 2, "upper": 1}],
        [{"kind": "length", "force": "string", "upper": [1, 2, 3]}],
        [{"kind": "length", "force": "string", "upper": "long"}])),
    *((changed("/settings", v), "/settings") for v in (
        {"method": "newton"}, {"tolerance": 0}, {"tolerance": -1}, {"max_iterations": 0}, {"speed": 1}, [], None)),
    (changed("/extra", 1), "/extra"),
    *((changed("/start", v), "/start") for v in ([], [1, 2], "low", {}, [[1]], [1e999], 3, [None])),
    *((changed("/goals/0", {"kind": "position", "points": v}), "/goals/0") for v in (
        [], 5, [[0, 0]], [[9, 9, 9]], [["x", 0, 0]], None, [[1e999, 0, 0]])),
    (changed("/goals/0", {"kind": "position", "points": [[0, 0, -0.2]], "particles": [1]}), "/goals/0"),
    ({**changed("/goals/0/target", ...), "settings": {"method": "least_squares"}}, "/settings/method"),
    (changed("/goals/0/kind", "\ud800"), "/"),
]  # fmt: skip


def test_every_malformed_body_is_one_sentence_with_a_pointer(client: httpx.Client) -> None:
    """Fifty and more bodies that are no problem of the scene: each is refused before it is a job."""
    assert len(WRONG) > 70
    for body, pointer in WRONG:
        text = json.dumps(body).replace("Infinity", "1e999")
        answer = client.post("/v1/design", content=text, headers={"content-type": "application/json"})
        assert answer.status_code == 422, (body, answer.text[:300])
        slug = answer.json()["type"].rsplit("/", 1)[1]
        assert slug in ("invalid-input", "invalid-scene"), text
        found = problem(answer, 422, slug)
        assert found["errors"][0]["pointer"].startswith(pointer), (text[-300:], found)
        assert len(found["errors"][0]["detail"]) > 10 and "Traceback" not in answer.text
    nested = {"scene": PROBLEM["scene"], "design": changed("/goals/0/particles", [9])}
    nested["design"].pop("scene")
    assert client.post("/v1/jobs", json=nested).json()["errors"][0]["pointer"].startswith("/design/goals/0")
    for wrong in ({"scene": PROBLEM["scene"], "design": 5}, {"scene": PROBLEM["scene"], "design": {}, "sweep": {}}):
        assert client.post("/v1/jobs", json=wrong).status_code == 422
    for wrong in ({}, [], {**SLOPES, "settings": {}}, {**SLOPES, "goals": []}, {**SLOPES, "variables": []}):
        assert client.post("/v1/sensitivity", json=wrong).status_code == 422
    assert not [job for job in client.get("/v1/jobs").json()["jobs"] if job["kind"] == "design"]
