"""Figures 9.17 to 9.20 on the canvas: a line that stretches misses the catenary; an arc that hardly does becomes it."""

from typing import Any

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.17-arc-to-catenary").scene)

CASES = {
    "line": ("line", False),
    "arc": ("arc", False),
    "wide arc": ("wide arc", False),
    "arc, rest by arc length": ("arc", True),
    "wide arc, rest by arc length": ("wide arc", True),
}
MEASURES = '''
import math


def measured(lines, arc):
    """Length, sag and the largest height over the catenary of length `arc` (None: the cable's own) through its ends."""
    points = [lines[0].From] + [line.To for line in lines]
    lengths = [line.Length for line in lines]
    total = sum(lengths)
    span = points[-1].X - points[0].X
    low, high = 1e-9, 100.0
    for _ in range(200):  # L = 2 a sinh(span / 2a)
        u = (low + high) / 2
        low, high = (u, high) if math.sinh(u) / u < (arc or total) / span else (low, u)
    a = span / 2 / low
    middle = (points[0].X + points[-1].X) / 2
    foot = a * math.cosh((points[0].X - middle) / a)
    off = max(abs(p.Z - points[0].Z - a * math.cosh((p.X - middle) / a) + foot) for p in points)
    return lengths, total, -min(p.Z for p in points), off


'''


def definition() -> Definition:
    d = Definition(
        "9.17-arc-to-catenary",
        "Figure 9.17: an arc becomes a catenary",
        "model.3dm holds a line of 10 m, an arc of 20 m over 10 m and one over 14 m, each cut into 50 springs. The "
        "line must stretch to hang and misses the catenary; the arcs have the length they need and come down on it.",
    )
    with d.group("Values"):
        file = d.text("File", "model.3dm")
        count = d.slider("Springs [-]", GIVEN["pieces"], 2, 200)
        down = d.native("Unit Z", factor=d.slider("Load [N]", -GIVEN["load"], -10, 0, decimals=1))
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        reset = d.toggle("Reset", True)
        soft = d.slider("Stiffness of the line [N/m]", 75, 10, 1000)
        stiff = d.slider("Stiffness of the arcs [N/m]", GIVEN["stiffness"], 100, 10000)
        factor = d.slider("Rest factor of the arcs [-]", GIVEN["rest_factor"], 0.9, 1.1, decimals=3)
        rest = d.text("Rest length along the arcs [m]", "0.4")

    def cable(title: str, layer: str, along: bool) -> Any:
        """A curve of the model as a cable: its springs as they hang."""
        curve = d.component("RhinoFile", file=file, layer=d.text("Layer", layer))["curves"]
        lines = d.component("Shatter", curve=curve, count=count)["lines"]
        ends = d.native("End Points", curve=curve)
        options = {"stiffness": soft} if layer == "line" else {"stiffness": stiff, "rest_factor": factor}
        springs = d.component("Springs", connection=lines, **options, **({"rest_length": rest} if along else {}))
        load = d.component("Unary", point=d.component("Divide", curve=curve, count=count), force=down)
        engine = d.component(
            "Engine", title, forces=flat(springs, load), anchors=flat(ends["Start"], ends["End"]), settings=settings,
            geometry=lines, reset=reset,
        )  # fmt: skip
        return engine["geometry"]

    hanging = []
    for title, (layer, along) in CASES.items():
        with d.group(title[0].upper() + title[1:]):
            hanging.append(cable(title, layer, along))
    with d.group("Numbers", "What expected.json holds the figure to."):
        code, names = MEASURES, {}
        for i, title in enumerate(CASES):
            arc = "None" if title == "line" else "20.0"
            code += f"lengths_{i}, length_{i}, sag_{i}, off_{i} = measured(cable_{i}, {arc})\n"
            said = {f"length_{i}": "length", f"sag_{i}": "sag", f"off_{i}": "off the catenary"}
            names |= {variable: f"{title}: {what}" for variable, what in said.items()}
        code += "shortest, longest = min(lengths_1), max(lengths_1)\n"
        code += "change = max(abs(length - 20.0 / len(lengths_1)) for length in lengths_1)\n"
        names |= {
            "shortest": "arc: shortest segment", "longest": "arc: longest segment",
            "change": "arc: largest change of a segment",
        }  # fmt: skip
        inputs = {f"cable_{i}": lines for i, lines in enumerate(hanging)}
        d.numbers(code, inputs, names, lists=list(inputs))
    return d
