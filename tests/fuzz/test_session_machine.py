"""Sessions agree with a simple model of them, whatever is asked of them and whichever process is killed in between.

Eight of 500 runs in `make test`, all in `make soak`.
"""

from __future__ import annotations

import itertools
import signal
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any, ClassVar

import psutil
from hypothesis import strategies as st
from hypothesis.stateful import Bundle, RuleBasedStateMachine, consumes, initialize, invariant, multiple, rule

from server.conftest import Served
from serving import CABLE, SOAK

from .machines import agrees_with_its_model

RUNS, STEPS = (500, 30) if SOAK else (5, 12)
WISHES = 25  # for a new start of the server until one is granted

LOADS = st.integers(-6, -1).map(float)
INNER = st.integers(1, 4)


def scene(load: float) -> dict[str, Any]:
    """The cable with this load on every particle."""
    found = deepcopy(CABLE)
    found["forces"][1]["vector"] = [0, 0, load]
    return found


@dataclass
class Model:
    """What a session should be."""

    load: float
    held: frozenset[int] = frozenset((0, 5))
    revision: int = 0
    before: list[tuple[float, frozenset[int]]] = field(default_factory=list)
    after: list[tuple[float, frozenset[int]]] = field(default_factory=list)
    gesture: str = ""
    playing: bool = False

    def edit(self, load: float, held: frozenset[int], gesture: str) -> None:
        """A patch."""
        if not gesture or gesture != self.gesture:
            self.before.append((self.load, self.held))
        self.load, self.held, self.gesture = load, held, gesture
        self.after.clear()
        self.revision += 1

    def move(self, source: list[Any], target: list[Any]) -> None:
        """Undo or redo."""
        target.append((self.load, self.held))
        self.load, self.held = source.pop()
        self.gesture = ""
        self.revision += 1


class Sessions(RuleBasedStateMachine):
    """One run; all share a server, which is killed and started again now and then."""

    keys = Bundle("keys")
    served: ClassVar[Served | None] = None
    state: ClassVar[str] = ""
    numbers: ClassVar[Any] = itertools.count()
    wishes: ClassVar[Any] = itertools.count()

    @initialize()
    def begin(self) -> None:
        if Sessions.served is None:
            Sessions.served = Served(state=Sessions.state, workers=1, awake=8)
        self.models: dict[str, Model] = {}
        self.touched = ""

    def client(self) -> Any:
        assert Sessions.served is not None
        return Sessions.served.client

    def ask(self, method: str, key: str, rest: str = "", status: int = 200, **given: Any) -> Any:
        """The answer to a request on a session, whose status is the one expected."""
        self.touched = key
        answer = self.client().request(method, f"/v1/sessions/{key}{rest}", **given)
        assert answer.status_code == status, (method, rest, answer.text[:300])
        return answer.json() if answer.content else None

    @rule(target=keys, load=LOADS)
    def make(self, load: float) -> str:
        key = f"run-{next(Sessions.numbers)}"
        self.ask("PUT", key, status=201, json=scene(load))
        self.models[key] = Model(load)
        return key

    @rule(key=keys, load=LOADS, gesture=st.sampled_from(("", "", "drag", "slide")))
    def load(self, key: str, load: float, gesture: str) -> None:
        model, given = self.models[key], {"forces": {"1": {"vector": [0, 0, load]}}}
        self.ask("PATCH", key, json={**given, "gesture": gesture} if gesture else given)
        model.edit(load, model.held, gesture)

    @rule(key=keys, particle=INNER, gesture=st.sampled_from(("", "drag")))
    def pin(self, key: str, particle: int, gesture: str) -> None:
        model, given = self.models[key], {"pin": [{"particles": [particle]}]}
        self.ask("PATCH", key, json={**given, "gesture": gesture} if gesture else given)
        model.edit(model.load, model.held | {particle}, gesture)

    @rule(key=keys, particle=INNER)
    def release(self, key: str, particle: int) -> None:
        model = self.models[key]
        if particle in model.held:
            self.ask("PATCH", key, json={"release": [particle]})
            model.edit(model.load, model.held - {particle}, "")

    @rule(key=keys, edit=st.sampled_from(({"forces": {"9": {}}}, {"pin": [{"particles": [99]}]}, {"nothing": 1}, [])))
    def misedit(self, key: str, edit: Any) -> None:
        self.ask("PATCH", key, status=422, json=edit)

    @rule(key=keys)
    def miss(self, key: str) -> None:
        """An edit for another revision than it is at."""
        self.ask(
            "PATCH", key, status=412, json={"release": []}, headers={"if-match": f'"{self.models[key].revision + 1}"'}
        )

    @rule(key=keys, action=st.sampled_from(("undo", "undo", "redo")))
    def back_or_forth(self, key: str, action: str) -> None:
        model = self.models[key]
        source, target = (model.before, model.after) if action == "undo" else (model.after, model.before)
        self.ask("POST", key, f"/{action}", status=200 if source else 422)
        if source:
            model.move(source, target)

    @rule(key=keys)
    def reset(self, key: str) -> None:
        self.ask("POST", key, "/reset")
        self.models[key].revision += 1

    @rule(key=keys, frames=st.integers(1, 4))
    def step(self, key: str, frames: int) -> None:
        before = self.ask("GET", key)
        found = self.ask("POST", key, "/step", params={"frames": frames})
        assert found["iteration"] > before["iteration"] or found["status"] in ("converged", "diverged")
        self.models[key].playing = False

    @rule(key=keys)
    def play(self, key: str) -> None:
        self.ask("POST", key, "/play")
        self.models[key].playing = True

    @rule(key=keys)
    def pause(self, key: str) -> None:
        self.ask("POST", key, "/pause")
        self.models[key].playing = False

    @rule(target=keys, key=keys)
    def branch(self, key: str) -> Any:
        model, new = self.models[key], f"run-{next(Sessions.numbers)}"
        self.ask("POST", key, "/branches", status=201, params={"to": new})
        self.models[new] = Model(model.load, model.held, model.revision)
        self.touched = new
        return multiple(new)

    @rule(key=keys, load=LOADS)
    def replace(self, key: str, load: float) -> None:
        """Another scene on the same session, which plays on; the one that it has changes nothing."""
        model = self.models[key]
        self.ask("PUT", key, json=scene(load))
        if load != model.load:
            self.models[key] = Model(load, revision=model.revision + 1, playing=model.playing)

    @rule(key=consumes(keys))
    def delete(self, key: str) -> None:
        self.ask("DELETE", key, status=204)
        self.ask("GET", key, status=404)
        self.ask("PATCH", key, status=404, json={"release": []})
        del self.models[key]
        self.touched = ""

    @rule(key=keys)
    def kill_a_process(self, key: str) -> None:
        """The processes that hold sessions end; they come back by themselves, those that played go on."""
        self.ask("GET", key, "/scene")
        assert Sessions.served is not None
        for process in sorted(Sessions.served.workers(), key=lambda p: p.create_time())[1:]:
            try:
                process.kill()
            except psutil.NoSuchProcess:
                continue

    @rule(how=st.sampled_from((signal.SIGKILL, signal.SIGTERM)))
    def restart(self, how: int) -> None:
        """The server ends or is killed, and all is as it was, paused. One wish in so many is granted: it takes long."""
        if Sessions.served is None or next(Sessions.wishes) % WISHES != WISHES - 1:
            return
        Sessions.served.end(how)
        Sessions.served = Served(state=Sessions.state, workers=1, awake=8)
        for key, model in self.models.items():
            model.playing = False
            self.touched = key
            self.agrees()

    @invariant()
    def agrees(self) -> None:
        key = getattr(self, "touched", "")
        if not key or key not in self.models:
            return
        model = self.models[key]
        given = self.ask("GET", key, "/scene")
        held = {p for anchor in self.ask("GET", key, "/anchors")["anchors"] for p in anchor["particles"]}
        found = self.ask("GET", key)
        assert given["forces"][1]["vector"] == [0, 0, model.load]
        assert held == model.held
        assert (found["revision"], found["undo"], found["redo"]) == (
            model.revision,
            len(model.before),
            len(model.after),
        )
        assert model.playing or not found["playing"]
        assert found["particles"] == 6

    def teardown(self) -> None:
        for key in getattr(self, "models", {}):
            self.client().delete(f"/v1/sessions/{key}")


def test_sessions_agree_with_their_model() -> None:
    agrees_with_its_model(Sessions, RUNS, STEPS)
