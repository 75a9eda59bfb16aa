"""Moments between pairs of lines that turn them to the nearest multiple of an angle a: M = S (theta -
n a).

theta is the angle between the directions of the lines, from 0 to pi, and n a the nearest multiple
up to pi; energy S (theta - n a)^2 / 2. n is found again wherever the lines are, so that each
multiple has a well of its own. A multiple of pi / 2 makes lines parallel or perpendicular, one of
pi parallel in the same or the opposite direction. The lines need not meet; forces and moments of
each pair sum to zero.

E = S (theta - n a)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "angle_snap",
    points=(_point_1, _point_2, _point_3, _point_4),
    strength=_strength_,
    multiple=_multiple_,
    name=name_,
)
