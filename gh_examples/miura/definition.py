"""Miura's fold on the canvas: rigid panels and hinges in the level creases."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("miura").scene)

SHEET = """
import math

import Rhino

lean, corner = math.radians(start), math.radians(angle)
up = height * math.sin(lean) * math.sin(corner)
steep = math.cos(lean) * math.tan(corner)
across = math.sqrt(1.0 + steep**2)
along, aside = side * steep / across, side / across
forward = height * math.sqrt(1.0 - (math.sin(lean) * math.sin(corner)) ** 2)
rows, columns = int(rows), int(columns)
wide = columns + 1


def corner_of(j, i):
    return Rhino.Geometry.Point3d(along * i, forward * j + aside * (i % 2), up * (j % 2))


mesh = Rhino.Geometry.Mesh()
for j in range(rows + 1):
    for i in range(wide):
        p = corner_of(j, i)
        mesh.Vertices.Add(p.X, p.Y, p.Z)
panels, numbers, start_points, end_points, tips_1, tips_2, rest = [], [], [], [], [], [], []
for j in range(rows):
    for i in range(columns):
        first = wide * j + i
        mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
        panels += [corner_of(j, i), corner_of(j + 1, i), corner_of(j + 1, i + 1), corner_of(j, i + 1)]
        numbers += 4 * [columns * j + i]
        if j:
            start_points.append(corner_of(j, i))
            end_points.append(corner_of(j, i + 1))
            tips_1.append(corner_of(j + 1, i))
            tips_2.append(corner_of(j - 1, i))
            rest.append(math.radians(2.0 * fold) * (-1.0 if j % 2 else 1.0))
held = [corner_of(0, 0), corner_of(0, 2), corner_of(2, 0)]
hold_x, hold_y, hold_z = [True, False, False], [True, True, False], [True, True, True]
"""
NUMBERS = """
import math


def apart(p, q):
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(p, q)))


x = [(p.X, p.Y, p.Z) for p in (mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices)))]
width, depth, height = [max(c) - min(c) for c in zip(*x)]
lean, corner = math.radians(fold), math.radians(angle)
up = tall * math.sin(lean) * math.sin(corner)
steep = math.cos(lean) * math.tan(corner)
along, aside = side * steep / math.sqrt(1.0 + steep**2), side / math.sqrt(1.0 + steep**2)
forward = tall * math.sqrt(1.0 - (math.sin(lean) * math.sin(corner)) ** 2)
wide = int(columns) + 1
off = 0.0
for number, p in enumerate(x):
    j, i = divmod(number, wide)
    q = (along * i, forward * j + aside * (i % 2), up * (j % 2))
    off = max(off, apart(p, q))
folds, strained = [], 0.0
for first in range(len(x) - wide):
    if (first + 1) % wide:
        a, b, c, d = x[first], x[first + 1], x[first + wide], x[first + wide + 1]
        sides = ((a, b, side), (c, d, side), (a, c, tall), (b, d, tall))
        strained = max(strained, max(abs(apart(p, q) - size) for p, q, size in sides))
        if first >= wide:  # both panels at this crease lean by the same
            folds.append(sum(math.asin(abs(q[2] - a[2]) / tall / math.sin(corner)) for q in (c, x[first - wide])))
turned = math.degrees(sum(folds) / len(folds))
"""
NAMES = {
    "width": "width", "depth": "depth", "height": "height", "off": "distance from Miura's sheet, largest",
    "turned": "fold of the level creases", "strained": "change of a panel's side, largest",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "miura",
        "Origami: Miura's fold",
        "Each panel is a rigid body of its four corners, and hinges in the level creases fold the sheet. Set Reset to "
        "False and drag Fold: width, depth and height follow the closed form.",
    )
    with d.group("Sheet"):
        names = ("fold", "start", "rows", "columns", "side", "height", "angle")
        sliders = {
            "fold": d.slider("Fold [degrees]", GIVEN["fold"], 11, 85),
            "start": d.slider("Start [degrees]", GIVEN["start"], 5, 30),
            "rows": d.slider("Rows [-]", GIVEN["rows"], 2, 12),
            "columns": d.slider("Columns [-]", GIVEN["columns"], 2, 16),
            "side": d.slider("Side [m]", GIVEN["side"], 0.5, 2, decimals=2),
            "height": d.slider("Other side [m]", GIVEN["height"], 0.5, 2, decimals=2),
            "angle": d.slider("Angle [degrees]", GIVEN["angle"], 30, 80),
        }
        results = ["mesh", "panels", "numbers", "start_points", "end_points", "tips_1", "tips_2", "rest", "held",
                   "hold_x", "hold_y", "hold_z"]  # fmt: skip
        sheet = d.script("Miura", SHEET, {name: sliders[name] for name in names}, results)
    with d.group("Forces"):
        bodies = d.component(
            "RigidBody", point=sheet["panels"], group=sheet["numbers"],
            strength=d.slider("Strength [N/m]", GIVEN["strength"], 100, 100000),
        )  # fmt: skip
        hinges = d.component(
            "Hinge", point_1=sheet["start_points"], point_2=sheet["end_points"], point_3=sheet["tips_1"],
            point_4=sheet["tips_2"], strength=d.slider("Hinges [N m/rad]", 10, 1, 100), rest_angle=sheet["rest"],
        )  # fmt: skip
        anchors = d.component("Anchors", point=sheet["held"], x=sheet["hold_x"], y=sheet["hold_y"], z=sheet["hold_z"])
    with d.group("Engine"):
        engine = parts.engine(
            d, "relaxation", "1e-9", forces=flat(hinges, bodies), anchors=anchors, geometry=sheet["mesh"]
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {name: sliders[name] for name in ("fold", "columns", "side", "angle")}
        d.numbers(NUMBERS, {"mesh": engine["geometry"], "tall": sliders["height"], **given}, NAMES)
    return d
