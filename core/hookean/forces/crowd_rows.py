"""Rows of elements that all feel one another: their columns, and where those of one room end."""

from __future__ import annotations

from typing import Any

from hookean.compiled.marks import device
from hookean.forces.neighbours import capacity

STIFFNESS, SKIN, ROOM = 2, 3, 4  # columns of parameters, after the two that neighbours read
NEAREST = 1e-20  # distance of centres from which a pair has a direction


@device
def end_of_crowd(parameters: Any, start: Any) -> Any:
    """Where the elements of one room end."""
    room, count = parameters[start, ROOM], parameters.shape[0]
    stop = start + capacity(room)
    if stop > count or parameters[stop - 1, ROOM] != room or (stop < count and parameters[stop, ROOM] == room):
        stop = start
        while stop < count and parameters[stop, ROOM] == room:
            stop += 1
    return stop
