"""An elastic gridshell: rods in two directions, drawn flat and pushed up as their ends move together; and one rod."""

from typing import Any

import numpy as np

from hookean import Scene

CELL = 4  # pieces between two crossings
BESIDE = 2.0  # m from the net to the single rod


def scene(
    rods: int = 5, length: float = 12.0, shortened: float = 0.1, bending: float = 1000.0, axial: float = 1e6,
    bump: float = 0.01, **settings: Any,
) -> Scene:  # fmt: skip
    """`rods` each way, `length` [m] long, and a single one beside them; anchors bring the ends of each together by a
    part `shortened`. All are flat but for a `bump` of their length, which chooses the side.

    Rods have a stiffness `bending` (EI) [N m2] and `axial` (EA) [N]; where two cross they share a particle, and turn
    freely against each other.
    """
    lines, drawn = net(rods, length, bump)
    pieces = lines.shape[1] - 1
    step = length / pieces
    ends = lines[:, [0, -1]]
    inwards = 0.5 * shortened * (drawn[ends[:, 1]] - drawn[ends[:, 0]])
    targets = np.stack([drawn[ends[:, 0]] + inwards, drawn[ends[:, 1]] - inwards], axis=1)
    return Scene(
        particles=drawn,
        forces=[
            {"kind": "springs", "name": "rods", "particles": in_rows(lines, 2), "stiffness": axial / step,
             "rest_length": step},
            {"kind": "bend", "name": "bending", "particles": in_rows(lines, 3), "stiffness": bending,
             "rest_angle": 0.0},
        ],
        anchors=[
            {"name": "ends", "particles": ends.ravel(), "targets": targets.reshape(-1, 3)},
            {"name": "single rod", "particles": [lines[-1, pieces // 2]], "axes": "y"},
        ],
        settings={"tolerance": 1e-9, **settings},
    )  # fmt: skip


def net(rods: int, length: float, bump: float) -> tuple[np.ndarray, np.ndarray]:
    """Particles of each rod in order, (2 rods + 1, pieces + 1), the single one last, and places (n, 3) [m]."""
    pieces = CELL * (rods + 1)
    i, j = np.meshgrid(*2 * [np.arange(pieces + 1)], indexing="ij")
    up = np.sin(np.pi * i / pieces)
    whole = np.stack([i / pieces - 0.5, j / pieces - 0.5, bump * up * up.T], axis=2) * length
    at = CELL * np.arange(1, rods + 1)
    used = np.zeros(i.shape, bool)
    used[at], used[:, at] = True, True
    number = np.cumsum(used).reshape(used.shape) - 1
    single = np.stack([whole[:, 0, 0], 0.0 * up[:, 0] - 0.5 * length - BESIDE, bump * length * up[:, 0]], axis=1)
    alone = used.sum() + np.arange(pieces + 1)
    lines = np.concatenate([number[:, at].T, number[at], alone[None]])
    return lines, np.concatenate([whole[used], single])


def in_rows(lines: np.ndarray, count: int) -> np.ndarray:
    """So many neighbours in a row, (k, count), along all lines."""
    return np.lib.stride_tricks.sliding_window_view(lines, count, axis=1).reshape(-1, count)
