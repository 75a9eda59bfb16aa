"""Elastic supports: a force -k d along each axis of space for the displacement d, and moments for
rotations.

E = sum over x, y, z of (k d^2 + kr phi^2) / 2. The displacement is that from the start position, or
from a target; phi is the rotation vector of the particle's orientation, turned from the start, of
at most half a turn (there the moment changes its sign). Only particles at the ends of beams have
rotations. A support that must not give way is one of the scene's `anchors`.

E = sigma (k d^2 + kr phi^2)/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "support",
    points=_point,
    stiffness=_stiffness_,
    rotation_stiffness=_rotation_stiffness_,
    targets=targets_,
    name=name_,
)
