"""Particles pulled to the closest point C of a curve that itself stays where it is: E = S |C - x|^2 /
2.

The curve is a polyline, open or closed; give a NURBS curve as points that divide it finely
(`discretize.divide`): a piece is off by length^2 / (8 radius) and askew by length / (2 radius),
which holds back that part of a load as friction would. Of points equally near, that on the first
piece is taken. Particles may slide along. One rests at a distance load / S from the curve; a
strength of 0 has no effect (it is not a hard constraint). Source: classic Kangaroo's CurvePull;
Ericson, Real-Time Collision Detection, 2005, chapter 5 (closest points).

E = S |C - x|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pull_to_curve",
    curve=_curve,
    points=_point,
    strength=_strength_,
    name=name_,
)
