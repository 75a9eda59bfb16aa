"""Hinges between the triangles start-end-tip 1 and end-start-tip 2: moment M = S (theta - theta0).

theta [rad] is the fold angle, 0 where flat, positive where the tips rise to the side of (end -
start) x (tip 1 - start). Energy per hinge S (theta - theta0)^2 / 2, with theta - theta0 taken in
(-pi, pi] and theta0 = rest angle x angle factor; a triangle without height has no fold and no
force. S is the moment about the edge per radian, whatever the size of the triangles: a plate of
bending stiffness D [force length] cut into parallel strips of width h has S = D l / h along folds
of length l; `shell` finds what a plate needs on any mesh. With a limit the hinge yields: beyond
this angle from rest the moment stays the same, S x limit, and at the end of the step the rest angle
follows up to that angle. Forces and moments of every hinge sum to zero. Folds of origami are hinges
with the angle of a mountain or valley as rest angle, and the folding as its factor. Source:
Grinspun et al., "Discrete shells", 2003.

E = S (theta - theta0)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "hinge",
    points=(_point_1, _point_2, _point_3, _point_4),
    strength=_strength_,
    rest_angle=rest_angle_,
    angle_factor=_angle_factor_,
    limit=_limit_,
    name=name_,
)
