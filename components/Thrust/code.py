"""A force F along a line that turns with it, from its start to its end, half on each of them: f = F u
/ 2.

u is the direction of the line. The force has no moment about the middle of its line. It has no
energy: a line that is moved along, turned and moved back has gained work. A body of mass m that
turns at an even rate, so that the thrust remains at a right angle to its speed v, runs in a circle
of radius m v^2 / F. A line of zero length has no direction and no thrust. Newton steps use the
symmetric part of its stiffness. Source: classic Kangaroo's Rocket.

f = F u/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "thrust",
    lines=_connection,
    thrust=_thrust_,
    name=name_,
)
