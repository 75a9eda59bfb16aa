"""The goals of Kangaroo 2 with six degrees of freedom whose places are frames: beams and supports."""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.pieces import Piece, Swap
from hookean_canvas.kangaroo.recipe import Recipe

_HEAD = '''"""%s"""

from hookean_client import canvas


def plain(vector):
    return [vector.X, vector.Y, vector.Z]


'''
BEAMS = f"""{_HEAD % "Lines from node to node, offsets from there to frames, and the frames' Y; GJ is G with J = 1."}
def numbers(given):
    return [canvas.geometry.number(item) for item in canvas.listed(given)] or [1.0]


starts, ends = canvas.listed(_startframe), canvas.listed(_endframe)
frames = [starts, ends, canvas.listed(startnode_) or starts, canvas.listed(endnode_) or ends]
lines, offset_start, offset_end, normals = [], [], [], []
for first, last, node, other in zip(*canvas.matched(*frames)):
    lines.append(canvas.geometry.to_line([plain(node.Origin), plain(other.Origin)]))
    for offsets, frame, at in ((offset_start, first, node), (offset_end, last, other)):
        offsets.append(canvas.geometry.to_vector([p - q for p, q in zip(plain(frame.Origin), plain(at.Origin))]))
    normals.append(first.YAxis)
torsion = numbers(gj_)
"""
SUPPORTS = f"""{_HEAD % "Points of frames, and stiffness along and about the world's axes where theirs are held."}
def flags(given):
    return [bool(item) for item in canvas.listed(given)] or [True]


def along(frame, k, held):
    \"\"\"The stiffness along the world's axes; frames that are not along them are held all round, or not.\"\"\"
    if len(set(held)) == 1:
        return [k * held[0]] * 3
    found = [0.0, 0.0, 0.0]
    for axis, flag in zip((frame.XAxis, frame.YAxis, frame.ZAxis), held):
        sizes = [abs(x) for x in plain(axis)]
        if max(sizes) < 1.0 - 1e-9:
            raise ValueError("a support holds axes of a tilted frame; supports act along the world's axes here")
        found[sizes.index(max(sizes))] += k * flag
    return found


points, stiffness, rotation_stiffness = [], [], []
strengths = [canvas.geometry.number(item) for item in canvas.listed(strength_)] or [100.0]
given = [canvas.listed(_frame), strengths] + [flags(one) for one in (x_, y_, z_, xx_, yy_, zz_)]
for frame, k, *held in zip(*canvas.matched(*given)) if given[0] else ():
    points.append(canvas.geometry.to_point(plain(frame.Origin)))
    stiffness.append(canvas.geometry.to_vector(along(frame, k, held[:3])))
    rotation_stiffness.append(canvas.geometry.to_vector(along(frame, k, held[3:])))
"""


def _slots(text: str) -> tuple[Slot, ...]:
    """Inputs or outputs by `name: what it is`, one a line."""
    pairs = (line.split(": ", 1) for line in text.strip().splitlines())
    return tuple(Slot(name, told, 1) for name, told in pairs)


_FLAGS = "\n".join(f"{name}_: Whether it is held. Default: True." for name in ("x", "y", "z", "xx", "yy", "zz"))
HELPERS = {
    "*beams": Recipe(
        "Beams between Nodes", "Nodes", "Lines and offsets of beams", BEAMS,
        _slots(
            "_startframe: Frames at the start\n_endframe: Frames at the end\nstartnode_: Frames of nodes there\n"
            "endnode_: Frames of nodes at the end\ngj_: GJ. Default: 1."
        ),
        _slots(
            "lines: From node to node\noffset_start: To the frames at the start\noffset_end: At the end\n"
            "normals: Y of the frames\ntorsion: GJ"
        ),
    ),
    "*supports": Recipe(
        "Supports of Frames", "Frames", "Points and stiffness", SUPPORTS,
        _slots(f"_frame: Frames\n{_FLAGS}\nstrength_: Strengths. Default: 100."),
        _slots("points: Points\nstiffness: Along the axes\nrotation_stiffness: About the axes"),
    ),
}  # fmt: skip
TOLD = {"*beams": "a script for lines and offsets", "*supports": "a script for points and stiffness"}

GOALS: dict[str, Swap] = {
    "beam": Swap(
        (
            Piece(
                "Beam",
                {"e": "e", "a": "a", "ix": "iy", "iy": "iz"},
                {"force": "beam"},
                {"j": 1.0},
            ),
            Piece(
                "*beams",
                {
                    "startframe": "startframe",
                    "endframe": "endframe",
                    "startnode": "startnode",
                    "endnode": "endnode",
                    "gj": "gj",
                },
                feeds={
                    "lines": "0.connection",
                    "offset_start": "0.offset_start",
                    "offset_end": "0.offset_end",
                    "normals": "0.normal",
                    "torsion": "0.g",
                },
            ),
        ),
        "nodes are particles, frames the ends of the beam on rigid arms; Ix is Iy here, about the frame's X, and GJ is "
        "G with J = 1; Kangaroo's law is not published",
    ),
    "support": Swap(
        (
            Piece("Support", {}, {"force": "support"}),
            Piece(
                "*supports",
                {
                    "frame": "frame",
                    **{axis: axis for axis in ("x", "y", "z", "xx", "yy", "zz")},
                    "strength": "strength",
                },
                feeds={
                    "points": "0.point",
                    "stiffness": "0.stiffness",
                    "rotation_stiffness": "0.rotation_stiffness",
                },
            ),
        ),
        "the strength is k and kr; axes of tilted frames are all held, or none; Kangaroo's law is not published",
    ),
}
