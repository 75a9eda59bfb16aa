"""Convex solids that push each other apart where they overlap, with dry friction: E = k V d.

A solid is the convex hull of the particles of a group, where they are at the start. It is rigid,
and moves with the best fit to its particles; `rigid_body` with the same groups keeps these in their
places. Of two that overlap, the face that is nearest to the centroid of the overlap presses on the
other solid by k d, d the depth below the face. This is an elastic foundation: on an area A a force
F sinks in by F / (k A), a moment M turns it by M / (k I). The energy is the integral of k d over
the overlap, its volume V by the depth of its centroid. Forces and moments are shared among all
particles of a solid, so that their sums stay.

With friction they stick, as stiff along the contact as across it, until mu N is reached, mu the
smaller of both. What holds starts from where they touch first: at the start itself for what touches
there, and when they do not move in time. A solid that is not convex is made of several with one
`collision_group`, on the particles of one body. For boxes that are tilted in any way, give their
eight corners as a group here and to `rigid_body`; boxes along the axes that may grow or shrink are
`box_collide`. Corners of two solids at one place, given as points, become one particle: give them
as particles, or draw a joint. Boxes that are flush without friction are no stable stack: each gains
room by moving out.

E = k V d
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "rigid_collide",
    points=_point,
    group=group_,
    strength=_strength_,
    friction=_friction_,
    collision_group=collision_group_,
    name=name_,
)
