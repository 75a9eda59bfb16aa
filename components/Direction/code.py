"""Lines parallel to a direction d that is fixed in space: E = k |part of the line across d|^2 / 2.

The force is linear: k times the part of the line, end - start, that is normal to d, on the end, and
the opposite on the start. It does not resist changes of length, and a line may point either way
along d. Without a direction each line gets the coordinate axis that is nearest to it at the start.
Forces of each line sum to zero, moments do not. K2's Direction has half of its strength as k.

E = k |l - (l.d) d|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "direction",
    lines=_connection,
    stiffness=_stiffness_,
    direction=direction_,
    name=name_,
)
