"""Particles pulled to the closest point of a straight line that stays where it is: E = k d^2 / 2.

The line goes through O along t and has no ends (for one with ends, see `pull_to_curve`). Particles
may slide along it; one rests at a distance load / k from it.

E = k (|x - O|^2 - (t.(x - O))^2)/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pull_to_line",
    points=_point,
    origin=_origin_,
    direction=_direction_,
    strength=_strength_,
    name=name_,
)
