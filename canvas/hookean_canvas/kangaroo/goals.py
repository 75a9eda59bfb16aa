"""The goals of Kangaroo 2, for the tables of the import."""

from __future__ import annotations

from dataclasses import replace

from hookean_canvas.kangaroo import held, rare, six
from hookean_canvas.kangaroo.pieces import HALF, Piece, Swap, corners, fed, force, halved, pairs

_TOUCH = "k by the distance between the points where the circles touch the edge"
_MOMENT = "a moment per radian here, of the same size for small angles where lines keep their lengths"
_BY_INDEX = "points are picked from the solver's Points by their numbers"
_LOADS = "a load adds nothing to the mass of its particle"
_INDEXED = Piece("*indexed", {"p": "places", "point": "places", "i": "indices", "index": "indices"})


def _indexed(swap: Swap, differs: str, **feeds: str) -> Swap:
    """A swap whose points are picked from those of the solver."""
    first = swap.pieces[0]
    kept = {old: ours for old, ours in first.inputs.items() if ours not in ("point", "targets")}
    return replace(
        swap,
        pieces=(replace(first, inputs=kept), replace(_INDEXED, feeds=feeds)),
        differs=differs,
        unless={},
    )


def _by_mesh(first: Swap, other: Swap) -> Swap:
    """A goal that takes a mesh, whose older or newer version takes points."""
    return replace(first, needs=("m",), other=other)


_ANCHOR = Swap(
    (
        Piece(
            "AnchorSpring",
            {"p": "point", "point": "point", "t": "targets", "target": "targets", "strength": "strength"},
            {"force": "a"},
        ),
    ),
    "the same soft anchor; the component Anchors holds exactly and reports reactions",
    unless=dict.fromkeys(("i", "index"), "it goes by index, and no solver has Points"),
)
_LOAD = Swap(
    (
        Piece(
            "Unary",
            {"p": "point", "point": "point", "fv": "force", "forcevector": "force"},
            {"force": "u"},
        ),
    ),
    f"{_LOADS}; points, not indices, say where it acts",
    {"w": "loads need no weighting", "weighting": "loads need no weighting"},
    {"w": 1.0, "weighting": 1.0},
)

_PLANES = {"planea": "planes", "planeb": "planes_of_others"}
_BODIES = {"part": "meshes", "points": "points", "plane": "frames"}
_RIGID = Swap(
    (
        Piece("RigidBody", {"strength": "strength"}, {"force": "rigidbody"}),
        Piece("*bodies", _BODIES, {"planes": "planes"}, feeds={"points": "0.point"}),
    ),
    "the vertices of a part and the origin of its plane are particles of its body, too; Planes are those at the start; "
    "k for each particle; Kangaroo's law is not published",
)

_POLYGONS = Swap(
    (
        Piece(
            "Collide2d",
            {"polylines": "connection", "curves": "connection", "strength": "strength"},
            {"force": "c"},
        ),
        Piece("*plane", {"plane": "planes"}, feeds={"normal": "0.normal"}),
    ),
    "corners of one polyline inside another; the goals of one branch share a plane; Kangaroo's law is not published",
)

GOALS: dict[str, Swap] = {
    **six.GOALS,
    **rare.GOALS,
    "length(line)": force("Springs", "s", line="connection", length="rest_length", strength="stiffness"),
    "edgelengths": force("Springs", "el", mesh="connection", lengthfactor="rest_factor", strength="stiffness"),
    "anchor": replace(
        _ANCHOR, other=_indexed(_ANCHOR, f"the same soft anchor; {_BY_INDEX}", places="0.point", targets="0.targets")
    ),
    "anchorxyz": held.ANCHOR,
    "load": replace(_indexed(_LOAD, f"{_LOADS}; {_BY_INDEX}", places="0.point"), other=_LOAD),
    "pressure": force("Pressure", "p", m="mesh", strength="pressure"),
    "soapfilm": _by_mesh(
        force(
            "SoapFilm",
            "s",
            "the strength is the film's tension; its triangles keep even by themselves",
            m="mesh",
            strength="tension",
        ),
        fed(
            "SoapFilm",
            "s",
            Piece(
                "*film", {"pts": "points", "strength": "strength"}, feeds={"meshes": "0.mesh", "tensions": "0.tension"}
            ),
            differs="the strength is the film's tension; triangles of one strength are one mesh",
        ),
    ),
    "hinge": force(
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
    "plastichinge": force(
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
    "nofoldthrough": force(
        "NoFoldThrough",
        "hingelimit",
        "the strength is a moment per radian here",
        foldstart="point_1",
        foldend="point_2",
        tip1="point_3",
        tip2="point_4",
        strength="strength",
    ),
    "oncurve": force("PullToCurve", "p", points="point", curve="curve", strength="strength"),
    "onmesh": force("PullToMesh", "p", points="point", mesh="target", strength="strength"),
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
            Piece("*corners", {"polyline": "lines"}, feeds=corners(1)),
        ),
        "axial and bending stiffness are two forces here; EI is the same number; a drawn curve has a side, unless "
        "_sections_ is free",
    ),
    "angle": Swap(
        (
            Piece("Bend", {"restangle": "rest_angle", "strength": "stiffness"}, {"force": "a"}),
            Piece("*corners", {"linea": "lines", "lineb": "others"}, feeds=corners(0)),
        ),
        "EI is the same number; the two lines have to meet at an end",
    ),
    "show": Swap((Piece("*geometry", {"g": "in"}, {"in": "g"}),), "a parameter that hands its geometry on"),
    "grab": Swap(
        (Piece("Grab", {"on": "on", "strength": "strength", "range": "range"}, {"grab": "grab"}),),
        "the left button drags particles that no anchor holds",
        {"anchors": "the mouse makes no anchors here"},
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
    "spherecollide": halved("Collide", "s", "strength", points="point", radius="radius"),
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
        halved("CollideLines", "collider", "strength", objects="connection", radii="radius"),
        differs=f"{HALF}; lines that share an end ignore each other",
        without=dict.fromkeys(("ignorea", "ignoreb"), "lines of one `collision_group` ignore each other"),
    ),
    "coincident": halved(
        "Coincident",
        "coincident",
        "strength",
        Piece("*lines", {"point0": "start", "point1": "end"}, feeds={"lines": "0.connection"}),
    ),
    "clamplength": halved(
        "ClampLength", "clamp", "stiffness", line="connection", lowerlimit="lower_limit", upperlimit="upper_limit"
    ),
    "equallength": halved("EqualLength", "equal", "stiffness", line="connection"),
    "direction": halved("Direction", "direction", "stiffness", line="connection", direction="direction"),
    "constanttension": halved("ConstantTension", "t", "tension", line="connection"),
    "smooth": halved("Smooth", "smooth", "stiffness", m="mesh"),
    "planarize": force("Planarize", "planarize", m="mesh", strength="stiffness"),
    "cyclicquad": _by_mesh(
        force("CyclicQuad", "cyclic", "the circle is that of least squared distances", m="mesh", strength="strength"),
        fed(
            "CyclicQuad",
            "cyclic",
            Piece("*faces", {f"p{i}": f"corner_{i + 1}" for i in range(4)}, feeds={"mesh": "0.mesh"}),
            differs="the circle is that of least squared distances",
            strength="strength",
        ),
    ),
    "tangentincircles": _by_mesh(
        replace(
            force("TangentIncircles", "ti", _TOUCH, m="mesh", strength="stiffness"),
            unless=dict.fromkeys(("b", "boundary"), "a boundary curve; PullToCurve keeps points on a curve"),
        ),
        force(
            "TangentIncircles",
            "tangentincircles",
            _TOUCH,
            edgestart="point_1",
            edgeend="point_2",
            tip1="point_3",
            tip2="point_4",
            strength="stiffness",
        ),
    ),
    "coplanar": force("CoPlanar", "coplanar", points="point", strength="strength"),
    "colinear": force("CoLinear", "colinear", points="point", strength="strength"),
    "cospherical": force(
        "CoSpherical", "cospherical", "the sphere of least squared distances", points="point", strength="strength"
    ),
    "cocircular": force(
        "CoCircular", "cocircular", "the circle of least squared distances", points="point", strength="strength"
    ),
    "onplane": Swap(
        (
            Piece("PullToPlane", {"points": "point", "strength": "strength"}, {"force": "p"}),
            Piece("*plane", {"plane": "planes"}, feeds={"origin": "0.origin", "normal": "0.normal"}),
        ),
    ),
    "plasticanchor": force("AnchorSpring", "a", p="point", point="point", limit="limit", strength="strength"),
    "volume": fed(
        "Volume",
        "v",
        Piece(
            "*volume",
            {"m": "mesh", "mesh": "mesh", "v": "volume", "volume": "volume", "strength": "strength"},
            feeds={"meshes": "0.mesh", "stiffness": "0.stiffness", "factors": "0.volume_factor"},
        ),
        differs="the bulk modulus of what is in the mesh, 6 x strength x volume / area of the start shape; in Kangaroo "
        "the area of the present shape counts",
    ),
    "polygonarea": fed(
        "PolygonArea",
        "a",
        Piece(
            "*polygon",
            {"polyline": "polyline", "area": "area", "strength": "strength"},
            feeds={"lines": "0.connection", "stiffness": "0.stiffness", "factors": "0.area_factor"},
        ),
        differs="a pressure on the edges in any plane, by the lengths of the start shape; in Kangaroo short edges push "
        "as much as long ones, in plan",
    ),
    "wind": fed(
        "Wind",
        "w",
        Piece("*size", {"w": "vectors", "windvector": "vectors"}, feeds={"sizes": "0.pressure"}),
        differs="the velocity pressure is the length of the vector; Kangaroo's law is not published",
        m="mesh",
        mesh="mesh",
        w="direction",
        windvector="direction",
    ),
    "magnetsnap": halved("MagnetSnap", "s", "strength", points="point", range="range", r="range"),
    "tangentialsmooth": replace(
        halved("TangentialSmooth", "smooth", "stiffness", m="mesh"),
        differs=f"{HALF}; vertices keep their height over their neighbours",
    ),
    "conicalize": force(
        "Conical", "c", "a moment per radian at vertices with four faces", m="mesh", strength="strength"
    ),
    "developablize": force("Developable", "d", "a moment per radian", m="mesh", strength="strength"),
    "anglesnap": pairs("AngleSnap", "a", "*snap", _MOMENT, factor="multiple"),
    "clampangle": pairs(
        "ClampAngle",
        "c",
        "*clamp",
        f"{_MOMENT}; the nearer limit counts",
        lower="lower_limit",
        upper="upper_limit",
    ),
    "equalangle": pairs(
        "EqualAngle", "ea", "*snap", "a moment per radian here, as for AngleSnap; Kangaroo's law is not published"
    ),
    "lengthratio": pairs(
        "LengthRatio",
        "a",
        "*ends",
        "k is half of the strength, as for EqualLength; Kangaroo's law is not published",
        Piece("*half", {"strength": "numbers"}, feeds={"halves": "0.stiffness"}),
        ratio="ratio",
    ),
    "lengthsnap": force("LengthSnap", "s", line="connection", factor="multiple", strength="stiffness"),
    "plasticlength": force(
        "Springs", "s", line="connection", l="yield_extension", limit="yield_extension", strength="stiffness"
    ),
    "dynamicweight1d": fed(
        "LineWeight",
        "dw",
        Piece("*negative", {"w": "numbers", "weight": "numbers"}, feeds={"negative": "0.weight"}),
        differs="a positive weight is upwards, as in Kangaroo's published goal, by the script that turns its sign",
        line="connection",
    ),
    "transform": replace(
        halved(
            "TransformLock",
            "t",
            "stiffness",
            Piece(
                "*lines",
                {"p0": "start", "point0": "start", "p1": "end", "point1": "end"},
                feeds={"lines": "0.connection"},
            ),
            t="matrix",
            transform="matrix",
        ),
        differs=f"{HALF}; one transformation for each branch; one that scales pushes the original by its scale",
    ),
    "curvepointcollide": Swap(
        (
            Piece(
                "CollideCurve",
                {"points": "point", "curve": "curve", "in": "inside", "interior": "inside", "strength": "strength"},
                {"force": "s"},
            ),
            Piece("*plane", {"pl": "planes", "plane": "planes"}, feeds={"normal": "0.normal"}),
        ),
        "the curve is a prism without ends along the normal of its plane; one curve for each branch",
    ),
    "floorfriction": Swap(
        (Piece("Floor", {}, {"force": "f"}),),
        "it holds all particles, no particle sinks in, and friction is Coulomb's",
        {
            "p": "the floor holds all particles",
            "points": "the floor holds all particles",
            "l": "friction is Coulomb's here",
            "limit": "friction is Coulomb's here",
            "s": "the floor is hard here",
            "strength": "the floor is hard here",
        },
        {"strength": 1.0, "s": 1.0},
    ),
    "rigidbodycollide": Swap(
        (
            Piece("RigidCollide", {"strength": "strength"}, {"force": "solidcollide"}),
            Piece(
                "*solids",
                {"mesha": "meshes", "meshb": "others", **_PLANES},
                feeds={"points": "0.point", "numbers": "0.group"},
            ),
        ),
        "the convex hulls of both meshes; k is a pressure by depth here, and Kangaroo's law is not published",
    ),
    "solidplanecollide": Swap(
        (
            Piece("SolidPlaneCollide", {"strength": "strength"}, {"force": "solidplanecollide"}),
            Piece("*solids", {"solid": "meshes", "solidplane": "planes"}, feeds={"points": "0.point"}),
            Piece("*plane", {"collisionplane": "planes"}, feeds={"origin": "0.origin", "normal": "0.normal"}),
        ),
        "k for each corner; Kangaroo's law is not published",
    ),
    "concentric": Swap(
        (
            Piece("Concentric", {"strength": "strength"}, {"force": "concentric"}),
            Piece(
                "*axles",
                {"axisa": "lines", "axisb": "others", **_PLANES},
                feeds={f"point_{i}": f"0.point_{i}" for i in (1, 2, 3, 4)},
            ),
        ),
        "the ends of axes are particles of the bodies whose planes are given; Kangaroo's law is not published",
        without={"flip": "an axis has no direction here"},
        usual={"flip": False},
    ),
    "alignfaces": Swap(
        (
            Piece("AlignFaces", {"strength": "strength", "flip": "flip"}, {"force": "alignfaces"}),
            Piece(
                "*mates",
                {"facea": "faces", "faceb": "others", **_PLANES},
                feeds={f"point_{i}": f"0.point_{i}" for i in (1, 2, 3, 4, 5, 6)},
            ),
        ),
        "three points of each face are particles of the body whose plane is given; Kangaroo's law is not published",
    ),
    "isothermic": Swap(
        (
            Piece("Isothermic", {"m": "mesh", "strength": "stiffness"}, {"force": "p"}),
            Piece("CyclicQuad", {"m": "mesh", "strength": "strength"}, {"force": "p"}),
        ),
        "sides with the same products and corners on circles are two forces here; Kangaroo's law is not published",
    ),
    "softbodycollide": force(
        "SoftCollide",
        "s",
        "meshes become one mesh of as many bodies, each closed; Kangaroo's law is not published",
        meshes="mesh",
        strength="strength",
    ),
    "collide2d": _POLYGONS,
    "curvecollide": _POLYGONS,
    "rigidpointset": _RIGID,
    "rigidbody": _RIGID,
}
