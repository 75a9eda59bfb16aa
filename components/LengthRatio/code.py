"""Pairs of lines A, B of which B is r times as long as A: E = k (b - r a)^2 / 2, a and b their
lengths.

The tension k (b - r a) acts in B, and -r times that in A: where B is too long, it shortens and A
lengthens. The lines need not meet; forces and moments of each pair sum to zero. A line of zero
length has no direction and no force.

E = k (b - r a)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "length_ratio",
    points=(_point_1, _point_2, _point_3, _point_4),
    stiffness=_stiffness_,
    ratio=_ratio_,
    name=name_,
)
