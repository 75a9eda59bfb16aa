"""Spheres that a solid pushes out where they overlap it: E = k d^2 / 2, d the depth.

The solid is a closed mesh that itself stays where it is: one of the scene's meshes by name, or
vertices and faces of its own. d = r - s, where s is the distance of a particle to the closest point
of the mesh, negative inside; with `inside` the free side is the inside, and d = r + s. With a
radius of 0 particles themselves are kept out. One that is pressed on a face with a force F sinks in
by F / k.

Vertices at the same place count as one, quads are cut along the diagonal that leaves no sliver, and
all faces are turned outwards together. A mesh may not cross itself. Centres deep inside a thin
solid leave it by the side that is closest. Sources: Baerentzen and Aanaes, "Signed distance
computation using the angle weighted pseudonormal", 2005 (which side); Ericson, Real-Time Collision
Detection, 2005 (closest points).

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "collide_solid",
    target=_target,
    points=_point,
    radius=_radius_,
    inside=_inside_,
    strength=_strength_,
    name=name_,
)
