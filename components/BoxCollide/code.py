"""Boxes along the axes that keep their volume and proportions and push each other apart: E = sum k o^2
/ 2 + sum K l^2 (V / V0 - 1)^2 / 2 + sum S |a - s a0|^2 / 2.

Each box is given by two opposite corners, which are particles. o is how far two boxes overlap along
the axis where that is least, and what is pushed are the faces that meet there. V / V0 is the volume
of a box by that at the start, l^3 = V0; a are its sizes, a0 those at the start and s the scale of
least squares: a box that grows or shrinks as a whole keeps its proportions. Where all boxes are
flat along an axis, they are rectangles in the plane of the others. Forces sum to zero. Boxes do not
turn: that is what their axes, which are fixed in space, hold, and why the moments of these forces
do not sum to zero. All boxes of the force can touch. For boxes that are tilted in any way, or turn,
use `rigid_body` and `rigid_collide`, each with the eight corners of every box as a group. Sources:
Cohen et al., "I-COLLIDE", 1995 (sorted ends); classic Kangaroo's BoxCollide.

E = sigma k o^2/2 + sigma K l^2 (V/V0 - 1)^2/2 + sigma S |a - s a0|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "box_collide",
    lines=_connection,
    strength=_strength_,
    volume_strength=_volume_strength_,
    proportion_strength=_proportion_strength_,
    name=name_,
)
