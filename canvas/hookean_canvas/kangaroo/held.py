"""Anchors by axes with a strength, and the damping of BouncySolver, for the tables of the import; their scripts."""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.pieces import Piece, Swap
from hookean_canvas.kangaroo.recipe import Recipe

AXES = '''"""A plane across each axis on which a point is held, with the strength for each."""

from hookean_client import canvas


def flags(given):
    return [bool(value) for value in canvas.listed(given)] or [True]


places, normals, strengths = [], [], []
sizes = [canvas.geometry.number(value) for value in canvas.listed(strength_)] or [1000.0]
for row in zip(*canvas.matched(canvas.geometry.points(_point), flags(x_), flags(y_), flags(z_), sizes)):
    for axis in (0, 1, 2):
        if row[1 + axis]:
            places.append(canvas.geometry.to_point(row[0]))
            normals.append(canvas.geometry.to_vector([float(axis == c) for c in (0, 1, 2)]))
            strengths.append(row[4])
'''
DRAG = '''"""The drag that keeps a part of the velocity in a step of 0.01, 2 (1 - part) / (1 + part) / 0.01."""

from hookean_client import canvas

parts = [canvas.geometry.number(value) for value in canvas.listed(_parts)]
drag = [max(0.0, 200.0 * (1.0 - part) / (1.0 + part)) for part in parts]
'''
HELPERS = {
    "*axes": Recipe(
        "Held Axes",
        "Axes",
        "Planes across the axes on which points are held",
        AXES,
        (
            Slot("_point", "Points", 1, "point"),
            *(Slot(f"{axis}_", f"Whether {axis} is held", 1, "bool") for axis in "xyz"),
            Slot("strength_", "Strengths in Kangaroo", 1),
        ),
        (Slot("places", "Points"), Slot("normals", "Axes"), Slot("strengths", "Strengths")),
    ),
    "*drag": Recipe(
        "Drag",
        "Drag",
        "Drag that keeps a part of the velocity in a step",
        DRAG,
        (Slot("_parts", "Parts of the velocity", 1),),
        (Slot("drag", "Drag"),),
    ),
}
TOLD = {"*axes": "a script for axes", "*drag": "a script for drag"}
"""What the scripts are called in the table of the documentation."""

_EXACT = "anchors hold exactly here; where a strength other than 1000 is given, Pull To Plane holds each axis by it"

ANCHOR = Swap(
    (Piece("Anchors", {"p": "point", "point": "point", "x": "x", "y": "y", "z": "z"}, {"anchors": "a"}),),
    _EXACT,
    {"strength": _EXACT},
    {"strength": 1000.0},
    unless={"strength": ""},
    other=Swap(
        (
            Piece("PullToPlane", {}, {"force": "a"}),
            Piece(
                "*axes",
                {"p": "point", "point": "point", "x": "x", "y": "y", "z": "z", "strength": "strength"},
                feeds={"places": "0.point|0.origin", "normals": "0.normal", "strengths": "0.strength"},
            ),
        ),
        "held by its strength along each axis, as in Kangaroo",
    ),
)
"""AnchorXYZ: exact where its strength is that which Kangaroo types in."""

BOUNCY = Piece("*drag", {"damping": "parts"}, feeds={"drag": "1.drag"})
"""What turns another damping than 0.99, which is that of the drag 1 here, into drag."""
