"""A wall of loose bricks: rigid boxes that fall onto each other, and stay by friction."""

from itertools import pairwise
from typing import Any

import numpy as np

from hookean import Scene

LONG, WIDE, HIGH = 0.5, 0.25, 0.2  # m, with the joints
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def scene(
    courses: int = 10, across: int = 6, gap: float = 0.004, weight: float = 500.0, strength: float = 1e8,
    friction: float = 0.6, **settings: Any,
) -> Scene:  # fmt: skip
    """`courses` of bricks in running bond, `across` in each, drawn with joints of a `gap` [m] on a slab that is held.

    A brick has a `weight` [N], half ones half of it. Contacts have a `strength` [N/m3] and a `friction` [-].
    """
    boxes, share, _ = bricks(courses, across, gap)
    end = across * LONG
    slab = box(-0.25, end + 0.25, -HIGH, 0.0, 1.4 * WIDE)
    x = np.concatenate([slab, boxes.reshape(-1, 3)])
    count = len(x) // 8
    body = {"particles": np.arange(len(x)), "group": np.arange(count).repeat(8)}
    load = -weight * share.repeat(8)[:, None] / 8.0 * [0.0, 0.0, 1.0]
    faces = (8 * np.arange(count)[:, None, None] + SIDES).reshape(-1, 4)
    return Scene(
        particles=x,
        meshes={"boxes": {"vertices": x, "faces": faces}},
        forces=[
            {"kind": "rigid_body", "name": "bodies", **body, "strength": 0.1 * strength},
            {"kind": "rigid_collide", "name": "contacts", **body, "strength": strength, "friction": friction},
            {"kind": "unary", "name": "weight", "particles": np.arange(8, len(x)), "vector": load},
        ],
        anchors=[{"name": "slab", "particles": range(8)}],
        geometry=[{"name": "boxes", "kind": "mesh", "mesh": "boxes"}],
        settings={"solver": "relaxation", "tolerance": 1e-5, **settings},
    )  # fmt: skip


def bricks(courses: int, across: int, gap: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners (m, 8, 3) [m] of the bricks as drawn, which part of a whole one each is, and the course of each."""
    found, share, number = [], [], []
    for course in range(courses):
        ends = np.arange(across + 1.0) if course % 2 == 0 else np.array([0.0, *np.arange(0.5, across), across])
        low = course * HIGH + (course + 1) * gap
        for left, right in pairwise(ends):
            found.append(box(LONG * left + 0.5 * gap, LONG * right - 0.5 * gap, low, low + HIGH, WIDE))
            share.append(right - left)
            number.append(course)
    return np.array(found), np.array(share), np.array(number)


def box(left: float, right: float, low: float, high: float, wide: float) -> np.ndarray:
    """Corners (8, 3) [m] of a box that is `wide` about the XZ plane."""
    corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
    return np.array([left, -0.5 * wide, low]) + corners * [right - left, wide, high - low]


def sinking(courses: int, gap: float, weight: float, strength: float) -> np.ndarray:
    """How deep each course sinks into what is below it [m]: the weight above by k and the area. Bricks stand on their
    whole length on the slab, and on two halves less a gap on each other."""
    above = weight * np.arange(courses, 0, -1)
    length = np.where(np.arange(courses) == 0, LONG - gap, LONG - 2.0 * gap)
    return above / (strength * WIDE * length)
