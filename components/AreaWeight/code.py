"""A weight q per area of the faces of a mesh as large as they are now: f = q A g / 3 on each corner.

g is the direction of gravity. The load grows with the faces, as that of a form-found shell of
constant thickness, of whose final area nothing is known yet, or of snow. A quad is the mean of its
two cuts into triangles. The weight of a membrane that stretches is conserved by `self_weight`, with
a total. These forces have no energy: moving a face up large and down small gains work. Newton steps
use the symmetric part of their stiffness.

f = q A g/3
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "area_weight",
    mesh=_mesh,
    weight=_weight_,
    direction=_direction_,
    name=name_,
)
