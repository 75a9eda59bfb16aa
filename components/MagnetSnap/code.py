"""Particles of a group that attract each other where they are nearer than the range R: E = k (d^2 -
R^2) / 2.

The force k d of each pair ends at once at the range, and the energy is 0 from there on; what is
near meets, and what is far stays as it is. Which pairs are near is found in every step, in a time
that grows with the number of particles. Groups of more than 100 particles have no tangent: such
models relax, and their stability is unknown.

E = k (d^2 - R^2)/2, d < R
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "magnet_snap",
    points=_point,
    group=group_,
    strength=_strength_,
    range=_range_,
    name=name_,
)
