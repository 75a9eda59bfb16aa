"""A weight q per length of lines as long as they are now, half of it on each end: f = q l g / 2.

g is the direction of gravity. The load grows with the line, as that of a cable that is paid out, of
ice or of snow on a line; a cable that carries it has the shape of a catenary whatever its
stiffness. The weight of a line that stretches is conserved by `self_weight`, with its start length.
These forces have no energy: moving a line up long and down short gains work. Newton steps use the
symmetric part of their stiffness.

f = q l g/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "line_weight",
    lines=_connection,
    weight=_weight_,
    direction=_direction_,
    name=name_,
)
