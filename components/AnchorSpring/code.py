"""A soft anchor: a spring of rest length 0 to a target, f = S (T - x), E = S |T - x|^2 / 2.

The particle moves by load / S; an anchor that must not move is one of the scene's `anchors`. The
default strength is that of Kangaroo 2's Anchor. With a limit, or a sticky force, the anchor slides:
beyond this distance, or this force, the force stays the same, S x limit, and at the end of the step
the target follows the particle up to that distance. The smaller of both counts.

E = S |T - x|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "anchor_spring",
    points=_point,
    strength=_strength_,
    targets=targets_,
    limit=_limit_,
    sticky=_sticky_,
    name=name_,
)
