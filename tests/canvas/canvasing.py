"""A canvas in a test: stand-ins of Rhino and Grasshopper, components, and solutions until nothing is scheduled."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from hookean_canvas.run import stand_in
from serving import HANG


class Bench:
    """A document with components; `run` solves one of them as the canvas would."""

    def __init__(self, path: str | None = "/models/cable.gh", identity: Any = None) -> None:
        self.document = stand_in.Document(path, identity)

    def component(self, name: str, inputs: tuple[str, ...] = (), guid: Any = None) -> Any:
        """`ghenv` of a new component."""
        return stand_in.Environment(stand_in.Component(name, inputs=inputs, guid=guid, document=self.document))

    def solve(self, ghenv: Any, work: Callable[[], Any]) -> Any:
        """One solution: what `work()` gives."""
        ghenv.Component.messages, self.document.scheduled = [], []
        return work()

    def run(self, ghenv: Any, work: Callable[[], Any], until: Callable[[Any], Any] | None = None) -> Any:
        """Solutions until `until(what work gave)`, or until none is scheduled."""
        end = time.monotonic() + HANG
        while True:
            found = self.solve(ghenv, work)
            if until(found) if until is not None else not self.document.scheduled:
                return found
            said = (ghenv.Component.Message, ghenv.Component.messages)
            assert self.document.scheduled, f"nothing is scheduled: {said}"
            assert time.monotonic() < end, f"waited too long: {said}"
            time.sleep(self.document.scheduled[0][0] / 1000.0)


def let_go() -> None:
    """As after Rhino was closed: no thread and no connection is left of any client in this process, neither of the
    installed one nor of those that definitions carry."""
    clients = {name: module for name, module in sys.modules.items() if name.startswith("hookean_client")}
    for name, module in clients.items():
        if name.endswith(".canvas_engine"):
            for player in module._players.values():
                player.ended = True
                player.wait(HANG)
                if player.frames is not None:
                    player.frames.close()
                player.frames = None
            module._players.clear()
            module._keys.clear()
    for name, module in clients.items():
        if name.endswith(".canvas_link"):
            module.service.forget()


def sentences(ghenv: Any, level: str = "") -> list[str]:
    """What a component says, of one level or of all."""
    return [text for known, text in ghenv.Component.messages if level in ("", known)]


def point(x: float, y: float, z: float) -> Any:
    return sys.modules["Rhino"].Geometry.Point3d(x, y, z)


def line(a: tuple[float, float, float], b: tuple[float, float, float]) -> Any:
    return sys.modules["Rhino"].Geometry.Line(point(*a), point(*b))


def xyz(place: Any) -> tuple[float, float, float]:
    return (place.X, place.Y, place.Z)
