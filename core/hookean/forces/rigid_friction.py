"""Dry friction of two bodies that touch: they stick where they met, and slip where the friction is not enough.

What holds them is as stiff along the area of contact as across it: a force by how far one has moved along the other
where they press, and a moment by how far it has turned about the normal. Neither is larger than Coulomb's law allows,
mu N and mu N r, r the radius of gyration of the area. Where the first of two bodies would be on the other without these
forces is kept in a row of the first, or of the second where the first has none left. Before a step has ended that is
where both were at the start.
Source: Cundall and Strack, "A discrete numerical model for granular assemblies", 1979.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.convex import AREA, AT, AXIS, FORCE, HEAD, MOMENT, POLAR, PRESS, TURN
from hookean.forces.groups import following

START = 6  # column of the parameters: where the centre of a body was at the start, x y z
PARTNER, STARTED, PLACE, FRAME, ANCHOR = (
    0,
    1,
    2,
    5,
    14,
)  # of the memory of a row: number of the other body and 1, whether
# a step has ended, centre and rotation of the body on the other without friction; how many numbers
SLIP, ARM, HERE, TURNED = 3, 4, 5, 6  # rows of the room: how far it is off, from the centres to the contact, rotation
OLD = 9


@device
def slot(memory: Any, parameters: Any, first: Any, partner: Any) -> Any:
    """The row of a body that remembers a contact; -1 if none does."""
    e = first
    while e >= 0:
        if memory[e, PARTNER] == partner:
            return e
        e = following(parameters, e)
    return -1


@device
def row_of(memory: Any, parameters: Any, bodies: Any, a: Any, b: Any, sign: Any) -> Any:
    """The row that remembers the contact of two bodies, of the first or of the second; -1 if none does."""
    row = slot(memory, parameters, int(bodies[a, HEAD]), sign * (b + 1.0))
    return row if row >= 0 else slot(memory, parameters, int(bodies[b, HEAD]), sign * (a + 1.0))


@device
def claim(memory: Any, parameters: Any, bodies: Any, a: Any, b: Any, row: Any) -> Any:
    """Mark the row that remembers the contact of two bodies: the row that has it, or a free row of the first, or a free
    row of the second. -1 if no row is free, as under a slab that more bodies touch than there are rows."""
    if row >= 0:
        memory[row, PARTNER] = -memory[row, PARTNER]
        return row
    for body, other in ((a, b), (b, a)):
        free = slot(memory, parameters, int(bodies[body, HEAD]), 0.0)
        if free >= 0:
            memory[free, PARTNER] = other + 1.0
            return free
    return -1


@device
def arms(bodies: Any, a: Any, b: Any, origin: Any, hit: Any, room: Any) -> None:
    """From the centres of two bodies to where they press on each other, the last in the frame of the first, and how the
    first is turned in that of the other."""
    for c in range(3):
        at = hit[AT + c] + bodies[origin, c]
        room[ARM, c], room[HERE, c] = at - bodies[a, c], at - bodies[b, c]
    for i in range(3):
        room[0, i] = 0.0
        for k in range(3):
            room[0, i] += bodies[a, TURN + 3 * k + i] * room[ARM, k]
            room[TURNED + i, k] = 0.0
            for c in range(3):
                room[TURNED + i, k] += bodies[b, TURN + 3 * c + i] * bodies[a, TURN + 3 * c + k]


@device
def apart(parameters: Any, memory: Any, bodies: Any, a: Any, b: Any, origin: Any, row: Any, hit: Any, room: Any) -> Any:
    """How far the first body has slipped on the other, along the area of contact, and the sine of the angle that it has
    turned; zero where it came to it in this step."""
    one, other = int(bodies[a, HEAD]), int(bodies[b, HEAD])
    arms(bodies, a, b, origin, hit, room)
    for i in range(3):
        room[SLIP, i] = 0.0
    if row < 0 and memory[one, STARTED] != 0.0:
        return 0.0
    for i in range(3):
        room[1, i] = memory[row, PLACE + i] if row >= 0 else parameters[one, START + i] - parameters[other, START + i]
        for k in range(3):
            old = 1.0 if i == k else 0.0
            room[OLD + i, k] = memory[row, FRAME + 3 * i + k] if row >= 0 else old
            room[1, i] += room[OLD + i, k] * room[0, k]
    along, turned = 0.0, 0.0
    for i in range(3):
        p, q, axis, there = (i + 1) % 3, (i + 2) % 3, 0.0, 0.0
        for k in range(3):
            axis += 0.5 * (room[TURNED + q, k] * room[OLD + p, k] - room[TURNED + p, k] * room[OLD + q, k])
            there += bodies[b, TURN + 3 * i + k] * room[1, k]
        for k in range(3):
            turned += axis * bodies[b, TURN + 3 * k + i] * hit[AXIS + k]
        room[SLIP, i] = room[HERE, i] - there
        along += room[SLIP, i] * hit[AXIS + i]
    for i in range(3):
        room[SLIP, i] -= along * hit[AXIS + i]
    return turned


@device
def allowed(hit: Any, rough: Any, turned: Any, room: Any) -> Any:
    """The parts of slip and of turn that friction can hold."""
    square = 0.0
    for i in range(3):
        square += room[SLIP, i] * room[SLIP, i]
    if not hit[AREA] > 0.0:
        return 0.0, 0.0
    far, most = np.sqrt(square) * hit[AREA], rough * hit[PRESS]
    round_it, moment = abs(turned) * hit[POLAR], most * np.sqrt(hit[POLAR] / hit[AREA])
    return most / far if far > most else 1.0, moment / round_it if round_it > moment else 1.0


@device
def grip(parameters: Any, memory: Any, bodies: Any, a: Any, b: Any, origin: Any, k: Any, rough: Any, desk: Any) -> None:
    """Add the friction of two bodies that touch."""
    hit, room = desk[1][0], desk[2]
    row = row_of(memory, parameters, bodies, a, b, 1.0)
    turned = apart(parameters, memory, bodies, a, b, origin, row, hit, room)
    slip, twist = allowed(hit, rough, turned, room)
    for i in range(3):
        room[SLIP, i] *= -k * hit[AREA] * slip
    for i in range(3):
        p, q = (i + 1) % 3, (i + 2) % 3
        moment = -k * hit[POLAR] * twist * turned * hit[AXIS + i]
        bodies[a, FORCE + i] += room[SLIP, i]
        bodies[b, FORCE + i] -= room[SLIP, i]
        bodies[a, MOMENT + i] += moment + room[ARM, p] * room[SLIP, q] - room[ARM, q] * room[SLIP, p]
        bodies[b, MOMENT + i] -= moment + room[HERE, p] * room[SLIP, q] - room[HERE, q] * room[SLIP, p]


@device
def hold_on(parameters: Any, memory: Any, bodies: Any, a: Any, b: Any, origin: Any, rough: Any, desk: Any) -> None:
    """Remember where the first body would be on the other without friction, up to what that can hold."""
    hit, room = desk[1][0], desk[2]
    row = row_of(memory, parameters, bodies, a, b, -1.0)
    turned = apart(parameters, memory, bodies, a, b, origin, row, hit, room)
    slip, twist = allowed(hit, rough, turned, room)
    row = claim(memory, parameters, bodies, a, b, row)
    if row < 0:
        return
    sine = -twist * turned
    less = 1.0 - np.sqrt(max(1.0 - sine * sine, 0.0))
    for i in range(3):  # the normal in the frame of the other
        room[1, i] = 0.0
        for c in range(3):
            room[1, i] += bodies[b, TURN + 3 * c + i] * hit[AXIS + c]
    for k_ in range(3):
        along = 0.0
        for i in range(3):
            along += room[1, i] * room[TURNED + i, k_]
        for i in range(3):
            p, q = (i + 1) % 3, (i + 2) % 3
            cross = room[1, p] * room[TURNED + q, k_] - room[1, q] * room[TURNED + p, k_]
            bent = room[TURNED + i, k_] * (1.0 - less) + sine * cross + less * along * room[1, i]
            memory[row, FRAME + 3 * i + k_] = bent
    for i in range(3):
        there = 0.0
        for c in range(3):
            there += bodies[b, TURN + 3 * c + i] * (room[HERE, c] - slip * room[SLIP, c])
            there -= memory[row, FRAME + 3 * i + c] * room[0, c]
        memory[row, PLACE + i] = there
