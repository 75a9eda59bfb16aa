"""Figure 9.16: chains between two points, of a length and under a direction of gravity."""

from typing import Any

import numpy as np

from hookean import Scene

CASES: dict[str, dict[str, Any]] = {
    "rising": {},
    "level": {"end": (10.0, 0.0, 0.0)},
    "nearly taut": {"end": (10.0, 0.0, 0.0), "length": 10.1},
    "very slack": {"end": (3.0, 0.0, 1.0), "length": 18.0},
    "gravity aslant": {"end": (9.0, 0.0, 0.0), "gravity": (0.6, 0.0, -0.8)},
    "gravity sideways": {"end": (0.0, 0.0, -8.0), "gravity": (1.0, 0.0, 0.0)},
}


def scene(
    start: Any = (0.0, 0.0, 0.0), end: Any = (8.0, 0.0, 4.0), length: float = 12.0, gravity: Any = (0.0, 0.0, -1.0),
    links: int = 60,
) -> Scene:  # fmt: skip
    """A chain of a `length` [m] and 1 N/m that hardly stretches, from `start` to `end` [m] under `gravity`, a unit
    vector. It starts as two straight legs; each of its `links` weighs half at each of its ends."""
    link = round(length / links, 12)
    inner, ends = np.arange(1, links), [0, links]
    springs = {"kind": "springs", "name": "chain", "particles": np.arange(links)[:, None] + [0, 1], "stiffness": 1e7,
               "rest_length": link}  # fmt: skip
    weights = [
        {"kind": "unary", "name": name, "particles": where, "vector": (weight * np.array(gravity)).round(12) + 0.0}
        for name, where, weight in (("chain weight", inner, link), ("weight at the ends", ends, 0.5 * link))
    ]
    return Scene(
        particles=legs(*np.array([start, end, gravity], float), length, links),
        forces=[springs, *weights],
        anchors=[{"name": "A and B", "particles": ends}],
        settings={"tolerance": 1e-9},
    )


def legs(a: np.ndarray, b: np.ndarray, down: np.ndarray, length: float, links: int) -> np.ndarray:
    """Particles (links + 1, 3) on two straight legs from a over the lowest point the chain reaches to b."""
    chord = b - a
    across = down - (down @ chord) / (chord @ chord) * chord
    across /= np.linalg.norm(across)
    low = a + 0.5 * chord + 0.5 * np.sqrt(length**2 - chord @ chord) * across
    part = np.linspace(0.0, 1.0, links + 1)[:, None]
    return np.where(part < 0.5, a + 2.0 * part * (low - a), low + (2.0 * part - 1.0) * (b - low)).round(8) + 0.0
