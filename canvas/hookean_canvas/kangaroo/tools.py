"""The tools of Kangaroo that make geometry or count, for the tables of the import."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hookean_canvas.kangaroo.pieces import Piece, Swap

_MESH = {"m": "mesh", "mesh": "mesh"}
_LEVEL = {**_MESH, "level": "level"}
_RUN = "it makes the whole mesh at once"
_FOLDS = "boundaries, and folds above 30 degrees, are kept"
_SIZE = "edges have the same length all over"


def _tool(
    bundle: str, inputs: Mapping[str, str], outputs: Mapping[str, str], differs: str = "",
    without: Mapping[str, str] | None = None, usual: Mapping[str, Any] | None = None, idle: tuple[str, ...] = (),
) -> Swap:  # fmt: skip
    return Swap((Piece(bundle, inputs, outputs),), differs, without or {}, usual or {}, idle=idle)


BOTH: dict[str, Swap] = {
    "nakedvertices": _tool(
        "NakedVertices",
        _MESH,
        {
            "clothed_index": "clothedi|clothedindex",
            "naked_index": "nakedi|nakedindex",
            "clothed_points": "clothedpts",
            "naked_points": "nakedpts",
        },
    ),
    "warpweft": _tool(
        "WarpWeft",
        _MESH,
        {"warp": "a|warp", "weft": "b|weft", "warp_naked": "na|nakeda", "weft_naked": "nb|nakedb"},
        "which family comes first may differ; a mesh without two is an error, unless `_strict_` is False",
    ),
    "removeduplicatelines": _tool("RemoveDuplicateLines", {"lines": "lines", "tolerance": "tolerance"}, {"lines": "q"}),
    "interconnectpoints": _tool(
        "InterconnectPoints",
        {"points": "points", "p": "points"},
        {"lines": "i|lines|l"},
        "from each point to all later",
    ),
    "removeduplicatepts": _tool(
        "RemoveDuplicatePoints", {"points": "points", "tolerance": "tolerance"}, {"points": "q|uniquepoints"}
    ),
    "combine&clean": _tool(
        "CombineClean",
        {"meshes": "meshes"},
        {"mesh": "m|mesh"},
        "vertices nearer than 0.01 become one, another distance may be connected; faces that are there twice go",
    ),
    "refine": _tool("Refine", _LEVEL, {"mesh": "m|mesh"}, "vertices may have other numbers"),
    "refinestrips": _tool(
        "RefineStrips",
        _LEVEL,
        {"mesh": "m|mesh"},
        "strips are refined along their length, whatever the direction of their faces; `_direction_` chooses another",
    ),
    "diagonalize": _tool("Diagonalize", _MESH, {"mesh": "diagonalmesh|m"}, "vertices may have other numbers"),
    "checkerboard": _tool(
        "Checkerboard",
        _MESH,
        {"pattern": "a"},
        "the colours may be exchanged; a mesh that needs more than two is an error, unless `_strict_` is False",
    ),
    "hingepoints": _tool(
        "HingePoints",
        _MESH,
        {"start": "1", "end": "2", "tip_1": "3", "tip_2": "4"},
        "quads are cut along their shorter diagonals, which are hinges, too",
    ),
    "foldangle": _tool(
        "FoldAngle",
        {"p1": "start", "p2": "end", "p3": "tip_1", "p4": "tip_2"},
        {"angle": "angle"},
        "0 where flat, positive where the tips rise to the side of (P2 - P1) x (P3 - P1)",
    ),
    "meshmap": _tool(
        "MeshMap",
        {
            "sourcemesh": "source",
            "targetmesh": "target",
            "m1": "source",
            "m2": "target",
            "point": "point",
            "p": "point",
            "distance": "distance",
            "d": "distance",
        },
        {"points": "point|p"},
        "the distance is a factor of the heights over the mesh",
    ),
}
"""Tools of both generations."""

CLASSIC: dict[str, Swap] = {
    **BOTH,
    "meshmachine": _tool(
        "Remesh",
        {"geometry": "mesh", "geom": "mesh", "length": "length"},
        {"mesh": "m|mesh"},
        f"{_RUN}, of meshes alone; {_FOLDS}; {_SIZE}",
        {
            **dict.fromkeys(("fixcurves", "fixc", "fixvertices", "fixv"), _FOLDS),
            **dict.fromkeys(("flip",), "edges are flipped towards six neighbours"),
            **dict.fromkeys(("pullstrength", "pull"), "vertices are on the given mesh"),
            **dict.fromkeys(("curvatureadaptivity", "adapt", "boundaryscale", "bscale", "boundarydistance"), _SIZE),
            **dict.fromkeys(("bdist", "sizepoints", "sizp", "sizevalues", "sizv", "exponent", "exp"), _SIZE),
            **dict.fromkeys(("background", "bkgd"), _SIZE),
            **dict.fromkeys(("iterations", "iter", "reset"), _RUN),
        },
        {
            "flip": 1,
            "pullstrength": 0.8,
            "curvatureadaptivity": 0.0,
            "boundaryscale": 1.0,
            "exponent": 2,
            "boundarydistance": 5.0,
            "background": 0.5,
            "iterations": None,
            "reset": None,
        },
        ("iterations", "iter", "reset"),
    ),
    "counter": _tool(
        "Counter",
        {"reset": "reset"},
        {"count": "t"},
        "it counts its solutions: connect a timer, or an interval",
    ),
    "sequence": _tool(
        "Sequence",
        {"frames": "frames"},
        {"reset": "s"},
        "True in its first solution, then False; it schedules its own solutions and ends after the last frame",
    ),
    "trail": _tool(
        "Trail",
        {"points": "points", "reset": "reset", "record": "record"},
        {"trail": "t|trail"},
        "paths are polylines; the second output has their points",
    ),
}

SECOND: dict[str, Swap] = {
    **BOTH,
    "meshcorners": Swap(
        (Piece("MeshCorners", {**_MESH, "angle": "angle"}, {"corners": "corners|c"}, {"order": "boundary"}),),
        "corners follow one another along the boundary; which comes first may differ",
    ),
    "simpleremesh": _tool(
        "Remesh",
        {"geometry": "mesh", "length": "length"},
        {"mesh": "mesh"},
        f"meshes alone; {_FOLDS}",
        {"creases": _FOLDS, "corners": _FOLDS, "steps": "`_iterations_` counts other rounds; its default is enough"},
        {"steps": 50},
    ),
    "triremesh": _tool(
        "Remesh",
        {"geometry": "mesh", "length": "length"},
        {"mesh": "triangulation"},
        f"meshes alone; {_FOLDS}",
        {
            "target": "vertices are on the given mesh",
            "features": _FOLDS,
            "sharp": _FOLDS,
            "iterations": "`_iterations_` counts other rounds; its default is enough",
        },
        {"iterations": 25, "sharp": None},
    ),
    "meshdirection": _tool("AlignQuads", _MESH, {"mesh": "mesh|m"}, "a mesh in which no directions agree is an error"),
    "meshturn": _tool("TurnQuads", _MESH, {"mesh": "mesh|m"}, "by a right angle, unless `_turns_` is another number"),
    "multipipe": _tool(
        "Pipes",
        {"curves": "lines", "nodesize": "radius"},
        {"mesh": "pipe"},
        "a mesh of flat faces round straight lines, with one radius; there a SubD",
        {
            **dict.fromkeys(("sizepoints", "strutsize"), "pipes have one radius"),
            **dict.fromkeys(("endoffset", "segment", "kinkangle", "cubefit", "caps"), "its faces are made otherwise"),
        },
        {
            "endoffset": 1.0,
            "strutsize": 1.0,
            "segment": 0.0,
            "kinkangle": 0.6,
            "cubefit": 0.0,
            "caps": 1,
            "sizepoints": None,
        },
    ),
    "splitatcorners": _tool(
        "SplitAtCorners", {"poly": "polyline", "angle": "angle"}, {"corners": "corners", "parts": "parts"}
    ),
}
