"""Wind on the faces of a mesh: f = q A (n.d) n, normal to each face, a third of it on each corner.

q is the velocity pressure, rho v^2 / 2 times a coefficient, d the direction of the wind, A and n
area and normal of the shape as it is. Either side of a face may meet the wind: the force is the
same for a mesh turned inside out, and is q A cos(theta) on a plate at angle theta. Nothing shelters
a face from the wind. A quad is the mean of its two cuts into triangles. These forces have no
energy, and Newton steps take the symmetric part of their stiffness.

f = q A (n.d) n
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "wind",
    mesh=_mesh,
    pressure=_pressure_,
    direction=_direction_,
    name=name_,
)
