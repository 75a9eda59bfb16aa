"""Pressure p normal to the faces of a mesh, on the side their corners run counter-clockwise: f = p A n
/ 3.

A and n are those of the shape as it is, so the force follows the face (wind and air, not snow).
Each corner of a triangle takes a third; a quad is the mean of its two cuts into triangles. Positive
p pushes along the normal: out of a closed mesh whose faces are oriented outwards. On a closed mesh,
or where the rim is held, these forces have the energy -p V, V the volume between the mesh and its
start centre, and that is the energy reported; with a free rim they have none (turning a flap in a
loop can gain work), and Newton steps take the symmetric part of their stiffness.

f = p A n / 3
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pressure",
    mesh=_mesh,
    pressure=_pressure_,
    name=name_,
)
