"""Goals of Kangaroo 2 that few files have, for the tables of the import: Bomb and ImageCircles; their scripts."""

from __future__ import annotations

from dataclasses import replace

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.pieces import Piece, Swap
from hookean_canvas.kangaroo.recipe import Recipe

BLASTS = '''"""Each point with each detonation: where from, its momentum, and its moment, 0.01 an iteration."""

from hookean_client import canvas


def numbers(given, usual):
    return [canvas.geometry.number(value) for value in canvas.listed(given)] or usual


places, origins, momenta, times = [], [], [], []
centres = canvas.geometry.points(_location)
rows = zip(*canvas.matched(canvas.geometry.points(_points), numbers(strength_, [1.0]), centres)) if centres else ()
for place, size, centre in rows:
    for count in numbers(detonations_, [150.0, 250.0, 350.0]):
        places.append(canvas.geometry.to_point(place))
        origins.append(canvas.geometry.to_vector(centre))
        momenta.append(size)
        times.append(0.01 * count)
'''
PIXELS = '''"""The brightness of a coloured mesh as rows of numbers from 0 to 1 and the corners of that image, in plan.

There are about as many pixels as vertices, with those of a grid in the middles; one without takes the mean around it.
"""

from hookean_client import canvas


def brightness(colour):
    r, g, b = (colour.R, colour.G, colour.B) if hasattr(colour, "R") else tuple(colour)[:3]
    return (0.299 * r + 0.587 * g + 0.114 * b) / 255.0


def pixels(places, values):
    """Means of what lies in each pixel, those of empty ones from their neighbours; and the corners of the image."""
    low, high = ([end(p[axis] for p in places) for axis in (0, 1)] for end in (min, max))
    width, height = (max(high[axis] - low[axis], 1e-12) for axis in (0, 1))
    wide = max(2, int(round((len(places) * width / height) ** 0.5)))
    tall = max(2, int(round(float(len(places)) / wide)))
    steps = width / (wide - 1), height / (tall - 1)
    held = {}
    for p, value in zip(places, values):
        at = tuple(int(round((p[axis] - low[axis]) / steps[axis])) for axis in (0, 1))
        held.setdefault(at, []).append(value)
    known = dict((at, sum(found) / len(found)) for at, found in held.items())
    while len(known) < wide * tall:
        grown = dict(known)
        for i in range(wide):
            for j in range(tall):
                near = [known[i + p, j + q] for p in (-1, 0, 1) for q in (-1, 0, 1) if (i + p, j + q) in known]
                if (i, j) not in known and near:
                    grown[i, j] = sum(near) / len(near)
        known = grown
    ends = [[end[axis] + side * steps[axis] for axis in (0, 1)] + [0.0] for end, side in ((low, -0.5), (high, 0.5))]
    return [[known[i, j] for i in range(wide)] for j in range(tall)], ends


image = corners = None
meshes = canvas.listed(_mesh)
if meshes:
    places = canvas.geometry.mesh(meshes[0])["vertices"]
    colours = meshes[0].VertexColors
    count = colours.Count if hasattr(colours, "Count") else len(colours)
    if count != len(places):
        raise ValueError("the mesh has no colours, which are the image; colour its vertices")
    rows, ends = pixels(places, [brightness(colours[i]) for i in range(count)])
    image = [" ".join("%.6g" % value for value in row) for row in rows]
    corners = [canvas.geometry.to_point(end) for end in ends]
'''
HELPERS = {
    "*blasts": Recipe(
        "Detonations",
        "Blasts",
        "Momenta of points by an explosion",
        BLASTS,
        (
            Slot("_location", "Where it explodes", 1, "point"),
            Slot("_points", "Points", 1, "point"),
            Slot("detonations_", "Iterations after which it explodes. Default: 150, 250 and 350.", 1),
            Slot("strength_", "Strengths in Kangaroo", 1),
        ),
        (
            Slot("places", "Points"),
            Slot("origins", "Where their momenta come from"),
            Slot("momenta", "Momenta"),
            Slot("times", "Moments"),
        ),
    ),
    "*pixels": Recipe(
        "Image of a Mesh",
        "Pixels",
        "The colours of a mesh as an image",
        PIXELS,
        (Slot("_mesh", "A coloured mesh", 1),),
        (Slot("image", "Rows of numbers"), Slot("corners", "Corners of the image")),
    ),
}
TOLD = {"*blasts": "a script for detonations", "*pixels": "a script for the image"}
"""What the scripts are called in the table of the documentation."""

_CIRCLES = Swap(
    (
        Piece(
            "CircleImage",
            {"points": "point", "min": "minimum_radius", "max": "maximum_radius"},
            {"force": "imagecircles"},
        ),
        Piece("*pixels", {"m": "mesh", "mesh": "mesh"}, feeds={"image": "0.image", "corners": "0.corners"}),
        Piece("*half", {"strength": "numbers"}, feeds={"halves": "0.strength"}),
    ),
    "half of the strength, as SphereCollide; circles are large where the mesh is bright; Kangaroo's law is not "
    "published; the solver gives out the circles where it is at rest",
    unless={"curves": ""},
)
_KEPT = Piece(
    "CollideCurve", {"points": "point", "curves": "curve", "strength": "strength"}, {"force": "imagecircles"},
    {"inside": True},
)  # fmt: skip

GOALS: dict[str, Swap] = {
    "bomb": Swap(
        (
            Piece("Impulse", {}, {"force": "bomb"}),
            Piece(
                "*blasts",
                {
                    "location": "location",
                    "points": "points",
                    "detonationtime": "detonations",
                    "strength": "strength",
                },
                feeds={
                    "places": "0.point",
                    "origins": "0.origin",
                    "momenta": "0.momentum",
                    "times": "0.time",
                },
            ),
        ),
        "the strength is a momentum, and an iteration is 0.01 of time, the step of the Engine; Kangaroo's law is not "
        "published; solvers that look for equilibrium leave it out, as in Kangaroo",
        {"reset": "the reset of the Engine starts the count again"},
    ),
    "imagecircles": replace(
        _CIRCLES,
        other=replace(
            _CIRCLES,
            pieces=(*_CIRCLES.pieces, _KEPT),
            differs=f"{_CIRCLES.differs}; centres stay inside the curves",
            unless={},
        ),
    ),
}
