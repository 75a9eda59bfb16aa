"""Particles of a group are pulled onto one sphere: E = sum k d^2 / 2, d the distances to its least-
squares sphere.

Centre and radius are those of the least sum of squared distances, weighted by k; the search starts
from an algebraic fit (Coope, "Circle fitting by linear and nonlinear least squares", 1993). The
sphere moves and grows with the particles: forces and moments sum to zero. Each particle feels k at
most. Four particles or fewer always have a sphere. A group in one plane, or with a radius beyond
100,000 times its size, has a plane instead.

E = sigma k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "co_spherical",
    points=_point,
    group=group_,
    strength=_strength_,
    name=name_,
)
