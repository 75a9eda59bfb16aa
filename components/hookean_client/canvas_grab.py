"""Grab: particles of an Engine are dragged by the mouse in Rhino's viewports.

A press takes the particle nearest to the line of sight, if it is within a range of it. While the button is down, the
particle is held, or pulled by a spring, where the mouse is, in the plane through it across the line of sight; then it
is free again. The mouse never waits: a thread sends the newest place to the session. For Python 2.7 to 3.13.
"""

import threading

from .canvas_geometry import Unfit
from .canvas_items import text
from . import canvas_words as words
from . import FAILURES, Problem
from . import canvas_geometry as geometry
from . import canvas_link as link
from .canvas_values import default, flag

KIND, RANGE = "grab", 3.0
TINY = 1e-12


def grab(ghenv, on, reach, strength):
    """What an Engine needs to know, as text; None while it is switched off."""

    def work():
        if not flag(on, True):
            return None
        numbers = []
        for name, given, usual in (("range", reach, RANGE), ("strength", strength, 0.0)):
            number = geometry.number(default(given, usual)[0])
            if not number >= 0.0 or number > 1e12:
                raise Unfit("%s: %s given; a number from 0 to 1e12 is expected" % (name, number))
            numbers.append(number)
        source = words.source(ghenv)
        return text({"kind": KIND, "range": numbers[0], "strength": numbers[1], "source": source})

    return words.told(ghenv, work)


def follow(ghenv, player, wanted):
    """Let the mouse drag particles of a player, as the Grab that is connected wants it (None: not)."""
    hand = player.hand
    if hand is None and wanted is not None:
        hand = player.hand = Hand(player)
    if hand is not None:
        hand.ghenv = ghenv
        hand.let(wanted)


class Hand(object):
    """What the mouse holds of a player: `particle`, or None."""

    def __init__(self, player):
        self.player, self.ghenv, self.particle = player, None, None
        self._wanted = self._plane = self._mouse = None
        self._goal, self._sent, self._news = None, None, threading.Event()
        self._dragged = set()  # once: that no anchor holds them is known

    @property
    def busy(self):
        """Whether it holds something, or has something to send."""
        return self.particle is not None or self._news.is_set()

    def let(self, wanted):
        """Take hold as wanted from now on; None: let go."""
        self._wanted = wanted
        if wanted is None:
            self.drop()
        if self._mouse is None and wanted is not None:
            self._mouse = _mouse(self)
        if self._mouse is not None:
            self._mouse.Enabled = wanted is not None

    def press(self, eye, beyond):
        """Take the particle nearest to the line of sight through two points; whether there is one within reach."""
        player, way = self.player, _unit([b - a for a, b in zip(eye, beyond)])
        frame = player.frame() if player.kept is not None and not player.ended else None
        if self._wanted is None or not frame or not way or player.kept.reset or player.kept.paused:
            return False
        told = (player.state or {}).get("reactions", {})
        held = {p for p, exact in zip(told.get("particles", ()), told.get("exact", ())) if exact} - self._dragged
        flat, best, least = frame["particles"], None, self._wanted["range"]
        for i in range(frame["n"]):
            apart = [flat[3 * i + c] - eye[c] for c in range(3)]
            along = _dot(apart, way)
            far = max(0.0, _dot(apart, apart) - along * along) ** 0.5
            if far <= least and along > 0.0 and i not in held:
                best, least = i, far
        if best is None:
            return False
        self.particle, self._plane = best, (flat[3 * best : 3 * best + 3], way)
        self._dragged.add(best)
        return self.drag(eye, beyond)

    def drag(self, eye, beyond):
        """Bring what is held to where the line of sight meets its plane."""
        start, normal = self._plane
        way = [b - a for a, b in zip(eye, beyond)]
        steep = _dot(way, normal)
        if abs(steep) > TINY:
            part = _dot([s - e for s, e in zip(start, eye)], normal) / steep
            self._send([self.particle, [e + part * w for e, w in zip(eye, way)], self._wanted["strength"]])
        return True

    def drop(self):
        """Let go."""
        if self.particle is not None:
            self.particle = None
            self._send(None)

    def _send(self, goal):
        self._goal = goal
        if not self._news.is_set():
            self._news.set()
            thread = threading.Thread(target=self._work, name="hookean-grab")
            thread.daemon = True
            thread.start()
        words.schedule(self.ghenv, 1)

    def _work(self):
        """Send the newest goal, until there is none that was not sent."""
        while self._goal is not self._sent:
            goal, before = self._goal, self._sent
            if before is not None and goal is not None and before[0] != goal[0]:
                goal = None  # let go of the other one first
            try:
                session = link.service.client().session(self.player.key)
                session.edit(dict(_edit(before, goal), gesture="grab"))
                answer = session.play(fast="true" if self.player.kept.fast else "false")  # what rests goes on
                self.player.revision = max(self.player.revision, answer["revision"])
            except (Problem,) + FAILURES:  # the session is gone, or new: no hand is in it
                self.particle = None
            self._sent = goal
        self._news.clear()
        if self._goal is not self._sent and not self._news.is_set():
            self._send(self._goal)


def _edit(before, goal):
    """The edit that leads from one goal (particle, place, strength) to another; None: nothing is held."""
    soft = before is not None and before[2] > 0.0
    if goal is None:
        return {"remove": [KIND]} if soft else {"release": before[:1] if before else []}
    particle, place, strength = goal
    if strength > 0.0 and soft:
        return {"forces": {KIND: {"targets": [place]}}}
    if strength > 0.0:
        spring = {"kind": "anchor_spring", "name": KIND, "particles": [particle], "targets": [place]}
        return {"add": [dict(spring, strength=strength)]}
    return {"pin": [{"particles": [particle], "targets": [place]}]}


def _mouse(hand):
    """Where the mouse is in Rhino's viewports, from now on; None outside of Rhino."""
    try:
        from Rhino.UI import MouseCallback
    except ImportError:
        return None

    class Mouse(MouseCallback):
        __namespace__ = "hookean"  # of the class, where Python meets .NET

        def OnMouseDown(self, e):
            if str(e.MouseButton) == "Left" and hand.press(*_sight(e)):
                e.Cancel = True

        def OnMouseMove(self, e):
            if hand.particle is not None:
                e.Cancel = hand.drag(*_sight(e))

        def OnMouseUp(self, e):
            if hand.particle is not None:
                hand.drop()
                e.Cancel = True

    return Mouse()


def _sight(e):
    """Two points of the line of sight through the mouse, the nearer one first."""
    line = e.View.ActiveViewport.ClientToWorld(e.ViewportPoint)
    ends = [[end.X, end.Y, end.Z] for end in (line.From, line.To)]
    toward = e.View.ActiveViewport.CameraDirection
    down = _dot([b - a for a, b in zip(*ends)], [toward.X, toward.Y, toward.Z])
    return ends if down >= 0.0 else ends[::-1]


def _dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def _unit(way):
    length = _dot(way, way) ** 0.5
    return [part / length for part in way] if length > TINY else None
