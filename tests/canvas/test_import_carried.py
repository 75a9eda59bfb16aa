"""Goals that join rigid bodies at points that are not theirs: the bodies carry these, as they do in Kangaroo."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.test_import_run import places, ran

pytestmark = pytest.mark.usefixtures("home")

NEWER = UUID("e245de5b-6d3b-48d3-8092-3bf0202ebf8f")
"""The RigidBody with a plane."""
BOX = """
import Rhino.Geometry as rg
m = rg.Mesh()
for z in (0, 1):
    for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
        m.Vertices.Add(x + dx, y, z)
for f in ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
    m.Faces.AddFace(*f)
"""
OUTLINE = """
import Rhino.Geometry as rg
c = rg.Polyline(4)
for p in points + points[:1]:
    c.Add(p.X, p.Y, p.Z)
"""
TRIPOD = [(np.cos(turn), np.sin(turn)) for turn in np.radians([0.0, 120.0, 240.0])]
AXES = [[(0.5, 0.3, -1.0), (0.5, 0.5, 2.0)], [(3.5, 0.3, -1.0), (3.5, 0.5, 5.0)]]
FACES = [
    [(0.2, 0.2, 1.0), (0.8, 0.2, 1.0), (0.8, 0.8, 1.1)],
    [(3.2, 0.2, 4.0), (3.8, 0.2, 1.0), (3.8, 0.8, 1.0)],
]
PLANES = [
    [(0.5 + 0.5 * c, 0.5 + 0.5 * s, 1.0) for c, s in TRIPOD],
    [(3.5 + 0.5 * c, 0.5 + 0.5 * s, 0.0) for c, s in TRIPOD],
]
"""Points in the top of one box and the bottom of the other."""
CORNERS = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)


def assembly(name: str, inputs: tuple[str, str], shapes: list[Any], kind: str, framed: bool) -> Kangaroo:
    """Two boxes with frames in their middles, joined at lines or outlines that end beside their corners. Frames that
    are not given are there too, and the bodies hand them on."""
    d = Kangaroo(name.lower(), name, name)
    goals, planes, wired = [], [], {}
    for i, dx in enumerate((0.0, 3.0)):
        mesh = d.script(f"Box {i}", f"dx = {dx}\n{BOX}", {}, ["m"])
        planes.append(d.native("XY Plane", origin=d.point(dx + 0.5, 0.5, 0.5)))
        typed = (("Part", None), ("Plane", None), ("Points", None), ("Strength", 10.0))
        given = {"plane": planes[-1]} if framed else {}
        rigid = d.kangaroo("RigidBody", typed, ["RigidBody", "Planes"], guid=NEWER, part=mesh, **given)
        goals.append(rigid["RigidBody"])
        if not framed:
            planes[-1] = rigid["Planes"]
        ends = [d.point(*place) for place in shapes[i]]
        if kind == "line":
            wired[inputs[i].lower()] = d.native("Line", start_point=ends[0], end_point=ends[1])
        elif kind == "plane":
            wired[inputs[i].lower()] = d.native("XY Plane", origin=d.point(dx + 0.5, 0.5, 1.0 - i))
        else:
            wired[inputs[i].lower()] = d.script(f"Outline {i}", OUTLINE, {"points": ends}, ["c"], lists=["points"])
    typed = (("PlaneA", None), ("PlaneB", None), *((one, None) for one in inputs), ("Flip", False), ("Strength", 7.0))
    goals.append(d.kangaroo(name, typed, [name], planea=planes[0], planeb=planes[1], **wired))
    d.panel("particles", d.solved(*goals)["V"])
    return d


@pytest.mark.thinned
@pytest.mark.parametrize("framed", [True, False])
@pytest.mark.parametrize(
    ("name", "inputs", "shapes", "kind"),
    [
        ("Concentric", ("AxisA", "AxisB"), AXES, "line"),
        ("AlignFaces", ("FaceA", "FaceB"), FACES, "outline"),
        ("AlignFaces", ("FaceA", "FaceB"), PLANES, "plane"),
    ],
)
def test_axes_and_faces_beside_the_corners_of_bodies_move_with_them(
    name: str, inputs: tuple[str, str], shapes: list[Any], kind: str, framed: bool, tmp_path: Path
) -> None:
    """Two bodies that are free to move can satisfy the joint without strain: then every distance within a box and its
    axis is what it was, and the axes are one line, or the faces in one plane."""
    found = places(ran(assembly(name, inputs, shapes, kind, framed), tmp_path))
    count = len(shapes[0])
    assert len(found) == 2 * (count + 8 + 1)
    # in the order in which they appear: the ends of the joint, then each box and the origin of its frame
    one, other = found[:count], found[count : 2 * count]
    boxes = found[2 * count :].reshape(2, 9, 3)
    middle = [0.5, 0.5, 0.5]
    for own, box, ends, dx in zip((one, other), boxes, shapes, (0.0, 3.0), strict=True):
        before, after = np.vstack([ends, np.vstack([CORNERS, middle]) + [dx, 0, 0]]), np.vstack([own, box])
        apart = np.linalg.norm(before[:, None] - before[None], axis=2)
        np.testing.assert_allclose(np.linalg.norm(after[:, None] - after[None], axis=2), apart, atol=1e-4)
    if kind == "line":
        along = (one[1] - one[0]) / np.linalg.norm(one[1] - one[0])
        assert np.abs(np.cross(other - one[0], along)).max() < 1e-4
    else:
        normal = np.cross(one[1] - one[0], one[2] - one[0])
        assert np.abs((other - one[0]) @ normal).max() < 1e-4 * np.linalg.norm(normal)
