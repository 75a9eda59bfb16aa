"""The process of one session: steps its simulation, takes edits between slices of a few milliseconds, sends frames.

Messages are raw bytes, a JSON head and a body, each way. Commands have an `id` and are answered in order, but for
`step`, which is answered when it is done. Events have none: frames, checkpoints and a sign of life twice a second.
It may be killed any time: what is acknowledged is in the store, progress in a checkpoint, which the server asks for
(`keep`) once a sign of life reports `unsaved` progress and the disk's budget allows it.
"""

from __future__ import annotations

import logging
import os
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from hookean.running.result import Status
from hookean.running.simulation import Simulation
from hookean_server.problems import Problem
from hookean_server.sessions import parts, wire
from hookean_server.sessions.folding import foldable
from hookean_server.sessions.resting import Resting
from hookean_server.workers import channel

log = logging.getLogger("hookean.session")

FRAME = 1.0 / 60.0  # seconds from frame to frame while it plays
FAST = 0.05  # and at full speed, where each frame costs iterations
SLICE = 0.005  # seconds of solving between commands
BEAT = 0.5
CHECKPOINT = 0.8  # from checkpoint to checkpoint, at least

CHANGES = ("edit", "replace", "revert")  # after them a relaxation goes on from what is then
MOVES = ("play", "pause", "step", "relax")

Reply = tuple[dict[str, Any], bytes]


def host(connection: Connection, memory: int, forked: bool) -> None:
    """Serve one session until the server closes its end, dies or kills us."""
    from hookean_server.workers.memory import keep_pages, limit_memory
    from hookean_server.workers.process import _die_with_parent

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _die_with_parent(forked)
    limit_memory(memory)
    keep_pages()
    with suppress(EOFError, OSError):
        Host(connection).run()
    os._exit(0)  # threads of libraries would hold a normal exit up


class Host:
    """A simulation and the connection to the server."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self.simulation: Simulation | None = None
        self.before: Simulation | None = None  # what the last change may be put back to
        self.wired, self.edited = parts.Wired(), parts.Edited()
        self.playing = False
        self.fast = False
        self.resting: Resting | None = None  # while it goes to rest; it plays then
        self.rested: Resting | None = None  # the last one, which may have a moment to go
        self.follow_at = 0.0  # when its next shape is due
        self.left = 0  # iterations that a `step` still has to do
        self.stepping: Any = None  # its id
        self.credit = 0
        self.number = 0
        self.changed = self.stored = 0  # counts of changes: shown, and in a checkpoint
        self.now = 0
        self.shown, self.shown_at = -1, 0.0  # revision and moment of the last frame
        self.sent = b""  # the last frame
        self.due = 0.0  # when the next frame's iterations are due
        self.owed = 0  # iterations until the next frame
        self.each = 1  # iterations that fit into a slice
        self.saved_at = self.beat_at = time.monotonic()

    def run(self) -> None:
        """Until the connection ends."""
        while True:
            rest = self._rest()
            while self.connection.poll(rest):
                self._take()
                rest = 0.0
            if self.simulation is not None and self._due():
                self._advance(self.simulation)
            if self.simulation is not None and self.resting is not None:
                self._follow(self.simulation, self.resting)
            self._show()
            self._beat()

    def _due(self) -> bool:
        """Whether iterations are due now."""
        if self.resting is not None:
            return False
        paced = self.playing and (self.owed > 0 or time.monotonic() >= self.due)
        return self.left > 0 or paced or (self.playing and self.fast)

    def _rest(self) -> float:
        """How long there is nothing to do."""
        now = time.monotonic()
        if self.resting is not None:
            return FRAME
        if self.left or (self.playing and self.fast):
            return 0.0
        wait = self.beat_at + BEAT - now
        if self.playing:
            wait = min(wait, 0.0 if self.owed else self.due - now)
        return max(0.0, float(wait))

    def _take(self) -> None:
        head, body = channel.receive(self.connection)
        if head["do"] == "credit":
            self.credit = 1
            return
        if head["do"] == "unstored":
            self.stored = -1  # the last checkpoint: another one is due
            return
        if head["do"] == "keep":
            self._keep()
            return
        if self.simulation is not None:
            self._finite(self.simulation)
        goes_on = self.resting is not None and head["do"] in CHANGES
        wanted = head["do"] in (*CHANGES, *MOVES) and not self._stale(head)
        if self.simulation is not None and self.resting is not None and wanted:
            self.resting.leave(self.simulation)
            self.resting = None
        answer = self._do(head, body)
        if goes_on and self.resting is None:
            self._relax()
        if answer is not None:
            self._send({"id": head["id"], **answer[0]}, answer[1])

    def _do(self, head: dict[str, Any], body: bytes) -> Reply | None:
        """The answer to a command; faults become problems."""
        try:
            if self._stale(head):
                raise Problem("stale-revision", f"{self._stale(head)}; read it and repeat the edit.")
            action: Callable[[dict[str, Any], bytes], Reply | None] = getattr(self, f"do_{head['do']}")
            return action(head, body)
        except Exception as error:
            slug = head.get("slug", "invalid-input")
            return channel.problem_of(error, slug, head["do"], log, scene="invalid-scene").to_wire(), b""

    def _stale(self, head: dict[str, Any]) -> str:
        """Why a command is for another revision than this one; "" where it is not."""
        wanted = head.get("revision")
        now = wanted if self.simulation is None else self.simulation.state.revision
        return "" if wanted in (None, now) else f"The session is at revision {now}, not {wanted}"

    # commands

    def do_create(self, head: dict[str, Any], body: bytes) -> Reply:
        """A new session from a scene or a saved simulation; answers with what to store."""
        self.simulation = parts.opened(body)
        self._mark()
        return self._described(), parts.saved(self.simulation)

    def do_restore(self, head: dict[str, Any], body: bytes) -> Reply:
        """A session from the store: its base, the edits since, and the last checkpoint of its state."""
        base, state, *edits = parts.split(body, head["sizes"])
        self.simulation = parts.restored(base, state, edits, head["revisions"])
        after = self.simulation.state
        after.revision = max(after.revision, head["revision"])  # later than what is there, where edits were lost
        self._mark()
        self.stored = self.now
        return self._described(), b""

    def do_fold(self, head: dict[str, Any], body: bytes) -> Reply:
        """A base of the store with the first edits after it as part of it: how many, and the new base. For a process
        that holds nothing else."""
        base, *edits = parts.split(body, head["sizes"])
        count = foldable(edits)
        if not count:
            return {"count": 0}, b""
        return {"count": count}, parts.saved(parts.restored(base, b"", edits[:count], head["revisions"][:count]))

    def do_replace(self, head: dict[str, Any], body: bytes) -> Reply:
        """Another scene, in which particles keep where they are, or a saved simulation, in which they are as saved."""
        simulation = self._simulation()
        following = parts.following(simulation, body)
        if following is None:
            return {**self._described(), "same": True}, b""
        self.before, self.simulation = simulation, following
        self._mark()
        return self._described(), parts.saved(self.simulation)

    def do_edit(self, head: dict[str, Any], body: bytes) -> Reply:
        """A patch, an undo, a redo or a reset; answers with what to store so that it can be made again exactly."""
        simulation = self._simulation()
        resolved, sets = parts.make(simulation, body)
        self.before = simulation
        self._mark()
        return {**self._described(), "sets": sets}, resolved

    def do_revert(self, head: dict[str, Any], body: bytes) -> Reply:
        """Take back an edit, or another scene, that could not be stored: as if it had never been made."""
        if self.before is not None and self.before is self.simulation:
            self.before.revert()  # an edit; another scene has left this one as it was
        self.simulation, self.before = self.before or self.simulation, None
        self._mark()
        return self._described(), b""

    def do_play(self, head: dict[str, Any], body: bytes) -> Reply:
        """Step on by itself; `fast` as quickly as it can, else `sub_iterations` for each of 60 frames a second; a
        `step` under way ends."""
        simulation = self._moving()
        self.playing, self.fast, self.owed, self.left = True, bool(head.get("fast")), 0, 0
        self._stepped()
        if simulation.status is Status.DIVERGED:
            self.playing = False
        self.due = time.monotonic()
        self._mark()
        return self._described(), b""

    def do_relax(self, head: dict[str, Any], body: bytes) -> Reply:
        """Go to rest by the scene's own solver; it plays until then. A `step` under way ends."""
        self.owed = self.left = 0
        self._stepped()
        self._relax()
        return self._described(), b""

    def do_pause(self, head: dict[str, Any], body: bytes) -> Reply:
        """Stand still; a `step` under way ends."""
        self.playing = False
        self.left = self.owed = 0
        self._stepped()
        self._mark()
        return self._described(), b""

    def do_step(self, head: dict[str, Any], body: bytes) -> Reply | None:
        """Step `frames` frames on and pause; answered when done."""
        simulation = self._moving()
        self._stepped()
        self.playing, self.owed = False, 0
        self.left = int(head["frames"]) * simulation.scene.settings.sub_iterations
        self.stepping = head["id"]
        return None

    def do_describe(self, head: dict[str, Any], body: bytes) -> Reply:
        """How the session stands."""
        return self._described(), b""

    def do_checkpoint(self, head: dict[str, Any], body: bytes) -> Reply:
        """The state as it is now; nothing where the store has it."""
        simulation = self._simulation()
        if self.stored == self.now:
            return self._described(), b""
        self.stored = self.now
        return self._described(), parts.state_bytes(simulation)

    def do_save(self, head: dict[str, Any], body: bytes) -> Reply:
        """All of it: scene, anchors and state."""
        return self._described(), parts.saved(self._simulation())

    def do_export(self, head: dict[str, Any], body: bytes) -> Reply:
        """The session as a file of some format, or its topology."""
        from hookean_server.sessions import exports

        how = head["format"], head.get("arrays", "list"), head.get("view", {})
        media_type, data, notes = exports.export(self._simulation(), *how)
        return {**self._described(), "type": media_type, "notes": notes}, data

    # running

    def _advance(self, simulation: Simulation) -> None:
        """One slice of iterations. The clock decides how many; where the run leads and ends does not depend on it."""
        began = time.monotonic()
        frame, before = simulation.scene.settings.sub_iterations, simulation.state.iteration
        if not (self.owed or self.left or self.fast):
            self.owed = frame
            self.due = max(self.due + FRAME, began)
        count = min(self.each, (self.left % frame or frame) if self.left else self.owed or self.each)
        judged = True
        if not self.left or simulation.solver.together:
            simulation.play(count)
        elif self.left % frame == count % frame:  # as `Simulation.step` judges
            simulation.iterate(count)
        else:
            simulation.advance(count)
            judged = False  # the status is that of the frame before
        done, took = max(count, simulation.state.iteration - before), time.monotonic() - began
        self.each = max(1, min(2 * self.each, int(done * SLICE / max(took, 1e-6)), 100_000))
        self.left, self.owed = max(0, self.left - done), max(0, self.owed - done)
        if judged:
            self._note(simulation)
        else:
            self._mark()

    def _relax(self) -> None:
        """Begin to go to rest from here."""
        self.resting = self.rested = Resting(self._simulation(), self.rested)
        self.resting.start()
        self.playing = self.fast = True
        self._mark()

    def _follow(self, simulation: Simulation, resting: Resting) -> None:
        """Take over where a relaxation is: shapes on the way as often as they are shown, and its end."""
        if resting.finish(simulation):
            self.resting = self.rested = None
            self.playing = False
            self._mark()
        elif (began := time.monotonic()) >= self.follow_at and resting.show(simulation):
            self._mark()
            now = time.monotonic()
            self.follow_at = now + max(FAST, 10.0 * (now - began))

    def _moving(self) -> Simulation:
        """The simulation, about to move; a relaxation that ended without rest does not end its motion."""
        simulation = self._simulation()
        if simulation.status not in (Status.RUNNING, Status.CONVERGED, Status.DIVERGED):
            simulation.arrive(simulation.state)
        return simulation

    def _note(self, simulation: Simulation) -> None:
        """Something has moved, and may have come to its end."""
        if simulation.status is not Status.RUNNING:
            self.playing, self.left, self.owed = False, 0, 0
        if not self.left:
            self._stepped()
        self._mark()

    def _finite(self, simulation: Simulation) -> None:
        """A state that is not finite is neither shown nor stored: the run goes on to where it is judged, and back to
        its last good shape."""
        while simulation.status is Status.RUNNING and not simulation.finite:
            if self.left:
                simulation.look()
            else:
                simulation.play(1)
            self._note(simulation)

    def _stepped(self) -> None:
        """Answer the `step` that has ended."""
        if self.stepping is not None:
            self._send({"id": self.stepping, **self._described()}, b"")
            self.stepping = None

    def _mark(self) -> None:
        self.now += 1

    def _show(self) -> None:
        """Send a frame, if one is wanted and there is anything new in it; in real time, once it is whole."""
        simulation, now = self.simulation, time.monotonic()
        if not self.credit or simulation is None or self.changed == self.now:
            return
        apart = FAST if self.playing and self.fast else 0.5 * FRAME
        due = now >= self.shown_at + apart and not self.owed
        if due or not (self.playing or self.left) or simulation.state.revision != self.shown:
            self._finite(simulation)
            self.credit, self.changed = 0, self.now
            self.shown, self.shown_at = simulation.state.revision, now
            self.number += 1
            frame = wire.encode(parts.frame(simulation, self.number, self.playing or bool(self.left)))
            changes = wire.changes(self.sent, frame)
            self.sent = frame
            self._send({"event": "frame", "changes": changes is not None}, frame if changes is None else changes)

    def _keep(self) -> None:
        """Send a checkpoint, where there is progress to store."""
        if self.simulation is not None and self.now != self.stored:
            self._finite(self.simulation)
            self.saved_at, self.stored = time.monotonic(), self.now
            self._send({"event": "checkpoint", **self._described()}, parts.state_bytes(self.simulation))

    def _beat(self) -> None:
        """Send a sign of life, when one is due; it reports whether there is progress to store."""
        now = time.monotonic()
        if now < self.beat_at + BEAT:
            return
        self.beat_at = now
        if self.simulation is None:
            self._send({"event": "beat"}, b"")
            return
        self._finite(self.simulation)
        unsaved = self.now != self.stored and now >= self.saved_at + CHECKPOINT
        self._send({"event": "beat", **self._described(), "unsaved": unsaved}, b"")

    def _described(self) -> dict[str, Any]:
        simulation = self._simulation()
        wiring, now = self.wired.tag(simulation), time.monotonic_ns()  # a clock that all processes share
        solving = self.resting is not None
        told = {"wiring": wiring, "playing": self.playing, "solving": solving, "told": now}
        return {**parts.describe(simulation), **self.edited.revisions(simulation), **told}

    def _simulation(self) -> Simulation:
        if self.simulation is None:
            raise Problem("internal", "The session is not open yet.")
        return self.simulation

    def _send(self, head: dict[str, Any], body: bytes) -> None:
        channel.send(self.connection, head, body)
