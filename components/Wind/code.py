"""Wind on the faces of a mesh: f = q A (n.d) n, normal to each face, a third of it on each corner.

q is the velocity pressure, rho W^2 / 2 times a coefficient, d the direction of the wind, A and n
area and normal of the shape as it is. Either side of a face may meet the wind: the force is the
same for a mesh turned inside out, and is q A cos(theta) on a plate at angle theta. Nothing shelters
a face from the wind. A quad is the mean of its two cuts into triangles. These forces have no
energy, and Newton steps take the symmetric part of their stiffness.

With the speed W of the wind given, a face that moves with the velocity u feels the wind relative to
it: f = q A n.(d - u / W) n, which takes energy out of its vibrations. With a waterline the wind
blows on what is above the level alone, or below it as a current does: faces that the level cuts
share the integrals of the part that is in the wind, exactly.

f = q A (n.d) n
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "wind",
    mesh=_mesh,
    pressure=_pressure_,
    direction=_direction_,
    speed=_speed_,
    waterline=waterline_,
    below=_below_,
    name=name_,
)
