"""What playing writes to disk, what counts as use of a session, and what can be taken back after many edits."""

from __future__ import annotations

import asyncio
import json
import os
import sys
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean import Scene, Simulation
from hookean_server.keeping.budget import DEBT, RATE, Budget
from hookean_server.lifecycle import leftovers
from hookean_server.sessions import folding, parts, rows, upkeep
from hookean_server.sessions import manager as managing
from hookean_server.sessions.live import Live
from hookean_server.sessions.manager import Manager
from hookean_server.settings import Settings
from hookean_server.store import Store
from serving import CABLE, SOAK
from soak import sampled

MINUTES = 24 * 60 if SOAK else 4
DESCRIBED = {"revision": 0, "iteration": 0, "status": "running", "message": "", "particles": 1, "playing": True}


class Clock:
    """Time that a test lets pass."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class Process:
    """A session's process that plays: it has progress to store at every sign of life."""

    lost = False

    def __init__(self) -> None:
        self.asked = 0

    def keep(self) -> None:
        self.asked += 1

    def unstored(self) -> None:
        raise AssertionError("it was not stored")

    def kill(self) -> None:
        pass


def state_of(count: int) -> int:
    """Bytes of the checkpoint of a net with so many particles."""
    side = int(np.sqrt(count))
    points = [[float(i % side), float(i // side), 0.0] for i in range(side * side)]
    springs = [[i, i + 1] for i in range(side * side - 1)]
    scene = {"particles": points, "forces": [{"kind": "springs", "particles": springs}]}
    simulation = Simulation(Scene.read({**scene, "anchors": [{"particles": [0]}]}))
    simulation.step()
    return len(parts.state_bytes(simulation)) * count // (side * side)


@pytest.mark.thinned
@pytest.mark.skipif(not Path("/proc/self/io").exists(), reason="counts the bytes written by /proc/self/io")
@pytest.mark.parametrize(("particles", "sessions", "most"), [(10_000, 1, 20e6), (10_000, 5, 20e6), (490_000, 1, 50e6)])
def test_playing_writes_within_its_budget(particles: int, sessions: int, most: float, tmp_path: Path) -> None:
    """Sessions that play, by a clock of the test: what the process writes to its files, log and manifest included, is
    at most 20 MB a minute at 10,000 particles, however many play, and 50 MB at 490,000. All of them get stored.
    In `make soak` it is a day."""
    each = state_of(2500) * particles // 2500
    minutes = min(MINUTES, 120) if particles > 100_000 else MINUTES
    folder = tempfile.mkdtemp(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else tmp_path)
    clock = Clock()
    store = Store(Path(folder) / "sessions.db", clock=clock)
    stored: dict[str, list[float]] = {}

    async def play() -> list[int]:
        manager = Manager(Settings(), store)
        lives = [Live(str(number), "", dict(DESCRIBED)) for number in range(sessions)]
        for live in lives:
            await store.run(rows.put(live.key, "", os.urandom(1000), DESCRIBED, []))
            manager.sessions[live.key], live.process = live, Process()  # type: ignore[assignment]
        written, before = [], _written()
        for beat in range(int(120 * minutes)):
            for live in lives:
                process: Any = live.process
                asked = process.asked
                manager._event(live, process, {"event": "beat", **DESCRIBED, "unsaved": True}, b"")
                if process.asked > asked:
                    body = bytes([beat % 256]) * each
                    manager._event(live, process, {"event": "checkpoint", **DESCRIBED, "iteration": beat}, body)
                    await store.run(lambda db: None)
                    stored.setdefault(live.key, []).append(clock.now)
            clock.now += 0.5
            if beat % 120 == 119:
                written.append(_written() - before)
                before = _written()
        return written

    try:
        written = asyncio.run(play())
    finally:
        store.close()
    assert max(written) <= most, written
    assert sum(written) <= 20e6 * minutes + 2.1 * each
    assert len(stored) == sessions and all(len(times) > 1 for times in stored.values())
    if particles == 10_000:
        longest = max(b - a for times in stored.values() for a, b in pairwise(times))
        assert longest <= 5.0 * sessions  # each has its turn, every few seconds where one plays


def _written() -> int:
    """Bytes that this process has written."""
    lines = dict(line.split(": ") for line in Path("/proc/self/io").read_text().splitlines())
    return int(lines["wchar"])


def test_shapes_at_rest_are_stored_ahead_of_the_budget_but_not_without_end() -> None:
    clock = Clock()
    budget = Budget(clock=clock)
    spent = 0.0
    budget.spend(10**7)
    assert not budget.allows("plays") and budget.allows("rests", resting=True)
    while budget.allows("rests", resting=True):
        budget.spend(10**6)
        spent += 2e6
    assert spent <= DEBT + 3e6
    clock.now += 2 * DEBT / RATE
    assert budget.allows("plays")
    budget.spend(10**6)
    owed = budget.owed
    clock.now -= 1000.0  # a clock that jumps back gives nothing, and takes nothing
    assert budget.owed == pytest.approx(owed)


# use


def test_a_session_that_is_read_or_watched_is_in_use(monkeypatch: pytest.MonkeyPatch) -> None:
    """GET, watching and exports count as use, also of a session that sleeps; listing does not."""
    now = [1000.0]
    monkeypatch.setattr(managing.time, "monotonic", lambda: now[0])

    async def aged() -> set[str]:
        store = Store(None)
        for key in ("read", "watched", "left", "unused"):
            await store.run(rows.put(key, "", b"base", DESCRIBED, []))
        manager = Manager(Settings(session_seconds=100.0), store)
        await manager.start()
        assert manager._ticking is not None
        manager._ticking.cancel()  # the test looks instead
        watched = manager.find("watched")
        watched.watchers += 1
        for tick in range(20):
            now[0] += managing.TICK
            manager.find("read")
            if tick < 3:
                manager.find("left")
            await upkeep.forget(manager, managing.TICK)
        await manager.close()
        store.close()
        return set(manager.sessions)

    assert asyncio.run(aged()) == {"read", "watched"}


def test_a_server_that_starts_uses_no_session() -> None:
    """Seconds of service without use count on over starts."""

    async def idle() -> list[float]:
        store = Store(None)
        await store.run(rows.put("a", "", b"base", DESCRIBED, []))
        found = []
        for _ in range(3):
            manager = Manager(Settings(), store)
            await manager.start()
            await upkeep.forget(manager, managing.TICK)
            await manager.close()
            found.append((await store.run(rows.listed()))[0].idle)
        store.close()
        return found

    assert asyncio.run(idle()) == [15.0, 30.0, 45.0]


# undo


def edited(count: int, chance: np.random.Generator) -> tuple[bytes, Simulation, list[bytes], list[int]]:
    """Random edits of a cable, gestures, undos, redos and resets among them: base, simulation, and what is stored."""
    simulation = Simulation(Scene.read(CABLE))
    base, store = parts.saved(simulation), Store(None)
    store.submit(rows.put("a", "", base, parts.describe(simulation), [])).result(20.0)
    for _ in range(count):
        draw = chance.random()
        load: dict[str, Any] = {"forces": {"1": {"vector": [0, 0, -float(chance.integers(1, 10**6))]}}}
        edit = load if draw < 0.5 else {**load, "gesture": f"drag {chance.integers(2)}"}
        if draw > 0.75 and simulation.history.before:
            edit = {"undo": True}
        elif draw > 0.65 and simulation.history.after:
            edit = {"redo": True}
        elif draw > 0.98:
            edit = {"reset": True}
        made, sets = parts.make(simulation, json.dumps(edit).encode())
        store.submit(rows.edit("a", simulation.state.revision, sets, made)).result(20.0)
    found = store.submit(rows.load("a")).result(20.0)
    store.close()
    return base, simulation, found.edits, found.revisions


@pytest.mark.soak
@pytest.mark.parametrize("seed", sampled(range(12), 4))
def test_old_edits_become_base_and_all_that_can_be_taken_back_stays(seed: int) -> None:
    """The history of 450 random edits is the same from the folded base: its length both ways, and each setup."""
    base, simulation, edits, revisions = edited(450, np.random.default_rng(seed))
    count = folding.foldable(edits)
    folded = parts.saved(parts.restored(base, b"", edits[:count], revisions[:count]))
    again = parts.restored(folded, b"", edits[count:], revisions[count:])
    whole = parts.restored(base, b"", edits, revisions)
    for one in (again, whole):
        assert one.state.revision == simulation.state.revision
        assert len(one.history.before) == len(whole.history.before)
        assert len(one.history.after) == len(whole.history.after)
    assert _setups(again) == _setups(whole)
    assert count > 0 or len(edits) < 150


def _setups(simulation: Simulation) -> list[str]:
    history = simulation.history
    return [setup.scene.canonical for setup in (*history.before, *history.after)] + [simulation.scene.canonical]


def test_many_edits_can_be_taken_back_after_the_session_slept(monkeypatch: pytest.MonkeyPatch) -> None:
    """130 edits: those that can be taken back, 100, stay edits of the store when older ones become part of the base;
    put to sleep and woken the session has them all."""
    monkeypatch.setattr(managing, "MANY_EDITS", 120)

    async def undone() -> tuple[int, int, int, list[float]]:
        store = Store(None)
        manager = Manager(Settings(), store)
        await manager.start()
        await manager.put("a", json.dumps(CABLE).encode())
        for number in range(130):
            await manager.edit("a", json.dumps({"forces": {"1": {"vector": [0, 0, -float(number)]}}}).encode())
            while manager.sessions["a"].folding:
                await asyncio.sleep(0.01)
        stored = await store.run(rows.load("a"))
        live = manager.find("a")
        await manager._sleep(live, 60.0)
        loads, before = [], 0
        for _ in range(5):
            described = await manager.edit("a", b'{"undo": true}')
            before = max(before, described["undo"])
            _, scene = await manager.export("a", "scene")
            loads.append(json.loads(scene)["forces"][1]["vector"][2])
        revision = manager.find("a").described["revision"]
        await manager.close()
        store.close()
        return len(stored.edits), before, revision, loads

    left, before, revision, loads = asyncio.run(undone())
    assert 100 <= left < 120 and before == 99 and revision == 135
    assert loads == [-128.0, -127.0, -126.0, -125.0, -124.0]


# what is left behind


@pytest.mark.skipif(sys.platform == "win32", reason="processes of POSIX")
def test_folders_of_killed_processes_are_taken_away_at_the_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of this package, whose process has ended, and half-written files of the state folder; nothing else."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    gone = 2**22 + 7  # above the largest number of a process
    kept = {f"hookean-{os.getpid()}-abc", "hookean-abc", f"other-{gone}-abc", "server.json"}
    for name in (*kept, f"hookean-{gone}-abc"):
        (tmp_path / name).mkdir()
    (tmp_path / "server.json1x2y.new").touch()
    leftovers.sweep(tmp_path)
    assert {entry.name for entry in tmp_path.iterdir()} == kept
    assert leftovers.prefix().startswith(f"hookean-{os.getpid()}-")


def test_a_state_is_stored_once_the_session_rests() -> None:
    """What rests is stored without waiting for those that play, and its log is emptied into the file."""

    async def stored() -> bytes:
        store = Store(None)
        store.budget.spend(10**7)
        manager = Manager(Settings(), store)
        await manager.start()
        await manager.put("a", json.dumps(CABLE).encode())
        await manager.command("a", "relax")
        found: Any = None
        for _ in range(3000):
            found = await store.run(rows.load("a"))
            kept = (await store.run(rows.listed()))[0]
            if found.state and kept.status == "converged":
                break
            await asyncio.sleep(0.02)
        await manager.close()
        store.close()
        assert kept.status == "converged"
        return bytes(found.state)

    assert asyncio.run(stored())
