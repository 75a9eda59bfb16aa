"""A load q per length of lines, in one direction, half of it on each end: f = q l g / 2.

g is the direction of the load, gravity unless given. l is the true length as it is now: the load
grows with the line, as that of a cable that is paid out, or of ice; a cable that carries it has the
shape of a catenary whatever its stiffness. Per plan l is the length of the line's shadow along g,
as of snow: a cable that carries it is a parabola. Per start l stays that of the start, as the
weight of a line that stretches. Per true and plan length these forces have no energy: moving a line
up long and down short gains work; what is reported is -F . x of the present load F. Newton steps
use the symmetric part of their stiffness.

f = q l g/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "line_weight",
    lines=_connection,
    weight=_weight_,
    per=_per_,
    direction=_direction_,
    name=name_,
)
