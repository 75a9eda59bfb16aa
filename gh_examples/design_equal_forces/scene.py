"""A net in a plane whose forces are equal: three of them meet at 120 degrees wherever they meet."""

from typing import Any

import numpy as np

from hookean import Scene

SIX = np.pi / 6 + np.arange(6) * np.pi / 3


def honeycomb(rings: int, edge: float) -> tuple[Any, Any, Any]:
    """Points (n, 3) of hexagons around one in so many `rings`, of `edge` [m]; their lines (k, 2); and the ends of the
    lines that lead outwards, which are held."""
    centres = [(q, r) for q in range(-rings, rings + 1) for r in range(-rings, rings + 1) if abs(q + r) <= rings]
    places: dict[tuple[float, float], int] = {}
    lines: set[tuple[int, int]] = set()
    for q, r in centres:
        x, y = np.sqrt(3.0) * (q + r / 2) * edge + edge * np.cos(SIX), 1.5 * r * edge + edge * np.sin(SIX)
        corners = [places.setdefault((round(a, 6), round(b, 6)), len(places)) for a, b in zip(x, y, strict=True)]
        lines |= {(min(pair), max(pair)) for pair in zip(corners, [*corners[1:], corners[0]], strict=True)}
    points = np.array([[a, b, 0.0] for a, b in places])
    pairs = np.array(sorted(lines))
    outer = np.flatnonzero(np.bincount(pairs.ravel()) == 2)
    near = [pairs[(pairs == i).any(axis=1)].sum(axis=1) - i for i in outer]
    out = np.array([2.0 * points[i] - points[both].sum(axis=0) for i, both in zip(outer, near, strict=True)])
    ends = points[outer] + edge * out / np.linalg.norm(out, axis=1)[:, None]
    rim = len(points) + np.arange(len(ends))
    return np.concatenate([points, ends]), np.concatenate([pairs, np.stack([outer, rim], axis=1)]), rim


def scene(rings: int = 2, edge: float = 1.0, wave: float = 0.08, density: float = 5.0) -> Scene:
    """A honeycomb of so many `rings` with a force `density` [kN/m], its ends pulled into an oval, a `wave` on it."""
    points, lines, rim = honeycomb(rings, edge)
    around = np.arctan2(points[rim, 1], points[rim, 0])
    points[rim] *= np.array([1.15, 0.95, 1.0]) * (1.0 + wave * np.cos(3.0 * around))[:, None]
    inside = np.setdiff1d(np.arange(len(points)), rim)
    return Scene(
        units={"force": "kN"},
        particles=points,
        forces=[{"kind": "springs", "name": "net", "particles": lines, "stiffness": density, "rest_length": 0.0}],
        anchors=[{"name": "rim", "particles": rim}, {"name": "plane", "particles": inside, "axes": "z"}],
    )


def problem(force: float = 10.0, **given: Any) -> dict[str, Any]:
    """Which force densities give every line the same `force` [kN]?"""
    return {
        "scene": scene(**given),
        "variables": [{"force": "net", "field": "stiffness", "lower": 0.05}],
        "goals": [{"kind": "force", "force": "net", "target": force}],
    }
