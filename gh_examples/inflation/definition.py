"""A pneumatic roof on the canvas: films under pressure on a round rim and on a square frame, in two sizes of mesh."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat, graft

GIVEN = defaults(figure("inflation").scene)

FILMS = """
import math

import Rhino

point = Rhino.Geometry.Point3d
films, held = [], []


def disc(rings, y):
    mesh = Rhino.Geometry.Mesh()
    mesh.Vertices.Add(0, y, 0)
    inner = [0]
    for ring in range(1, rings + 1):
        outer = [inner[-1] + 1 + k for k in range(6 * ring)]
        for k in range(6 * ring):
            turn, out = math.pi / 3.0 * k / ring, radius * ring / rings
            mesh.Vertices.Add(out * math.cos(turn), y + out * math.sin(turn), 0)
        for k in range(6 * ring):
            side, step = divmod(k, ring)
            near = side * (ring - 1) + step
            a, b = inner[near % len(inner)], inner[(near + 1) % len(inner)]
            p, q = outer[k], outer[(k + 1) % len(outer)]
            mesh.Faces.AddFace(a, p, q)
            if step < ring - 1:
                mesh.Faces.AddFace(a, q, b)
        inner = outer
    held.extend(mesh.Vertices.Point3dAt(i) for i in inner)
    return mesh


def square(count, side, y):
    mesh = Rhino.Geometry.Mesh()
    wide = count + 1
    for i in range(wide):
        for j in range(wide):
            u, v = 2.0 * i / count - 1.0, 2.0 * j / count - 1.0
            off = 0.4 * side * radius * (1.0 - u * u) * (1.0 - v * v)
            mesh.Vertices.Add(radius * u + 2.6 * radius, y + radius * v, off)
            if side > 0 and (i in (0, count) or j in (0, count)):
                held.append(mesh.Vertices.Point3dAt(wide * i + j))
    for i in range(count):
        for j in range(count):
            a = wide * i + j
            corners = [a, a + wide, a + wide + 1, a + 1]
            mesh.Faces.AddFace(*(corners if side > 0 else corners[::-1]))
    return mesh


for part, y in ((1, 0.0), (2, 4.0 * radius)):
    count = int(divisions) // part
    films += [disc(int(rings) // part, y), square(count, 1.0, y), square(count, -1.0, y)]
"""
NUMBERS = """
import math


def places(mesh):
    return [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]


cap, upper, lower, coarse_cap, coarse_upper = [places(mesh) for mesh in films[:5]]
rise, coarse = max(p.Z for p in cap), max(p.Z for p in coarse_cap)
limit = (4.0 * rise - coarse) / 3.0
ball = 2.0 * tension / pressure
low = math.sqrt(ball**2 - radius**2)
off = max(abs(math.sqrt(p.X**2 + p.Y**2 + (p.Z + low) ** 2) - ball) for p in cap)
sides = 6 * int(rings)
area = 0.5 * sides * radius**2 * math.sin(2.0 * math.pi / sides)
held = [v for path in reactions.Paths for v in reactions.Branch(path)]
rim = held[:sides]
frame = held[sides : sides + 4 * int(divisions)]
carried = -sum(v.Z for v in rim) / pressure / area
balance = sum(v.Z for v in frame)
cushion = (4.0 * max(p.Z for p in upper) - max(p.Z for p in coarse_upper)) / 3.0
mirror = max(abs(p.Z + q.Z) for p, q in zip(upper, lower))
"""
NAMES = {
    "limit": "cap: rise, in the limit of fine meshes",
    "off": "cap: distance from the sphere, largest",
    "carried": "cap: force on the rim over pressure times its plan",
    "cushion": "cushion: rise of the upper film, in the limit of fine meshes",
    "mirror": "cushion: upper and lower film, largest difference",
    "balance": "cushion: force on the frame upwards",
}


def definition() -> Definition:
    d = Definition(
        "inflation",
        "A pneumatic roof",
        "Pressure inflates films of constant tension on a round rim and on a square frame; the same again with half as "
        "many faces a side. Set Reset to False and change the pressure: the cap is a sphere of 2 T / p.",
    )
    with d.group("Films"):
        given = {
            "rings": d.slider("Rings [-]", GIVEN["rings"], 2, 24),
            "divisions": d.slider("Squares a side [-]", GIVEN["divisions"], 4, 32),
            "radius": d.slider("Radius [m]", GIVEN["radius"], 1, 10, decimals=1),
        }
        made = d.script("Films", FILMS, given, ["films", "held"])
    with d.group("Forces"):
        pressure = d.slider("Pressure [Pa]", GIVEN["pressure"], 10, 390)
        tension = d.slider("Tension [N/m]", GIVEN["tension"], 1000, 5000)
        film = d.component("SoapFilm", mesh=graft(made["films"]), tension=tension)
        air = d.component("Pressure", mesh=graft(made["films"]), pressure=pressure)
    with d.group("Engine"):
        engine = parts.engine(d, "newton", "1e-7", forces=flat(film, air), anchors=made["held"], geometry=made["films"])
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        found = {
            "films": engine["geometry"],
            "reactions": engine["reactions"],
            "pressure": pressure,
            "tension": tension,
        }
        d.numbers(NUMBERS, {**found, **given}, NAMES, lists=["films"], trees=["reactions"])
    return d
