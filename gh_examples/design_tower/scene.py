"""A tower of two legs that holds a sideways pull: where to put its feet so that forces have the shortest way."""

from typing import Any

from hookean import Scene


def scene(height: float = 12.0, pull: float = 30.0, base: float = 4.0) -> Scene:
    """Two legs of a `height` [m] with their feet `base` [m] from the axis, and a `pull` [kN] along x at their top. All
    joints are held; where the forces of the legs balance the pull, the top needs no hold."""
    return Scene(
        units={"force": "kN"},
        particles=[[-base, 0, 0], [base, 0, 0], [0, 0, height]],
        forces=[
            {"kind": "constant_tension", "name": "legs", "particles": [[0, 2], [1, 2]], "tension": [pull, -pull]},
            {"kind": "unary", "name": "pull", "particles": [2], "vector": [pull, 0, 0]},
        ],
        anchors=[{"name": name, "particles": [i]} for i, name in enumerate(("left", "right", "top"))],
    )


def problem(**given: Any) -> dict[str, Any]:
    """Which feet and forces of the legs have the least load path, the sum of |force| x length?"""
    return {
        "scene": scene(**given),
        "variables": [
            {"force": "legs", "field": "tension", "lower": -1000.0, "upper": 1000.0},
            {"anchor": "left", "axes": "x", "lower": -100.0, "upper": -0.5},
            {"anchor": "right", "axes": "x", "lower": 0.5, "upper": 100.0},
        ],
        "goals": [{"kind": "load_path", "force": "legs"}],
        "constraints": [{"kind": "reaction", "anchor": "top", "axes": "xz", "lower": 0.0, "upper": 0.0}],
    }
