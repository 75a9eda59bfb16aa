"""Pairs of triangles whose incircles touch at their common edge: E = k u^2 / 2, u how far apart they
touch it.

With the sides L0 to L3 round both triangles u = (L0 - L1 + L2 - L3) / 2, so u is zero where L0 + L2
= L1 + L3 (a circle packing mesh, CP mesh, has this at all edges). Forces and moments of every pair
sum to zero. Edges of a mesh count where two triangles share them; its quads are left out. Source:
Schiftner et al., "Packing circles and spheres on surfaces", 2009.

E = k (L0 - L1 + L2 - L3)^2/8
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "tangent_incircles",
    points=(_point_1, _point_2, _point_3, _point_4),
    mesh=_mesh,
    stiffness=_stiffness_,
    name=name_,
)
