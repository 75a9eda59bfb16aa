"""Figure 9.6 on the canvas: a cable let go bounces until it is at rest; its shape at some times, and at last."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.6-bouncing").scene)

MOTION = parts.motion(
    "The particles at a time: the same forces, anchors and settings, run for so many steps from the start."
)
NUMBERS = """
def length(points):
    return sum(a.DistanceTo(b) for a, b in zip(points, points[1:]))


def sag(points):
    return -min(p.Z for p in points)


shapes = [moving.Branch(path) for path in moving.Paths]
if len(shapes) == 5:
    at_03, at_06, at_09, at_12, at_18 = [length(points) for points in shapes]
    sag_09 = sag(shapes[2])
at_rest = length(resting)
sag_rest = sag(resting)
"""


def definition() -> Definition:
    d = Definition(
        "9.6-bouncing",
        "Figure 9.6: a cable bounces",
        "The cable of figure 9.4 in physical time: 1 kg on every particle, steps of 1 ms. Set Fast to False to watch "
        "it: it passes its equilibrium by half, comes back, and settles. Motion gives its shape at the times listed.",
    )
    line = parts.line(d, GIVEN["pieces"])
    forces, _ = parts.hung(d, line, GIVEN, damped=True)
    with d.group("Settings"):
        settings = d.component(
            "Settings", time_step=d.text("Time step [s]", str(GIVEN["time_step"])),
            sub_iterations=d.slider("Steps a frame [-]", GIVEN["sub_iterations"], 1, 200),
            drag=d.slider("Drag [N s/m]", GIVEN["drag"], 0, 10, decimals=1), solver=d.text("Solver", "verlet"),
            residual=d.text("Residual [-]", "1e-10"), fast=d.toggle("Fast", True),
        )  # fmt: skip
    with d.group("Motion", "The same cable at some times, each from the start."):
        moving = d.script(
            "Motion", MOTION,
            {"forces": forces, "anchors": line.held, "settings": settings,
             "time": d.parameter("Number", "Times [s]", [0.3, 0.6, 0.9, 1.2, 1.8])},
            ["particles"], lists=["forces", "anchors"],
        )  # fmt: skip
    with d.group("Engine"):
        engine = d.component(
            "Engine", forces=forces, anchors=line.held, settings=settings,
            geometry=line.pieces, reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS, {"moving": moving, "resting": engine["particles"]},
            {
                "at_03": "length at 0.3 s", "at_06": "length at 0.6 s", "at_09": "length at 0.9 s",
                "at_12": "length at 1.2 s", "at_18": "length at 1.8 s", "sag_09": "sag at 0.9 s",
                "at_rest": "length at rest", "sag_rest": "sag at rest",
            },
            lists=["resting"], trees=["moving"],
        )  # fmt: skip
    return d
