"""Chebyshev's linkage on the canvas: bars, rigid couplers, and anchors that turn the cranks."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("linkage").scene)

LINKAGES = """
import math

import Rhino

point = Rhino.Geometry.Point3d
bars, couplers, numbers, bodies, grounds, cranks, targets, ends, pens = [], [], [], [], [], [], [], [], []


def joints(angle, y):
    # crank 1 m, rocker and half of the coupler 2.5 m, base 2 m
    a, b = math.cos(angle), math.sin(angle)
    half = 0.5 * math.sqrt((2.0 - a) ** 2 + b * b)
    up = math.sqrt(6.25 - half * half) / (2.0 * half)
    x, z = 0.5 * (a + 2.0) + b * up, 0.5 * b + (2.0 - a) * up
    return point(0, y, 0), point(a, y, b), point(x, y, z), point(2, y, 0), point(2 * x - a, y, 2 * z - b)


for number, angle in enumerate(angles):
    y = number * apart
    one, crank, rocker, other, pen = joints(math.pi, y)
    bars += [Rhino.Geometry.Line(one, crank), Rhino.Geometry.Line(rocker, other)]
    bodies += [crank, rocker, pen]
    numbers += 3 * [number]
    grounds += [one, other]
    cranks.append(crank)
    targets.append(joints(math.radians(angle), y)[1])
    ends += [rocker, pen]
    pens.append(pen)
    couplers.append(Rhino.Geometry.Polyline([crank, rocker, pen]).ToPolylineCurve())
"""
NUMBERS = """
shapes = [[curve.Point(i) for i in range(3)] for curve in couplers]
z90, z135, z180, z225, z270 = [shape[2].Z for shape in shapes]
line = max(shape[2].X for shape in shapes) - min(shape[2].X for shape in shapes)
held = [v for path in reactions.Paths for v in reactions.Branch(path)][2 * len(shapes) : 3 * len(shapes)]
t90, t135, t180, t225, t270 = [v.Z * s[0].X - v.X * s[0].Z for v, s in zip(held, shapes)]
changed = max(abs(p.DistanceTo(q) - 2.5) for s in shapes for p, q in zip(s, s[1:]))
"""
ANGLES = (90, 135, 180, 225, 270)
NAMES = {
    **{f"z{angle}": f"height of the pen at {angle} degrees" for angle in ANGLES},
    "line": "length of the line",
    **{f"t{angle}": f"torque of the crank at {angle} degrees" for angle in ANGLES},
    "changed": "change of a coupler, largest",
}


def definition() -> Definition:
    d = Definition(
        "linkage",
        "Chebyshev's linkage",
        "Five linkages drawn with the crank at 180 degrees; anchors with targets turn the cranks. Rigid Body keeps the "
        "couplers straight. Set Reset to False, change the angles and watch the pens.",
    )
    with d.group("Linkages"):
        names = ["bars", "couplers", "numbers", "bodies", "grounds", "cranks", "targets", "ends", "pens"]
        made = d.script(
            "Linkages", LINKAGES,
            {"angles": d.parameter("Number", "Crank angles [degrees]", [float(angle) for angle in ANGLES]),
             "apart": d.slider("Apart [m]", GIVEN["apart"], 0.1, 5, decimals=1)},
            names, lists=["angles"],
        )  # fmt: skip
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 1000, 100000000)
        bars = d.component("Springs", connection=made["bars"], stiffness=stiffness)
        bodies = d.component("RigidBody", point=made["bodies"], group=made["numbers"], strength=stiffness)
        down = d.native("Unit Z", factor=d.slider("Load [N]", -GIVEN["weight"], -1000, 0))
        weight = d.component("Unary", point=made["pens"], force=down)
    with d.group("Anchors"):
        grounds = d.component("Anchors", "Grounds", point=made["grounds"])
        cranks = d.component("Anchors", "Cranks", point=made["cranks"], targets=made["targets"])
        plane = d.component("Anchors", "Plane", point=made["ends"], x=d.toggle("X", False), z=d.toggle("Z", False))
    with d.group("Engine"):
        engine = parts.engine(
            d,
            "relaxation",
            "1e-9",
            forces=flat(bars, bodies, weight),
            anchors=flat(grounds, cranks, plane),
            geometry=made["couplers"],
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        d.numbers(
            NUMBERS, {"couplers": engine["geometry"], "reactions": engine["reactions"]}, NAMES,
            lists=["couplers"], trees=["reactions"],
        )  # fmt: skip
    return d
