"""The roof without thrust on its walls on the canvas: move the drift of snow, and each tie follows."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_tied_roof").scene)

DRAWN = """
import Grasshopper
import Rhino

count, number = int(links), int(arches)
lines, ties, inner, loads, walls, crowns = [], [], [], [], [], []
groups = Grasshopper.DataTree[object]()
for j in range(number):
    row = []
    for i in range(count + 1):
        y = span * (i / count - 0.5)
        row.append(Rhino.Geometry.Point3d(bay * j, y, 0.9 * rise * (1 - (2 * y / span) ** 2)))
    lines += [Rhino.Geometry.Line(row[i], row[i + 1]) for i in range(count)]
    for i in range(count):
        groups.Add(count * j + i, Grasshopper.Kernel.Data.GH_Path(j))
    ties.append(Rhino.Geometry.Line(row[0], row[-1]))
    inner += row[1:-1]
    load = Rhino.Geometry.Vector3d(0, 0, weight + drift * j / max(number - 1, 1))
    loads += [load] * (count - 1)
    walls += [row[0], row[-1]]
    crowns.append(row[count // 2])
"""
NUMBERS = """
without = max(abs(v.Y) for v in before)
thrust = max(abs(v.Y) for v in reactions)
pulls = list(forces.Branch(1))
crown = max(abs(particles[9 * j + 4].Z - 2.0) for j in range(7))
first_tie, last_tie = -pulls[0], -pulls[-1]
rows = [list(values.Branch(i)) for i in range(values.BranchCount)]
density, cut = sorted(rows, key=lambda row: -abs(row[-1] - 8.001))
first, last, length = density[0], density[-1], cut[-1]
weight = -sum(v.Z for v in reactions)
"""
NAMES = {
    "without": "without: thrust on a wall at an arch", "thrust": "thrust on a wall at an arch, most",
    "crown": "rise of a crown off 2 m, most", "first_tie": "first tie: force of the roof's",
    "last_tie": "last tie: force of the roof's", "first": "first arch: force density",
    "last": "last arch: force density", "length": "last tie: length cut", "weight": "weight on the walls",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_tied_roof",
        "A roof without thrust on its walls",
        "Upside down: loads act upwards; a pull in the arches is a push in the roof. Design finds the force density "
        "of each arch and the length of each tie.",
    )
    with d.group("Drawn"):
        given = {
            "span": d.slider("Span [m]", GIVEN["span"], 2, 20),
            "rise": d.slider("Rise [m]", GIVEN["rise"], 1, 5, 1),
            "links": d.slider("Links [-]", GIVEN["links"], 4, 20),
            "arches": d.slider("Arches [-]", GIVEN["arches"], 1, 12),
            "bay": d.slider("Bay [m]", GIVEN["bay"], 1, 5, 1),
            "weight": d.slider("Load [kN]", GIVEN["load"], 0, 9, 1),
            "drift": d.slider("Drift [kN]", GIVEN["drift"], 0, 9, 1),
        }
        outputs = ["lines", "ties", "inner", "loads", "walls", "crowns", "groups"]
        drawn = d.script("Roof", DRAWN, given, outputs)
    with d.group("Forces"):
        arches = d.component(
            "Springs",
            "Arches",
            connection=drawn["lines"],
            stiffness=d.slider("Density [kN/m]", GIVEN["density"], 1, 50),
            rest_factor=d.slider("Rest factor [-]", 0, 0, 1),
        )
        ties = d.component(
            "Springs", "Ties", connection=drawn["ties"], stiffness=d.text("Stiffness [kN/m]", "1e4"),
            rest_length=d.slider("Tie [m]", GIVEN["span"], 2, 20),
        )  # fmt: skip
        load = d.component("Unary", "Load", point=drawn["inner"], force=drawn["loads"])
        forces = flat(arches, ties, load)
        unit = d.component("Settings", force_unit=d.text("Force", "kN"), solver=d.text("Solver", "newton"))
    with d.group("Problem", "A density for each arch, a length for each tie."):
        density = d.component(
            "Variables", "Densities", force=arches, field=d.text("Density", "stiffness"), tie=drawn["groups"],
            lower=d.slider("Lower [kN/m]", 0.1, 0, 1, 1),
        )  # fmt: skip
        length = d.component(
            "Variables",
            "Lengths",
            force=ties,
            field=d.text("Length", "rest_length"),
            lower=d.slider("Lower [m]", 1, 0, 9),
        )
        crown = d.component(
            "Goals", "Rise", kind=d.text("Kind", "position"), points=drawn["crowns"], axes=d.text("Up", "z"),
            target=given["rise"],
        )  # fmt: skip
        thrust = d.component(
            "Goals", "No thrust", kind=d.text("Walls", "reaction"), anchors=drawn["walls"], axes=d.text("Across", "y"),
            target=d.slider("Thrust [kN]", 0, 0, 10),
        )  # fmt: skip
    with d.group("Start and design", "Ties that do nothing, and ties that work."):
        start = d.component(
            "Engine", "Start", forces=forces, anchors=drawn["walls"], settings=unit, reset=d.toggle("Reset", True)
        )
        found = d.component(
            "Design", forces=forces, anchors=drawn["walls"], settings=unit, geometry=drawn["lines"],
            variables=flat(density, length), goals=flat(crown, thrust),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        given = {
            "before": start["reactions"],
            "particles": found["particles"],
            "forces": found["forces"],
            "values": found["values"],
            "reactions": found["reactions"],
        }
        d.numbers(NUMBERS, given, NAMES, lists=["before", "particles", "reactions"], trees=["forces", "values"])
    return d
