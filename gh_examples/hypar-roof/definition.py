"""The hypar roof on the canvas: one engine finds the form, a second one loads real cloth and ropes with snow."""

import numpy as np

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

ROOF = figure("hypar-roof")
GIVEN = defaults(ROOF.scene)
AREA = 0.75 * np.pi * 0.02**2 / 4.0  # m2, of a rope

DRAWN = """
import Rhino

count = int(divisions)
wide = count + 1
mesh = Rhino.Geometry.Mesh()
for i in range(wide):
    for j in range(wide):
        u, v = i / count, j / count
        mesh.Vertices.Add(side * u, side * v, rise * (u + v - 2 * u * v))
for i in range(count):
    for j in range(count):
        first = wide * i + j
        mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
corners = [mesh.Vertices.Point3dAt(i) for i in (0, count, wide * count, wide * wide - 1)]


def line(one, other):
    return Rhino.Geometry.Line(mesh.Vertices.Point3dAt(one), mesh.Vertices.Point3dAt(other))


warp, weft, ropes = [], [], []
for i in range(wide):
    for j in range(count):
        for threads, one, other in (
            (weft, wide * i + j, wide * i + j + 1), (warp, wide * j + i, wide * (j + 1) + i)
        ):
            threads.append(line(one, other))
            if i in (0, count):
                ropes.append(line(one, other))
rope_density = density * count
"""
CUT = """
import Rhino

count = int(divisions)
wide = count + 1
x = [form.Vertices.Point3dAt(i) for i in range(wide * wide)]
warp, weft, ropes = [], [], []
cut = {"warp": [], "weft": [], "ropes": []}
stiff = {"warp": [], "weft": [], "ropes": []}


def put(lines, name, one, other, density, elastic):
    length = x[one].DistanceTo(x[other])
    lines.append(Rhino.Geometry.Line(x[one], x[other]))
    cut[name].append(length / (1.0 + density * length / elastic))  # so that it has its tension at this length
    stiff[name].append(elastic / cut[name][-1])


strip = side / count
for i in range(wide):
    for j in range(count):
        for name, lines, elastic, one, other in (
            ("weft", weft, float(weft_stiffness) * strip, wide * i + j, wide * i + j + 1),
            ("warp", warp, float(warp_stiffness) * strip, wide * j + i, wide * (j + 1) + i),
        ):
            put(lines, name, one, other, prestress, elastic)
            if i in (0, count):
                put(ropes, "ropes", one, other, rope_density, float(rope_elastic))
warp_cut, weft_cut, ropes_cut = cut["warp"], cut["weft"], cut["ropes"]
warp_stiff, weft_stiff, ropes_stiff = stiff["warp"], stiff["weft"], stiff["ropes"]
heavy, pressed = 1.35 * weight, 1.5 * snow
"""
NUMBERS = """
count = int(divisions)
wide = count + 1


def places(mesh):
    return [mesh.Vertices.Point3dAt(i) for i in range(wide * wide)]


x = places(form)
lengths = []
for i in (0, count):
    for j in range(count):
        for one, other in ((wide * i + j, wide * i + j + 1), (wide * j + i, wide * (j + 1) + i)):
            lengths.append(x[one].DistanceTo(x[other]))
densities = [force / length for force, length in zip(form_forces.Branch(3), lengths)]
least, largest = min(densities), max(densities)

y = places(result)
rim = [wide * i for i in range(count)] + [wide * count + j for j in range(count)]
rim += [wide * i + count for i in range(count, 0, -1)] + [j for j in range(count, 0, -1)]
plan = 0.5 * abs(sum(y[a].X * y[b].Y - y[a].Y * y[b].X for a, b in zip(rim, rim[1:] + rim[:1])))
pushes = [list(forces.Branch(i)) for i in (0, 1)]
ratio = -sum(v.Z for v in pushes[1]) / (pressed * plan)
pulls = [v for path in reactions.Paths for v in reactions.Branch(path)]
both = pushes[0] + pushes[1] + pulls
balance = max(abs(sum(v.X for v in both)), abs(sum(v.Y for v in both)), abs(sum(v.Z for v in both)))
use = max(forces.Branch(4)) / float(breaks)
"""
NAMES = {
    "least": "form: force density of a rope, least",
    "largest": "form: force density of a rope, largest",
    "ratio": "snow: its sum / (q x plan)",
    "balance": "snow: reactions and loads, sum",
    "use": "snow: use of a rope, largest",
}


def definition() -> Definition:
    d = Definition(
        "hypar-roof",
        "A hypar roof of cloth between ropes",
        "The first engine finds the form of cloth and ropes under their prestress and weight. Cut takes the lengths of "
        "real cloth and ropes from it, and the second engine puts snow on them. Set Reset to False and change the "
        "prestress and the snow. Wind and other combinations are in recipe.toml.",
    )
    with d.group("Roof"):
        divisions = d.slider("Divisions [-]", GIVEN["divisions"], 2, 32)
        side = d.slider("Side [m]", GIVEN["side"], 5, 30, decimals=1)
        made = d.script(
            "Roof", DRAWN,
            {"divisions": divisions, "side": side, "rise": d.slider("Rise [m]", GIVEN["rise"], 0, 8, decimals=1),
             "density": d.slider("Ropes [kN/m]", GIVEN["edge_density"], 1, 50, decimals=1)},
            ["mesh", "corners", "warp", "weft", "ropes", "rope_density"],
        )  # fmt: skip
    with d.group("Form"):
        zero, weight = d.text("Rest factor [-]", "0"), d.slider("Weight [kN/m2]", GIVEN["gravity"], 0, 0.1, decimals=4)
        prestress = d.slider("Prestress [kN/m]", GIVEN["prestress"], 0.1, 10, decimals=2)
        threads = ("warp", prestress), ("weft", prestress), ("ropes", made["rope_density"])
        drawn = [
            d.component("Springs", name, connection=made[name], stiffness=stiffness, rest_factor=zero)
            for name, stiffness in threads
        ]
        settings = d.component(
            "Settings", solver=d.text("Solver", "newton"), residual=d.text("Residual [-]", "1e-9"),
            fast=d.toggle("Fast", True), force_unit=d.text("Unit of force", "kN"),
        )  # fmt: skip
        common = {"anchors": made["corners"], "settings": settings, "reset": d.toggle("Reset", True)}
        own = d.component("AreaWeight", "Weight", mesh=made["mesh"], weight=weight)
        form = d.component("Engine", "Form", forces=flat(*drawn, own), geometry=made["mesh"], **common)
    with d.group("Cut"):
        elastic = {
            "warp_stiffness": d.text("Warp [kN/m]", f"{ROOF.WARP:g}"),
            "weft_stiffness": d.text("Weft [kN/m]", f"{ROOF.WEFT:g}"),
            "rope_elastic": d.text("Rope EA [kN]", repr(150e6 * AREA)),
        }
        threads = "warp", "weft", "ropes"
        cut = d.script(
            "Cut", CUT,
            {"form": form["geometry"], "divisions": divisions, "side": side, "prestress": prestress,
             "rope_density": made["rope_density"], "weight": weight,
             "snow": d.slider("Snow [kN/m2]", GIVEN["snow"], 0, 2, decimals=2), **elastic},
            [*threads, *(f"{name}_{what}" for name in threads for what in ("cut", "stiff")), "heavy", "pressed"],
        )  # fmt: skip
        real = [
            d.component("Springs", name, connection=cut[name], stiffness=cut[f"{name}_stiff"],
                        rest_length=cut[f"{name}_cut"])
            for name in threads
        ]  # fmt: skip
    with d.group("Snow"):
        own = d.component("AreaWeight", "Weight", mesh=form["geometry"], weight=cut["heavy"])
        snow = d.component(
            "AreaWeight", "Snow", mesh=form["geometry"], per=d.text("Per", "plan"), weight=cut["pressed"]
        )
        engine = d.component("Engine", "Snow", forces=flat(*real, own, snow), geometry=form["geometry"], **common)
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json compares it with."):
        given = {"divisions": divisions, "form": form["geometry"], "form_forces": form["forces"],
                 "result": engine["geometry"], "forces": engine["forces"], "reactions": engine["reactions"],
                 "pressed": cut["pressed"], "breaks": d.text("Breaks at [kN]", repr(1570e3 * AREA))}  # fmt: skip
        d.numbers(NUMBERS, given, NAMES, trees=["form_forces", "forces", "reactions"])
    return d
