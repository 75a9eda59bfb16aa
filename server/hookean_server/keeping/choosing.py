"""Which rows of a damaged store make whole sessions and jobs, and what is lost, by name."""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from hookean_server.keeping.manifest import Key, Owner, Read
from hookean_server.keeping.pages import Row
from hookean_server.keeping.schema import STATE, TABLES


@dataclass(frozen=True)
class Loss:
    """What is lost of one session or job; `what` is a sentence that names it."""

    kind: str
    key: str
    what: str


@dataclass
class Chosen:
    """Rows to keep as they are, rows to write again with other values, and what is lost."""

    rows: list[Row] = field(default_factory=list)
    changed: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)
    seq: int = 0


class Found:
    """The latest version of every row that was found.

    A whole manifest bounds them: rows of later writes were never acknowledged, sessions and jobs that it does not name
    were deleted. Rows later than all of its lines show that the manifest was cut; then nothing is left out.
    """

    def __init__(self, rows: Iterable[Row], said: Read | None) -> None:
        self.said = None if said is None else said.settled(0)
        self.bounded: dict[Key, dict[tuple[Any, ...], Row]] = {}
        self.latest: dict[Key, dict[tuple[Any, ...], Row]] = {}
        self.seq = 0
        bounds = {} if self.said is None else self.said.owners
        for name, row in rows:
            table = TABLES[name]
            owner, seq = (table.kind, table.owner(row)), row[len(table.key) + 1]
            self.seq = max(self.seq, seq)
            since = row[table.columns.index("since")] if "since" in table.columns else 0
            place = (name, since, *row[: len(table.key)])
            _put(self.latest, owner, place, name, row)
            if owner in bounds and seq <= bounds[owner].seq:
                _put(self.bounded, owner, place, name, row)
        told = [owner.seq for owner in bounds.values()]
        if said is not None and said.pending is not None:
            told += [owner.seq for owner in said.pending[1].values() if owner is not None]
        if said is not None and said.whole and self.seq <= max(told, default=0):
            self.latest = self.bounded

    def choose(self) -> Chosen:
        """What is kept of it."""
        said = self.said.owners if self.said is not None else {}
        chosen = Chosen(seq=max([self.seq, *(owner.seq for owner in said.values())]))
        for owner in sorted({*said, *self.latest}):
            rows, known = list(self.latest.get(owner, {}).values()), said.get(owner)
            {"session": _session, "job": _job}[owner[0]](chosen, owner[1], rows, known)
        return chosen


def _put(found: dict[Key, dict[tuple[Any, ...], Row]], owner: Key, place: tuple[Any, ...], name: str, row: Any) -> None:
    rows, at = found.setdefault(owner, {}), len(TABLES[name].key) + 1
    if place not in rows or row[at] > rows[place][1][at]:
        rows[place] = (name, row)


def _session(chosen: Chosen, key: str, rows: list[Row], said: Owner | None) -> None:
    """The latest base, with all edits that follow it without a gap."""
    bases = [row for name, row in rows if name == "bases"]
    label = said.label if said is not None else ""
    heads = [_named("sessions", row) for name, row in rows if name == "sessions"]
    label = label or max(((head["seq"], head["label"]) for head in heads), default=(0, ""))[1]
    called = f'Session "{label or key}"' + (f" ({key})" if label and label != key else "")
    if not bases:
        at = f"; it was at revision {said.revision}" if said is not None else ""
        chosen.losses.append(Loss("session", key, f"{called} is lost{at}."))
        return
    base = max((_named("bases", row) for row in bases), key=lambda found: found["seq"])
    same = [(name, row) for name, row in rows if _named(name, row)["since"] == base["since"]]
    edits = {found["number"]: (found, row) for found, row in ((_named(n, r), r) for n, r in same if n == "edits")}
    kept: list[Row] = [("bases", next(row for row in bases if row[2] == base["seq"]))]
    last, number = base["revision"], base["number"] + 1
    while number in edits:
        kept.append(("edits", edits[number][1]))
        last, number = edits[number][0]["revision"], number + 1
    parts = {name: row for name, row in same if name in ("notes", "sessions", *STATE)}
    kept += parts.items()
    whole = said is not None and owner_of(kept).same(said)
    chosen.rows += [(name, row) for name, row in kept if name != "sessions"]
    _head(chosen, key, label, base, last, parts.get("sessions"), said, whole)
    shape = said is None or owner_of(kept).state == said.state
    if not whole and (what := _lost(parts, edits, last, number, said, shape)):
        chosen.losses.append(Loss("session", key, f"{called}: {what}."))


def _head(
    chosen: Chosen,
    key: str,
    label: str,
    base: dict[str, Any],
    last: int,
    row: tuple[Any, ...] | None,
    said: Owner | None,
    whole: bool,
) -> None:
    """The row of a session: as it was; or of another creation, so that no ETag that a client has of lost
    data matches, with an unused revision, if edits are lost."""
    before = said.revision if said is not None else _named("sessions", row)["revision"] if row is not None else last
    if row is not None and (whole or last == before == _named("sessions", row)["revision"]):
        chosen.rows.append(("sessions", row))
        return
    given = _named("sessions", row) if row is not None else {"particles": 0, "created": time.time(), "idle": 0.0}
    revision = last if last == before else max(last, before) + 1
    fresh = {"key": key, "since": base["since"], "label": label, "revision": revision, "nonce": secrets.token_hex(8)}
    chosen.changed.append(("sessions", {**given, **fresh}))


def _lost(parts: dict[str, Any], edits: dict[int, Any], last: int, number: int, said: Owner | None, shape: bool) -> str:
    """What is lost of a session whose base is whole. `shape`: whether its last one is there."""
    found = []
    before = said.revision if said is not None else last
    beyond = max((edit[0]["revision"] for n, edit in edits.items() if n > number), default=last)
    if max(before, beyond) > last:
        found.append(f"edits after revision {last} are lost, up to revision {max(before, beyond)}")
    if not shape or "states" not in parts:
        found.append("its last shape is lost, so it continues from an earlier one")
    if "sessions" not in parts:
        found.append("its creation time is lost")
    if "notes" not in parts:
        found.append("the notes on its file are lost")
    if not found and said is not None:
        found.append("some of its edits may be older than those that were stored")
    return ", and ".join(found)


def _job(chosen: Chosen, key: str, rows: list[Row], said: Owner | None) -> None:
    """A job with its request; items that are lost are computed again."""
    found = {name: row for name, row in rows if name in ("jobs", "requests")}
    called = f"Job {key}" + (f" ({said.label})" if said is not None and said.label else "")
    if len(found) < 2:
        chosen.losses.append(Loss("job", key, f"{called} is lost."))
        return
    items = [(name, row) for name, row in rows if name in ("items", "answers")]
    job = _named("jobs", found["jobs"])
    missing = job["total"] - sum(name == "items" for name, _ in items)
    again = job["status"] in ("done", "failed") and missing > 0
    whole = said is not None and owner_of([*found.items(), *items]).same(said)
    chosen.rows += [("requests", found["requests"]), *items]
    if again:
        chosen.changed.append(("jobs", {**job, "status": "waiting", "message": "Waiting."}))
    else:
        chosen.rows.append(("jobs", found["jobs"]))
    if again:
        chosen.losses.append(Loss("job", key, f"{called}: {missing} of its {job['total']} results are computed again."))
    elif not whole and said is not None:
        what = "some of its results are lost; those of a job that had not ended are computed again"
        chosen.losses.append(Loss("job", key, f"{called}: {what}."))


def owner_of(rows: Iterable[Row]) -> Owner:
    """The manifest entry of these rows."""
    owner = Owner()
    for name, row in rows:
        table = TABLES[name]
        part = "state" if name in STATE else "row"
        owner.turn(part, None, row[len(table.key)], row[len(table.key) + 1])
    return owner


def _named(name: str, row: Sequence[Any]) -> dict[str, Any]:
    return dict(zip(TABLES[name].columns, row, strict=True))
