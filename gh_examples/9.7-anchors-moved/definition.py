"""Figures 9.7 and 9.8 on the canvas: an anchor of a running cable is moved, put back, and the cable is reset."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.7-anchors-moved").scene)

SEQUENCE = """
# What a person does: wait until the cable is at rest, move the anchor, wait, put it back, wait, reset, wait.
import sys
import types

from Grasshopper.Kernel import GH_Document
from Rhino.Geometry import Vector3d

key = "hookean sequence " + str(ghenv.Component.InstanceGuid)
state = sys.modules.setdefault(key, types.ModuleType("sequence"))
if _reset or not hasattr(state, "phase"):
    state.phase = 0
    state.told = {}
phase = state.phase
shift = Vector3d(x, 0, z) if phase == 1 else Vector3d(0, 0, 0)
hold = bool(_reset) or phase == 3
if not _reset and phase < 5:
    component = ghenv.Component
    again = GH_Document.GH_ScheduleDelegate(lambda document: component.ExpireSolution(False))
    component.OnPingDocument().ScheduleSolution(50, again)
"""
NUMBERS = """
# Tells the sequence when the cable is at rest, by the name they share, and keeps what it was then.
import sys

state = sys.modules[key]
reached = particles[-1].DistanceTo(anchor) < 1e-9
rests = iterations == 0 if state.phase == 3 else str(status).startswith("In equilibrium") and iterations > 0
if reached and rests and phase == state.phase and phase < 5:
    points = particles
    state.told[phase] = (
        sum(a.DistanceTo(b) for a, b in zip(points, points[1:])), min(p.Z for p in points), max(forces.Branch(0)),
        sum(v.Z for v in reactions.Branch(0)),
    )
    state.phase += 1
told = state.told
if 4 in told:
    before = told[0][0]
    moved, lowest, force = told[1][:3]
    back = abs(told[2][0] - before)
    upward = told[4][3]
    again = abs(told[4][0] - before)
"""


def definition() -> Definition:
    d = Definition(
        "9.7-anchors-moved",
        "Figure 9.7: an anchor moved while the cable runs",
        "The right anchor goes 3 m in and 2 m up while the cable runs, comes back, and the cable is reset. An anchor "
        "keeps the particle it was given, so no support is lost. Reset False plays the sequence.",
    )
    line = parts.line(d, GIVEN["pieces"])
    with d.group("Sequence"):
        reset = d.toggle("Reset", True)
        sequence = d.script(
            "Sequence", SEQUENCE,
            {"_reset": reset, "x": d.slider("In [m]", -3, -5, 0, decimals=1),
             "z": d.slider("Up [m]", 2, -5, 5, decimals=1)},
            ["shift", "hold", "phase", "key"],
        )  # fmt: skip
        right = d.native("Move", geometry=line.ends["End"], motion=sequence["shift"])
    forces, _ = parts.hung(d, line, GIVEN)
    with d.group("Engine"):
        settings = d.component(
            "Settings", drag=d.slider("Drag [N s/m]", GIVEN["drag"], 0, 10, decimals=1),
            residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True),
        )  # fmt: skip
        engine = d.component(
            "Engine", forces=forces, anchors=[line.ends["Start"], right["Geometry"]], settings=settings,
            geometry=line.pieces, reset=sequence["hold"],
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "reactions": engine["reactions"],
             "iterations": engine["iterations"], "status": engine["status"], "anchor": right["Geometry"],
             "phase": sequence["phase"], "key": sequence["key"]},
            {
                "before": "length before", "moved": "length while moved", "lowest": "lowest point while moved",
                "force": "largest force while moved", "back": "length put back, change",
                "upward": "reactions after a reset", "again": "length after a reset, change",
            },
            lists=["particles"], trees=["forces", "reactions"],
        )  # fmt: skip
    return d
