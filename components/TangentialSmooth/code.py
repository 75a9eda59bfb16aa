"""Interior vertices of a mesh move along it, under or over the mean of their neighbours: E = k |r -
(r.n) n|^2 / 2.

r is the vector from the mean of the neighbours to the vertex, n the normal of their ring, along its
area vector. The vertex is pulled in its tangent plane only, and keeps its height over the mean;
where it has a height, the neighbours feel a small couple that turns the normal: forces and moments
sum to zero. It keeps meshes even without making them flat. The faces have one orientation. A ring
without area has no normal and no force. `soapfilm` keeps its triangles even by itself.

E = k |r - (r.n) n|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "tangential_smooth",
    mesh=_mesh,
    stiffness=_stiffness_,
    name=name_,
)
