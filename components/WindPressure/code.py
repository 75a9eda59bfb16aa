"""Wind as codes give it, on the faces of a mesh: f = -q Cp A n / 3 on each corner, q times a pressure
coefficient.

n and A are the normal and the area of a face as it is; n points to the side on which its corners
run counter-clockwise, the outside. A positive Cp presses on the outside, a negative one is suction.
For a roof that is open below, give the net coefficient of both sides.

By regions, `coefficient` is one Cp, or one for each face. By angle, `angles` are those [deg]
between the outward normal and the direction the wind comes from (0: the face meets the wind, 180:
it is in the lee), and `coefficient` has a Cp for each: linear between them, constant beyond. The
angle follows the shape. These forces have no energy unless Cp is constant and the rim held, and
Newton steps take the symmetric part of their stiffness. Source: EN 1991-1-4, 5.2 (external pressure
we = qp(ze) cpe).

f = -q Cp A n/3
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "wind_pressure",
    mesh=_mesh,
    pressure=_pressure_,
    coefficient=_coefficient_,
    angles=angles_,
    direction=_direction_,
    name=name_,
)
