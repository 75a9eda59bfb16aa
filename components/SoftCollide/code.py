"""Closed meshes that deform and push each other apart: E = k d^2 / 2 for each vertex of one inside
another, d its distance to the nearest point of that one's surface.

The vertex is pushed by k d, and the corners of the nearest face by the opposite, shared by the
barycentric coordinates of the point: forces and moments sum to zero. The bodies are the parts of
one mesh that are not joined: each is closed, and does not feel itself. Quads are cut along the
diagonal that leaves no sliver at the start. Where edges cross without a vertex inside, nothing is
pushed: sharp bodies need fine meshes. Bodies keep their shapes by other forces (springs, `volume`,
`rigid_body`). For a solid that stays where it is see `collide_solid`. Sources: Ericson, Real-Time
Collision Detection, 2005, 5.1.5 (closest points); Kangaroo 2's SoftBodyCollide.

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "soft_collide",
    mesh=_mesh,
    strength=_strength_,
    name=name_,
)
