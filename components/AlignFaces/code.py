"""Pairs of faces that come into one plane, with opposite normals: E = k (d1^2 + d2^2) / 4 + M (1 + n1
. n2).

A face is three particles, its normal n by the right-hand rule; what they are the corners of is
another force's matter, such as `rigid_body`. d1 and d2 are the distances of the middle of each face
from the plane of the other. With `flip` normals become the same, 1 - n1 . n2. Faces may slide and
turn in their common plane. Pulled apart by a force F they have a distance of F / k; a moment M1
that bends one away turns it by M1 / M.

E = k (done^2 + dtwo^2)/4 + M (1 + none.ntwo)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "align_faces",
    points=(_point_1, _point_2, _point_3, _point_4, _point_5, _point_6),
    strength=_strength_,
    moment=_moment_,
    flip=_flip_,
    name=name_,
)
