"""Pairs of particles a, b of which b is pulled to the image of a, and a so that its image meets b.

Energy k |b - T a|^2 / 2, T an affine transformation: T p = A p + t, given as a matrix of 3 or 4
rows and 4 columns [A t]. The force on a is k A^T (b - T a): for a motion or a mirror image that is
as large as on b, with a scale s it is s times that. K2's Transform has half of its strength as k,
and is the same for motions.

E = k |b - T a|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "transform_lock",
    lines=_connection,
    stiffness=_stiffness_,
    matrix=_matrix,
    name=name_,
)
