"""What the components of Kangaroo are for: solvers, goals and tools; and why some of them have no counterpart."""

from __future__ import annotations

from enum import Enum

from hookean_canvas.archive.parts import Part
from hookean_canvas.kangaroo import engineering
from hookean_canvas.kangaroo.ids import COMPONENTS, Known, key
from hookean_canvas.kangaroo.reasons import REASONS
from hookean_canvas.kangaroo.table import CLASSIC, SECOND


class Role(Enum):
    """A solver; a goal (a force, settings, what is shown) for one; a tool, which works alone."""

    SOLVER = "solver"
    GOAL = "goal"
    TOOL = "tool"


_SOLVER_NAMES = "kangaroophysics zombiekangaroo solver bouncysolver zombiesolver stepsolver soft&hardsolver"
_TOOL_NAMES = """
bipartite byparent checkerboard combine&clean corners diagonalize facefaceoffset foldangle hingepoints
interconnectpoints meshcorners meshdirection meshmachine meshmap meshturn multipipe nakedvertices planarity
planarityanalysis planaritydisplay quaddivide reciprocal refine refinestrips remesh remeshbycolour
removeduplicatelines removeduplicatepts simple simpleremesh splitatcorners stripper tangentcircles triremesh
unroller vertexneighbours warpweft counter sequence trail wave
"""
_SOLVERS, _TOOLS = frozenset(_SOLVER_NAMES.split()), frozenset(_TOOL_NAMES.split())

_KNOWN = {key(known.name) for known in COMPONENTS.values() if known.generation != "engineering"} | {
    *CLASSIC,
    *SECOND,
    *REASONS,
}


def role(known: Known, stream: bool = False) -> Role:
    """What a component is for; one that no table knows is a goal where goals come from (`stream`), else a tool."""
    name = key(known.name)
    if known.generation == "engineering":
        return Role.GOAL if name in engineering.GOALS else Role.TOOL
    if name in _SOLVERS:
        return Role.SOLVER
    if name in _TOOLS:
        return Role.TOOL
    return Role.GOAL if stream or name in _KNOWN else Role.TOOL


def reason(known: Known) -> str:
    """Why a component of Kangaroo stays as it is."""
    if known.generation == "engineering":
        why = engineering.REASONS.get(key(known.name), "it has no counterpart")
        return f"{why}; it stays on" if role(known) is Role.TOOL else why
    if key(known.name) not in _TOOLS:
        return REASONS.get(key(known.name), "it has no counterpart")
    why = REASONS.get(key(known.name), "a tool for geometry")
    return f"{why}; it stays on" + (
        ", as it comes with Rhino" if known.generation == "second" else " and needs Kangaroo"
    )


def called(part: Part, known: Known) -> str:
    """A component of Kangaroo as a person finds it: its name, and its nickname where that is another."""
    label = part.label
    return known.name if key(label) in usual(known) else f"{known.name} ({label})"


def usual(known: Known) -> set[str]:
    """Nicknames that Kangaroo gives by itself."""
    short = {"springsfromline": "springs", "unaryforce": "uforce", "kangaroophysics": "kangaroo", "soapfilm": "sg"}
    return {key(known.name), short.get(key(known.name), ""), "tsmooth", "mc", "nv"}
