"""What stands for each component of Kangaroo: which of ours, input by input, what differs, and what has no counterpart.

Inputs and outputs of Kangaroo by their names in lower case without spaces, as files have them; ours by the names of
their variables without underscores. Sources of the differences: docs/from-kangaroo.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from hookean_canvas.kangaroo.ids import Known, key


@dataclass(frozen=True)
class Piece:
    """One of our components: `inputs` ours by Kangaroo's, `outputs` Kangaroo's by ours (`|`: either), `values` set.

    `feeds`: by an output, the input it is wired to, as the number of a piece and a name.
    """

    bundle: str
    inputs: Mapping[str, str]
    outputs: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    feeds: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Swap:
    """What a component of Kangaroo is swapped for.

    `pieces`: the first stands in its place. `differs`: a sentence. `without`: why an input has no counterpart.
    `usual`: what Kangaroo types into such an input, which says nothing. `needs`: inputs that identify the version.
    `unless`: inputs that must be empty, each with the reason.
    """

    pieces: tuple[Piece, ...]
    differs: str = ""
    without: Mapping[str, str] = field(default_factory=dict)
    usual: Mapping[str, Any] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    unless: Mapping[str, str] = field(default_factory=dict)


def _force(bundle: str, output: str, differs: str = "", needs: str = "", **inputs: str) -> Swap:
    return Swap((Piece(bundle, inputs, {"force": output}),), differs, needs=tuple(needs.split()))


_ENGINE = {
    "iterations": "iterations",
    "particles": "particlesout",
    "geometry": "geometryout",
    "energy": "ke",
    "report": "out",
}
_PHYSICS = {"forceobjects": "forces", "anchorpoints": "anchors", "settings": "settings", "geometry": "geometry"}
_ENDS = "it ends at a residual (out-of-balance force over load), not at a speed or an energy"
_FRICTION = "friction is Coulomb's here (0.6 resting, 0.5 sliding), another law than the number typed in Kangaroo"
_EXACT = "anchors hold exactly here, so they have no strength"
_BARE = "without Settings there is no floor"
_ENERGY = "the energy is that of all forces and of the motion, not of the motion alone"

_TOOLS = {
    "nakedvertices": Swap(
        (
            Piece(
                "NakedVertices",
                {"m": "mesh", "mesh": "mesh"},
                {
                    "clothed_index": "clothedi|clothedindex",
                    "naked_index": "nakedi|nakedindex",
                    "clothed_points": "clothedpts",
                    "naked_points": "nakedpts",
                },
            ),
        )
    ),
    "warpweft": Swap(
        (
            Piece(
                "WarpWeft",
                {"m": "mesh", "mesh": "mesh"},
                {"warp": "a", "weft": "b", "warp_naked": "na", "weft_naked": "nb"},
            ),
        ),
        "which family comes first may differ; a mesh without two is an error, unless `_strict_` is False",
    ),
    "removeduplicatelines": Swap(
        (Piece("RemoveDuplicateLines", {"lines": "lines", "tolerance": "tolerance"}, {"lines": "q"}),)
    ),
}
"""Tools of both generations."""

SETTINGS = Swap(
    (
        Piece(
            "Settings",
            {
                "tolerance": "tolerance",
                "timestep": "time_step",
                "subiterations": "sub_iterations",
                "floor": "floor",
                "drag": "drag",
                "solver": "solver",
            },
            {"settings": "settings"},
        ),
    ),
    "solvers 0 and 1 are verlet and yoshida; Archimedes, 2 and 3, is not here, and they are others if wired; "
    + _FRICTION,
    {
        "restitution": "the floor of the settings rebounds with 0.7; the component Floor takes another",
        "staticfriction": _FRICTION,
        "kineticfriction": _FRICTION,
        "settle": "bouncing ends by itself",
        "tumble": "sliding keeps the speed that friction leaves",
        "sound": "nothing sounds",
    },
    {"restitution": 0.7, "staticfriction": 10.0, "kineticfriction": 10.0, "settle": 2.0, "tumble": 1.0, "sound": False},
)

CLASSIC: dict[str, Swap] = {
    "kangaroophysics": Swap(
        (Piece("Engine", {**_PHYSICS, "simulationreset": "reset"}, _ENGINE),), f"{_ENERGY}; {_ENDS}; {_BARE}"
    ),
    "zombiekangaroo": Swap(
        (Piece("Engine", {**_PHYSICS, "simulationreset": "reset"}, _ENGINE),),
        f"the Engine plays on the service instead of holding the canvas; {_ENDS}",
        {"threshold": _ENDS, "maxiters": "the engine stops by itself; `max_iterations` of a scene limits it"},
    ),
    "kangaroosettings": SETTINGS,
    "springsfromline": Swap(
        (
            Piece(
                "Springs",
                {
                    "connection": "connection",
                    "stiffness": "stiffness",
                    "damping": "damping",
                    "restlength": "rest_length",
                    "uppercutoff": "upper_cutoff",
                    "lowercutoff": "lower_cutoff",
                    "cutoff": "upper_cutoff",
                    "plasticity": "plasticity",
                },
                {"force": "springs"},
            ),
        ),
        "a rest length of 0, which Kangaroo types in, stays 0; an empty input would be the start length here",
        {"compressionfail": "it does nothing in Kangaroo either", "tensilefail": "it does nothing in Kangaroo either"},
        {"compressionfail": 0.0, "tensilefail": 0.0},
    ),
    "unaryforce": _force("Unary", "unaryforce", point="point", force="force"),
    "anchorspring": Swap(
        (Piece("AnchorSpring", {"point": "point", "strength": "strength"}, {"force": "a"}),),
        without={"sticky": "soft anchors do not slip here"},
    ),
    "anchorxyz": Swap((Piece("Anchors", {"point": "point", "x": "x", "y": "y", "z": "z"}, {"anchors": "a"}),), _EXACT),
    "bend": _force(
        "Bend",
        "b",
        "the strength is EI here, moment x length per angle; a rest angle has a side, unless _sections_ is free",
        point1="point_1",
        point2="point_2",
        point3="point_3",
        bendstrength="stiffness",
        restangle="rest_angle",
    ),
    "hinge": _force(
        "Hinge",
        "h",
        "the strength is a moment per radian here",
        point1="point_1",
        point2="point_2",
        point3="point_3",
        point4="point_4",
        strength="strength",
        restangle="rest_angle",
    ),
    "planarize": _force(
        "Planarize",
        "p",
        "k by the distance between the diagonals",
        point1="point_1",
        point2="point_2",
        point3="point_3",
        point4="point_4",
        planarizestrength="stiffness",
    ),
    "shell": _force(
        "Shell",
        "shellforce",
        "the strength is the plate's bending stiffness D here, whatever the mesh",
        mesh="mesh",
        strength="strength",
        anglefactor="angle_factor",
    ),
    "meshpressure": _force(
        "Pressure",
        "p",
        "positive pressure pushes along the normals, out of counter-clockwise faces",
        mesh="mesh",
        pressurelevel="pressure",
    ),
    "springsfrommesh": _force(
        "Springs", "springs", mesh="connection", stiffness="stiffness", restlengthfactor="rest_factor"
    ),
    "polyspring": _force("Springs", "springs", polyline="connection", stiffness="stiffness"),
    "curvepull": _force(
        "PullToCurve",
        "c",
        "a strength of 0 pulls not at all; it is no hard constraint",
        curve="curve",
        points="point",
        strength="strength",
    ),
    "pulltosurf": _force(
        "PullToMesh",
        "p",
        "the surface is taken as a mesh; connect a fine one for a curved surface",
        constraintsurface="target",
        points="point",
        pullstrength="strength",
    ),
    "pulltomesh": _force(
        "PullToMesh",
        "p",
        "a strength of 0 pulls not at all; it is no hard constraint",
        constraintmesh="target",
        points="point",
        pullstrength="strength",
    ),
}

CLASSIC |= _TOOLS

_GOALS = {"goalobjects": "forces", "reset": "reset"}
_SOLVED = {"iterations": "i", "particles": "v", "geometry": "o"}
_OUT = "geometry comes out as Show takes it in, or as the goals' lines where nothing is shown, in its own tree"
_PAUSE = "the Engine runs while reset is False; it has no other switch"


def _corners(piece: int) -> dict[str, str]:
    return {f"point_{i}": f"{piece}.point_{i}" for i in (1, 2, 3)}


def _solver(solver: str, differs: str, **without: str) -> Swap:
    values = {"solver": solver} | ({"fast": True} if "holding the canvas" in differs else {})
    settings = Piece("Settings", {"tolerance": "tolerance"}, values=values, feeds={"settings": "0.settings"})
    usual = {
        "threshold": None,
        "on": True,
        "damping": 0.99,
        "iterations": 10,
        "momentum": False,
        "animate": True,
        "parallel": True,
    }
    told = {"threshold": _ENDS, "on": _PAUSE, **without}
    return Swap((Piece("Engine", _GOALS, _SOLVED), settings), f"{differs}; {_OUT}", told, usual)


_HALF = "half of the strength, which is what it pulls with in Kangaroo"


def _halved(bundle: str, output: str, column: str, *more: Piece, **inputs: str) -> Swap:
    """For a goal that pulls with half of its strength."""
    half = Piece("*half", {"strength": "numbers"}, feeds={"halves": f"0.{column}"})
    return Swap((Piece(bundle, inputs, {"force": output}), half, *more), _HALF)


SECOND: dict[str, Swap] = {
    "solver": _solver(
        "momentum",
        "the same iteration, played on the service",
        points="particles come from the forces",
        restart="reset does both",
        addcurrent="particles come from the forces",
        parallel="the service decides that",
    ),
    "bouncysolver": _solver(
        "verlet",
        "particles have mass and time is physical, so the motion is another; the shape at rest is the same",
        damping="the settings' drag and the springs' damping slow the motion",
        iterations="`sub_iterations` of Settings",
    ),
    "zombiesolver": _solver(
        "momentum",
        "the Engine plays on the service instead of holding the canvas",
        maxiterations="the engine stops by itself",
    ),
    "stepsolver": _solver(
        "momentum",
        "the Engine plays on instead of waiting for each step",
        momentum="choose the solver in Settings",
        damping="drag of Settings",
        subiterations="`sub_iterations` of Settings",
        animate=_PAUSE,
    ),
    "length(line)": _force("Springs", "s", line="connection", length="rest_length", strength="stiffness"),
    "edgelengths": _force("Springs", "el", mesh="connection", lengthfactor="rest_factor", strength="stiffness"),
    "anchor": Swap(
        (Piece("AnchorSpring", {"p": "point", "t": "targets", "strength": "strength"}, {"force": "a"}),),
        "the same soft anchor; the component Anchors holds exactly and reports reactions",
        unless=dict.fromkeys(("i", "index"), "it goes by index; anchors here go by their points"),
    ),
    "anchorxyz": Swap(
        (Piece("Anchors", {"p": "point", "x": "x", "y": "y", "z": "z"}, {"anchors": "a"}),),
        _EXACT,
        {"strength": _EXACT},
        {"strength": 1000.0},
    ),
    "load": Swap(
        (Piece("Unary", {"p": "point", "fv": "force"}, {"force": "u"}),),
        "a load adds nothing to the mass of its particle; points, not indices, say where it acts",
        {"w": "loads need no weighting"},
        {"w": 1.0},
    ),
    "pressure": _force("Pressure", "p", m="mesh", strength="pressure"),
    "soapfilm": _force(
        "SoapFilm",
        "s",
        "the strength is the film's tension; its triangles keep even by themselves",
        "m",
        m="mesh",
        strength="tension",
    ),
    "hinge": _force(
        "Hinge",
        "h",
        "the strength is a moment per radian here, on any triangles",
        foldstart="point_1",
        foldend="point_2",
        tip1="point_3",
        tip2="point_4",
        restangle="rest_angle",
        strength="strength",
    ),
    "plastichinge": _force(
        "Hinge",
        "h",
        "the strength is a moment per radian here, on any triangles",
        foldstart="point_1",
        foldend="point_2",
        tip1="point_3",
        tip2="point_4",
        limit="limit",
        strength="strength",
    ),
    "nofoldthrough": _force(
        "NoFoldThrough",
        "hingelimit",
        "the strength is a moment per radian here",
        foldstart="point_1",
        foldend="point_2",
        tip1="point_3",
        tip2="point_4",
        strength="strength",
    ),
    "oncurve": _force("PullToCurve", "p", points="point", curve="curve", strength="strength"),
    "onmesh": _force("PullToMesh", "p", points="point", mesh="target", strength="strength"),
    "floor": Swap(
        (Piece("Floor", {}, {"force": "h"}),),
        "no particle sinks in, and it rubs",
        {"strength": "the floor is hard here"},
        {"strength": 1.0},
    ),
    "rod": Swap(
        (
            Piece(
                "Springs",
                {"polyline": "connection", "lengthfactor": "rest_factor", "axialstrength": "stiffness"},
                {"force": "r"},
            ),
            Piece("Bend", {"anglefactor": "angle_factor", "bendstrength": "stiffness"}, {"force": "r"}),
            Piece("*corners", {"polyline": "lines"}, feeds=_corners(1)),
        ),
        "axial and bending stiffness are two forces here; EI is the same number; a drawn curve has a side, unless "
        "_sections_ is free",
    ),
    "angle": Swap(
        (
            Piece("Bend", {"restangle": "rest_angle", "strength": "stiffness"}, {"force": "a"}),
            Piece("*corners", {"linea": "lines", "lineb": "others"}, feeds=_corners(0)),
        ),
        "EI is the same number; the two lines have to meet at an end",
    ),
    "show": Swap((Piece("*geometry", {"g": "in"}, {"in": "g"}),), "a parameter that hands its geometry on"),
    "grab": Swap(
        (Piece("*nothing", {}),),
        "an empty parameter, as it acts only while the mouse drags; drag particles in the studio (`hookean studio`)",
        dict.fromkeys(("on", "strength", "range", "anchors"), "particles are dragged in the studio"),
        dict.fromkeys(("on", "strength", "range"), None),
    ),
    "vertexloads": Swap(
        (
            Piece("Unary", {}, {"force": "l"}),
            Piece("MeshVertices", {"mesh": "mesh"}, feeds={"points": "0.point"}),
            Piece("*upwards", {"strength": "size"}, feeds={"vectors": "0.force"}),
        ),
        "a positive strength is upwards in both",
    ),
    "length(pts)": Swap(
        (
            Piece("Springs", {"length": "rest_length", "strength": "stiffness"}, {"force": "s"}),
            Piece("*lines", {"start": "start", "end": "end"}, feeds={"lines": "0.connection"}),
        ),
    ),
    "spherecollide": _halved("Collide", "s", "strength", points="point", radius="radius"),
    "solidpointcollide": Swap(
        (
            Piece(
                "CollideSolid",
                {"points": "point", "solid": "target", "interior": "inside", "strength": "strength"},
                {"force": "s"},
            ),
        ),
        without={"unidirectional": "the solid stays where it is"},
        usual={"unidirectional": True},
    ),
    "collider": replace(
        _halved("CollideLines", "collider", "strength", objects="connection", radii="radius"),
        differs=f"{_HALF}; lines alone: points with a radius are Collide; lines that share an end ignore each other",
        without=dict.fromkeys(("ignorea", "ignoreb"), "lines of one `collision_group` ignore each other"),
    ),
    "coincident": _halved(
        "Coincident",
        "coincident",
        "strength",
        Piece("*lines", {"point0": "start", "point1": "end"}, feeds={"lines": "0.connection"}),
    ),
    "clamplength": _halved(
        "ClampLength", "clamp", "stiffness", line="connection", lowerlimit="lower_limit", upperlimit="upper_limit"
    ),
    "equallength": _halved("EqualLength", "equal", "stiffness", line="connection"),
    "direction": _halved("Direction", "direction", "stiffness", line="connection", direction="direction"),
    "constanttension": _halved("ConstantTension", "t", "tension", line="connection"),
    "smooth": _halved("Smooth", "smooth", "stiffness", m="mesh"),
    "planarize": _force("Planarize", "planarize", m="mesh", strength="stiffness"),
    "cyclicquad": _force(
        "CyclicQuad", "cyclic", "the circle is that of least squared distances", m="mesh", strength="strength"
    ),
    "tangentincircles": _force(
        "TangentIncircles",
        "tangentincircles",
        "k by the distance between the points where the circles touch the edge",
        edgestart="point_1",
        edgeend="point_2",
        tip1="point_3",
        tip2="point_4",
        strength="stiffness",
    ),
    "coplanar": _force("CoPlanar", "coplanar", points="point", strength="strength"),
    "onplane": Swap(
        (
            Piece("PullToPlane", {"points": "point", "strength": "strength"}, {"force": "p"}),
            Piece("*plane", {"plane": "planes"}, feeds={"origin": "0.origin", "normal": "0.normal"}),
        ),
    ),
    "plasticanchor": _force("AnchorSpring", "a", p="point", point="point", limit="limit", strength="strength"),
    **_TOOLS,
}


def swap_of(known: Known) -> Swap | None:
    """What a component of Kangaroo is swapped for; None where it stays."""
    return (CLASSIC if known.generation == "classic" else SECOND).get(key(known.name))


def markdown() -> str:
    """The table for docs/canvas.md: every component that is translated, by what, and what differs."""
    lines = ["| Kangaroo | component | here | what differs |", "| --- | --- | --- | --- |"]
    for generation, table in (("0.099", CLASSIC), ("2", SECOND)):
        for name, swap in table.items():
            by = ", ".join(_HELPER.get(piece.bundle, piece.bundle) for piece in swap.pieces)
            told = "; ".join(
                [
                    swap.differs,
                    *(f"{key}: {why}" for key, why in swap.without.items() if why not in swap.differs),
                    *(f"stays where {why}" for why in dict.fromkeys(swap.unless.values())),
                ]
            )
            lines.append(f"| {generation} | {name} | {by} | {told.strip('; ')} |")
    return "\n".join(lines) + "\n"


_HELPER = {
    "*geometry": "a parameter",
    "*nothing": "an empty parameter",
    "*corners": "a script for corners",
    "*upwards": "a script for vectors",
    "*lines": "a script for lines",
    "*half": "a script for halves",
    "*plane": "a script for planes",
}
