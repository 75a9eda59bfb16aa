"""Pairs of axes that become one line: E = k sum d^2 / 2, d the distances of the ends of each from the
other.

An axis is the line through two particles; what they are the corners of is another force's matter,
such as `rigid_body`. Bodies may turn about the common axis and slide along it. Of two axes of one
length l about one middle a force F moves one by F / (4 k) off the other, and a moment M turns it by
M / (k l^2).

E = k sigma d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "concentric",
    points=(_point_1, _point_2, _point_3, _point_4),
    strength=_strength_,
    name=name_,
)
