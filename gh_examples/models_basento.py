"""Draws the model of the Basento study: one bay of a skin stretched between four feet and a deck.

Run it from the project's root: `.venv/bin/python gh_examples/models_basento.py`. The same version of rhino3dm writes
the same bytes. The proportions (a bay of 70 m, a deck 16 m wide and 16 m up) are near those of the bridge; the drawing
is a study of its idea, not a survey.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rhino3dm

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent

BAY, DECK_WIDTH, DECK_HEIGHT = 70.0, 16.0, 16.0  # m
FEET_APART, FEET_WIDTH = 26.0, 11.0  # m, along and across
CAMBER = 1.5  # m, how far the drawn skin bows across: it hangs between the fingers and arches over the feet


def skin() -> rhino3dm.NurbsSurface:
    """A NURBS surface of degree 3 x 2, lofted through five sections: finger, foot, finger, foot, finger."""
    along = 0.5 * np.array([-BAY, -FEET_APART, 0.0, FEET_APART, BAY])
    half = 0.5 * np.array([DECK_WIDTH, FEET_WIDTH, DECK_WIDTH, FEET_WIDTH, DECK_WIDTH])
    height = np.array([DECK_HEIGHT, 0.0, DECK_HEIGHT, 0.0, DECK_HEIGHT])
    bow = CAMBER * np.array([-1.0, 1.0, -1.0, 1.0, -1.0])
    sections = np.zeros((5, 3, 3))
    for j, (side, rise) in enumerate(((-1.0, 0.0), (0.0, 2.0), (1.0, 0.0))):
        sections[:, j] = np.column_stack([along, side * half, height + rise * bow])
    controls = np.linalg.solve(_values(), sections.reshape(5, 9)).reshape(5, 3, 3)
    surface = rhino3dm.NurbsSurface.Create(3, False, 4, 3, 5, 3)
    for i in range(5):
        for j in range(3):
            surface.Points[i, j] = rhino3dm.Point4d(*controls[i, j], 1.0)
    for k, value in enumerate([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]):
        surface.KnotsU[k] = value
    for k, value in enumerate([0.0, 0.0, 1.0, 1.0]):
        surface.KnotsV[k] = value
    return surface


def _values() -> np.ndarray:
    """Cubic B-splines over the knots 0, 0.5 and 1 at 0, 1/4, 1/2, 3/4 and 1."""
    return np.array([[32, 0, 0, 0, 0], [4, 19, 8, 1, 0], [0, 8, 16, 8, 0], [0, 1, 8, 19, 4], [0, 0, 0, 0, 32]]) / 32.0


def basento() -> None:
    """The skin, its four feet, the six fingers that carry the deck, the edges of the deck, the ends of the bay."""
    deck = 0.5 * np.array([BAY, DECK_WIDTH])
    feet = [(x, y, 0.0) for x in (-0.5 * FEET_APART, 0.5 * FEET_APART) for y in (-0.5 * FEET_WIDTH, 0.5 * FEET_WIDTH)]
    fingers = [(x, y, DECK_HEIGHT) for x in (-deck[0], 0.0, deck[0]) for y in (-deck[1], deck[1])]
    points = [NewObject(rhino3dm.Point(rhino3dm.Point3d(*p)), layer="feet", name="foot") for p in feet]
    points += [NewObject(rhino3dm.Point(rhino3dm.Point3d(*p)), layer="fingers", name="finger") for p in fingers]
    edges = []
    for y in (-deck[1], deck[1]):
        ends = [rhino3dm.Point3d(x, y, DECK_HEIGHT) for x in (-deck[0], deck[0])]
        edges.append(NewObject(rhino3dm.LineCurve(*ends).ToNurbsCurve(), layer="deck", name="deck edge"))
    write_new(
        HERE / "basento" / "model.3dm",
        Additions(
            layers=(
                NewLayer("skin", colour=(40, 90, 160, 255)),
                NewLayer("deck", colour=(60, 60, 60, 255)),
                NewLayer("feet", colour=(190, 60, 40, 255)),
                NewLayer("fingers", colour=(190, 120, 40, 255)),
            ),
            objects=(NewObject(skin(), layer="skin", name="bay"), *points, *edges),
        ),
        own=False,
    )


if __name__ == "__main__":
    basento()
