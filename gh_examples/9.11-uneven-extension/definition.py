"""Figure 9.11 on the canvas: springs nearer the supports of a loaded cable stretch more."""

from hookean_canvas.definitions.write import Definition, flat

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
    with d.group("Line"):
        end = d.point(d.slider("Span [m]", 10, 1, 20, decimals=1), 0, 0)
        line = d.native("Line", start_point=d.point(0, 0, 0), end_point=end)
        ends = d.native("End Points", curve=line)
        count = d.slider("Springs [-]", 5, 1, 50)
        pieces = d.component("Shatter", curve=line, count=count)
        points = d.component("Divide", curve=line, count=count)
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", 1000, 10, 5000)
        springs = d.component("Springs", connection=pieces["lines"], stiffness=stiffness)
        down = d.native("Unit Z", factor=d.slider("Load [N]", -20, -100, 0, decimals=1))
        load = d.component("Unary", point=points, force=down)
    with d.group("Engine"):
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        engine = d.component(
            "Engine", forces=flat(springs, load), anchors=[ends["Start"], ends["End"]], settings=settings,
            geometry=pieces["lines"], reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "starts": pieces["lengths"],
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
