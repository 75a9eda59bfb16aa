"""A cable net on the canvas: an engine finds the form by force densities, a second one loads cables of steel."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

MODULE = figure("cable_net")
GIVEN = defaults(MODULE.scene) | defaults(MODULE.form)

DRAWN = """
import Rhino

count = int(divisions)
mesh = Rhino.Geometry.Mesh()
for i in range(count + 1):
    for j in range(count + 1):
        u, v = i / count, j / count
        mesh.Vertices.Add(side * u, side * v, rise * (u * v + (1 - u) * (1 - v)))
wide = count + 1
for i in range(count):
    for j in range(count):
        first = wide * i + j
        mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
corners = [mesh.Vertices.Point3dAt(i) for i in (0, count, wide * count, wide * wide - 1)]


def line(one, other):
    return Rhino.Geometry.Line(mesh.Vertices.Point3dAt(one), mesh.Vertices.Point3dAt(other))


net, edges = [], []
for i in range(wide):
    for j in range(count):
        for one, other in ((wide * i + j, wide * i + j + 1), (wide * j + i, wide * (j + 1) + i)):
            (edges if i in (0, count) else net).append(line(one, other))
"""
STEEL = """
import Rhino

count = int(divisions)
wide = count + 1
x = [form.Vertices.Point3dAt(i) for i in range(wide * wide)]
net, edges, net_lengths, edge_lengths, net_stiff, edge_stiff = [], [], [], [], [], []
for i in range(wide):
    for j in range(count):
        for one, other in ((wide * i + j, wide * i + j + 1), (wide * j + i, wide * (j + 1) + i)):
            rim = i in (0, count)
            length = x[one].DistanceTo(x[other])
            steel, density = (edge_steel, edge_density) if rim else (net_steel, net_density)
            cut = length / (1.0 + density * length / steel)  # so that it has its tension at this length
            (edges if rim else net).append(Rhino.Geometry.Line(x[one], x[other]))
            (edge_lengths if rim else net_lengths).append(cut)
            (edge_stiff if rim else net_stiff).append(steel / cut)
plan = [0.0] * len(x)
for i in range(count):
    for j in range(count):
        corner = [wide * i + j, wide * (i + 1) + j, wide * (i + 1) + j + 1, wide * i + j + 1]
        a, b, c, d = [x[k] for k in corner]
        area = 0.5 * abs((c.X - a.X) * (d.Y - b.Y) - (c.Y - a.Y) * (d.X - b.X))
        for k in corner:
            plan[k] += 0.25 * area
points = x
loads = [Rhino.Geometry.Vector3d(0, 0, -snow * size) for size in plan]
"""
NUMBERS = """
count = int(divisions)
wide = count + 1


def places(mesh):
    return [mesh.Vertices.Point3dAt(i) for i in range(wide * wide)]


drawn, loaded, still = places(form), places(result), places(same)
middle = len(drawn) // 2
height, sag = drawn[middle].Z, drawn[count // 2].X
form_net, form_edges = [max(form_forces.Branch(i)) for i in (0, 1)]
moved = max(p.DistanceTo(q) for p, q in zip(drawn, still))
down = drawn[middle].Z - loaded[middle].Z
net, edge = [list(forces.Branch(i)) for i in (0, 1)]
largest_edge, largest, least = max(edge), max(net), min(net)
balance = sum(v.Z for path in reactions.Paths for v in reactions.Branch(path)) + sum(v.Z for v in loads)
"""
NAMES = {
    "height": "form: height of the middle",
    "sag": "form: sag of an edge in plan",
    "form_edges": "form: largest force in an edge",
    "form_net": "form: largest force in the net",
    "moved": "no snow: largest movement",
    "down": "snow: middle goes down by",
    "largest_edge": "snow: largest force in an edge",
    "largest": "snow: largest force in the net",
    "least": "snow: least force in the net",
    "balance": "snow: reactions up less its weight",
}


def definition() -> Definition:
    d = Definition(
        "cable_net",
        "A cable net under snow",
        "The first engine finds the form by force densities. Steel cuts cables to their lengths in it, and the second "
        "engine puts snow on them. Set Reset to False and change snow and force densities.",
    )
    with d.group("Net"):
        divisions = d.slider("Meshes [-]", GIVEN["divisions"], 2, 20)
        made = d.script(
            "Net", DRAWN,
            {"divisions": divisions, "side": d.slider("Side [m]", GIVEN["side"], 5, 30, decimals=1),
             "rise": d.slider("Rise [m]", GIVEN["rise"], 0, 8, decimals=1)},
            ["mesh", "corners", "net", "edges"],
        )  # fmt: skip
    with d.group("Form"):
        density = d.slider("Force density [kN/m]", GIVEN["density"], 1, 50, decimals=1)
        edge_density = d.slider("At edges [kN/m]", GIVEN["edge_density"], 10, 500, decimals=1)
        zero = d.text("Rest factor [-]", "0")
        drawn = [
            d.component("Springs", name, connection=made[name], stiffness=q, rest_factor=zero)
            for name, q in (("net", density), ("edges", edge_density))
        ]
        unit = {"force_unit": d.text("Unit of force", "kN")}
        settings = d.component(
            "Settings", solver=d.text("Solver", "relaxation"), residual=d.text("Residual [-]", "1e-10"),
            fast=d.toggle("Fast", True), **unit,
        )  # fmt: skip
        reset = d.toggle("Reset", True)
        common = {"anchors": made["corners"], "settings": settings, "reset": reset}
        form = d.component("Engine", "Form", forces=flat(*drawn), geometry=made["mesh"], **common)
    with d.group("Steel"):
        snow = d.slider("Snow [kN/m2]", GIVEN["snow"], -2, 2, decimals=2)
        steel = d.script(
            "Steel", STEEL,
            {"form": form["geometry"], "divisions": divisions, "net_density": density, "edge_density": edge_density,
             "net_steel": d.slider("Net EA [kN]", GIVEN["net_steel"], 1000, 100000),
             "edge_steel": d.slider("Edge EA [kN]", GIVEN["edge_steel"], 10000, 1000000), "snow": snow},
            ["net", "edges", "net_lengths", "edge_lengths", "net_stiff", "edge_stiff", "points", "loads"],
        )  # fmt: skip
        cables = [
            d.component("Springs", connection=steel[f"{name}s" if name == "edge" else name],
                        stiffness=steel[f"{name}_stiff"], rest_length=steel[f"{name}_lengths"])
            for name in ("net", "edge")
        ]  # fmt: skip
        load = d.component("Unary", point=steel["points"], force=steel["loads"])
    with d.group("Snow"):
        ride = {"geometry": form["geometry"], **common}
        bare = d.component("Engine", "No snow", forces=flat(*cables), **ride)
        engine = d.component("Engine", "Snow", forces=flat(*cables, load), **ride)
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {"divisions": divisions, "form": form["geometry"], "form_forces": form["forces"],
                 "same": bare["geometry"], "result": engine["geometry"], "forces": engine["forces"],
                 "reactions": engine["reactions"], "loads": steel["loads"]}  # fmt: skip
        d.numbers(NUMBERS, given, NAMES, lists=["loads"], trees=["form_forces", "forces", "reactions"])
    return d
