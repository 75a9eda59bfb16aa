"""Particles that a plane pushes back to its front, with dry friction: E = k d^2 / 2, d the depth
behind the plane.

The plane goes through O, its front is where the normal n points, and it has no edge. A solid with
its corners at these particles rests on it by them, and so by its edges and faces. A force F on a
particle sinks it in by F / k. With friction a particle sticks where it touched the plane first, as
stiff along the plane as across it, until that takes mu k d; then it slides. For what touches at the
start, and when nothing moves in time, it sticks where it starts. Source: Cundall and Strack, "A
discrete numerical model for granular assemblies", 1979.

E = k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "solid_plane_collide",
    points=_point,
    origin=_origin_,
    normal=_normal_,
    strength=_strength_,
    friction=_friction_,
    name=name_,
)
