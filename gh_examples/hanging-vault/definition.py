"""The hanging vault on the canvas: a chain and a net, turned over to an arch and a vault."""

from typing import Any

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("hanging-vault").scene)

INNER = """
inner = list(points)[1:-1]
"""
TURN = """
import Rhino


def over(p):
    return Rhino.Geometry.Point3d(p.X, p.Y, -p.Z)


def standing(line):
    return Rhino.Geometry.Line(over(line.From), over(line.To))


struts = lengths = points = loads = supports = None
if status.startswith("In equilibrium"):
    pulls, weights = list(forces.Branch(0)), list(forces.Branch(1))
    struts = [standing(line) for line in strings]
    lengths = [line.Length + pull / float(stiffness) for line, pull in zip(strings, pulls)]
    points = [over(p) for p in loaded]
    loads = [weight for weight in weights]
    supports = [over(p) for p in held]
"""
CHAIN = """
import math


def catenary(a, x):
    return a * (math.cosh(span / (2 * a)) - math.cosh(x / a))


span, whole = 16.0, 19.2
low, high = 1.0, 100.0
for _ in range(200):  # 2 a sinh(span / 2a) = length
    a = 0.5 * (low + high)
    low, high = (a, high) if 2 * a * math.sinh(span / (2 * a)) > whole else (low, a)
pulls, pushes = list(forces.Branch(0)), list(arch_forces.Branch(0))
middle = sum(p.X for p in chain) / len(chain)
sag = as_catenary = -min(p.Z for p in chain)
pull = abs(reactions.Branch(0)[0].X)
over_weight = pull / 3.0
tension = max(pulls)
rise = max(p.Z for p in arch)
off = max(abs(p.Z - catenary(a, p.X - middle)) for p in arch)
thrust = abs(arch_reactions.Branch(0)[0].X)
push = max(pushes)
reverse = max(abs(p + q) for p, q in zip(pulls, pushes))
balance = residual * 1.8
"""
CHAIN_NAMES = {
    "sag": "chain: sag", "as_catenary": "chain: sag, as a catenary", "pull": "chain: horizontal pull",
    "over_weight": "chain: horizontal pull / weight, as a catenary", "tension": "chain: greatest tension",
    "rise": "arch: rise", "off": "arch: off the catenary, most", "thrust": "arch: thrust",
    "push": "arch: greatest force, tension +", "reverse": "arch: sum of a force and its reverse, largest",
    "balance": "arch: out of balance",
}  # fmt: skip
NET = """
pulls, pushes = list(forces.Branch(0)), list(vault_forces.Branch(0))
loads = list(forces.Branch(1))
lifts, thrusts = list(reactions.Branch(0)), list(vault_reactions.Branch(0))
sag = -min(p.Z for p in net)
least = min(pulls)
tension = max(pulls)
weight = sum(r.Z for r in lifts)
crown = max(p.Z for p in vault)
push = max(pushes)
reverse = max(abs(p + q) for p, q in zip(pulls, pushes))
balance = residual * sum(abs(load.Z) for load in loads) / len(loads)
moved = iterations
vault_weight = sum(r.Z for r in thrusts)
thrust = (thrusts[0].X ** 2 + thrusts[0].Y ** 2) ** 0.5
both = max(max(abs(p.X + q.X), abs(p.Y + q.Y)) for p, q in zip(lifts, thrusts))
"""
NET_NAMES = {
    "sag": "net: sag", "least": "net: least tension", "tension": "net: greatest tension", "weight": "net: weight",
    "crown": "vault: crown", "push": "vault: greatest force, tension +",
    "reverse": "vault: sum of a force and its reverse, largest", "balance": "vault: out of balance",
    "moved": "vault: iterations", "vault_weight": "vault: weight", "thrust": "vault: thrust at a corner",
    "both": "vault: thrusts and the net's pulls, largest sum",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "hanging-vault",
        "Hang it, turn it over: a chain and a net, an arch and a vault",
        "What hangs is all in tension. Turned upside down under the same weight, with struts that push as hard as the "
        "strings pulled, it stands all in compression and nothing moves.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file = d.text("File", "model.3dm")
        chain = d.component("RhinoFile", file=file, layer=d.text("Chain", "chain"))["curves"]
        count = d.slider("Links [-]", 32, 2, 60)
        links = d.component("Shatter", curve=chain, count=count)["lines"]
        knots = d.component("Divide", curve=chain, count=count)
        inner = d.script("Inner", INNER, {"points": knots}, ["inner"], lists=["points"])
        ends = d.native("End Points", curve=chain)
        mesh = d.component(
            "RhinoFile", file=file, layer=d.text("Net", "net"), u=d.slider("U [-]", GIVEN["along"], 2, 40),
            v=d.slider("V [-]", GIVEN["across"], 2, 40),
        )["meshes"]  # fmt: skip
        columns = d.component("RhinoFile", file=file, layer=d.text("Columns", "columns"))["points"]
    with d.group("Hanging forces"):
        stiff = d.text("Stiffness of the chain [kN/m]", "1e7")
        length = d.slider("Length of a link [m]", 0.6, 0.5, 1, decimals=2)
        weight = d.native("Unit Z", factor=d.slider("Weight of a link [kN]", -1.8, -10, 0, decimals=1))
        chain_forces = flat(
            d.component("Springs", "Chain", connection=links, stiffness=stiff, rest_length=length),
            d.component("Unary", "Links", point=inner, force=weight),
        )
        string = d.text("Stiffness of the net [kN/m]", "1e4")
        slack = d.slider("Rest factor [-]", GIVEN["length_factor"], 1, 1.5, decimals=2)
        per_length = d.slider("Weight of string [kN/m]", GIVEN["weight"], 0, 5, decimals=1)
        net_forces = flat(
            d.component("Springs", "Net", connection=mesh, stiffness=string, rest_factor=slack),
            d.component("SelfWeight", "Weight", connection=mesh, per_length=per_length),
        )
    with d.group("Hanging"):
        reset, fast, newton = d.toggle("Reset", True), d.toggle("Fast", True), d.text("Solver", "newton")
        unit = d.text("Force", "kN")
        exact = d.component(
            "Settings", solver=newton, residual=d.text("Residual [-]", "1e-9"), force_unit=unit, fast=fast
        )
        hung: dict[str, Any] = {"settings": exact, "reset": reset}
        held = flat(ends["Start"], ends["End"])
        hanging = d.component("Engine", "Chain hangs", forces=chain_forces, anchors=held, geometry=links, **hung)
        sagging = d.component("Engine", "Net hangs", forces=net_forces, anchors=flat(columns), geometry=mesh, **hung)
    with d.group("Turned over", "Mirrored in the plane of the supports; rest length = length + tension / k."):
        outputs = ["struts", "lengths", "points", "loads", "supports"]
        lists = ["strings", "loaded", "held"]
        moved = d.component("MeshEdges", mesh=sagging["geometry"])["edges"]
        vertices = d.component("MeshVertices", mesh=sagging["geometry"])
        held_ends = [ends["Start"], ends["End"]]
        knots = d.script("Inner", INNER, {"points": hanging["particles"]}, ["inner"], lists=["points"])
        cases = (("Arch", hanging, hanging["geometry"], knots, held_ends, stiff),
                 ("Vault", sagging, moved, vertices, columns, string))  # fmt: skip
        turned = []
        for name, engine, strings, loaded, supports, stiffness in cases:
            given = {"strings": strings, "loaded": loaded, "held": supports, "forces": engine["forces"]}
            given |= {"status": engine["status"], "stiffness": stiffness}
            over = d.script(f"Turn over: {name}", TURN, given, outputs, lists=lists, trees=["forces"])
            springs = d.component(
                "Springs", f"{name} struts", connection=over["struts"], stiffness=stiffness,
                rest_length=over["lengths"],
            )  # fmt: skip
            load = d.component("Unary", f"{name} load", point=over["points"], force=over["loads"])
            turned.append((name, flat(springs, load), over["supports"], over["struts"]))
    with d.group("Standing"):
        rest = d.component(
            "Settings", "Settings, standing", solver=newton, force_unit=unit, fast=fast,
            allow_unstable=d.toggle("Keep unstable equilibria", True),
        )  # fmt: skip
        arch, vault = (
            d.component(
                "Engine", f"{name} stands", forces=forces, anchors=flat(supports), geometry=struts, settings=rest,
                reset=reset,
            )
            for name, forces, supports, struts in turned
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        for below, above, names, code, (short, tall) in (
            (hanging, arch, CHAIN_NAMES, CHAIN, ("chain", "arch")), (sagging, vault, NET_NAMES, NET, ("net", "vault")),
        ):  # fmt: skip
            given = {short: below["particles"], tall: above["particles"]}
            given |= {"forces": below["forces"], f"{tall}_forces": above["forces"]}
            given |= {"reactions": below["reactions"], f"{tall}_reactions": above["reactions"]}
            given |= {"residual": above["residual"], "iterations": above["iterations"]}
            d.numbers(code, given, names, lists=[short, tall], trees=[k for k in given if "orces" in k or "reac" in k])
    return d
