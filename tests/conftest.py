"""What all tests have in common."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from soak import SOAK, examples

# modules and tests that are collected stay to the end: to look for garbage among them takes a tenth of the time
gc.disable()

# how long an example takes is the machine's affair, and no test is about it
settings.register_profile(
    "untimed", max_examples=examples(100), deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("untimed")


WAITING = ("faults", "components", "server")
"""Folders whose tests wait for other processes half of the time."""
PATIENT = ("test_visits.py", "test_guard.py")
"""Files among them that wait for limits of half a minute: the first."""
COMPUTING = ("docs", "tests", "fuzz", "canvas", "laws", "files")
"""Folders whose tests keep a processor busy; all others follow. In both the longest tests come first, so that no worker
is left alone with one of them."""
STUDIO = sorted(path.name for path in (Path(__file__).parent / "studio").glob("test_*.py"))
PARTS = 2  # of them: each has a browser and a service
EACH = 5
"""Of as many cases of tests that are slow or thinned one is run, and all in `make soak`."""
BEHIND = 5
"""The niceness of workers that have no test of the studio."""
APART = ("laws/test_laws.py", "laws/test_determinism.py", "core/test_equilibrium.py")
"""Long files whose functions share nothing that takes long to make: several workers can have a part of one."""


def unit(test: str) -> str:
    """What a worker takes as a whole: a file, with its fixtures; a function of `APART`; a part of the tests with a
    browser, which share it, its service and the scripts it has compiled."""
    file, _, function = test.partition("::")
    if file.startswith("tests/studio/"):
        return f"studio, part {STUDIO.index(Path(file).name) % PARTS}"
    return f"{file}::{function.partition('[')[0]}" if file.endswith(APART) else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Share tests among workers by `unit`."""
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class Units(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return unit(nodeid)

        def _reschedule(self, node: Any) -> None:
            """Give a worker two tests or, where no more come, its end: it begins one only when it knows what follows.
            A worker that replaces one that died would otherwise wait for ever with its last test."""
            if node not in self.registered_collections:
                return
            super()._reschedule(node)
            while self.workqueue and not node.shutting_down and self._pending_of(self.assigned_work[node]) < 2:
                self._assign_work_unit(node)
            if not self.workqueue and not node.shutting_down:
                node.shutdown()

    return Units(config, log)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Let the studio's tests go first: they take longest, one after the other, and wait for much."""
    beside = hasattr(os, "nice") and "PYTEST_XDIST_WORKER" in os.environ and item.path.parent.name != "studio"
    if beside and (now := os.nice(0)) < BEHIND:  # at once: services that start later have the same
        os.nice(BEHIND - now)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave what takes long to `make soak`; share the others out with `order`."""
    left = [] if SOAK else [item for item in items if item.get_closest_marker("soak")]
    left += [] if SOAK else more_of_the_thinned(items)
    if left:
        config.hook.pytest_deselected(items=left)
        gone = {id(item) for item in left}
        items[:] = [item for item in items if id(item) not in gone]
    order(items)


def more_of_the_thinned(items: list[pytest.Item]) -> list[pytest.Item]:
    """Of the cases of each test that is slow or thinned all but one of `EACH`: of a slow test the first; of a
    thinned one the place depends on its name, so that every force is in some of the tests of all forces."""
    cases: dict[str, list[pytest.Item]] = {}
    kept: dict[str, int] = {}
    for item in items:
        slow, thinned = item.get_closest_marker("slow"), item.get_closest_marker("thinned")
        if (slow or thinned) and not item.get_closest_marker("soak"):
            test = item.nodeid.partition("[")[0]
            cases.setdefault(test, []).append(item)
            kept[test] = len(test) if thinned else 0
    return [
        item
        for test, same in cases.items()
        for place, item in enumerate(same)
        if place % EACH != kept[test] % min(EACH, len(same))
    ]


def pytest_collection_finish() -> None:
    """Garbage is collected from now on, but not looked for in what was collected."""
    gc.freeze()
    gc.enable()


def order(items: list[pytest.Item]) -> None:
    """The studio's tests first, for they take longest; then files that wait and files that compute in turn, so that at
    any time some workers wait while others compute."""
    units = list(dict.fromkeys(unit(item.nodeid) for item in items))
    folders = {unit(item.nodeid): item.path.parent.name for item in items}
    places = {name: -1.0 for name in units if folders[name] == "studio"}
    rank = {folder: place for place, folder in enumerate((*WAITING, *COMPUTING))}
    patient = {name for name in units if name.endswith(PATIENT)}
    others = [name for name in units if name not in places]
    others.sort(key=lambda name: (name not in patient, rank.get(folders[name], len(rank))))
    for waits in (True, False):
        row = [name for name in others if (folders[name] in WAITING) is waits]
        places.update((name, place / len(row)) for place, name in enumerate(row))
    items.sort(key=lambda item: places[unit(item.nodeid)])


@pytest.fixture(scope="session", autouse=True)
def own_state(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Whatever looks for a server finds none of the person who runs the tests, and starts none beside theirs. The
    definitions of tests are trusted, as in CI."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOOKEAN_TRUST", "1")
        patch.setenv("HOOKEAN_STATE", str(tmp_path_factory.mktemp("state")))
        yield
