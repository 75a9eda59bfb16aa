"""The Basento study on the canvas: a skin in tension, and the same shape with every force reversed."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("basento").scene)

REVERSE = """
import Rhino

struts = strut_lengths = ribs = rib_lengths = nudged = nudged_ribs = tips = pressed = None
if status.startswith("In equilibrium"):
    k, pulls = float(stiffness), [list(forces.Branch(0)), list(forces.Branch(1))]
    strut_lengths = [line.Length + pull / k for line, pull in zip(skin, pulls[0])]
    rib_lengths = [line.Length + pull / k for line, pull in zip(edges, pulls[1])]
    struts, ribs = list(skin), list(edges)
    middle = particles[len(particles) // 2]

    def pushed(p):  # the middle, pressed down
        return Rhino.Geometry.Point3d(p.X, p.Y, p.Z - nudge if p.DistanceTo(middle) < 1e-9 else p.Z)

    nudged = [Rhino.Geometry.Line(pushed(line.From), pushed(line.To)) for line in skin]
    nudged_ribs = [Rhino.Geometry.Line(pushed(line.From), pushed(line.To)) for line in edges]
    tips, held = list(fingers), list(reactions.Branch(0))[feet:]
    pressed = [Rhino.Geometry.Vector3d(0.0, 0.0, -reaction.Z) for reaction in held]
"""
NUMBERS = """
def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def triangle(a, b, c):
    p, q = minus(b, a), minus(c, a)
    n = p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]
    return 0.5 * sum(part * part for part in n) ** 0.5


points = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
rows = [[(p.X, p.Y, p.Z) for p in points[i : i + v + 1]] for i in range(0, len(points), v + 1)]
lines = list(skin) + list(edges)
pulls = list(forces.Branch(0)) + list(forces.Branch(1))
pushes = list(reversed_forces.Branch(0)) + list(reversed_forces.Branch(1))
held, standing = list(reactions.Branch(0)), list(reversed_reactions.Branch(0))
pairs = list(zip(held, standing))
least, greatest = min(pulls), max(pulls)
least_push, greatest_push = -max(pushes), -min(pushes)
reverse = max(abs(p + q) for p, q in zip(pulls, pushes))
sideways = max(max(abs(p.X + q.X), abs(p.Y + q.Y)) for p, q in pairs)
upright = max(abs(p.Z + q.Z) for p, q in pairs[:feet])
both = max(sideways, upright)
loads = [load.Z for load in reversed_forces.Branch(2)]
deck = -sum(loads)
balance = residual * deck / len(loads)
moved_in = iterations
fled = max(max(a.From.DistanceTo(b.From), a.To.DistanceTo(b.To)) for a, b in zip(after.Branch(0), skin))
lift = sum(r.Z for r in standing[:feet])
work = sum(pull * line.Length for pull, line in zip(pulls, lines))
outside = sum(r.X * p.X + r.Y * p.Y + r.Z * p.Z for r, p in zip(held, supports))
maxwell = work - outside
area = 0.0
for near, far in zip(rows, rows[1:]):  # a quad is the mean of its two cuts
    for a, d, b, c in zip(near, near[1:], far, far[1:]):
        area += 0.5 * (triangle(a, b, c) + triangle(a, c, d) + triangle(a, b, d) + triangle(b, c, d))
line = [p for p in points if abs(p.Y) < 1e-6]
pier = min(line, key=lambda p: abs(p.X)).Z
lowest = min(p.Z for p in line)
"""
NAMES = {
    "least": "least tension", "greatest": "greatest tension", "least_push": "least compression",
    "greatest_push": "greatest compression", "reverse": "sum of a force and its reverse, largest",
    "both": "reactions and their reverse, largest sum", "balance": "out of balance in compression",
    "moved_in": "iterations in compression", "fled": "moved after a nudge of 1 mm", "deck": "deck carried",
    "lift": "feet push up", "work": "force times length, in tension",
    "maxwell": "force times length against Maxwell", "area": "area of the skin", "pier": "height over the pier",
    "lowest": "lowest height on the middle line",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "basento",
        "The Basento study: the same shape in tension and in compression",
        "A skin stretched between four feet and six fingers, all cables. Then every force turned round: struts of "
        "concrete that push as hard, and the deck rests on the fingers. It is in equilibrium, but not stable: pressed "
        "down by a millimetre, it flees.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file = d.text("File", "model.3dm")
        v, skin = d.slider("V [-]", GIVEN["across"], 2, 20), d.text("Skin", "skin")
        drawn = d.component("RhinoFile", file=file, layer=skin, u=d.slider("U [-]", GIVEN["along"], 2, 60), v=v)
        feet, fingers = (
            d.component("RhinoFile", file=file, layer=d.text(name.title(), name))["points"]
            for name in ("feet", "fingers")
        )
        standing = d.native("List Length", list=feet)
    with d.group("Tension"):
        mesh, factor = drawn["meshes"], d.slider("Rest factor [-]", 0, 0, 1, decimals=2)
        cables = [
            d.component(
                "Springs", name, connection=mesh, edges=d.text(f"Which: {name}", which),
                stiffness=d.slider(f"{name} [kN/m]", GIVEN[of], 1, 1000), rest_factor=factor,
            )
            for name, which, of in (("Skin", "all", "skin_density"), ("Edges", "naked", "edge_density"))
        ]  # fmt: skip
        reset, fast, unit = d.toggle("Reset", True), d.toggle("Fast", True), d.text("Force", "kN")
        solver = d.text("Solver", "newton")
        exact = d.component(
            "Settings", solver=solver, residual=d.text("Residual [-]", "1e-12"), force_unit=unit, fast=fast
        )
        stretched = d.component(
            "Engine", "Tension", forces=flat(*cables), anchors=flat(feet, fingers), settings=exact, geometry=mesh,
            reset=reset,
        )  # fmt: skip
        lines = d.component("MeshEdges", mesh=stretched["geometry"])
    with d.group("Reversed", "Rest length = length + tension / k; what held the fingers up now presses down on them."):
        concrete = d.text("Concrete [kN/m]", "5e6")
        nudge = d.slider("Nudge [m]", 0.001, 0, 0.1, decimals=3)
        given = {"skin": lines["edges"], "edges": lines["naked"], "particles": stretched["particles"]}
        told = {name: stretched[name] for name in ("forces", "reactions", "status")}
        over = d.script(
            "Reverse", REVERSE,
            {**given, **told, "fingers": fingers, "stiffness": concrete, "nudge": nudge, "feet": standing},
            ["struts", "strut_lengths", "ribs", "rib_lengths", "nudged", "nudged_ribs", "tips", "pressed"],
            lists=[*given, "fingers"], trees=["forces", "reactions"],
        )  # fmt: skip
        deck = d.component("Unary", "Deck", point=over["tips"], force=over["pressed"])
        held = [
            d.component("Anchors", "Feet", point=feet),
            d.component("Anchors", "Fingers", point=fingers, z=d.toggle("Fingers held upright", False)),
        ]
        pairs = (("struts", "ribs"), ("nudged", "nudged_ribs"))
        tables = [
            [
                d.component("Springs", f"{name} of concrete", connection=over[name], stiffness=concrete,
                            rest_length=over[lengths])
                for name, lengths in zip(pair, ("strut_lengths", "rib_lengths"), strict=True)
            ]
            for pair in pairs
        ]  # fmt: skip
    with d.group("Compression"):
        rest = d.component(
            "Settings", "Settings, compression", solver=solver, residual=d.text("Residual, compression [-]", "1e-9"),
            force_unit=unit, fast=fast, allow_unstable=d.toggle("Keep unstable equilibria", True),
        )  # fmt: skip
        pressed = d.component(
            "Engine", "Compression", forces=flat(*tables[0], deck), anchors=flat(*held), settings=rest, reset=reset,
            geometry=over["struts"],
        )  # fmt: skip
        motion = d.component("Settings", "Motion", time_step=d.text("Time step [s]", "1e-4"), force_unit=unit)
        fleeing = d.component(
            "Moments", forces=flat(*tables[1], deck), anchors=flat(*held), settings=motion, geometry=over["nudged"],
            times=d.slider("After [s]", 0.4, 0, 1, decimals=2),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        both = {"mesh": stretched["geometry"], "v": v, "feet": standing, **given}
        trees = {"forces": stretched["forces"], "reactions": stretched["reactions"]}
        trees |= {"reversed_forces": pressed["forces"], "reversed_reactions": pressed["reactions"]}
        trees["after"] = fleeing["geometry"]
        both |= {"residual": pressed["residual"], "iterations": pressed["iterations"]}
        both["supports"] = [feet, fingers]
        d.numbers(NUMBERS, {**both, **trees}, NAMES, lists=[*given, "supports"], trees=list(trees))
    return d
