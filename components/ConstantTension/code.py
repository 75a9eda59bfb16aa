"""Lines with the same tension T at any length, such as ropes over pulleys to hanging weights: E = T l.

Where three of the same tension meet, they meet at 120 degrees (the Fermat point): the lines of a
loaded net of constant tensions have the least total T l. A negative tension pushes the ends apart.
A line of zero length has no direction and no force. Source: Maxwell, On reciprocal figures, frames
and diagrams of forces, 1870 (T l); K2's ConstantTension, which pulls with half of its strength.

E = T l
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "constant_tension",
    lines=_connection,
    tension=_tension_,
    name=name_,
)
