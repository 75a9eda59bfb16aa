"""Making the scene of a family. Runs in a worker."""

from __future__ import annotations

from typing import Any

from hookean.errors import InputError
from hookean.scene.families import found
from hookean.scene.text import parse
from hookean.values.units import Units
from hookean_server.workers.task import Cancelled, Clock, Done


def make_family(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The scene of the family `options["name"]` with the units and parameters in `body`, as JSON. Raises InputError."""
    clock = Clock()
    value = parse(body)
    if not isinstance(value, dict) or not set(value) <= {"units", "parameters"}:
        raise InputError("/", "give an object with units and parameters, both optional")
    parameters = value.get("parameters", {})
    if not isinstance(parameters, dict):
        raise InputError("/parameters", "give an object of parameters by name")
    clock.lap("decode")
    scene = found(options["name"]).scene(parameters, Units.read(value.get("units", {})))
    clock.lap("make")
    return Done(scene.canonical.encode(), timing=clock.parts)
