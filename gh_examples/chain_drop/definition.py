"""A falling chain on the canvas: its shape and energy at some times, each from the start."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("chain_drop").scene)

CHAIN = """
import math

import Rhino

count = int(links)
up = [gravity * (i - 0.5 * (count - 1)) for i in range(count)]


def steps(pull):
    # of the links of a chain at rest with this horizontal pull
    tension = [math.hypot(pull, v) for v in up]
    size = [length / count / t + 1.0 / stiffness for t in tension]
    return [(s * pull, s * v) for s, v in zip(size, up)]


low, high = 0.0, gravity * count
for _ in range(200):
    pull = 0.5 * (low + high)
    low, high = (pull, high) if sum(x for x, _ in steps(pull)) < apart else (low, pull)
points, lines = [Rhino.Geometry.Point3d(0, 0, 0)], []
for x, z in steps(low):
    points.append(Rhino.Geometry.Point3d(points[-1].X + x, 0, points[-1].Z + z))
    lines.append(Rhino.Geometry.Line(points[-2], points[-1]))
nail = points[0]
rest = length / count
load = Rhino.Geometry.Vector3d(0, 0, -gravity)
"""
MOTION = parts.motion(
    "The free end and the energy at a time: the same forces and settings, run for so many steps from the start."
)
MOTION += 'energy = answer and answer["energy"]["total"]\n'
NUMBERS = """
import math

ends = [-moving.Branch(path)[-1].Z for path in moving.Paths]
if len(ends) == 7:
    depth_3, depth_6, depth_9, before, after, depth_12 = ends[1:]
    ahead = depth_12 - 0.5 * gravity * 1.2**2
    speed = (after - before) / 0.0002
    x = 0.5 * (before + after) / length
    ratio = speed / math.sqrt(gravity * length * x * (2.0 - x) / (1.0 - x))
    change = max(abs(energy - energies[0]) for energy in energies) / (gravity * (links + 1) * length)
"""
NAMES = {
    "depth_3": "depth of the free end at 0.3 s",
    "depth_6": "depth of the free end at 0.6 s",
    "depth_9": "depth of the free end at 0.9 s",
    "depth_12": "depth of the free end at 1.2 s",
    "ahead": "ahead of a stone at 1.2 s",
    "speed": "speed of the free end at 1.1 s",
    "ratio": "speed of the free end at 1.1 s over that of a narrow fold",
    "change": "change of the energy, largest, over weight times length",
}


def definition() -> Definition:
    d = Definition(
        "chain_drop",
        "A falling chain",
        "A folded chain is released at one end and falls in physical time, 1 kg on every particle, without damping. "
        "Motion gives its shape at the times listed. Set Reset to False to watch it fall.",
    )
    with d.group("Chain"):
        given = {
            "length": d.slider("Length [m]", GIVEN["length"], 5, 20, decimals=1),
            "links": d.slider("Links [-]", GIVEN["links"], 4, 80),
            "gravity": d.slider("Gravity [m/s2]", GIVEN["gravity"], 0.1, 30, decimals=2),
        }
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10000, 1000000)
        apart = d.slider("Nails apart [m]", GIVEN["apart"], 0.1, 4.9, decimals=1)
        chain = d.script(
            "Chain", CHAIN, {**given, "stiffness": stiffness, "apart": apart},
            ["points", "lines", "nail", "rest", "load"],
        )  # fmt: skip
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=chain["lines"], stiffness=stiffness, rest_length=chain["rest"],
            damping=d.text("Damping [N s/m]", "0"),
        )  # fmt: skip
        forces = flat(springs, d.component("Unary", point=chain["points"], force=chain["load"]))
        time_step, drag = d.text("Time step [s]", "0.0001"), d.text("Drag [N s/m]", "0")
        frame = d.slider("Steps a frame [-]", 100, 1, 500)
        settings = d.component(
            "Settings", time_step=time_step, sub_iterations=frame, drag=drag, solver=d.text("Solver", "yoshida")
        )
    with d.group("Motion", "The same chain at some times, each from the start."):
        moving = d.script(
            "Motion", MOTION,
            {"forces": forces, "anchors": flat(chain["nail"]), "settings": settings,
             "time": d.parameter("Number", "Times [s]", [0.0, 0.3, 0.6, 0.9, 1.0999, 1.1001, 1.2])},
            ["particles", "energy"], lists=["forces", "anchors"],
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        d.numbers(
            NUMBERS, {"moving": moving["particles"], "energies": moving["energy"], **given}, NAMES, lists=["energies"],
            trees=["moving"],
        )  # fmt: skip
    return d
