"""Two hundred and more malformed scenes: each gets a problem with a pointer, and the next good one is relaxed."""

from __future__ import annotations

import httpx
import pytest

from serving import CABLE
from soak import sampled

from . import malformed
from .conftest import problem

CASES = malformed.table()
TRIED = sampled(CASES, 3)


def test_there_are_enough_and_all_differ() -> None:
    assert len(CASES) >= 200
    assert len({body for body, _ in CASES.values()}) == len(CASES)


def test_the_scene_they_are_made_from_is_good(client: httpx.Client) -> None:
    assert client.post("/v1/relax", json=malformed.GOOD).status_code == 200


@pytest.mark.thinned
@pytest.mark.parametrize("name", TRIED, ids=range(len(TRIED)))
def test_malformed(client: httpx.Client, name: str) -> None:
    body, pointer = CASES[name]
    response = client.post("/v1/relax", content=body, headers={"content-type": "application/json"})
    assert response.status_code in (413, 422), (name[:200], response.text[:300])
    slug = "invalid-scene" if response.status_code == 422 else "too-large"
    found = problem(response, response.status_code, slug)
    assert found["errors"][0]["pointer"].startswith(pointer), (name[:200], found)
    assert len(response.content) < 20_000
    good = client.post("/v1/relax", json=CABLE)
    assert good.status_code == 200 and good.json()["status"] == "converged"
