"""Lines with the same tension T at any length, such as ropes over pulleys to hanging weights: E = T l.

Where three of the same tension meet, they meet at 120 degrees (the Fermat point): the lines of a
loaded net of constant tensions have the least total T l, and many lines of it may vanish. A line
shorter than e, a thousandth of the mean start length of the lines of its force, closes up smoothly,
with T l / e (E = T (l^2 / e + e) / 2): where others hold it with less than T, it has that fraction
of e as its length and reports that force. A negative tension pushes the ends apart. Source:
Maxwell, On reciprocal figures, frames and diagrams of forces, 1870 (T l); Huber, "Robust estimation
of a location parameter", Ann. Math. Statist. 35 (1964) 73 (below e); K2's ConstantTension, which
pulls with half of its strength.

E = T l; T (l^2/e + e)/2 below e
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "constant_tension",
    lines=_connection,
    tension=_tension_,
    name=name_,
)
