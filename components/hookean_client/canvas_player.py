"""One engine's session on the service, kept as the canvas wants it: made, patched, played and watched in threads.

An anchor holds the particle it first met, its home, by its name: source, path and item. Homes outlive moves and resets;
those of a session that was left come back from its scene. For Python 2.7 to 3.13.
"""

import threading
import time

from .canvas_packed import unpacked
from . import Problem, connect
from . import canvas_draw as drawing
from . import canvas_fall as fall
from . import canvas_link as link
from . import canvas_scene as compose

LEFT = 30.0  # seconds without a solution after which nobody watches any more
NEAR = 1e-9


class Parting(link.Task):
    """A last word to a server that runs; none is started for it."""

    def _find(self):
        return connect(start=False, timeout=0.0)


class Player(object):
    """`wanted` is what the canvas wants, `kept` what the session has; `topology` and `state` as the service sends them.
    `before`: the player of the same engine before the definition was saved under another name."""

    def __init__(self, key, title="", before=None):
        self.key, self.title = key, title
        self.wanted = self.kept = self.refused = None
        self.sent = self.form = self.where = self.topology = self.state = self.frames = self.task = None
        self.anchors, self.revision, self.running = {}, -1, True
        self.shown = self.seen = self.component = None
        self.shared = None  # (name, particle, axes) of each anchor, where particles have several
        self.falls = self.hand = None  # why the form falls freely; what the mouse holds of it
        self.ended = self._watched = False
        self._branch, self._met, self._trouble = None, False, None
        self._heard, self._read, self._cost = (-1, link.now()), 0.0, 0.0
        if before is not None:
            self._branch, self.anchors, self._met = before, dict(before.anchors), True
            self.shown = before.shown
            before.end()

    def look(self):
        """Start what has to be done, if nothing is under way; returns at once."""
        self.seen, task = link.now(), self.task
        if task is not None and not task.done:
            return
        problem, self.task = (None, None) if task is None else (task.problem, None if task.problem is None else task)
        if problem is None:
            self._trouble = None
        elif link.wants_server(problem) or problem.status == 404:
            self._lose(task)
            if link.now() - task.until < (0.0 if problem.status == 404 else link.AGAIN):
                return
        elif self.refused is self.wanted:
            return
        if self.frames is not None and (self.frames.ended or self.frames.message):
            self._lose(None)
        if self.kept is not self.wanted:
            self._begin(self._bring, self.wanted)
        elif self._stale():
            self._begin(self._fetch, None)

    def _begin(self, work, wanted):
        def run(client):
            try:
                work(client.session(self.key), wanted)
            except Problem as problem:
                if not link.wants_server(problem) and problem.status != 404:
                    self.refused = wanted
                raise

        self.task = link.Task(run, self._trouble)

    def _lose(self, task):
        """Nothing is known of the session any more, but how it was shown last."""
        self._trouble = task.trouble if task is not None else link.SENTENCES["lost"]
        if task is not None and task.problem.status == 404:
            self._trouble = None  # it was forgotten; it is made again
        link.service.doubt()
        frames, self.frames, self.kept, self.sent = self.frames, None, None, None
        self.running = True
        if frames is not None:
            frames.close()

    def leave(self):
        """Nobody watches any more: the session stands still until somebody does."""
        frames, self.frames, self.kept = self.frames, None, None
        if frames is not None:
            frames.close()
            Parting(lambda client: client.session(self.key).pause(timeout=5.0))

    def end(self):
        """It is not needed any more."""
        self.ended = True
        if self.hand is not None:
            self.hand.let(None)
        self.leave()
        drawing.clear(self.key)

    def wait(self, seconds):
        """Whether nothing is under way, after at most so many seconds."""
        return self.task is None or self.task.wait(seconds)

    # how it stands

    def frame(self):
        """The newest frame with the last edit, or None."""
        frame = self.frames and self.frames.latest()
        fits = frame and frame["revision"] >= self.revision and frame["n"] == self.topology["particles"]
        return frame if fits else None

    @property
    def rests(self):
        """Whether it stands still: at rest, paused, or held at the start."""
        frame = self.frame()
        return bool(frame) and (self.kept.reset or self.kept.paused or frame["status"] != "running")

    @property
    def exact(self):
        """Whether `state` is the state of the newest frame, with all digits."""
        frame = self.frame()
        at = frame and (frame["revision"], frame["iteration"], frame["status"])
        return bool(frame and self.state) and self.state["at"] == at

    @property
    def settled(self):
        """Whether there is nothing to wait for."""
        drags = self.hand is not None and self.hand.busy
        return not drags and self.task is None and self.kept is self.wanted and self.rests and self.exact

    @property
    def trouble(self):
        """A sentence where something fails or is silent, or None."""
        if self.task is not None and self.task.trouble:
            return self.task.trouble
        silent = self._silence()
        return link.SENTENCES["silent"] % silent if silent > link.LATE else None

    def _silence(self):
        """For how long a session that runs has sent no frame [s]."""
        if self.frames is None or self.kept is None or self.rests:
            self._heard = (-1, link.now())
        elif self.frames.received != self._heard[0]:
            self._heard = (self.frames.received, link.now())
        return link.now() - self._heard[1]

    def _stale(self):
        """Whether the state should be read: at rest once, else now and then, and where no frames come."""
        if self.frame() is None:
            return self._silence() > link.LATE
        pause = max(0.5, 10.0 * self._cost)
        return not self.exact if self.rests else link.now() - self._read > pause

    # in threads

    def _bring(self, session, wanted):
        if self._branch is not None:
            self._go_on_from(session)
        if not self._met:
            self._recall(session)
        before = self.anchors
        scene = wanted.scene(self._held(wanted))
        form = compose.structure(scene)
        answer, new = None, self.sent is None or form != self.form
        if not new:
            edit = compose.patch(self.sent, scene)
            try:
                answer = session.edit(dict(edit, gesture="canvas")) if edit else None
            except Problem as problem:
                if problem.status != 422:
                    raise
                new = True  # what cannot be patched after all is a new scene
        if new:
            try:
                answer = session.put(scene, query={"label": self.title[:200]})
            except Problem:
                self.anchors = before  # a scene that is refused gives no anchor a home
                raise
            self.topology = dict(unpacked(session.read("topology", arrays="buffer")), mark=form)
            self.shared = None
        answer = self._set_going(session, wanted, new) or answer
        self.sent, self.form, self.where = scene, form, compose.places(scene)
        self.revision = self.revision if answer is None else answer["revision"]
        if new or self.state is None:
            self._fetch(session, None)
        self._judge(wanted)
        self.falls = fall.sentence(scene, fall.unmatched(self.state["report"]))
        if self.frames is None or self.frames.ended:
            self.frames = session.frames()
            self._keep_watch()
        self.kept, self.refused = wanted, None

    def _set_going(self, session, wanted, new):
        """Hold it at the start or where it is, or let it run; how it stands then."""
        if not wanted.reset:
            self.running = True
            if wanted.paused:
                return session.pause()
            return session.play(fast="true" if wanted.fast else "false")
        if not new and not self.running:
            return None
        session.pause()
        answer, self.running = session.reset(), False
        return answer

    def _fetch(self, session, _):
        began = link.now()
        before = session.read()
        state = unpacked(session.state(arrays="buffer"))
        state["at"] = (before["revision"], state["iterations"], state["status"])
        met = set(state["reactions"]["names"])
        if self.shared is None and any(one["name"] not in met for one in (self.sent or {}).get("anchors") or ()):
            held = unpacked(session.read("anchors"))["anchors"]
            self.shared = [(one["name"], p, one["axes"]) for one in held for p in one["particles"]]
        self.state, self._read = state, link.now()
        self._cost = self._read - began

    def _go_on_from(self, session):
        path = "/v1/sessions/%s/branches" % self._branch.key
        options = {"to": self.key, "label": self.title[:200]}
        try:
            try:
                session.client.post(path, None, options)
            except Problem as problem:
                if problem.slug != "key-taken":
                    raise
                session.delete()  # of a definition that was saved over
                session.client.post(path, None, options)
            for name in ("sent", "form", "where", "topology"):
                setattr(self, name, getattr(self._branch, name))
        except Problem as problem:
            if link.wants_server(problem):
                raise  # else there is nothing to go on from
        self._branch = None

    def _recall(self, session):
        """The homes of the anchors of a session that was left."""
        try:
            scene = unpacked(session.read("scene"))
        except Problem as problem:
            if problem.status != 404:
                raise
            scene = {}
        for anchor in scene.get("anchors") or []:
            if anchor.get("points") and anchor.get("name"):
                home, target = anchor["points"][0], (anchor.get("targets") or anchor["points"])[0]
                self.anchors[anchor["name"]] = {"home": home, "point": target, "met": True}
        self._met = True

    # anchors

    def _held(self, wanted):
        """The anchors with their homes; see `canvas_scene.compose`."""
        claimed = self._claims(wanted)
        new = []
        for anchor, known in zip(wanted.anchors, claimed):
            keeps = known and known["met"] and anchor["target"] is None
            new.append(dict(anchor, home=known["home"] if keeps else anchor["point"], known=known))
        moved = [one for one in new if _apart(one["home"], one["point"])]
        if not moved or not self._elsewhere(wanted):
            moved = [one for one in moved if wanted.reset and _apart(one["known"]["point"], one["point"])]
        if moved:
            self._rehome(moved, wanted)
        new = [dict(one, target=one["target"] or one["point"]) for one in new]
        self.anchors = {one["name"]: {"home": one["home"], "point": one["point"], "met": True} for one in new}
        return new

    def _claims(self, wanted):
        """For each anchor what is known of it: by its name, or, where items came, went or changed places, by where
        it was last."""
        groups = {}
        for anchor in wanted.anchors:
            groups.setdefault(anchor["group"], []).append(anchor)
        by_group, free = {}, dict(self.anchors)
        for name, known in self.anchors.items():
            by_group.setdefault(name.rpartition(" ")[0], {})[name] = known
        found = {}
        for group, members in groups.items():
            known = by_group.get(group, {})
            same = set(known) == {one["name"] for one in members}
            mixed = same and sorted(one["point"] for one in members) == sorted(k["point"] for k in known.values())
            for one in members if same and not mixed else ():
                found[one["name"]] = free.pop(one["name"])
        left = [one for one in wanted.anchors if one["name"] not in found]
        for one in left:
            name = next((n for n in sorted(free) if not _apart(free[n]["point"], one["point"])), None)
            if name is not None:
                found[one["name"]] = free.pop(name)
        for one in left:
            if one["name"] not in found:
                found[one["name"]] = free.pop(one["name"], None)
        return [found[one["name"]] for one in wanted.anchors]

    def _elsewhere(self, wanted):
        """Whether the forces act on other places than before."""
        scene = wanted.scene([])
        return self.where is not None and compose.places(scene) != self.where

    def _rehome(self, moved, wanted):
        """Anchors that were moved, in other geometry or while it is held at the start: where a particle lies at one,
        that is its home now."""
        scene = wanted.scene([])
        reach, cells = scene.get("weld_tolerance", 0.001), {}
        for spot in compose.spots(scene):
            cells.setdefault(_cell(spot, reach), []).append(spot)
        for one in moved:
            a, b, c = _cell(one["point"], reach)
            near = [(a + i, b + j, c + k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
            if any(not _apart(spot, one["point"], reach) for cell in near for spot in cells.get(cell, ())):
                one["home"] = one["point"]

    def _judge(self, wanted):
        """Anchors that met no particle have no home yet."""
        for unmatched in self.state["report"]["unmatched"]:
            parts = unmatched["pointer"].split("/")
            if parts[1] == "anchors":
                self.anchors[wanted.anchors[int(parts[2])]["name"]]["met"] = False

    def _keep_watch(self):
        """Leave the session in peace once nobody looks any more, and draw nothing once the component is gone."""
        if self._watched:
            return
        self._watched = True

        def watch():
            while not self.ended:
                time.sleep(1.0)
                if self.frames is not None and link.now() - self.seen > LEFT:
                    self.leave()
                if _gone(self.component):
                    self.end()

        thread = threading.Thread(target=watch, name="hookean-watch")
        thread.daemon = True
        thread.start()


def _gone(component):
    """Whether a component was deleted, or its definition closed."""
    document = None if component is None else component.OnPingDocument()
    if component is None or document is None:
        return component is not None
    try:
        from Grasshopper import Instances

        if getattr(document, "Owner", None) is not None:
            return False  # in a cluster
        return all(one.RuntimeID != document.RuntimeID for one in Instances.DocumentServer)
    except (ImportError, AttributeError, TypeError):
        return False


def _cell(spot, size):
    return tuple(int(part // max(size, NEAR)) for part in spot)


def _apart(a, b, reach=NEAR):
    return sum((p - q) ** 2 for p, q in zip(a, b)) > reach * reach
