"""Reading the scene of an example. Runs in a worker."""

from __future__ import annotations

import functools
from typing import Any

from hookean.commands.examples import Example, examples
from hookean_server.workers.task import Cancelled, Clock, Done


def read_example(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The scene of the example `options["name"]`, as JSON."""
    clock = Clock()
    found = by_name()[options["name"]].scene()
    clock.lap("read")
    return Done(found.canonical.encode(), timing=clock.parts)


@functools.cache
def by_name() -> dict[str, Example]:
    """The examples by the names of their folders."""
    return {example.name: example for example in examples()}
