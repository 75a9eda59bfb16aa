"""Functions for Grasshopper's Hops component, and the task that runs one, in a worker.

Values come as text inside JSON, in branches of data trees; geometry as rhino3dm's `Encode` writes it. Hops keeps
answers for ever, so everything here depends on its inputs alone.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from hookean.errors import InputError
from hookean.scene.text import parse
from hookean_server.hops import cables as hops_cables
from hookean_server.hops import discretize as hops_discretize
from hookean_server.hops import membranes as hops_membranes
from hookean_server.hops import motion as hops_motion
from hookean_server.hops import relax as hops_relax
from hookean_server.hops import structures as hops_structures
from hookean_server.hops.model import Function, Inputs
from hookean_server.workers.task import Cancelled, Clock, Done

LONGEST = 90.0  # seconds of solving; Hops waits for 100

FUNCTIONS: Mapping[str, Function] = {
    **hops_relax.FUNCTIONS,
    **hops_discretize.FUNCTIONS,
    **hops_cables.FUNCTIONS,
    **hops_membranes.FUNCTIONS,
    **hops_structures.FUNCTIONS,
    **hops_motion.FUNCTIONS,
}
"""Every function by its name; the routes and their guard walk this table."""


def solve(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The answer to POST /solve. Raises InputError with a sentence for the canvas."""
    clock = Clock()
    value = parse(body)
    if not isinstance(value, dict) or not isinstance(value.get("values"), list):
        raise InputError("/values", "a request of Hops has a list of values")
    name = str(value.get("pointer")).strip("/")
    if name not in FUNCTIONS:
        known = ", ".join(f"/{one}" for one in FUNCTIONS)
        raise InputError("/pointer", f"unknown function; known: {known}")
    function = FUNCTIONS[name]
    inputs = Inputs(function, value, min(LONGEST, options["seconds"]), options["largest"], options["bytes"])
    clock.lap("decode")
    found = function.run(inputs, cancelled)
    clock.lap("solve")
    answer = {"values": function.answer(found, inputs.bytes), "errors": [], "warnings": inputs.warnings}
    text = json.dumps(answer).encode()
    clock.lap("encode")
    return Done(text, timing=clock.parts)
