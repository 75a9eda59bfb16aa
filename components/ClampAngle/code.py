"""Moments between pairs of lines that are free between two angles and elastic outside: M = S (theta -
theta0).

theta is the angle between the directions of the lines, from 0 to pi, and theta0 the limit that is
passed; energy S (theta - theta0)^2 / 2, and 0 between the limits. The lines need not meet; forces
and moments of each pair sum to zero. The moment is the same for lines of any length, other than
that of K2's ClampAngle.

E = S (theta - theta0)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "clamp_angle",
    points=(_point_1, _point_2, _point_3, _point_4),
    strength=_strength_,
    lower_limit=_lower_limit_,
    upper_limit=_upper_limit_,
    name=name_,
)
