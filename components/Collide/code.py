"""Spheres about particles that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

a and b are the radii of two spheres, d is the distance of their centres. All spheres of the force
can touch, of any radii, except those of one `collision_group`. Two pressed together with a force F
overlap by F / k. Spheres with the same centre have no direction in which to part: nothing pushes
them.

In physical time (`verlet`, `yoshida`, simulations) two that meet with the speed u part with e u: a
dashpot c = 2 zeta sqrt(k m) acts while they overlap, m their reduced mass, zeta = -ln e / sqrt(pi^2
+ ln^2 e). With friction they stick where they touched first, as stiff along the contact as across
it, until mu N is reached, N the force that presses them together; then they slip. Spheres do not
turn, so with friction the sum of their moments is not zero. At rest, and where nothing moves in
time, there is neither. Source: Cundall and Strack, "A discrete numerical model for granular
assemblies", 1979.

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
    restitution=_restitution_,
    friction=_friction_,
    name=name_,
)
