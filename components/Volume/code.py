"""A closed mesh that resists a change of its volume V: E = K (V - V0)^2 / (2 V0), a pressure p = K (V0
- V) / V0.

K is the bulk modulus of what is in it, V0 the volume at the start times a factor. Each corner of a
triangle takes p A n / 3. Faces are oriented outwards; forces and moments sum to zero. Meshes of
more than 300 particles have no tangent: such models relax, and their stability is unknown.

E = K (V - V0)^2/(2 V0)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "volume",
    mesh=_mesh,
    stiffness=_stiffness_,
    volume_factor=_volume_factor_,
    name=name_,
)
