"""A vault whose forces are found: its surface is given, with a wall along its middle."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import grid


def surface(size: float, rise: float, along: int) -> Any:
    """The grid of `along` by `along` faces on z = rise (1 - (x2 + y2) / 2), x and y from -1 at a side to 1."""
    at = np.linspace(-1.0, 1.0, along + 1)
    mesh = grid(at, at)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    return np.stack([x * size / 2, y * size / 2, rise * (1.0 - (x**2 + y**2) / 2.0)], axis=1), mesh.faces


def scene(
    size: float = 8.0, rise: float = 2.0, along: int = 8, weight: float = 1.0, wall: float = 2.0, density: float = 4.0
) -> Scene:
    """A net of force `density` [kN/m] that hangs upside down: `weight` [kN] on each joint, and on those of the middle
    line the `wall` [kN] more, act upwards, so a pull in it is a push in the vault. Its rim is held on the surface of a
    `rise` [m] over a square of side `size` [m]; its middle is drawn flat."""
    target, faces = surface(size, rise, along)
    number = np.arange(len(target)).reshape(along + 1, along + 1)
    inside = number[1:-1, 1:-1]
    rim = np.setdiff1d(number, inside)
    lines = [np.stack([number[:-1, 1:-1], number[1:, 1:-1]], axis=2).transpose(1, 0, 2)]
    lines += [np.stack([number[1:-1, :-1], number[1:-1, 1:]], axis=2)]
    loads = np.full(inside.shape, weight)
    loads[:, along // 2 - 1] += wall
    drawn = target.copy()
    drawn[inside.ravel(), 2] = rise
    return Scene(
        units={"force": "kN"},
        particles=drawn,
        meshes={"vault": {"vertices": drawn, "faces": faces}},
        forces=[
            {"kind": "springs", "name": "net", "particles": np.concatenate([part.reshape(-1, 2) for part in lines]),
             "stiffness": density, "rest_length": 0.0},
            {"kind": "unary", "name": "weight", "particles": inside.ravel(),
             "vector": np.stack([0.0 * loads.ravel(), 0.0 * loads.ravel(), loads.ravel()], axis=1)},
        ],
        anchors=[{"name": "rim", "particles": rim}],
        geometry=[{"name": "vault", "kind": "mesh", "mesh": "vault"}],
    )  # fmt: skip


def problem(size: float = 8.0, rise: float = 2.0, along: int = 8, **given: Any) -> dict[str, Any]:
    """Which force densities, all of them pulls, put every joint on the surface, above its place in plan?"""
    made = scene(size=size, rise=rise, along=along, **given)
    inside = made.forces[1].particles
    target = surface(size, rise, along)[0]
    return {
        "scene": made,
        "variables": [{"force": "net", "field": "stiffness", "lower": 0.1}],
        "goals": [{"kind": "position", "particles": inside, "target": target[inside]}],
    }
