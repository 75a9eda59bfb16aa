"""A scene in motion, as frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from hookean.running.frame import Frame
from hookean.running.result import Status
from hookean.running.script import Script
from hookean.running.simulation import Simulation, Source
from hookean.scene.scene import Scene


def simulate(
    scene: Scene,
    frames: int | None = None,
    *,
    script: Script | Mapping[str, Any] | str | None = None,
    stream: Source | None = None,
) -> Iterator[Frame]:
    """Frames of a scene in motion, `sub_iterations` steps apart, bouncing included; ends at rest, after `frames` or
    with the frame in which the stream ends. A script that still moves something keeps it running.

    The first frame is the start. The scene's solver, or `verlet` where that is `auto`.
    """
    running = Simulation(scene, script, stream)
    yield running.frame()
    shown = 0
    while running.status is Status.RUNNING and not running.over and (frames is None or shown < frames):
        running.step()
        shown += 1
        yield running.frame()
