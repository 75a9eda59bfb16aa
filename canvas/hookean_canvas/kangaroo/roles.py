"""What the components of Kangaroo are for: solvers, goals and tools; and why some of them have no counterpart."""

from __future__ import annotations

from enum import Enum

from hookean_canvas.archive.parts import Part
from hookean_canvas.kangaroo.ids import COMPONENTS, Known, key
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

_PURE = "geometry without mechanics of this kind is not here"
_SOLID = "elements of solids and membranes with a Young's modulus are not here"
_LINE = (
    "forces between lines, or points and lines, by a power of their distance are not here; Collide Lines is a contact"
)
_REASONS = {
    _PURE: "g2 cpmesh reciprocalstructure rheotomicsurface",
    _SOLID: "triangularelement tetrahedralelement",
    _LINE: "lineline pointline",
}
REASONS: dict[str, str] = {
    "soapfilm": "warp and weft are families of a mesh's edges here; connect a mesh to SoapFilm",
    "bomb": "Impulse takes a time, not counts of iterations; its momentum is another number than the strength",
    "gstring": "Geodesic Strip takes a mesh and the vertices of its lines",
    "imagecircles": "Circle Image takes an image as numbers",
    "boxcollide": "Box Collide takes the diagonals of all boxes",
    "soft&hardsolver": "goals are not of two ranks here; anchors, locks and floors are exact",
    "livesoap": "Live Film makes the mesh of a film again while it relaxes, without a solver on the canvas",
    "collidesurf": "connect a mesh to Collide Solid",
    "shear": "a force of this kind is not here",
    "edgebend": "Shell takes a mesh; Hinge takes edges with their tips",
    "origami": "Hinge takes edges with their tips, rest angles and an angle factor",
    "gravity": "Unary takes points and a vector",
    "particle": "masses and first velocities are fields of a scene; the canvas has no component for them",
    "beam": "beams of six degrees of freedom are not here",
    "support": "supports of six degrees of freedom are not here",
    **{name: why for why, names in _REASONS.items() for name in names.split()},
}
"""Why a component has no counterpart, or what to use instead."""
_KNOWN = {key(known.name) for known in COMPONENTS.values()} | {*CLASSIC, *SECOND, *REASONS}


def role(known: Known, stream: bool = False) -> Role:
    """What a component is for; one that no table knows is a goal where goals come from (`stream`), else a tool."""
    name = key(known.name)
    if name in _SOLVERS:
        return Role.SOLVER
    if name in _TOOLS:
        return Role.TOOL
    return Role.GOAL if stream or name in _KNOWN else Role.TOOL


def reason(known: Known) -> str:
    """Why a component of Kangaroo stays as it is."""
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
