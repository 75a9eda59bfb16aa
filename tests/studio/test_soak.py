"""Drag, pause and reload, a minute of it, or two hours with HOOKEAN_SOAK=1: the page's memory stays flat."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

from serving import SOAK

from .browser import Studio, net

SECONDS = 7200.0 if SOAK else 60.0
SIDE = 50
FRAME = 4 * (3 * SIDE**2 + 2 * SIDE * (SIDE - 1) + 3 * 4)
"""Bytes of one frame's numbers: positions, forces of springs, reactions."""
DRAGS = 5
"""In one life of the page; then it is loaded anew."""

CONTEXTS = """() => {
    window.contexts = 0;
    const real = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...told) {
        if (kind.startsWith("webgl")) window.contexts += 1;
        return real.call(this, kind, ...told);
    };
}"""


class Weight:
    """What the page holds, once all is thrown away that can be."""

    def __init__(self, studio: Studio) -> None:
        self.devtools = studio.page.context.new_cdp_session(studio.page)
        self.devtools.send("Performance.enable")
        self.page = studio.page

    def now(self) -> dict[str, float]:
        """Bytes of scripts and of their arrays; counts of nodes, listeners and drawing contexts."""
        for _ in range(2):
            self.devtools.send("HeapProfiler.collectGarbage")
        heap: dict[str, Any] = self.devtools.send("Runtime.getHeapUsage")
        counts = {one["name"]: one["value"] for one in self.devtools.send("Performance.getMetrics")["metrics"]}
        return {
            "bytes": heap["usedSize"] + heap.get("backingStorageSize", 0),
            "nodes": counts["Nodes"],
            "listeners": counts["JSEventListeners"],
            "contexts": self.page.evaluate("() => window.contexts"),
        }


def test_drags_pauses_and_reloads_leave_nothing_behind(studio: Studio, capsys: pytest.CaptureFixture[str]):
    """Bounds: within a life of the page less than one frame is kept for each drag; from life to life no more nodes,
    listeners or contexts, and less than one frame for each life."""
    page, service = studio.page, studio.service
    page.add_init_script(f"({CONTEXTS})()")
    service.put("soak", net(SIDE))
    studio.open("soak")
    weight = Weight(studio)
    lives: list[list[dict[str, float]]] = []
    until = time.monotonic() + SECONDS
    while time.monotonic() < until or len(lives) < 4:
        page.reload()
        studio.drawing()
        played_dragged_paused(studio)  # what is made once is made
        life = [weight.now()]
        for _ in range(DRAGS):
            played_dragged_paused(studio)
            life.append(weight.now())
        lives.append(life)
        service.act("soak", "reset")

    grown = [life[-1]["bytes"] - life[0]["bytes"] for life in lives]
    ends = np.array([life[-1]["bytes"] for life in lives])
    slope = float(np.polyfit(np.arange(len(ends)), ends, 1)[0])
    with capsys.disabled():
        print(
            f"\n{len(lives)} lives of {DRAGS} drags: {ends[0] / 1e6:.2f} MB after the first, {ends[-1] / 1e6:.2f} MB"
            f" after the last; {np.median(grown) / DRAGS / 1e3:.1f} kB a drag, {slope / 1e3:.1f} kB a life;"
            f" a frame is {FRAME / 1e3:.0f} kB"
        )
    assert np.median(grown) < DRAGS * FRAME
    assert slope < FRAME
    for name in ("nodes", "listeners", "contexts"):
        assert max(life[-1][name] for life in lives[-2:]) <= max(life[-1][name] for life in lives[:2]), name
        assert all(life[-1][name] <= life[0][name] for life in lives[1:]), name
    assert {life[-1]["contexts"] for life in lives} == {1}
    assert studio.stats()["staleFramesDrawn"] == 0


def played_dragged_paused(studio: Studio) -> None:
    """Play, an anchor to and fro in the hand, pause, and back where it was."""
    studio.press("Play")
    received = studio.stats()["framesReceived"]
    studio.drag(0, 30, -20, steps=8)
    studio.until(lambda: studio.stats()["framesReceived"] > received + 5)
    studio.press("Pause")
    studio.until(lambda: not studio.service.summary("soak")["playing"])
    studio.press("Undo")
    studio.until(lambda: studio.service.summary("soak")["undo"] == 0)
