"""Circles packed in round boundaries on the canvas: spheres that collide, limits on their distance from a centre."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("circle_packing").scene)
COUNTS = [float(count) for count in GIVEN["counts"]] + [19.0, 19.0]
BOUNDARIES = [*GIVEN["boundaries"], 4.862, 4.863]

CIRCLES = """
import math

import Rhino

point = Rhino.Geometry.Point3d
golden = math.pi * (3.0 - math.sqrt(5.0))
centres, circles, lines, limits = [], [], [], []
x = 0.0
for number, (count, boundary) in enumerate(zip(counts, boundaries)):
    if number:
        x += boundaries[number - 1] + 2.0 + boundary
    centre = point(x, 0, 0)
    centres.append(centre)
    for i in range(int(count)):  # like the seeds of a sunflower
        out = (boundary - radius) * math.sqrt((i + 0.5) / count)
        circle = point(x + out * math.cos(golden * i), out * math.sin(golden * i), 0)
        circles.append(circle)
        lines.append(Rhino.Geometry.Line(centre, circle))
        limits.append(boundary - radius)
"""
NUMBERS = """
import math

packings, first = [], 0
for count, boundary in zip(counts, boundaries):
    packings.append((boundary, [(line.From, line.To) for line in lines[first : first + int(count)]]))
    first += int(count)


def contacts(places):
    for i, p in enumerate(places):
        for q in places[:i]:
            d = p.DistanceTo(q)
            if d < 2.0 * radius:
                yield stiffness * (2.0 * radius - d), d


def measured(packing):
    boundary, pairs = packing
    out = sorted(a.DistanceTo(b) for a, b in pairs)
    found = list(contacts([b for _, b in pairs]))
    wall = [(stiffness * (d - boundary + radius), d) for d in out if d > boundary - radius]
    return out, found, wall


seven, nineteen, many, less, more = [measured(packing) for packing in packings]
seven_contact, seven_wall = max(seven[1])[0], max(seven[2])[0]
inner, outer = sum(nineteen[0][1:7]) / 6, sum(nineteen[0][7:]) / 12
push, contact = max(nineteen[2])[0], max(nineteen[1])[0]
one, other = max(less[2])[0], max(more[2])[0]
fits = boundaries[4] + (boundaries[4] - boundaries[3]) * other / (one - other)
virial = sum(f * d for f, d in many[1]) / sum(f * d for f, d in many[2])
"""
NAMES = {
    "seven_contact": "seven: force between circles",
    "seven_wall": "seven: force of the boundary on a circle",
    "inner": "nineteen: radius of the inner ring",
    "outer": "nineteen: radius of the outer ring",
    "push": "nineteen: force of the boundary on a circle",
    "contact": "nineteen: largest force between circles",
    "fits": "nineteen: boundary in which they just fit",
    "virial": "ninety-one: forces times distances, circles over boundary",
}


def definition() -> Definition:
    d = Definition(
        "circle_packing",
        "Circles packed in a round boundary",
        "Collide pushes circles apart, and Clamp Length limits their distance from the centre of a boundary. Set Reset "
        "to False, change the numbers of circles and the radii of the boundaries.",
    )
    with d.group("Circles"):
        counts = d.parameter("Number", "Circles [-]", COUNTS)
        boundaries = d.parameter("Number", "Boundaries [m]", BOUNDARIES)
        radius = d.slider("Radius [m]", GIVEN["radius"], 0.5, 1.5, decimals=2)
        made = d.script(
            "Sunflower", CIRCLES, {"counts": counts, "boundaries": boundaries, "radius": radius},
            ["centres", "circles", "lines", "limits"], lists=["counts", "boundaries"],
        )  # fmt: skip
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 100, 1000000)
        collide = d.component("Collide", point=made["circles"], radius=radius, strength=stiffness)
        limit = d.component("ClampLength", connection=made["lines"], stiffness=stiffness, upper_limit=made["limits"])
    with d.group("Anchors"):
        centres = d.component("Anchors", "Centres", point=made["centres"])
        plane = d.component("Anchors", "Plane", point=made["circles"], x=d.toggle("X", False), y=d.toggle("Y", False))
    with d.group("Engine"):
        engine = parts.engine(
            d, "relaxation", "1e-9", forces=flat(collide, limit), anchors=flat(centres, plane), geometry=made["lines"]
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {"counts": counts, "boundaries": boundaries, "radius": radius, "stiffness": stiffness}
        d.numbers(NUMBERS, {"lines": engine["geometry"], **given}, NAMES, lists=["counts", "boundaries", "lines"])
    return d
