"""Chains with a sliding support on the canvas: springs, weights, and rings that are pulled to their rails."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat, graft

GIVEN = defaults(figure("catenary").scene)

CHAINS = """
import math

import Rhino

point, vector = Rhino.Geometry.Point3d, Rhino.Geometry.Vector3d
count = int(links)
low, high = 1e-6, math.pi
for _ in range(100):  # half of the angle of an arc of this length over the span
    half = 0.5 * (low + high)
    low, high = (half, high) if math.sin(half) / half > span / length else (low, half)
radius = 0.5 * length / half
lines, points, loads, rings, rails, nails = [], [], [], [], [], []
for number, angle in enumerate(angles):
    y = number * apart
    turns = [half * (2.0 * i / count - 1.0) for i in range(count + 1)]
    x = [
        point(0.5 * span + radius * math.sin(turn), y, radius * (math.cos(half) - math.cos(turn))) for turn in turns
    ]
    lines += [Rhino.Geometry.Line(p, q) for p, q in zip(x, x[1:])]
    points += x
    loads += [vector(0, 0, -weight * length / count * (0.5 if i in (0, count) else 1.0)) for i in range(count + 1)]
    nails.append(x[0])
    rings.append(x[-1])
    rails.append(vector(math.cos(math.radians(angle)), 0, math.sin(math.radians(angle))))
rest = length / count
"""
NUMBERS = """
import math

count = int(links)
chains = [lines[i : i + count] for i in range(0, len(lines), count)]
names = ("90", "120", "75")
slopes, pulls, rings, pushes, depths = [], [], [], [], []
for number, chain in enumerate(chains):
    x = [chain[0].From] + [line.To for line in chain]
    tensions = [stiffness * (p.DistanceTo(q) - length / count) for p, q in zip(x, x[1:])]
    heights = [0.5 * (p.Z + q.Z) for p, q in zip(x, x[1:])]
    rings.append(-x[-1].Z)
    depths.append(-min(p.Z for p in x))
    pulls.append(tensions[0] * (x[1].X - x[0].X) / x[0].DistanceTo(x[1]))
    turn = math.radians(angles[number])
    pushes.append(stiffness * abs((x[-1].X - span) * math.sin(turn) - x[-1].Z * math.cos(turn)))
    mean, middle = sum(tensions) / count, sum(heights) / count
    slopes.append(sum((t - mean) * (z - middle) for t, z in zip(tensions, heights))
                  / sum((z - middle) ** 2 for z in heights))
low, high = 1e-3, 1e3
for _ in range(200):  # a sinh(span / a) = length
    a = math.sqrt(low * high)
    low, high = (a, high) if span / a > 700 or a * math.sinh(span / a) > length else (low, a)
pole = rings[0] / (a * math.cosh(span / a) - a)
level = pulls[0] / weight / a
slope = sum(slopes) / len(slopes) / weight
ring_90, ring_120, ring_75 = rings
pull_90, pull_120, pull_75 = pulls
push_90, push_120, push_75 = pushes
depth_90, depth_120, depth_75 = depths
"""
ANGLES = [int(angle) for angle in GIVEN["angles"]]
NAMES = {
    **{f"ring_{angle}": f"rail at {angle} degrees: depth of the ring" for angle in ANGLES},
    **{f"pull_{angle}": f"rail at {angle} degrees: horizontal pull" for angle in ANGLES},
    **{f"push_{angle}": f"rail at {angle} degrees: force of the rail" for angle in ANGLES},
    **{f"depth_{angle}": f"rail at {angle} degrees: lowest point" for angle in ANGLES},
    "pole": "pole: depth of the ring over the catenary's",
    "level": "pole: horizontal pull over w a",
    "slope": "tension by height, over the weight, mean",
}


def definition() -> Definition:
    d = Definition(
        "catenary",
        "Chains with a sliding support",
        "Chains hang from nails and from rings that are pulled to rails: a ring slides until its chain is square to "
        "the rail. Set Reset to False and change the angles.",
    )
    with d.group("Chains"):
        angles = d.parameter("Number", "Angles of rails [degrees]", [float(angle) for angle in ANGLES])
        span = d.slider("Span [m]", GIVEN["span"], 1, 9, decimals=1)
        length = d.slider("Length [m]", GIVEN["length"], 9.5, 20, decimals=1)
        links = d.slider("Links [-]", GIVEN["links"], 4, 160)
        weight = d.slider("Weight [N/m]", GIVEN["weight"], 1, 100)
        given = {"angles": angles, "span": span, "length": length, "links": links, "weight": weight}
        made = d.script(
            "Chains", CHAINS, {**given, "apart": d.slider("Apart [m]", GIVEN["apart"], 0.1, 5, decimals=1)},
            ["lines", "points", "loads", "rings", "rails", "nails", "rest"], lists=["angles"],
        )  # fmt: skip
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 1000, 10000000)
        springs = d.component("Springs", connection=made["lines"], stiffness=stiffness, rest_length=made["rest"])
        load = d.component("Unary", point=made["points"], force=made["loads"])
        rails = d.component(
            "PullToLine", point=graft(made["rings"]), origin=graft(made["rings"]), direction=graft(made["rails"]),
            strength=stiffness,
        )  # fmt: skip
    with d.group("Engine"):
        engine = parts.engine(
            d, "relaxation", "1e-9", forces=flat(springs, load, rails), anchors=made["nails"], geometry=made["lines"]
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        d.numbers(NUMBERS, {"lines": engine["geometry"], "stiffness": stiffness, **given}, NAMES,
                  lists=["lines", "angles"])  # fmt: skip
    return d
