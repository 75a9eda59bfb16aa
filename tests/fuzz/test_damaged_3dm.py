"""Damaged .3dm files: each gives the same objects, a problem or a warning; none loses anything in silence, none hangs.

Eighty of the 2,000 in `make test`, all in `make soak`, and there more of them through a running server.
"""

from __future__ import annotations

import json
import multiprocessing
import re
import struct
from collections import Counter
from collections.abc import Iterator

import psutil
import pytest

from hookean_server.workers.deadline import ended, limited
from server.conftest import Served
from serving import HANG, SOAK, wait_for

from . import damage

COUNT = 2000 if SOAK else 40
SERVED = 100 if SOAK else 5
SECONDS = 5.0  # of computing that one file may take here


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    return damage.seeds()


@pytest.fixture(scope="module")
def reader() -> Iterator[damage.Reader]:
    found = damage.Reader(SECONDS)
    yield found
    found.close()


def test_what_is_whole_is_read_without_a_word(files: dict[str, bytes], reader: damage.Reader) -> None:
    """No checksum is called wrong in a file as it was written, whatever its version."""
    found = {name: reader.read(data) for name, data in files.items()}
    assert {name: f for name, f in found.items() if "problem" in f or f["warnings"]} == {}
    assert all(f["count"] for f in found.values())
    assert {int(name[-1]) for name in found if name.startswith("points-v")} == set(range(2, 9))


def test_the_real_files_are_there() -> None:
    if not damage.REAL.is_dir():
        pytest.skip(f"no .3dm files in {damage.REAL}")
    assert len(list(damage.REAL.glob("*.3dm"))) >= 5


def test_no_damage_goes_unnoticed(files: dict[str, bytes], reader: damage.Reader) -> None:
    whole = {name: reader.read(data) for name, data in files.items()}
    silent, seen = [], Counter[str]()
    # spread over the whole range, so that a part of them has every kind of damage too
    for number in range(0, 2000, 2000 // COUNT):
        name, how, data = damage.mutant(files, number)
        found = reader.read(data)
        if "problem" in found:
            assert found["problem"], f"{number}: the process ended with {found}"
            seen["problem"] += 1
        elif found["digest"] == whole[name]["digest"]:
            seen["same"] += 1
        elif found["warnings"]:
            seen["warned"] += 1
        else:
            silent.append((number, name, how, whole[name]["count"] - found["count"]))
    assert not silent
    assert sum(seen.values()) == COUNT and set(seen) == {"problem", "same", "warned"}


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    found = Served(workers=1, read_seconds=SECONDS)
    yield found.ready()
    found.end()


def test_the_service_answers_every_damaged_file(files: dict[str, bytes], served: Served) -> None:
    """With a result or a problem that is the file's, never the service's; its memory and descriptors stay."""
    process, sizes = psutil.Process(served.process.pid), []
    for number in range(0, 2000, 2000 // SERVED):
        _, _, data = damage.mutant(files, number)
        answer = served.client.post(
            "/v1/relax/3dm", files={"file": ("damaged.3dm", data)}, headers={"accept": "application/json"}
        )
        assert answer.status_code in (200, 422), (number, answer.text[:300])
        _free(answer.text)
        sizes.append((process.memory_info().rss, process.num_fds() if hasattr(process, "num_fds") else 0))
    half = sizes[len(sizes) // 2]
    assert sizes[-1][0] - half[0] <= 8 * 2**20
    # a worker that has read a file is replaced, and opens what it needs meanwhile: what stays is counted
    wait_for(lambda: not half[1] or process.num_fds() - half[1] <= 2)
    wait_for(lambda: served.health()["status"] == "ok")


def test_a_library_that_never_returns_is_ended() -> None:
    """Also one that holds the interpreter, so that nothing in its process can interrupt it."""
    process = multiprocessing.get_context("spawn").Process(target=_never_ends, daemon=True)
    process.start()
    process.join(HANG)
    assert ended(process.exitcode).startswith("reading it took too long")


def _never_ends() -> None:
    with limited(0.5):
        re.match(r"(a+)+$", "a" * 60 + "b")


def test_a_file_that_takes_too_long_is_a_problem_of_the_file() -> None:
    impatient = Served(workers=1, read_seconds=0.002)
    try:
        impatient.ready()
        answer = impatient.client.post("/v1/relax/3dm", files={"file": ("large.3dm", damage.large())})
        assert answer.status_code == 422, answer.text
        assert answer.json()["errors"][0]["pointer"] == "/file"
        assert "took too long" in answer.json()["errors"][0]["detail"]
        wait_for(lambda: impatient.health()["workers"]["idle"] == 1)
    finally:
        impatient.end()


def test_a_session_of_a_damaged_file_says_so(files: dict[str, bytes], served: Served) -> None:
    """The warnings come with the session, and in a header where the answer is a file."""
    data = bytearray(files["lines-v7"])
    attributes = data.index(struct.pack("<I", 0x02008072), damage.scan(bytes(data)).objects[3].start)
    data[attributes] ^= 1
    told = served.client.post("/v1/sessions", files={"file": ("damaged.3dm", bytes(data)), "recipe": ("r", RECIPE)})
    assert told.status_code == 201, told.text
    assert any("unknown kind" in warning for warning in told.json()["warnings"])
    form = {"file": ("damaged.3dm", bytes(data)), "recipe": ("r", RECIPE)}
    relaxed = served.client.post("/v1/relax/3dm", files=form)
    assert relaxed.headers["content-type"] == "model/vnd.3dm", relaxed.text[:300]
    assert any("unknown kind" in warning for warning in json.loads(relaxed.headers["hookean-warnings"]))


RECIPE = b'{"forces": [{"kind": "springs", "lines": "*"}], "anchors": [{"points": "ends:*"}]}'


def _free(text: str) -> None:
    assert "Traceback" not in text and "/tmp" not in text
