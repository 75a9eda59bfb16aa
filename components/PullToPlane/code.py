"""Particles pulled to the closest point of a plane that stays where it is: E = k d^2 / 2, d = n . (x -
O).

The plane goes through O, square to the normal n, and has no edge. Particles may slide along it; one
rests at a distance load / k from it. Both sides are the same.

E = k (n.(x - O))^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pull_to_plane",
    points=_point,
    origin=_origin_,
    normal=_normal_,
    strength=_strength_,
    name=name_,
)
