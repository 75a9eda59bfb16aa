"""Cables with friction over saddles: what is in each line, when none of them slips beyond what friction allows.

The strain of line i is t_i, its rest length c_i, and d_i by how much it would be longer than at rest if nothing had
slipped. Over the saddle between two lines the cable turns by an angle phi, and r = exp(mu phi) (Euler and Eytelwein):

    t_i / r <= t_(i+1) <= r t_i, and what has slipped over it until there, sum c t - sum d, is
    0 inside of this range, positive only where t_(i+1) = r t_i, negative only where t_(i+1) = t_i / r.

Each sum grows with the strain of its last line, so there is exactly one such state. `prefixes` finds from line to line
the strain that a line would have if the cable ended with it; `strains` then goes back from the end. A line looks back
only over saddles that slip: at once over those that slipped the same way before, as in the pool of adjacent violators
of isotonic regression, and over all where what slipped before still holds. So the looks grow nearly with the number of
saddles; with its square at worst, where each line changes how far a long slip reaches.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.groups import COLUMNS, begins, following
from hookean.forces.line_lengths import line, pull

STIFFNESS, REST, FRICTION, WAY, SHARE = range(COLUMNS, COLUMNS + 5)  # columns of the parameters

# columns of the table of one cable, by the place of a line in it; of the run of saddles before it that slip one way:
# which way, the place where it begins, and the sums and the last factor of the strains in it, for 1 in this line
ROW, LENGTH, OWN, LONGER, RATIO, STRAIN, RUN_WAY, RUN_FROM, RUN_OWN, RUN_LONGER, RUN_FACTOR, GRIP = range(12)
ALL_OWN, ALL_LONGER, LOW, HIGH = range(12, 16)  # those sums of all slips before it, and for which strains they hold
TABLE = 16

STEEPEST = 60.0  # of mu phi: beyond it nothing slips that has any force
LARGEST = 1e150  # factor between strains of one run


@device
def turn(x: Any, indices: Any, parameters: Any, before: Any, after: Any) -> Any:
    """Angle by which a cable turns between two of its lines [rad]; 0 beside a line of zero length."""
    a, ax, ay, az = line(x, indices, before)
    b, bx, by, bz = line(x, indices, after)
    if a == 0.0 or b == 0.0:
        return 0.0
    ax, ay, az, bx, by, bz = ax / a, ay / a, az / a, bx / b, by / b, bz / b
    cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    along = (ax * bx + ay * by + az * bz) * parameters[after, WAY]
    return np.arctan2(np.sqrt(cx * cx + cy * cy + cz * cz), along)


@device
def laid_out(x: Any, indices: Any, parameters: Any, memory: Any, first: Any, table: Any) -> Any:
    """Write the lines of a cable into the table; returns how many there are."""
    count, before, e = 0, first, first
    while e >= 0:
        length = line(x, indices, e)[0]
        table[count, ROW] = e
        table[count, LENGTH] = length
        table[count, OWN] = parameters[e, SHARE]
        table[count, LONGER] = length - parameters[e, SHARE] + memory[e, 0]
        table[count, RATIO] = 1.0
        if count > 0:
            angle = turn(x, indices, parameters, before, e)
            table[count, RATIO] = np.exp(min(parameters[e, FRICTION] * angle, STEEPEST))
        count += 1
        before, e = e, following(parameters, e)
    return count


@device
def slips(table: Any, at: Any, strain: Any) -> Any:
    """Which way the saddle before a line slips with this strain in it: 1 to the line, -1 away from it, 0 not at all."""
    if at == 0:
        return 0
    most = table[at - 1, STRAIN]
    if strain > most * table[at, RATIO]:
        return 1
    return -1 if strain < most / table[at, RATIO] else 0


@device
def narrowed(table: Any, at: Any, way: Any, factor: Any, low: Any, high: Any) -> Any:
    """The part between `low` and `high` for which the saddle before a line slips that way, or holds; the line has
    `factor` times as much in it. Empty for factors too small to divide by."""
    if factor < 1.0 / LARGEST:
        high = 0.0
    elif at > 0:
        most = table[at - 1, STRAIN] * table[at, RATIO] / factor
        least = table[at - 1, STRAIN] / table[at, RATIO] / factor
        if way > 0:
            low = max(low, most)
        elif way < 0:
            high = min(high, least)
        else:
            low, high = max(low, least), min(high, most)
    return low, high


@device
def back(table: Any, j: Any) -> Any:
    """Write the strain of a line if the cable ended with it, and what slips then; returns how many saddles were looked
    at."""
    at, own, longer, factor, run = j, table[j, OWN], table[j, LONGER], 1.0, 0
    low, high, looks, last, pure, whole = 0.0, np.inf, 1, 1.0, True, False
    way = slips(table, at, longer / own)
    while way != 0 and not whole:
        low, high = narrowed(table, at, way, factor, low, high)
        factor *= table[at, RATIO] if way < 0 else 1.0 / table[at, RATIO]
        at -= 1
        own += factor * table[at, OWN]
        longer += table[at, LONGER]
        all_own, all_longer = own + factor * table[at, ALL_OWN], longer + table[at, ALL_LONGER]
        strain = factor * (all_longer / all_own)
        whole = factor * LARGEST > 1.0 and table[at, LOW] < strain and strain < table[at, HIGH]
        if whole:
            low, high = max(low, table[at, LOW] / factor), min(high, table[at, HIGH] / factor)
        if table[at, RUN_WAY] == way:
            own += factor * table[at, RUN_OWN]
            longer += table[at, RUN_LONGER]
            factor *= table[at, RUN_FACTOR]
            at = int(table[at, RUN_FROM])
        pure = pure and run * way >= 0 and factor <= LARGEST
        if pure:
            run = way
            table[j, RUN_FROM], table[j, RUN_FACTOR] = at, factor
            table[j, RUN_OWN], table[j, RUN_LONGER] = own - table[j, OWN], longer - table[j, LONGER]
        if whole:
            own, longer = all_own, all_longer
        elif factor > LARGEST:
            own, factor, last = own / LARGEST, factor / LARGEST, last / LARGEST
        way = slips(table, at, factor * (longer / own))
        looks += 1
    if not whole:
        low, high = narrowed(table, at, 0, factor, low, high)
    table[j, RUN_WAY], table[j, STRAIN] = run, max(last * (longer / own), 0.0)
    table[j, ALL_OWN], table[j, ALL_LONGER] = own - table[j, OWN], longer - table[j, LONGER]
    table[j, LOW], table[j, HIGH] = low, high if last == 1.0 else 0.0  # after a division by LARGEST: never
    return looks


@device
def prefixes(table: Any, count: Any) -> Any:
    """Write the strain of each line if the cable ended with it; returns how many saddles were looked at."""
    looks = 0
    for j in range(count):
        looks += back(table, j)
    return looks


@device
def strains(table: Any, count: Any) -> None:
    """Turn the strains of `prefixes` into those of the whole cable, and write which saddles slip."""
    for i in range(1, count):
        at = count - i
        way = slips(table, at, table[at, STRAIN])
        table[at, RUN_WAY] = way
        if way > 0:
            table[at - 1, STRAIN] = table[at, STRAIN] / table[at, RATIO]
        elif way < 0:
            table[at - 1, STRAIN] = table[at, STRAIN] * table[at, RATIO]
    table[0, RUN_WAY] = 0.0


@device
def tensed(x: Any, indices: Any, parameters: Any, memory: Any, first: Any, table: Any) -> Any:
    """Write the lines of a cable into the table, with their strains; returns how many there are."""
    count = laid_out(x, indices, parameters, memory, first, table)
    prefixes(table, count)
    strains(table, count)
    return count


@device
def stiffen(x: Any, indices: Any, parameters: Any, table: Any, first: Any, end: Any, w: Any) -> None:
    """Add the bound of the stiffness of lines between two saddles that hold, in which T_i = a_i (sum of l - ...).

    Slips have slopes dT_i/dl_j = EA t_i / sum c t; half of rows and columns bounds the symmetric part. The angles have
    slopes of at most mu T by 1/l at the ends of both lines; 2 a b <= a^2 + b^2 divides that between lines and saddles.
    """
    axial = parameters[int(table[first, ROW]), STIFFNESS] * parameters[int(table[first, ROW]), REST]
    total, own, grip, whole = 0.0, 0.0, 0.0, 0.0
    for i in range(first, end):
        total += table[i, STRAIN]
        own += table[i, STRAIN] * table[i, OWN]
        whole += table[i, OWN]
        table[i, GRIP] = 0.0
        if i > first and table[i, LENGTH] > 0.0 and table[i - 1, LENGTH] > 0.0:
            mu = parameters[int(table[i, ROW]), FRICTION]
            table[i, GRIP] = mu
            grip += mu * (1.0 / table[i, LENGTH] + 1.0 / table[i - 1, LENGTH])
    count = end - first
    for i in range(first, end):
        e, length, strain = int(table[i, ROW]), table[i, LENGTH], table[i, STRAIN]
        along = max(1.0 / table[i, OWN], count / whole)
        if own > 0.0:
            along = max(along, 0.5 * (count * (strain / own) + total / own))
        across = strain / length if length > 0.0 else 0.0
        for k in range(2):
            w[indices[e, k]] += axial * (2.0 * (along + across) + strain * grip)
        if table[i, GRIP] > 0.0:
            both = axial * total * table[i, GRIP]
            for k in range(2):
                w[indices[e, k]] += both / length
                w[indices[int(table[i - 1, ROW]), k]] += both / table[i - 1, LENGTH]


def rough_cable_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, table = 0.0, np.zeros((indices.shape[0], TABLE))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        count = tensed(x, indices, parameters, memory, first, table)
        axial, start = parameters[first, STIFFNESS] * parameters[first, REST], 0
        for i in range(count):
            e, strain, length = int(table[i, ROW]), table[i, STRAIN], table[i, LENGTH]
            energy += 0.5 * axial * strain * strain * table[i, OWN]
            if length > 0.0:
                _, dx, dy, dz = line(x, indices, e)
                pull(indices, e, axial * strain / length, dx, dy, dz, f)
            if i > 0 and table[i, RUN_WAY] == 0.0:
                stiffen(x, indices, parameters, table, start, i, w)
                start = i
        stiffen(x, indices, parameters, table, start, count, w)
    return energy


def rough_cable_note(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    table = np.zeros((indices.shape[0], TABLE))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        count = tensed(x, indices, parameters, memory, first, table)
        if table[count - 1, STRAIN] == 0.0:
            continue  # a slack cable stays as it lies
        for i in range(count):
            memory[int(table[i, ROW]), 0] += table[i, OWN] * table[i, STRAIN] - table[i, LONGER]
