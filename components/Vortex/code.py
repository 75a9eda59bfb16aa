"""Particles pushed around an axis, by a power of their distance d from it: F = S d^n, square to axis
and radius.

Positive S turns counter-clockwise as seen against the axis. n = 1 is the field of a rigid rotation,
n = -1 that of a thin vortex. The force has no potential: a particle that goes round gains 2 pi S
d^(n+1) each time, so it settles only with drag: use `verlet` where it is strong beside what holds
the particle. Newton steps take the symmetric part of its stiffness. A positive cutoff lets it act
below this distance only, a negative one above it only. Particles nearer than 1e-20 to the axis feel
nothing.

F = S d^n
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "vortex",
    points=_point,
    origin=_origin_,
    axis=_axis_,
    strength=_strength_,
    exponent=_exponent_,
    cutoff=_cutoff_,
    name=name_,
)
