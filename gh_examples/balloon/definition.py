"""A balloon and a pair of bubbles on the canvas: gas in closed meshes, film on their sides."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat, graft

GIVEN = defaults(figure("balloon").scene)

BOXES = """
import Rhino


def side(mesh, low, axis, end, count):
    # squares of a side of a box of 1 m, with the normal outwards
    one, other = (axis + 1) % 3, (axis + 2) % 3
    first = len(mesh.Vertices)
    for i in range(count + 1):
        for j in range(count + 1):
            place = [0.0, 0.0, 0.0]
            place[axis] = float(end)
            place[one], place[other] = (i / count, j / count) if end else (j / count, i / count)
            mesh.Vertices.Add(*[low[k] + place[k] for k in range(3)])
    wide = count + 1
    for i in range(count):
        for j in range(count):
            a = first + wide * i + j
            mesh.Faces.AddFace(a, a + wide, a + wide + 1, a + 1)


def box(low, count, sides):
    mesh = Rhino.Geometry.Mesh()
    for number in sides:
        side(mesh, low, number // 2, number % 2, count)
    return mesh


cells, films = [], []
for shift, count in ((0.0, int(divisions)), (apart, int(divisions) // 2)):
    ball, left, right = (-2.2, -0.5 + shift, 0.0), (0.0, -0.5 + shift, 0.0), (1.0, -0.5 + shift, 0.0)
    cells += [box(low, count, range(6)) for low in (ball, left, right)]
    films += [
        box(ball, count, range(6)), box(left, count, (0, 2, 3, 4, 5)), box(right, count, (1, 2, 3, 4, 5)),
        box(left, count, (1,)),
    ]
"""
NUMBERS = """
import math


def places(mesh):
    # one for each place: sides of a box have their own vertices at its edges
    found = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
    return list({(round(p.X, 9), round(p.Y, 9), round(p.Z, 9)): (p.X, p.Y, p.Z) for p in found}.values())


def middle(points):
    return [sum(p[k] for p in points) / len(points) for k in range(3)]


def apart(p, q):
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(p, q)))


def volume(meshes):
    total = 0.0
    for mesh in meshes:
        x = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
        for i in range(len(mesh.Faces)):
            a, b, c, d = [x[corner] for corner in mesh.Faces[i]][:4]
            for p, q, r in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)):  # the mean of both cuts
                total += (p.X * (q.Y * r.Z - q.Z * r.Y) + p.Y * (q.Z * r.X - q.X * r.Z)
                          + p.Z * (q.X * r.Y - q.Y * r.X)) / 12.0
    return total


def pressure(meshes):
    return gas / volume(meshes) - outside


film, left_cap, right_cap, wall = meshes[:4]
walled = [left_cap, wall]
ball = pressure([film])
points = places(film)
centre = middle(points)
out = [apart(p, centre) for p in points]
radius = (3.0 * volume([film]) / 4.0 / math.pi) ** (1.0 / 3.0)
ball_limit = (4.0 * ball - pressure([meshes[4]])) / 3.0
laplace = ball * radius / (2.0 * tension)
boyle = (ball + outside) * volume([film])
round_off = max(out) - min(out)
pair = pressure(walled)
pair_limit = (4.0 * pair - pressure([meshes[5], meshes[7]])) / 3.0
mirror = pair - gas / (volume([right_cap]) - volume([wall])) + outside
flat = [p for p in places(wall)]
hub = middle(flat)
caps = {tuple(round(c, 6) for c in p) for p in places(left_cap)}
rim = [apart(p, hub) for p in flat if tuple(round(c, 6) for c in p) in caps]
apex = hub[0] - min(p[0] for p in places(left_cap))
angle = math.degrees(2.0 * math.atan(apex / (sum(rim) / len(rim))))
off = max(abs(p[0] - 1.0) for p in flat)
"""
NAMES = {
    "ball_limit": "balloon: pressure, in the limit of fine meshes",
    "laplace": "balloon: pressure over 2 T / R",
    "boyle": "balloon: absolute pressure times volume",
    "round_off": "balloon: greatest less least radius",
    "pair_limit": "pair: pressure, in the limit of fine meshes",
    "mirror": "pair: difference of their pressures",
    "angle": "pair: angle of wall and caps",
    "off": "pair: distance of the wall from its plane, largest",
}


def definition() -> Definition:
    d = Definition(
        "balloon",
        "A balloon and a pair of bubbles",
        "Gas in closed meshes inflates films of constant tension; the same again with half as many squares a side. Set "
        "Reset to False and change the tension: the pressure follows Boyle's law and Laplace's.",
    )
    with d.group("Boxes"):
        boxes = d.script(
            "Boxes", BOXES,
            {"divisions": d.slider("Squares a side [-]", GIVEN["divisions"], 2, 16),
             "apart": d.slider("To the coarse ones [m]", 4, 3, 10)},
            ["cells", "films"],
        )  # fmt: skip
    with d.group("Forces"):
        pressure = d.slider("Pressure at the start [Pa]", GIVEN["pressure"], 1, 20, decimals=1)
        outside = d.slider("Pressure outside [Pa]", GIVEN["outside"], 0, 5, decimals=1)
        tension = d.slider("Tension [N/m]", GIVEN["tension"], 0.1, 5, decimals=1)
        gas = d.component("Gas", mesh=graft(boxes["cells"]), pressure=pressure, outside=outside)
        films = d.component("SoapFilm", mesh=graft(boxes["films"]), tension=tension)
    with d.group("Engine"):
        engine = parts.engine(d, "relaxation", "1e-7", forces=flat(gas, films), geometry=boxes["films"])
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {"gas": pressure, "outside": outside, "tension": tension}
        d.numbers(NUMBERS, {"meshes": engine["geometry"], **given}, NAMES, lists=["meshes"])
    return d
