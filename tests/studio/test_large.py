"""Large models: what a drag has the service send and the page read, counted."""

from __future__ import annotations

import json
from typing import Any

import pytest

from soak import SOAK

from .browser import Studio, net

SIDE = 316 if SOAK else 40
MOVES = 8


@pytest.fixture
def drags(tab: Studio) -> tuple[Studio, list[str], list[int]]:
    """A net at rest, paused; addresses that are read from now on, and bytes of binary messages of its socket."""
    read: list[str] = []
    sizes: list[int] = []
    devtools = tab.page.context.new_cdp_session(tab.page)
    devtools.send("Network.enable")

    def heard(event: Any) -> None:
        if event["response"]["opcode"] == 2:
            sizes.append(3 * len(event["response"]["payloadData"]) // 4)

    devtools.on("Network.webSocketFrameReceived", heard)
    tab.service.put("large", net(SIDE))
    tab.open("large")
    tab.press("Pause")
    tab.place(0)
    tab.page.on("request", lambda request: read.append(request.url))
    return tab, read, sizes


@pytest.mark.soak
def test_a_drag_reads_no_scene_and_is_told_what_has_changed(drags: tuple[Studio, list[str], list[int]]) -> None:
    """One corner of a paused net: its 3 coordinates, 2 springs and the 12 numbers of reactions at most, 8 bytes each
    behind a header of 64. Anchors are read once, when the hand has let go."""
    studio, read, sizes = drags
    page = studio.page
    x, y = studio.place(0)
    before = len(sizes)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, MOVES + 1):
        drawn = studio.stats()["revisionDrawn"]
        page.mouse.move(x + 6 + 2 * step, y - step)
        studio.until(lambda drawn=drawn: studio.stats()["revisionDrawn"] > drawn)
    moved = sizes[before:]
    during = [address for address in read if address.rsplit("/", 1)[1] in ("scene", "topology", "anchors", "state")]
    assert during == []
    assert len(moved) >= MOVES and max(moved) <= 64 + 8 * (3 + 2 + 12) + 3
    page.mouse.up()
    studio.until(lambda: any(address.endswith("/anchors") for address in read))
    assert not any(address.endswith(("/scene", "/topology")) for address in read)
    target = studio.service.anchors("large")[0]["targets"][0]
    assert studio.particles()[0].tolist() == pytest.approx(target, rel=1e-6)


@pytest.mark.soak
def test_an_edit_of_a_force_has_the_scene_read_again(drags: tuple[Studio, list[str], list[int]]) -> None:
    """Once, as it changes more than the anchors; the topology stays."""
    studio, read, _ = drags
    studio.service.edit("large", {"forces": {"1": {"vector": [0, 0, -0.03]}}})
    studio.until(lambda: any(address.endswith("/scene") for address in read))
    assert not any(address.endswith(("/topology", "/anchors")) for address in read)
    assert json.dumps(studio.service.scene("large")).count("-0.03")
