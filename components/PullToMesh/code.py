"""Particles pulled to the closest point C of a mesh that itself stays where it is: E = S |C - x|^2 /
2.

The target is one of the scene's meshes by name, or vertices and faces of its own; it makes no
particles and does not move with any. Quads count as both of their cuts into triangles. Of points
equally near, that on the triangle given first is taken. A particle rests at a distance load / S
from the mesh; a strength of 0 has no effect (it is not a hard constraint). Pulls do not know inside
from outside (`collide_solid` does). Source: Ericson, Real-Time Collision Detection, 2005, chapters
5 and 6 (closest points, trees of boxes).

E = S |C - x|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pull_to_mesh",
    target=_target,
    points=_point,
    strength=_strength_,
    name=name_,
)
