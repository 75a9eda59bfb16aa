"""Closed polygons that resist a change of their area A: E = K (A - A0)^2 / (2 A0), K [force/length].

A is the size of the area vector, sum (a x b) / 2 over the edges a-b: of a polygon that is not flat
the area of its largest flat shadow. Edges of a polygon are given head to tail, in any order; each
polygon is a group. A0 is the area at the start times a factor. Forces and moments sum to zero; each
edge is pushed square to itself within the plane, by K (A0 - A) / A0 times its length. Polygons of
more than 100 edges have no tangent: such models relax, and their stability is unknown.

E = K (A - A0)^2/(2 A0)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "polygon_area",
    lines=_connection,
    group=group_,
    stiffness=_stiffness_,
    area_factor=_area_factor_,
    name=name_,
)
