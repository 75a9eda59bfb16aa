"""Capsules about lines that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

a and b are the radii of two capsules, d is the shortest distance of their lines, and the force k (a
+ b - d) acts where they are nearest, on both ends of each line by the lever rule. All capsules of
the force can touch, except those that share a particle and those of one `collision_group`. A line
that starts and ends at one particle is a sphere. Two pressed together with a force F overlap by F /
k. Lines that cross have no direction in which to part: nothing pushes them.

The contact of two capsules is one point. Of parallel ones it is in the middle of where they are
beside each other, and it moves quickly as they turn: piles of parallel capsules may not come to
rest. Source: Ericson, Real-Time Collision Detection, 2005, 4.5 and 5.1.9 (capsules, closest
points).

E = k (a + b - d)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "collide_lines",
    lines=_connection,
    radius=_radius_,
    strength=_strength_,
    collision_group=collision_group_,
    name=name_,
)
