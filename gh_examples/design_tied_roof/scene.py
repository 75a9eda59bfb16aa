"""A roof of arches on two walls that it must not push apart: each arch gets its own tie."""

from typing import Any

import numpy as np

from hookean import Scene


def scene(
    span: float = 8.0, rise: float = 2.0, links: int = 8, arches: int = 7, bay: float = 2.0, load: float = 1.5,
    drift: float = 1.0, density: float = 20.0,
) -> Scene:  # fmt: skip
    """Arches over a `span` [m], a `bay` [m] apart, in an even number of `links` of force `density` [kN/m], upside down:
    the `load` [kN] on each joint acts upwards, so a pull is a push in the roof. Snow adds from nothing to a `drift`
    [kN] from the first arch to the last. A tie of 10,000 kN/m joins the feet of each arch."""
    count = links + 1
    y = np.linspace(-span / 2, span / 2, count)
    arch = np.stack([0.0 * y, y, 0.9 * rise * (1.0 - (2.0 * y / span) ** 2)], axis=1)
    points = np.concatenate([arch + [bay * j, 0.0, 0.0] for j in range(arches)])
    first = count * np.arange(arches)
    lines = (first[:, None] + np.arange(links))[:, :, None] + [0, 1]
    inner = first[:, None] + np.arange(1, links)
    loads = np.repeat(load + drift * np.arange(arches) / max(arches - 1, 1), links - 1)
    ties = np.stack([first, first + links], axis=1)
    return Scene(
        units={"force": "kN"},
        particles=points,
        forces=[
            {"kind": "springs", "name": "arches", "particles": lines.reshape(-1, 2), "stiffness": density,
             "rest_length": 0.0},
            {"kind": "springs", "name": "ties", "particles": ties, "stiffness": 1e4, "rest_length": span},
            {"kind": "unary", "name": "load", "particles": inner.ravel(),
             "vector": np.stack([0.0 * loads, 0.0 * loads, loads], axis=1)},
        ],
        anchors=[{"name": "walls", "particles": ties.ravel()}],
    )  # fmt: skip


def problem(span: float = 8.0, rise: float = 2.0, links: int = 8, arches: int = 7, **given: Any) -> dict[str, Any]:
    """Which force density of each arch and which length of each tie give the `rise` and no thrust on the walls?"""
    made = scene(span=span, rise=rise, links=links, arches=arches, **given)
    each = [list(range(links * j, links * (j + 1))) for j in range(arches)]
    crowns = (links + 1) * np.arange(arches) + links // 2
    return {
        "scene": made,
        "variables": [
            {"force": "arches", "field": "stiffness", "tie": each, "lower": 0.1},
            {"force": "ties", "field": "rest_length", "lower": 0.9 * span},
        ],
        "goals": [
            {"kind": "position", "particles": crowns, "axes": "z", "target": rise},
            {"kind": "reaction", "anchor": "walls", "axes": "y", "target": 0.0},
        ],
    }
