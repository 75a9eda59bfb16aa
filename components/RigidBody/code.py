"""Particles of a group keep the shape of a body that moves and turns with them: E = sum k |x - (R q +
c)|^2 / 2.

q is the place of each particle in the body, drawn or given; R and c are the rotation and the place
of the body for which E is least, so forces and moments of a group sum to zero, and a body that is
moved and turned as a whole has no energy. Each particle feels k at most: a body is as stiff as k is
large. Particles on one line leave the turn about that line free. Particles of several bodies join
them: one is a ball joint, two are a hinge, three hold. Sources: Horn, "Closed-form solution of
absolute orientation using unit quaternions", 1987 (the rotation); Mueller et al., "Meshless
deformations based on shape matching", 2005.

E = sigma k |x - (R q + c)|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "rigid_body",
    points=_point,
    group=group_,
    shape=shape_,
    strength=_strength_,
    name=name_,
)
