"""Pairs that repel each other by a power of their distance, F = S d^n; with a negative strength they
attract.

Energy -S d^(n+1) / (n+1), or -S ln d where n = -1. n = -2 is gravity or electric charge, n = 0 a
constant force, n = 1 a spring of rest length 0 (S = -k). A positive cutoff lets a pair act below
this distance only, a negative one above it only; there the force ends at once, and the energy is 0.
Pairs nearer than 1e-20 do not act.

E = -S d^(n+1)/(n + 1)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "power_law",
    lines=_connection,
    strength=_strength_,
    exponent=_exponent_,
    cutoff=_cutoff_,
    name=name_,
)
