"""The sphere that falls and the sail in the wind as functions of Hops."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, count, item
from hookean_server.workers.task import Cancelled

Floats = NDArray[np.float64]

AIR = 1.225  # kg/m^3


def sphere(radius: float, bottom: float, around: int, along: int) -> Mesh:
    """A mesh sphere with its axis along y, triangles at its poles, its lowest point at a height."""
    turn = 2.0 * np.pi * np.arange(around) / around
    steps = np.pi * np.arange(1, along) / along
    ring, y = radius * np.sin(steps)[:, None], -radius * np.cos(steps)[:, None]
    rows = np.stack([ring * np.sin(turn), y + 0.0 * turn, ring * np.cos(turn)], axis=2).reshape(-1, 3)
    poles = np.array([[0.0, -radius, 0.0], [0.0, radius, 0.0]])
    vertices = np.concatenate([poles[:1], rows, poles[1:]]) + [0.0, 0.0, radius + bottom]
    number = 1 + np.arange(around * (along - 1)).reshape(along - 1, around)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=2).reshape(-1, 4)
    top = np.full(around, len(vertices) - 1)
    first = np.stack([0 * top, after[0], number[0], number[0]], axis=1)
    last = np.stack([number[-1], after[-1], top, top], axis=1)
    return Mesh(vertices, np.concatenate([first, quads, last]))


def volume(mesh: Mesh) -> float:
    """Enclosed volume [length^3] by the divergence theorem; a quad is the mean of its two cuts into triangles."""
    a, b, c, d = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    cuts = ((a, b, c), (a, c, d), (a, b, d), (b, c, d))
    return float(sum((p * np.cross(q, r)).sum() for p, q, r in cuts)) / 12.0


def _falling(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import diagonals, edges

    mesh = sphere(inputs.one("Radius"), inputs.one("Drop"), inputs.one("Around"), inputs.one("Along"))
    stiffness, strength = inputs.one("Stiffness"), inputs.one("Shell")
    x = mesh.vertices
    springs = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness}
        for name, pairs in (("edges", edges(mesh)), ("diagonals", diagonals(mesh)))
    ]
    shell = [{"kind": "shell", "name": "shell", "mesh": "sphere", "strength": strength}] if strength else []
    weight = {"kind": "unary", "name": "gravity", "particles": np.arange(len(x)), "vector": [0.0, 0.0, -9.81]}
    scene = {
        "particles": x,
        "meshes": {"sphere": {"vertices": x, "faces": mesh.faces}},
        "forces": [*springs, weight, *shell],
        "settings": {"solver": "verlet", "time_step": 0.004, "sub_iterations": 5, "drag": inputs.one("Drag"),
                     "floor": True, "tolerance": 0.0},
    }  # fmt: skip
    result = scenes.moved(inputs, scene, inputs.one("Time"), cancelled)
    now = Mesh(result.particles, mesh.faces)
    pairs = np.concatenate([result.force(name)["particles"] for name in ("edges", "diagonals")])
    return {
        "Mesh": now,
        "Springs": result.particles[pairs],
        "Fallen": x[:, 2].min() - result.particles[:, 2].min(),
        "Height kept": 100.0 * np.ptp(now.vertices[:, 2]) / np.ptp(x[:, 2]),
        "Volume": volume(now),
        "Volume kept": 100.0 * volume(now) / volume(mesh),
        "Status": str(result.status),
    }


def _sail(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import corners, edges, naked_edges

    size, speed = inputs.one("Size"), inputs.one("Speed")
    low, high = inputs.one("Low"), inputs.one("High")
    part = np.linspace(0.0, 1.0, inputs.one("Divisions") + 1)
    u, v = part[:, None], part[None, :]
    mesh = scenes.grid(size * part, size * part, low + (high - low) * (u + v - 2.0 * u * v))
    each = 0.5 * AIR * speed**2 * size**2 / len(mesh.vertices)
    nets = [
        {"kind": "springs", "name": "sail", "particles": edges(mesh), "stiffness": inputs.one("Stiffness"),
         "rest_factor": inputs.one("Rest factor")},
        {"kind": "springs", "name": "edge", "particles": naked_edges(mesh), "stiffness": inputs.one("Edge stiffness"),
         "rest_factor": inputs.one("Edge factor")},
    ]  # fmt: skip
    force = [each * inputs.one("Drag"), 0.0, each * inputs.one("Lift")]
    wind = {"kind": "unary", "name": "wind", "particles": np.arange(len(mesh.vertices)),
            "vector": force}  # fmt: skip
    held = corners(mesh)
    scene = {"particles": mesh.vertices, "forces": [*nets, wind], "anchors": [{"particles": held}],
             "settings": {"tolerance": 1e-8}}  # fmt: skip
    result = scenes.relaxed(inputs, scene, cancelled)
    return {
        **scenes.common(result, "sail", "edge"),
        "Mesh": Mesh(result.particles, mesh.faces),
        "Height of the middle": result.particles[len(mesh.vertices) // 2, 2],
        "Largest edge force": result.force("edge")["force"].max(),
        "Load": float(np.linalg.norm(force)),
    }


FUNCTIONS: dict[str, Function] = {
    "falling_sphere": Function(
        "Falling sphere",
        "Sphere",
        "Section 9.7: a mesh sphere falls onto the floor, at a time after its release",
        (
            item("Radius", "R", "Number", "Radius [model unit]", 5.0, minimum=0.1, maximum=1000.0),
            item("Drop", "H", "Number", "Height of its lowest point over the floor [model unit]", 5.0, minimum=0.0),
            count("Around", "N", "Faces around its axis", 20, 60, 3),
            count("Along", "M", "Faces from pole to pole", 12, 40, 3),
            scenes.stiffness(5000.0),
            item("Shell", "D", "Number", "Bending stiffness [N model unit]; 0: springs alone", 500.0, minimum=0.0),
            item("Drag", "b", "Number", "Drag on every particle [N s/model unit]", 1.0, minimum=0.0),
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
        _falling,
        "Figures",
    ),
    "sail": Function(
        "Sail",
        "Sail",
        "The essay of the sail: a net between four corners in a steady wind along x",
        (
            item("Size", "L", "Number", "Side of its plan [model unit]", 6.0, minimum=1e-3, maximum=1e4),
            item("Low", "A", "Number", "Height of two opposite corners [model unit]", 2.5),
            item("High", "B", "Number", "Height of the other two [model unit]", 4.5),
            count("Divisions", "N", "Faces along each side", 10, 100, 2),
            item("Speed", "v", "Number", "Speed of the wind [m/s]", 12.0, minimum=0.0, maximum=200.0),
            item("Drag", "cx", "Number", "Coefficient of pressure along x [-]", 0.5),
            item("Lift", "cz", "Number", "Coefficient of pressure upwards [-]", 0.8),
            scenes.stiffness(4000.0),
            scenes.rest_factor(0.92),
            item("Edge stiffness", "ke", "Number", "Stiffness of the cable along each side [N/model unit]", 40_000.0,
                 minimum=0.0),
            scenes.rest_factor(0.97, "Edge factor", "Re"),
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
        _sail,
        "Figures",
    ),
}  # fmt: skip
"""Functions by their names."""
