"""Particles of a group are pulled onto one circle: E = sum k d^2 / 2, d the distances to its least-
squares circle.

Plane, centre and radius are those of the least sum of squared distances in space, weighted by k.
The circle moves and grows with the particles: forces and moments sum to zero. Each particle feels k
at most. Three particles or fewer always have a circle. A group on one line, or with a radius beyond
100,000 times its size, has a line instead. Source: Coope, "Circle fitting by linear and nonlinear
least squares", 1993, for the start of the search.

E = sigma k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "co_circular",
    points=_point,
    group=group_,
    strength=_strength_,
    name=name_,
)
