"""Circles that a closed curve in their plane pushes out where they overlap it: E = k d^2 / 2, d the
depth.

The curve is a polyline that itself stays where it is; its last corner is joined to the first. d = r
- s, where s is the distance of a particle to the closest point of the curve, negative inside; with
`inside` the free side is the inside, and d = r + s. Only what is square to `normal` counts:
particles move freely along it, and the curve is a prism without ends. Give a NURBS curve as points
that divide it finely (`discretize.divide`). It may not cross itself. Source: Baerentzen and Aanaes,
"Signed distance computation using the angle weighted pseudonormal", 2005.

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "collide_curve",
    curve=_curve,
    points=_point,
    normal=_normal_,
    radius=_radius_,
    inside=_inside_,
    strength=_strength_,
    name=name_,
)
