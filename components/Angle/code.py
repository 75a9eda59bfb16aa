"""Moments between pairs of lines that turn them to a rest angle: M = S (theta - theta0).

theta [rad] is the angle between the directions of the lines, start to end, from 0 (the same
direction) to pi; the lines need not meet. Energy S (theta - theta0)^2 / 2. The moment acts on each
line as a couple, so that forces and moments sum to zero. A rest angle of 0 aligns two lines;
`angle_snap` with a multiple of pi aligns them in the same or the opposite direction, whichever is
nearer. Exactly parallel lines with another rest angle have no plane in which to turn, and no
moment. For the bending of rods use `bend`. Source: Adriaenssens and Barnes, "Tensegrity spline beam
and grid shell structures", 2001, with the angle in the place of its sine.

E = S (theta - theta0)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "angle",
    points=(_point_1, _point_2, _point_3, _point_4),
    strength=_strength_,
    rest_angle=rest_angle_,
    name=name_,
)
