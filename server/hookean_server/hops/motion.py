"""The sphere that falls and the sail in the wind as functions of Hops."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hookean.commands.examples import figure
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, count, item

_SPHERE = figure("sphere").scene
_WIND = figure("wind").scene


def _falling(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    from hookean.discretize import volume

    drawn = scene.meshes["sphere"]
    now = Mesh(result.particles, drawn.faces)
    pairs = np.concatenate([result.force(name)["particles"] for name in ("edges", "diagonals")])
    heights, before = now.vertices[:, 2], drawn.vertices[:, 2]
    return {
        "Mesh": now,
        "Springs": result.particles[pairs],
        "Fallen": before.min() - heights.min(),
        "Height kept": 100.0 * np.ptp(heights) / np.ptp(before),
        "Volume": volume(now),
        "Volume kept": 100.0 * volume(now) / volume(drawn),
        "Status": str(result.status),
    }


def _sail(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    return {
        **scenes.common(result, "sail", "edge"),
        "Mesh": Mesh(result.particles, scene.meshes["sail"].faces),
        "Height of the middle": result.particles[len(result.particles) // 2, 2],
        "Largest edge force": result.force("edge")["force"].max(),
        "Load": float(np.linalg.norm(result.force("wind")["force"][0])),
    }


FUNCTIONS: dict[str, Function] = {
    "falling_sphere": scenes.moving(
        _SPHERE, _falling, "Falling sphere", "Sphere",
        "Section 9.7: a mesh sphere falls onto the floor, at a time after its release",
        (
            item("Radius", "R", "Number", "Radius [model unit]", minimum=0.1, maximum=1000.0),
            item("Drop", "H", "Number", "Height of its lowest point over the floor [model unit]", minimum=0.0),
            count("Around", "N", "Faces around its axis", None, 60, 3),
            count("Along", "M", "Faces from pole to pole", None, 40, 3),
            scenes.STIFFNESS,
            item("Shell", "D", "Number", "Bending stiffness [N model unit]; 0: springs alone", minimum=0.0),
            item("Drag", "b", "Number", "Drag on every particle [N s/model unit]", minimum=0.0),
            item("Time", "t", "Number", "Time since the start [s]; a frame every 0.02 s", 8.0, minimum=0.0,
                 maximum=30.0),
        ),
        (
            item("Mesh", "M", "Mesh", "The sphere at this time"),
            scenes.SPRINGS,
            item("Fallen", "F", "Number", "How far its lowest point has come down [model unit]"),
            item("Height kept", "Hk", "Number", "Its height as a part of the first [%]"),
            item("Volume", "V", "Number", "Its volume [model unit^3]"),
            item("Volume kept", "Vk", "Number", "Its volume as a part of the first [%]"),
            scenes.STATUS,
        ),
        tolerance=0.0,
    ),
    "sail": scenes.relaxing(
        _WIND, _sail, "Sail", "Sail",
        "The essay of the sail: a net between four corners in a steady wind along x",
        (
            item("Size", "L", "Number", "Side of its plan [model unit]", minimum=1e-3, maximum=1e4),
            item("Low", "A", "Number", "Height of two opposite corners [model unit]"),
            item("High", "B", "Number", "Height of the other two [model unit]"),
            count("Divisions", "N", "Faces along each side", None, 100, 2),
            item("Speed", "v", "Number", "Speed of the wind [m/s]", minimum=0.0, maximum=200.0),
            item("Drag", "cx", "Number", "Coefficient of pressure along x [-]"),
            item("Lift", "cz", "Number", "Coefficient of pressure upwards [-]"),
            scenes.STIFFNESS,
            scenes.REST_FACTOR,
            item("Edge stiffness", "ke", "Number", "Stiffness of the cable along each side [N/model unit]",
                 minimum=0.0),
            replace(scenes.REST_FACTOR, name="Edge factor", nickname="Re"),
        ),
        (
            scenes.MESH,
            scenes.SPRINGS,
            scenes.FORCES,
            scenes.REACTIONS, scenes.SUPPORTS,
            item("Height of the middle", "H", "Number", "Of its middle vertex [model unit]"),
            item("Largest edge force", "Fe", "Number", "The largest force in a cable [N]"),
            item("Load", "P", "Number", "Load of the wind on each particle [N]"),
            scenes.STATUS,
        ),
    ),
}  # fmt: skip
"""Functions by their names."""
