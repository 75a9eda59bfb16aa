"""The forces of classic Kangaroo (0.099), for the tables of the import."""

from __future__ import annotations

import math
from dataclasses import replace

from hookean_canvas.kangaroo.pieces import Piece, Swap, corners, fed, force

_EXACT = "anchors hold exactly here, so they have no strength"

_LAW = "Kangaroo's law is not published"
_FACES = Piece("*faces", {f"point{i}": f"corner_{i}" for i in (1, 2, 3)}, feeds={"mesh": "0.mesh"})
_SHORT = Piece("*faces", {f"p{i}": f"corner_{i + 1}" for i in (0, 1, 2)}, feeds={"mesh": "0.mesh"})
_FAN = Piece("*fan", {"center": "centre", "neighbours": "neighbours"}, feeds={"mesh": "0.mesh"})
_GUST = Piece("*size", {"wind": "vectors", "strength": "factors"}, feeds={"sizes": "0.pressure"})
_BLOWS = f"the velocity pressure is strength x length of the vector; {_LAW}"
_STILL = {
    "relative": "the wind blows past faces at rest, unless Wind gets a speed",
    "waterline": "the wind blows at any height, unless Wind gets a waterline",
}
_CALM = {"relative": False, "waterline": 0}
_WATER = f"the level of the water is z = 0, and it pushes along the normals, out of counter-clockwise faces; {_LAW}"
_OUT = "positive pressure pushes along the normals, out of counter-clockwise faces"
_TOUCH = "k by the distance between the points where the circles touch the edge"


def _lines(first: str, second: str) -> Piece:
    return Piece("*lines", {first: "start", second: "end"}, feeds={"lines": "0.connection"})


FORCES: dict[str, Swap] = {
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
    "unaryforce": force("Unary", "unaryforce", point="point", force="force"),
    "anchorspring": Swap(
        (Piece("AnchorSpring", {"point": "point", "strength": "strength"}, {"force": "a"}),),
        without={"sticky": "soft anchors do not slip here"},
    ),
    "anchorxyz": Swap((Piece("Anchors", {"point": "point", "x": "x", "y": "y", "z": "z"}, {"anchors": "a"}),), _EXACT),
    "bend": force(
        "Bend",
        "b",
        "the strength is EI here, moment x length per angle; a rest angle has a side, unless _sections_ is free",
        point1="point_1",
        point2="point_2",
        point3="point_3",
        bendstrength="stiffness",
        restangle="rest_angle",
    ),
    "hinge": force(
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
    "planarize": force(
        "Planarize",
        "p",
        "k by the distance between the diagonals",
        point1="point_1",
        point2="point_2",
        point3="point_3",
        point4="point_4",
        planarizestrength="stiffness",
    ),
    "shell": force(
        "Shell",
        "shellforce",
        "the strength is the plate's bending stiffness D here, whatever the mesh",
        mesh="mesh",
        strength="strength",
        anglefactor="angle_factor",
    ),
    "meshpressure": force(
        "Pressure",
        "p",
        _OUT,
        mesh="mesh",
        pressurelevel="pressure",
    ),
    "springsfrommesh": force(
        "Springs", "springs", mesh="connection", stiffness="stiffness", restlengthfactor="rest_factor"
    ),
    "polyspring": force("Springs", "springs", polyline="connection", stiffness="stiffness"),
    "curvepull": force(
        "PullToCurve",
        "c",
        "a strength of 0 pulls not at all; it is no hard constraint",
        curve="curve",
        points="point",
        strength="strength",
    ),
    "pulltosurf": force(
        "PullToSurface",
        "p",
        "untrimmed surfaces alone: for a Brep of several faces connect a mesh to Pull To Mesh",
        constraintsurface="surface",
        points="point",
        pullstrength="strength",
    ),
    "levelset": force(
        "LevelSet",
        "l",
        "charges of size 1 that stay where they are; Kangaroo's law is not published",
        charges="charges",
        surfacept="point",
        threshold="level",
        strength="strength",
    ),
    "pulltomesh": force(
        "PullToMesh",
        "p",
        "a strength of 0 pulls not at all; it is no hard constraint",
        constraintmesh="target",
        points="point",
        pullstrength="strength",
    ),
    "powerlaw": force(
        "PowerLaw", "p", connection="connection", exponent="exponent", strength="strength", cutoff="cutoff"
    ),
    "fd": Swap(
        (Piece("ConstantTension", {"connection": "connection", "targetforce": "tension"}, {"force": "fd"}),),
        "the tension is the target force at once",
        dict.fromkeys(("stiffness", "damping", "restlength"), "the tension is the target force at once"),
        dict.fromkeys(("stiffness", "damping", "restlength"), None),
    ),
    "pressure": fed("Pressure", "p", _FACES, differs=_OUT, pressurelevel="pressure"),
    "hydro": fed("Hydrostatic", "h", _FACES, differs=_WATER, density="weight"),
    "hydromesh": force("Hydrostatic", "h", _WATER, mesh="mesh", density="weight"),
    "wind": replace(fed("Wind", "w", _FACES, _GUST, differs=_BLOWS, wind="direction"), without=_STILL, usual=_CALM),
    "windmesh": replace(
        fed("Wind", "w", _GUST, differs=_BLOWS, mesh="mesh", wind="direction"), without=_STILL, usual=_CALM
    ),
    "areaweight": Swap(
        (Piece("AreaWeight", {"weight": "weight"}, {"force": "a"}), _SHORT),
        f"a positive weight is downwards, a third of it on each corner; {_LAW}",
        {"cotan": "a third of the weight is on each corner"},
        {"cotan": False},
    ),
    "gasvolume": fed(
        "Gas",
        "v",
        Piece(
            "*gas",
            {"mesh": "mesh", "volume": "volume", "k": "strength"},
            feeds={"meshes": "0.mesh", "pressures": "0.pressure", "outside": "0.outside"},
        ),
        differs=f"K is the absolute pressure around the mesh, and in it at the volume at rest; {_LAW}",
    ),
    "laplacian": fed(
        "Smooth",
        "l",
        Piece(
            "*fan",
            {"center": "centre", "neighbours": "neighbours", "weighting": "weighting"},
            feeds={"mesh": "0.mesh", "weights": "0.weights"},
        ),
        differs=f"weights 0, 1 and 2 are uniform, cotangent and inverse_length, of the start shape; {_LAW}",
        strength="stiffness",
    ),
    "meshsmooth": fed("Smooth", "m", differs=_LAW, values={"vertices": "all"}, mesh="mesh", strength="stiffness"),
    "developablize": fed("Developable", "d", _FAN, differs=f"a moment per radian; {_LAW}", strength="strength"),
    "vortex": fed(
        "Vortex",
        "v",
        Piece("*axis", {"axisstart": "start", "axisend": "end"}, feeds={"vectors": "0.axis"}),
        differs=f"positive turns counter-clockwise as seen against the axis; {_LAW}",
        point="point",
        axisstart="origin",
        strength="strength",
        cutoff="cutoff",
        exponent="exponent",
    ),
    "align": replace(
        fed(
            "AngleSnap",
            "a",
            values={"multiple": math.pi},
            **{f"align{i}": f"point_{i}" for i in (1, 2, 3, 4)},
            alignstrength="strength",
        ),
        differs=f"a moment per radian that makes lines parallel, in the same direction or not; {_LAW}",
        without=dict.fromkeys(("exponent", "cutoff", "anglerange"), "the moment acts at any distance and angle"),
        usual=dict.fromkeys(("exponent", "cutoff", "anglerange"), 0.0),
    ),
    "equalize": force("EqualLength", "e", _LAW, lines="connection", eqnstrength="stiffness"),
    "equalizeangles": force(
        "EqualAngle",
        "e",
        f"a moment per radian; {_LAW}",
        point1="point_2",
        point2="point_1|point_3",
        point3="point_4",
        strength="strength",
    ),
    "planarizequads": force(
        "Planarize", "p", "k by the distance between the diagonals", mesh="mesh", strength="stiffness"
    ),
    "tangentincircles": force(
        "TangentIncircles",
        "t",
        _TOUCH,
        point1="point_1",
        point2="point_2",
        point3="point_3",
        point4="point_4",
        strength="stiffness",
    ),
    "polylinebend": Swap(
        (
            Piece("Bend", {"bendstrength": "stiffness", "anglefactor": "angle_factor"}, {"force": "b"}),
            Piece("*corners", {"polyline": "lines"}, feeds=corners(0)),
        ),
        "the strength is EI here; a drawn curve has a side, unless _sections_ is free",
    ),
    "mirror": fed(
        "Mirror",
        "m",
        _lines("a", "d"),
        Piece("*axis", {"b": "start", "c": "end"}, feeds={"middles": "0.point", "vectors": "0.normal"}),
        differs=f"the plane halfway between B and C is that of the start; one for each branch; {_LAW}",
        strength="stiffness",
    ),
    "translationlock": fed(
        "TranslationLock", "t", _lines("p1", "p2"), differs="elastic, with 1000", values={"stiffness": 1000.0}
    ),
    "projectedforce": fed(
        "ProjectedForce",
        "p",
        _lines("p1", "p2"),
        Piece("*size", {"vector": "vectors"}, feeds={"sizes": "0.component"}),
        differs="tension, whichever way the vector points",
        vector="direction",
    ),
    "rocket": fed("Thrust", "r", _lines("point1", "point2"), differs="half of it at each end", rocketstrength="thrust"),
    "spherecollide": fed(
        "Collide",
        "s",
        differs="contacts have a stiffness of 1000, unless another one is given",
        centers="point",
        radius="radius",
    ),
    "collidemesh": Swap(
        (Piece("CollideSolid", {"points": "point", "solid": "target"}, {"force": "c"}),),
        "contacts have a stiffness of 1000, unless another one is given",
        {"hardness": "contacts do not rebound", "traction": "contacts do not rub"},
        dict.fromkeys(("hardness", "traction"), None),
    ),
}
