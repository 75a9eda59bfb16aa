"""Two clients with conditional requests agree with a simple model of sessions, whatever they ask for in which order and
whichever start of the service answers.

Ten of 2,000 runs in `make test`, all in `make soak`.
"""

from __future__ import annotations

import itertools
import signal
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, ClassVar

import httpx
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from server.conftest import Served
from server.test_races import at_once
from serving import CABLE, SOAK

from .machines import agrees_with_its_model

RUNS, STEPS = (2000, 20) if SOAK else (6, 12)
WISHES = 60  # for a new start of the server until one is granted

KEYS = st.sampled_from(("x", "y"))
CLIENTS = st.sampled_from((0, 1))
LOADS = st.integers(-6, -1).map(float)
NOWHERE = '"0123456789abcdef-0-01234567"'
CONDITIONS = st.sampled_from(
    ("", "", "match seen", "match seen", "match any", "match list", "match weak", "none seen", "none weak", "none any")
)


@dataclass(frozen=True)
class Edition:
    """A revision of a creation, and its load."""

    creation: int
    revision: int
    load: float


def scene(load: float) -> dict[str, Any]:
    found = deepcopy(CABLE)
    found["forces"][1]["vector"] = [0, 0, load]
    return found


def headers(condition: str, seen: str) -> dict[str, str]:
    """The header of a condition, for a client that saw an ETag."""
    if not condition:
        return {}
    kind, _, what = condition.partition(" ")
    given = {"seen": seen, "any": "*", "list": f'{NOWHERE}, "a,b", {seen}', "weak": f"W/{seen}"}[what]
    return {"if-match" if kind == "match" else "if-none-match": given}


def met(condition: str, seen: Edition | None, now: Edition | None) -> bool:
    """Whether a change may be made (RFC 9110, sections 13.1.1 and 13.1.2)."""
    same = now is not None and seen is not None and (seen.creation, seen.revision) == (now.creation, now.revision)
    return {
        "": True,
        "match seen": same,
        "match list": same,
        "match weak": False,
        "match any": now is not None,
        "none seen": not same,
        "none weak": not same,
        "none any": now is None,
    }[condition]


class Conditional(RuleBasedStateMachine):
    """One run: two clients, two keys. All runs share a server, which is killed and started again now and then."""

    served: ClassVar[Served | None] = None
    state: ClassVar[str] = ""
    wishes: ClassVar[Any] = itertools.count()

    @initialize()
    def begin(self) -> None:
        if Conditional.served is None:
            Conditional.served = Served(state=Conditional.state, workers=1)
        self.now: dict[str, Edition] = {}
        self.creations = itertools.count()
        self.nonces: dict[int, str] = {}  # of each creation
        self.seen = [dict.fromkeys("xy", NOWHERE) for _ in range(2)]  # the ETags that each client has
        self.editions: dict[str, Edition] = {}  # that these stand for

    @property
    def client(self) -> httpx.Client:
        assert Conditional.served is not None
        return Conditional.served.client

    def saw(self, client: int, key: str, answer: httpx.Response) -> None:
        """A client takes up the ETag of an answer, which stands for what the model has."""
        tag, edition = answer.headers["etag"], self.now[key]
        nonce, revision, _ = tag.strip('"').split("-")
        assert nonce == self.nonces.setdefault(edition.creation, nonce) and int(revision) == edition.revision
        assert len(set(self.nonces.values())) == len(self.nonces)
        self.seen[client][key] = tag
        self.editions[tag] = edition

    def change(self, client: int, key: str, condition: str, method: str, rest: str = "", **given: Any) -> Any:
        """The answer to a change; None where the model says that it is not made, and the service says so too."""
        seen, now = self.seen[client][key], self.now.get(key)
        address = f"/v1/sessions/{key}{rest}"
        answer = self.client.request(method, address, headers=headers(condition, seen), **given)
        if now is None and method != "PUT":
            assert answer.status_code == 404, answer.text
            return None
        if not met(condition, self.editions.get(seen), now):
            assert answer.status_code == 412, answer.text
            assert (now is None) == ("etag" not in answer.headers)
            if now is not None:
                self.saw(client, key, answer)
            return None
        return answer

    @rule(client=CLIENTS, key=KEYS, condition=CONDITIONS, load=LOADS)
    def put(self, client: int, key: str, condition: str, load: float) -> None:
        answer = self.change(client, key, condition, "PUT", json=scene(load))
        if answer is None:
            return
        now = self.now.get(key)
        assert answer.status_code == (201 if now is None else 200), answer.text
        if now is None:
            self.now[key] = Edition(next(self.creations), 0, load)
        else:  # the scene it was given last, whatever edits have made of it, changes nothing
            changed = answer.json()["revision"] != now.revision
            self.now[key] = Edition(now.creation, now.revision + changed, load if changed else now.load)
        self.saw(client, key, answer)

    @rule(client=CLIENTS, key=KEYS, condition=CONDITIONS, load=LOADS)
    def edit(self, client: int, key: str, condition: str, load: float) -> None:
        answer = self.change(client, key, condition, "PATCH", json={"forces": {"1": {"vector": [0, 0, load]}}})
        if answer is not None:
            assert answer.status_code == 200, answer.text
            now = self.now[key]
            self.now[key] = Edition(now.creation, now.revision + 1, load)
            self.saw(client, key, answer)

    @rule(client=CLIENTS, key=KEYS, condition=CONDITIONS, action=st.sampled_from(("reset", "step", "pause")))
    def act(self, client: int, key: str, condition: str, action: str) -> None:
        answer = self.change(client, key, condition, "POST", f"/{action}")
        if answer is not None:
            assert answer.status_code == 200, answer.text
            now = self.now[key]
            self.now[key] = Edition(now.creation, now.revision + (action == "reset"), now.load)
            self.saw(client, key, answer)

    @rule(client=CLIENTS, key=KEYS, condition=CONDITIONS)
    def branch(self, client: int, key: str, condition: str) -> None:
        """To the other key: refused where that has a session, whatever the condition."""
        other, params = {"x": "y", "y": "x"}[key], {"to": {"x": "y", "y": "x"}[key]}
        if key in self.now and other in self.now:
            given = headers(condition, self.seen[client][key])
            answer = self.client.post(f"/v1/sessions/{key}/branches", params=params, headers=given)
            assert answer.status_code == 409, answer.text
            return
        answer = self.change(client, key, condition, "POST", "/branches", params=params)
        if answer is not None:
            assert answer.status_code == 201, answer.text
            self.now[other] = Edition(next(self.creations), self.now[key].revision, self.now[key].load)
            self.saw(client, other, answer)

    @rule(client=CLIENTS, key=KEYS, condition=CONDITIONS)
    def delete(self, client: int, key: str, condition: str) -> None:
        answer = self.change(client, key, condition, "DELETE")
        if answer is not None:
            assert answer.status_code == 204, answer.text
            del self.now[key]

    @rule(client=CLIENTS, key=KEYS, part=st.sampled_from(("", "/scene", "/state", "/anchors")))
    def read(self, client: int, key: str, part: str) -> None:
        """304 where the client has it: never of another revision, nor of another creation."""
        seen = self.seen[client][key]
        answer = self.client.get(f"/v1/sessions/{key}{part}", headers={"if-none-match": seen})
        now = self.now.get(key)
        assert answer.status_code in ((404,) if now is None else (200, 304)), answer.text
        if now is not None:
            self.saw(client, key, answer)
            assert answer.status_code == (304 if self.seen[client][key] == seen else 200)

    @rule(key=KEYS, loads=st.tuples(LOADS, LOADS))
    def edit_at_once(self, key: str, loads: tuple[float, float]) -> None:
        """Both clients have the same ETag: the edit of one of them lands."""
        if key not in self.now:
            return
        when = {"if-match": self.client.get(f"/v1/sessions/{key}").headers["etag"]}
        edits = [{"forces": {"1": {"vector": [0, 0, load]}}} for load in loads]
        address, client = f"/v1/sessions/{key}", self.client
        found = at_once(*(lambda edit=edit: client.patch(address, json=edit, headers=when) for edit in edits))
        assert sorted(answer.status_code for answer in found) == [200, 412]
        now, landed = self.now[key], int(found[1].status_code == 200)
        self.now[key] = Edition(now.creation, now.revision + 1, loads[landed])
        for number, answer in enumerate(found):
            self.saw(number, key, answer)

    @rule(key=KEYS, load=LOADS)
    def delete_and_put_at_once(self, key: str, load: float) -> None:
        """The scene is the first of another session, or goes to the one that is deleted then."""
        if key not in self.now:
            return
        address, client = f"/v1/sessions/{key}", self.client
        gone, made = at_once(lambda: client.delete(address), lambda: client.put(address, json=scene(load)))
        assert gone.status_code == 204 and made.status_code in (200, 201)
        del self.now[key]
        if made.status_code == 201:
            self.now[key] = Edition(next(self.creations), 0, load)
            self.saw(0, key, made)

    @rule(how=st.sampled_from((signal.SIGKILL, signal.SIGTERM)))
    def restart(self, how: int) -> None:
        """One wish in so many is granted: it takes long."""
        if Conditional.served is None or next(Conditional.wishes) % WISHES != WISHES - 1:
            return
        Conditional.served.end(how)
        Conditional.served = Served(state=Conditional.state, workers=1)

    @invariant()
    def agrees(self) -> None:
        found = {s["key"]: s for s in self.client.get("/v1/sessions").json()["sessions"]}
        assert {key: s["revision"] for key, s in found.items()} == {key: e.revision for key, e in self.now.items()}

    def teardown(self) -> None:
        for key in getattr(self, "now", {}):
            answer = self.client.get(f"/v1/sessions/{key}/scene")
            assert answer.json()["forces"][1]["vector"] == [0, 0, self.now[key].load]
            assert self.client.delete(f"/v1/sessions/{key}").status_code == 204


def test_two_clients_with_conditions_agree_with_their_model() -> None:
    agrees_with_its_model(Conditional, RUNS, STEPS)
