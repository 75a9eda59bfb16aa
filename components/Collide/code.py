"""Spheres about particles that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

a and b are the radii of two spheres, d is the distance of their centres. All spheres of the force
can touch, of any radii, except those of one `collision_group`. Two pressed together with a force F
overlap by F / k. Spheres with the same centre have no direction in which to part: nothing pushes
them.

E = k (a + b - d)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "collide",
    points=_point,
    radius=_radius_,
    strength=_strength_,
    collision_group=collision_group_,
    name=name_,
)
