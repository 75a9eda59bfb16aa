"""Figure 9.11 on the canvas: springs nearer the supports of a loaded cable stretch more."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.11-uneven-extension").scene)

NUMBERS = """
lengths = [a.DistanceTo(b) for a, b in zip(particles, particles[1:])]
longer = [now - start for now, start in zip(lengths, starts)]
tensions = forces.Branch(0)
length = sum(lengths)
extension = sum(longer)
first, second, third = longer[:3]
one_over_two = first - second
two_over_three = second - third
hooke = max(abs(tension - stiffness * x) for tension, x in zip(tensions, longer))
"""


def definition() -> Definition:
    d = Definition(
        "9.11-uneven-extension",
        "Figure 9.11: springs nearer the supports stretch more",
        "A cable of 10 m in five springs, 20 N on each of its six particles, becomes 10.468 m long. The springs at the "
        "supports carry the loads of the others too and stretch most.",
    )
    line = parts.line(d, GIVEN["pieces"])
    forces, stiffness = parts.hung(d, line, GIVEN)
    engine = parts.at_rest(d, forces, line, [line.ends["Start"], line.ends["End"]])
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "starts": line.lengths,
             "stiffness": stiffness},
            {
                "length": "length", "extension": "extension", "first": "extension of spring 1",
                "second": "extension of spring 2", "third": "extension of spring 3",
                "one_over_two": "spring 1 over spring 2", "two_over_three": "spring 2 over spring 3",
                "hooke": "difference of force and stiffness x extension",
            },
            lists=["particles", "starts"], trees=["forces"],
        )  # fmt: skip
    return d
