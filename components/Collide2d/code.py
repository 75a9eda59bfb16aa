"""Closed polygons in a plane that push each other apart: E = k d^2 / 2 for each corner of one inside
another, d its distance to the nearest point of that one's outline.

The corner is pushed by k d, and both ends of the edge by the opposite, shared as the point lies
between them: the forces sum to zero, and so do their moments about the normal of the plane. Only
what is square to `normal` counts: where polygons are at different heights above the plane, it holds
the rest of the moments. Polygons are closed loops of edges, given head to tail in any order; each
loop is one, and does not feel itself. Where sides cross without a corner inside, nothing is pushed:
divide long sides. Polygons keep their shapes by other forces (springs, `rigid_body`,
`polygon_area`). For one curve that stays where it is see `collide_curve`. Source: Kangaroo 2's
Collide2d.

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "collide_2d",
    lines=_connection,
    normal=_normal_,
    strength=_strength_,
    name=name_,
)
