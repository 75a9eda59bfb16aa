"""Groups of pairs of lines that turn to the same angle: E = sum S (theta - m)^2 / 2, m the mean of the
group.

theta is the angle between the directions of the lines of a pair, from 0 to pi, as for `angle`. m is
weighted by S, so that the energy is least by it, and the moment of each pair is S (theta - m). The
lines need not meet; forces and moments of each pair sum to zero. Pairs with the same number are one
group; without numbers all are.

E = sigma S (theta - m)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "equal_angle",
    points=(_point_1, _point_2, _point_3, _point_4),
    group=group_,
    strength=_strength_,
    name=name_,
)
