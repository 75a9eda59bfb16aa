"""A load: a constant force vector F on each particle. Energy -F . x. Source: the chapter, 9.3.

Particles with rotations, the ends of beams, may have a moment M beside. It keeps its direction in
space, and so has no energy in general. Equilibria are exact; tangents leave out its skew part, M x
/ 2, so that Newton steps and stability are exact where all rotations are about the axis of M.

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
