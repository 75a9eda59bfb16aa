"""The vault to a target surface on the canvas: move the wall's weight, and its forces follow."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_vault").scene)

DRAWN = """
import Rhino

count = int(along)


def place(i, j, flat):
    x, y = 2 * i / count - 1, 2 * j / count - 1
    inside = 0 < i < count and 0 < j < count
    z = rise if flat and inside else rise * (1 - (x * x + y * y) / 2)
    return Rhino.Geometry.Point3d(x * size / 2, y * size / 2, z)


number = range(count + 1)
drawn = [[place(i, j, True) for j in number] for i in number]
surface = [[place(i, j, False) for j in number] for i in number]
lines = [
    Rhino.Geometry.Line(drawn[i][j], drawn[i + 1][j]) for j in range(1, count) for i in range(count)
] + [Rhino.Geometry.Line(drawn[i][j], drawn[i][j + 1]) for i in range(1, count) for j in range(count)]
joints, targets, loads, rim = [], [], [], []
for i in number:
    for j in number:
        if 0 < i < count and 0 < j < count:
            joints.append(drawn[i][j])
            targets.append(surface[i][j])
            loads.append(Rhino.Geometry.Vector3d(0, 0, weight + (wall if j == count // 2 else 0)))
        elif 0 < i < count or 0 < j < count:
            rim.append(drawn[i][j])
"""
NUMBERS = """
def surface(p):
    x, y = p.X / 4, p.Y / 4
    return abs(p.Z - 2 * (1 - (x * x + y * y) / 2))


off, off_before = max(map(surface, particles)), max(surface(p) for p in before)
least = min(forces.Branch(0))
weight = -sum(v.Z for v in reactions)
density = list(values.Branch(0))
rows = [density[8 * k : 8 * k + 8] for k in range(14)]
along, across = rows[:7], rows[7:]
plain = [q for k, row in enumerate(along) for q in row if k != 3]
mean = sum(plain) / len(plain)
wall = sum(along[3]) / 8 - mean
spread = max(max(row) - min(row) for row in along)
total = mean + sum(q for row in across for q in row) / 56
"""
NAMES = {
    "off": "off the surface, most", "off_before": "equal densities: off the surface, most",
    "least": "least force, push of the vault", "weight": "weight on the walls",
    "wall": "density along the wall less that beside it", "spread": "density along, spread on a line",
    "total": "density along and across, sum",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_vault",
        "A vault to a target surface",
        "Upside down: loads act upwards; a pull in the net is a push in the vault. Design finds the force densities "
        "with which all joints are on the surface, above their places in plan.",
    )
    with d.group("Drawn", "A net in plan, its rim on the surface."):
        given = {
            "size": d.slider("Side [m]", GIVEN["size"], 2, 20),
            "rise": d.slider("Rise [m]", GIVEN["rise"], 1, 5, 1),
            "along": d.slider("Meshes [-]", GIVEN["along"], 4, 12),
            "weight": d.slider("Weight [kN]", GIVEN["weight"], 0, 5, 1),
            "wall": d.slider("Wall [kN]", GIVEN["wall"], 0, 9, 1),
        }
        drawn = d.script("Vault", DRAWN, given, ["lines", "joints", "targets", "loads", "rim"])
    with d.group("Forces"):
        net = d.component(
            "Springs", "Net", connection=drawn["lines"], stiffness=d.slider("Density [kN/m]", GIVEN["density"], 1, 20),
            rest_factor=d.slider("Rest factor [-]", 0, 0, 1),
        )  # fmt: skip
        load = d.component("Unary", "Weight", point=drawn["joints"], force=drawn["loads"])
        forces = flat(net, load)
        unit = d.component("Settings", force_unit=d.text("Force", "kN"), solver=d.text("Solver", "newton"))
    with d.group("Problem"):
        varied = d.component(
            "Variables", force=net, field=d.text("Field", "stiffness"), lower=d.slider("Lower [kN/m]", 0.1, 0, 1, 1)
        )
        goal = d.component(
            "Goals", "Surface", kind=d.text("Kind", "position"), points=drawn["joints"], target=drawn["targets"]
        )
    with d.group("Start and design", "The net with equal densities, and on the surface."):
        start = d.component(
            "Engine", "Start", forces=forces, anchors=drawn["rim"], settings=unit, reset=d.toggle("Reset", True)
        )
        found = d.component(
            "Design", forces=forces, anchors=drawn["rim"], settings=unit, geometry=drawn["lines"], variables=varied,
            goals=goal,
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        given = {
            "particles": found["particles"],
            "before": start["particles"],
            "forces": found["forces"],
            "values": found["values"],
            "reactions": found["reactions"],
        }
        d.numbers(NUMBERS, given, NAMES, lists=["particles", "before", "reactions"], trees=["forces", "values"])
    return d
