"""Figures 9.12 and 9.13 on the canvas: Hooke's law. Springs of 80 cm under several loads, stiffnesses and dampings."""

from typing import Any

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.12-hooke").scene)

MOTION = '''
"""How a spring swings under its load: the length at last, and when it last was 0.5 cm away from rest."""

import math

from hookean_client import canvas_ask, canvas_words

STEP, FRAMES, MASS = 0.01, 500, 1.0  # s, at most, N s^2/cm
EXTENSION = load / stiffness


def scene(iterations):
    return {
        "units": {"length": "cm", "force": "N", "time": "s"},
        "particles": [[0, 0, 0], [0, 0, -80]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]], "stiffness": stiffness, "damping": damping},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -load]},
        ],
        "anchors": [{"particles": [0]}],
        "settings": {
            "solver": "verlet", "tolerance": 1e-12, "drag": 0, "time_step": STEP, "max_iterations": iterations,
        },
    }


def work(client):
    def length(frame):
        return -client.post("/v1/relax", scene(frame * steps))["particles"][1][2]

    def away(frame):
        return abs(length(frame) - 80.0 - EXTENSION) > 0.5

    ratio = damping / (2.0 * math.sqrt(stiffness * MASS))
    if ratio < 1.0:  # it swings: nothing is left after the time at which its envelope is under 0.5 cm
        rate = ratio * math.sqrt(stiffness / MASS)
        last = int(math.log(EXTENSION / 0.5 / math.sqrt(1.0 - ratio**2)) / rate / (steps * STEP)) + 1
        while not away(last):
            last -= 1
    else:  # it creeps there
        last, after = 0, FRAMES
        while after - last > 1:
            middle = (last + after) // 2
            last, after = (middle, after) if away(middle) else (last, middle)
    return [length(FRAMES), last * steps * STEP]


found = canvas_ask.ask(ghenv, (canvas_words.run_of(ghenv), "motion"), repr((load, stiffness, damping, steps)), work)
length_at_last, settled = found or (None, None)
'''
DOWN = """
import Rhino

force = Rhino.Geometry.Vector3d(0, 0, -load)
"""
NUMBERS = """
under_load = one[0].Length
extension = under_load - 80
back = free[0].Length
x0, x25, x50, x75, x100 = [line.Length - 80 for line in row]
k1, k2, k4, k8 = [line.Length - 80 for line in stiff]
if len(at_last) == 3:
    last1, last10, last100 = at_last
    settled1, settled10, settled100 = settled
"""
NAMES = {
    "under_load": "length under the load", "extension": "extension", "back": "length without the load",
    **{f"x{n}": f"extension under {n} N" for n in (0, 25, 50, 75, 100)},
    **{f"k{n}": f"extension at {n} N/cm" for n in (1, 2, 4, 8)},
    **{f"last{n}": f"length at last, damping {n} N s/cm" for n in (1, 10, 100)},
    **{f"settled{n}": f"time to settle, damping {n} N s/cm" for n in (1, 10, 100)},
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "9.12-hooke",
        "Figure 9.12: Hooke's law",
        "A vertical spring of 80 cm and 2 N/cm: 100 N stretch it by 50 cm, without them it comes back. Beside it "
        "springs under several loads and of several stiffnesses, and how long one swings with several dampings.",
    )
    with d.group("Values"):
        unit, fast = d.text("Unit", "cm"), d.toggle("Fast", True)
        settings, unloaded = (
            d.component("Settings", length_unit=unit, residual=d.text(name, residual), fast=fast)
            for name, residual in (("Residual [-]", "1e-12"), ("Residual without a load [-]", "1e-10"))
        )
        reset = d.toggle("Reset", True)
        k = d.slider("Stiffness [N/cm]", GIVEN["stiffness"], 0.5, 10, decimals=1)
        weight = d.slider("Load [N]", GIVEN["weight"], 0, 200)
        down = d.script("Down", DOWN, {"load": weight}, ["force"])
        loads = d.parameter("Number", "Loads [N]", [0.0, -25.0, -50.0, -75.0, -100.0])
        stiffnesses = d.parameter("Number", "Stiffnesses [N/cm]", [1.0, 2.0, 4.0, 8.0])

    def engine(name: str, many: Any, bottom: float, stiffness: Any, force: Any) -> Any:
        """Vertical springs of 80 cm side by side, drawn from 0 down to `bottom`, one for each of `many`."""
        x = 0 if many is None else d.native("Series", start=0, step=30, count=d.native("List Length", list=many))
        lines = d.native("Line", start_point=d.point(x, 0, 0), end_point=d.point(x, 0, bottom))
        ends = d.native("End Points", curve=lines)
        rest = {} if force is not None else {"rest_length": d.text("Rest length [cm]", "80")}
        pulls = [d.component("Springs", connection=lines, stiffness=stiffness, **rest)]
        if force is not None:
            pulls.append(d.component("Unary", point=ends["End"], force=force))
        made = d.component(
            "Engine", name, forces=flat(*pulls), anchors=ends["Start"], geometry=lines, reset=reset,
            settings=unloaded if force is None else settings,
        )  # fmt: skip
        return made["geometry"]

    with d.group("One spring under its load"):
        one = engine("Load", None, -80, k, down)
    with d.group("The same, drawn to 130 cm, without the load"):
        free = engine("Free", None, -130, k, None)
    with d.group("Springs under several loads"):
        row = engine("Row", loads, -80, k, d.native("Unit Z", factor=loads))
    with d.group("Springs of several stiffnesses"):
        stiff = engine("Stiff", stiffnesses, -80, stiffnesses, down)
    with d.group("Motion", "One spring and its weight in physical time, for each damping; nothing else is damped."):
        motion = d.script(
            "Motion", MOTION,
            {"load": weight, "stiffness": k,
             "damping": d.parameter("Number", "Dampings [N s/cm]", [1.0, 10.0, 100.0]),
             "steps": d.parameter("Integer", "Steps of 10 ms a frame [-]", [5, 20, 80])},
            ["length_at_last", "settled"],
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.numbers(
            NUMBERS,
            {"one": one, "free": free, "row": row, "stiff": stiff, "at_last": motion["length_at_last"],
             "settled": motion["settled"]},
            NAMES, lists=["one", "free", "row", "stiff", "at_last", "settled"],
        )  # fmt: skip
    return d
