"""Pairs of particles a, b that are pulled to each other's mirror image in a plane: E = k |b - M a|^2 /
2.

M p = p - 2 n (n . (p - o)) is the image in the plane through o normal to n, which is fixed in
space. As M is its own inverse, both particles have forces of the same size: the force on a is the
image of that on b.

E = k |b - M a|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "mirror",
    lines=_connection,
    stiffness=_stiffness_,
    point=_point_,
    normal=_normal_,
    name=name_,
)
