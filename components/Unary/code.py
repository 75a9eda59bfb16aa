"""A load: a constant force vector F on each particle. Energy -F . x. Source: the chapter, 9.3.

Particles with rotations, the ends of beams, may have a moment M beside. It keeps its direction in
space, and so has no energy in general. Equilibria are exact, and Newton steps have its whole
tangent. Stability, frequencies and buckling leave out the skew part, M x / 2: they are exact where
all rotations are about the axis of M. Where they find the shape unstable, from about M = 3 EI / L
on a cantilever, a run leaves it and may not come to rest.

E = -F.x
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "unary",
    points=_point,
    vector=_force,
    moment=_moment_,
    name=name_,
)
