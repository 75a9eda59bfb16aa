"""Particles of a group are pulled into one plane: E = sum k d^2 / 2, d the distances to its least-
squares plane.

The plane goes through the mean of the particles, weighted by k, square to the axis of their least
variance. It moves with them: forces and moments sum to zero. Each particle feels k at most. Three
particles or fewer always have a plane. Where the two least variances are equal, as at the corners
of a cube, the plane is one of several.

E = sigma k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "co_planar",
    points=_point,
    group=group_,
    strength=_strength_,
    name=name_,
)
