"""Quads that become flat: E = k d^2 / 2, d the distance between the diagonals.

The force k d acts along the common normal of the diagonals, through the points where they are
nearest to each other, and is shared by their ends accordingly: forces and moments sum to zero. In a
quad whose diagonals halve each other each corner takes k d / 2, as in K2. Polygons of n corners,
given as rows of n particles, are made flat by the n quads of four corners in a row. A quad whose
diagonals are parallel, or that has one of zero length, has no force. Triangles of the mesh are
flat.

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "planarize",
    points=(_point_1, _point_2, _point_3, _point_4),
    mesh=_mesh,
    stiffness=_stiffness_,
    name=name_,
)
