"""Drag, pause and reload, in two lives of the page, or for two hours with HOOKEAN_SOAK=1: memory stays flat."""

from __future__ import annotations

import time
from typing import Any

import pytest

from serving import SOAK

from .browser import Studio, net

SECONDS = 7200.0 if SOAK else 0.0
SIDE = 100 if SOAK else 50
DRAGS = 100 if SOAK else 2
WARM = 3 if SOAK else 1
"""In one life of the page; then it is loaded anew."""
FRAME = 4 * (3 * SIDE**2 + 2 * SIDE * (SIDE - 1) + 3 * 4)
"""Bytes of one frame's numbers: positions, forces of springs, reactions."""
KEPT = 20 * FRAME if SOAK else 1.5e6
"""Bytes that a life may grow by: for code that is compiled while it runs (1.6 MB by the hundredth drag, nothing after),
a minute of charts and the text of a scene on its way (1.4 MB). A drag has some 25 frames: one in a hundred, in
a short life three in five, left behind are more."""

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
        """Bytes of scripts and of their arrays, the least of some seconds, for messages on their way come and go;
        counts of nodes, listeners and drawing contexts."""
        used = []
        for _ in range(8 if SOAK else 3):
            self.devtools.send("HeapProfiler.collectGarbage")
            heap: dict[str, Any] = self.devtools.send("Runtime.getHeapUsage")
            used.append(heap["usedSize"] + heap.get("backingStorageSize", 0))
            self.page.wait_for_timeout(400)
        counts = {one["name"]: one["value"] for one in self.devtools.send("Performance.getMetrics")["metrics"]}
        return {
            "bytes": min(used),
            "nodes": counts["Nodes"],
            "listeners": counts["JSEventListeners"],
            "contexts": self.page.evaluate("() => window.contexts"),
        }


@pytest.mark.soak
def test_drags_pauses_and_reloads_leave_nothing_behind(tab: Studio, capsys: pytest.CaptureFixture[str]):
    """Memory within the bound, no nodes or listeners for each drag, one drawing context."""
    studio, page, service = tab, tab.page, tab.service
    page.add_init_script(f"({CONTEXTS})()")
    scene = net(SIDE)
    scene["settings"]["drag"] = 0.5  # else each jump of the anchor stays in the net, until it flies across the picture
    service.put("soak", scene)
    studio.open("soak")
    weight = Weight(studio)
    lives: list[tuple[dict[str, float], dict[str, float]]] = []
    until = time.monotonic() + SECONDS
    while time.monotonic() < until or len(lives) < 2:
        page.reload()
        studio.drawing()
        for _ in range(WARM):  # what is made once is made
            played_dragged_paused(studio)
        first = weight.now()
        for _ in range(DRAGS):
            played_dragged_paused(studio)
        last = weight.now()
        assert not lives or last["bytes"] - first["bytes"] < KEPT  # in the first one scripts are compiled
        lives.append((first, last))
        assert studio.stats()["staleFramesDrawn"] == 0
        service.act("soak", "reset")

    grown = [last["bytes"] - first["bytes"] for first, last in lives[1:]]
    starts = [first["bytes"] for first, _ in lives]
    with capsys.disabled():
        print(
            f"\n{len(lives)} lives of the page with {DRAGS} drags each: {starts[0] / 1e6:.2f} MB to begin with, at most"
            f" {max(grown) / 1e6:.2f} MB more at the end of one, {(starts[-1] - starts[0]) / 1e6:+.2f} MB after all;"
            f" a frame has {FRAME / 1e6:.2f} MB"
        )
    assert max(starts) - starts[0] < 0.5 * starts[0]  # a life that remained would weigh as much as this one
    for name in ("nodes", "listeners"):  # a sentence more or less is none for every drag
        assert max(last[name] - first[name] for first, last in lives) < 12, name
        assert max(first[name] for first, _ in lives) - lives[0][0][name] < 12, name
    assert {last["contexts"] for _, last in lives} == {1}


def played_dragged_paused(studio: Studio) -> None:
    """Play, an anchor to and fro in the hand, pause, and back where it was."""
    studio.press("Play")
    received = studio.stats()["framesReceived"]
    studio.drag(0, 30, -20, steps=8)
    studio.until(lambda: studio.stats()["framesReceived"] > received + 5)
    studio.press("Pause")
    studio.until(lambda: not studio.service.summary("soak")["playing"])
    studio.press("Undo")
    back = studio.until(lambda: (now := studio.service.summary("soak"))["undo"] == 0 and now)["revision"]
    studio.until(lambda: studio.stats()["revisionDrawn"] >= back)
