"""Particles of a group are pulled onto one line: E = sum k d^2 / 2, d the distances to its least-
squares line.

The line goes through the mean of the particles, weighted by k, along the axis of their largest
variance. It moves with them: forces and moments sum to zero. Each particle feels k at most. Two
particles always have a line.

E = sigma k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "co_linear",
    points=_point,
    group=group_,
    strength=_strength_,
    name=name_,
)
