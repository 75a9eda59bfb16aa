"""Quads whose opposite sides have the same product of lengths: E = k u^2 / 2 with u = 2 (L0 L2 - L1
L3) / (L0 + L1 + L2 + L3).

u is a length: of a rectangle it is the difference of its sides. Where the corners also lie on a
circle (use `cyclic_quad`) the cross ratio of each quad is -1: the mesh is a discrete isothermic
surface, a net of conformal squares along lines of curvature, as minimal surfaces and surfaces of
revolution have. Scaling a quad scales u. Forces and moments of every quad sum to zero; a quad
without any size has no force. Triangles of the mesh have none. Source: Bobenko and Pinkall,
"Discrete isothermic surfaces", 1996.

E = 2 k ((L0 L2 - L1 L3)/(L0 + L1 + L2 + L3))^2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "isothermic",
    points=(_point_1, _point_2, _point_3, _point_4),
    mesh=_mesh,
    stiffness=_stiffness_,
    name=name_,
)
