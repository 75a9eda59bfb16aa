"""Pairs of particles pulled to one place: f = k (p1 - p0), E = k |p1 - p0|^2 / 2.

It is a spring of rest length 0 without damping, for constraints: ends that should meet, parts that
should be joined. Under a load P across it a pair is P / k apart.

E = k |p1 - p0|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "coincident",
    lines=_connection,
    strength=_strength_,
    name=name_,
)
