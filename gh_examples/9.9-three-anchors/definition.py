"""Figure 9.9 on the canvas: a cable with two anchors, with a third one, and with a third that meets no particle."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.9-three-anchors").scene)

NUMBERS = """
import re


def sag(points):
    return -min(p.Z for p in points)


third = min(range(len(held)), key=lambda i: abs(held[i].X - place) if 0 < i < len(held) - 1 else 1e9)
lifts = [v.Z for v in reactions.Branch(0)]
sag_two = sag(two)
sag_left = sag(held[: third + 1])
sag_right = sag(held[third:])
lift_third = lifts[2]
lift_all = sum(lifts)
sag_between = sag(stray)
distances = re.findall(r"([0-9.e-]+) m away", " ".join(said))
distance = float(distances[0]) if distances else None
"""


def definition() -> Definition:
    d = Definition(
        "9.9-three-anchors",
        "Figure 9.9: a cable with a third anchor",
        "The cable of 10 m in ten springs, held at its ends; at a third particle too; and with a third anchor between "
        "two particles, which has no influence: the engine says so and how far away it is.",
    )
    line = parts.line(d, GIVEN["pieces"])
    with d.group("Third anchors"):
        at = d.slider("At a particle [m]", 4, 0, 10, decimals=1)
        third = d.point(at, 0, 0)
        between = d.point(d.slider("Between particles [m]", 4.5, 0, 10, decimals=1), 0, 0)
    forces, _ = parts.hung(d, line, GIVEN)
    with d.group("Engines", "Two anchors, three, and one that meets no particle: one toggle for all."):
        reset = d.toggle("Reset", True)
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        engines = [
            d.component(
                "Engine", nickname, forces=forces, anchors=[line.ends["Start"], line.ends["End"], *more],
                settings=settings, geometry=line.pieces, reset=reset,
            )
            for nickname, more in (("Two", []), ("Three", [third]), ("Between", [between]))
        ]  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        two, held, stray = engines
        d.panel("report", stray["report"])
        d.numbers(
            NUMBERS,
            {"two": two["particles"], "held": held["particles"], "reactions": held["reactions"], "place": at,
             "stray": stray["particles"], "said": stray["report"]},
            {
                "sag_two": "sag with two anchors", "sag_left": "sag of the left part",
                "sag_right": "sag of the right part", "lift_third": "lift of the third anchor",
                "lift_all": "lift of all anchors", "sag_between": "sag with an anchor between particles",
                "distance": "distance of that anchor from a particle",
            },
            lists=["two", "held", "stray", "said"], trees=["reactions"],
        )  # fmt: skip
    return d
