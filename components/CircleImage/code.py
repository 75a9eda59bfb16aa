"""Circles, as large as an image says where they are, that push each other apart: E = k (R(p) + R(q) -
d)^2 / 2.

d is the distance of two centres, and the radius R at each is that of the image there, by x and y: a
grid of numbers from 0 to 1 over a rectangle, 0 for the smallest radius and 1 for the largest.
Between the numbers R is a quadratic B-spline, which follows linear images exactly, blurs edges by
about a pixel and has no creases. Overlapping circles are also pushed to where they are smaller, as
the energy has it: the image carries that part of the forces, so their sum is not zero. Circles that
just touch feel nothing. For a fixed radius of each circle see `collide`. Those of one
`collision_group` ignore each other.

E = k (R(p) + R(q) - d)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "circle_image",
    points=_point,
    image=_image,
    corners=_corners,
    minimum_radius=_minimum_radius_,
    maximum_radius=_maximum_radius_,
    strength=_strength_,
    collision_group=collision_group_,
    name=name_,
)
