"""A soft anchor: a spring of rest length 0 to a target, f = S (T - x), E = S |T - x|^2 / 2.

The particle moves by load / S; an anchor that must not move is one of the scene's `anchors`. The
default strength is that of Kangaroo 2's Anchor.

E = S |T - x|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "anchor_spring",
    points=_point,
    strength=_strength_,
    targets=targets_,
    name=name_,
)
