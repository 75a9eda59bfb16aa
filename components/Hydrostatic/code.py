"""Pressure of a liquid at rest on a mesh: p = gamma (level - z) below its level, 0 above, normal to
the faces.

gamma is the weight of the liquid per volume, 9.81 kN/m^3 for water; z is up. Each corner of a
triangle takes the integral of p and its linear function over the wet part, exactly, also where the
level cuts the face: resultants and their lines of action are those of the liquid on any mesh. A
quad is the mean of its two cuts into triangles. Positive gamma pushes along the normals, the liquid
being on the other side of the faces; negative gamma is a liquid on the side of the normals, as
around a ship whose faces are oriented outwards, or of water that ponds on a roof up to a level:
where the roof sags, there is more of it. On a closed mesh, or where the rim is held, these forces
have an energy, and that is the one reported; with a free rim they have none, and Newton steps take
the symmetric part of their stiffness.

p = gamma (level - z)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "hydrostatic",
    mesh=_mesh,
    weight=_weight_,
    level=_level_,
    name=name_,
)
