"""Figures 9.4 and 9.5 on the canvas: a line cut into springs, loads on its points, its ends held."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.4-cable").scene)

NUMBERS = """
lengths = [a.DistanceTo(b) for a, b in zip(particles, particles[1:])]
middle = len(lengths) // 2 - 1
springs = len(lengths)
length = sum(lengths)
first = lengths[0]
inner = lengths[middle]
longer = first - inner
force = forces.Branch(0)[0]
sag = -min(p.Z for p in particles)
lift = reactions.Branch(0)[0].Z
"""


def definition() -> Definition:
    d = Definition(
        "9.4-cable",
        "Figure 9.4: a cable under its loads",
        "A line of 10 m in ten springs, 10 N down on every particle, held at its ends. "
        "Reset True reads what is drawn, False lets it move. Pull the sliders while it runs.",
    )
    line = parts.line(d, GIVEN["pieces"])
    forces, _ = parts.hung(d, line, GIVEN)
    engine = parts.at_rest(d, forces, line, line.held)
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "reactions": engine["reactions"]},
            {
                "springs": "springs", "length": "length", "first": "length of the first spring",
                "inner": "length of a middle spring", "longer": "first spring longer than a middle one",
                "force": "force in the first spring", "sag": "sag", "lift": "lift of an anchor",
            },
            lists=["particles"], trees=["forces", "reactions"],
        )  # fmt: skip
    return d
